//! Unit tests of `methods/projected_newton`: pressures at their bounds, and the constant by which pressures carry a prescribed force.

use super::bounds::{find_free, snap};
use super::projection::constant_for;
use crate::contact::{NonNegative, State};
use crate::grid::Grid;
use crate::scene::{Each, Load, PressureLimit};
use crate::threads::Threads;

fn state(load: Load, h: &[f64]) -> State {
    let grid = Grid::new(h.len(), 1, 1.0, 1.0).expect("a grid");
    let mut state = State::new(grid, (load, 0.0), &Threads::One).expect("a state");
    state.h = h.to_vec();
    state.unload();
    state
}

#[test]
fn the_constant_carries_the_sum_wherever_pressures_are_cut() {
    for wanted in [0.0, 1e-300, 1e-12, 0.3, 2.0, 2.999, 1e9] {
        // Pressures enter one after the other as the constant grows, so that two steps of Newton's method do not suffice.
        let p: Vec<f64> = (-10..10).map(|k| -f64::from(k).exp2()).chain([0.5]).collect();
        let sum = |c: f64| p.iter().map(|p| (p + c).max(0.0)).sum();
        let slope = |c: f64| p.iter().filter(|p| *p + c > 0.0).count();
        let constant = constant_for(wanted, sum, slope, 512.0);
        // A sum of 21 terms, each with a rounding error of the size of the constant.
        assert!((sum(constant) - wanted).abs() <= 21.0 * f64::EPSILON * wanted.max(512.0), "{wanted}: {constant}");
    }
}

#[test]
fn the_constant_of_a_sum_that_no_constant_reaches_is_finite() {
    // The sum is at most 3, with all pressures at their limit of 1.
    let p = [0.5, 0.2, 0.1];
    let sum = |c: f64| p.iter().map(|p| (p + c).clamp(0.0, 1.0)).sum();
    let slope = |c: f64| p.iter().filter(|p| *p + c > 0.0 && *p + c < 1.0).count();
    let constant = constant_for(4.0, sum, slope, 0.5);
    assert!(constant.is_finite() && sum(constant) == 3.0, "{constant}");
}

#[test]
fn pressures_at_a_bound_but_for_rounding_are_at_it() {
    let mut state = state(Load::Approach(1.0), &[0.0; 4]);
    let (limit, rest) = (2.0, 1e-15);
    state.p = vec![limit * (1.0 - rest), rest, 1.0, 1e-6];
    snap(&mut state, PressureLimit(Each::Uniform(limit)));
    assert_eq!(state.p, [limit, 0.0, 1.0, 1e-6]);
    // Without limits a small positive pressure stays as it is.
    state.p = vec![1.0, rest, 1.0, 1e-6];
    snap(&mut state, NonNegative);
    assert_eq!(state.p, [1.0, rest, 1.0, 1e-6]);
}

#[test]
fn an_approach_between_held_and_touched_elements_frees_those_in_the_wrong_order() {
    // With a given force and an empty C: two elements at their limit, at distances of .1 and .4, and two without pressure, at .3 and .9.
    let mut state = state(Load::Force(2.0), &[0.1, 0.4, 0.3, 0.9]);
    state.p = vec![1.0, 1.0, 0.0, 0.0];
    state.at_limit = vec![true, true, false, false];
    let (mut distance, mut free) = (vec![0.0; 4], vec![false; 4]);
    find_free(&state, PressureLimit(Each::Uniform(1.0)), &mut distance, &mut free);
    // The elements at .4 and .3 are in the wrong order. The approach is set to .35 between them.
    assert_eq!(free, [false, true, true, false], "{distance:?}");
    assert!((distance[1] - 0.05).abs() < 1e-15 && (distance[2] + 0.05).abs() < 1e-15, "{distance:?}");
}
