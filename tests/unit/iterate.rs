//! Unit tests of `solver/iterate.rs`: the descent lowers the energy in each cycle, from any pressures.

use super::*;
use crate::contact::{lowest, NonNegative, Problem, State};
use crate::grid::Grid;
use crate::influence::{Coefficients, HalfSpace};
use crate::methods::projected_newton::ProjectedNewton;
use crate::progress::Criterion;
use crate::progress::{Goal, Monitor};
use crate::scene::Load;
use crate::threads::Threads;

/// A problem of a wavy punch, in which elements leave and enter the contact.
fn scene(load: Load, wave: f64) -> (Problem, State) {
    let grid = Grid::new(14, 11, 0.1, 0.1).expect("a grid");
    let h = |i: usize| 0.02 * (wave * (i % 14) as f64).sin() * (1.3 * (i / 14) as f64).cos();
    let h = (0..grid.len()).map(h).collect();
    let influence = Coefficients::from(HalfSpace::new(0.1, 0.1, 1.0));
    let problem = Problem::new(grid, influence, &Threads::One).expect("a problem");
    let mut state = State::new(grid, (load, 0.0), &Threads::One).expect("a state");
    state.h = h;
    state.unload();
    (problem, state)
}

fn descend(problem: &mut Problem, state: &mut State, cycles: u64) -> Outcome {
    descend_to(problem, state, cycles, 1e-9)
}

fn descend_to(problem: &mut Problem, state: &mut State, cycles: u64, tolerance: f64) -> Outcome {
    let goal = Goal { criterion: Criterion::Residual, tolerance, max_cycles: cycles };
    let (mut best, mut monitor) = (Best::default(), Monitor::silent());
    best.forget();
    let mut method = ProjectedNewton::default();
    let lowest = lowest(&state.h);
    let mut task = Task { problem, state, lowest, set: NonNegative, goal, monitor: &mut monitor };
    iterate(&mut method, &mut task, &mut best).expect("a solve")
}

#[test]
fn every_cycle_of_descent_lowers_the_energy_until_the_conditions_hold() {
    let waves = (0..20).map(|k| 0.1 + 0.15 * f64::from(k));
    for (load, wave) in waves.flat_map(|wave| [(Load::Approach(0.015), wave), (Load::Force(0.02), wave)]) {
        let (mut problem, mut state) = scene(load, wave);
        let mut last = f64::INFINITY;
        for cycle in 0.. {
            assert!(cycle < 200, "{load:?}: no end");
            let stop = descend(&mut problem, &mut state, 1);
            let distance = |i: usize| state.h[i] - if let Load::Approach(a) = load { a } else { 0.0 };
            let energy: f64 = (0..state.p.len()).map(|i| state.p[i] * (0.5 * state.u[i] + distance(i))).sum();
            assert!(state.p.iter().all(|p| *p >= 0.0));
            if stop == Outcome::Converged {
                break;
            }
            // Round-off of sums of 154 terms may hide a smaller decrease.
            assert!(energy < last + 1e-13 * last.abs(), "{load:?}, cycle {cycle}: {energy:e} after {last:e}");
            last = energy;
        }
        let survey = Survey::of(&state);
        assert!(survey.residual <= 1e-9 * survey.distance && survey.violation <= 1e-9, "{survey:?}");
        assert!(state.contact_count() > 10 && state.contact_count() < 154, "{}", state.contact_count());
    }
}

#[test]
fn descent_takes_over_from_any_pressures() {
    for start in [0.0, -1.0, 1e6, f64::NAN] {
        let (mut problem, mut state) = scene(Load::Force(0.05), 2.1);
        state.p.fill(start);
        assert_eq!(descend(&mut problem, &mut state, 1000), Outcome::Converged, "from {start}");
        // The tolerance is the round-off of a sum of 154 pressures.
        assert!((state.force() - 0.05).abs() <= 1e-15);
    }
}

/// The conditions hold in C, but one element outside penetrates by five times the tolerance. Its penetration is much smaller than the norm over C
/// that the tolerance allows, and must still count.
#[test]
fn one_element_that_penetrates_enters_a_large_contact_area() {
    let grid = Grid::new(48, 48, 0.1, 0.1).expect("a grid");
    let place = |k: usize| 0.1 * (k as f64 - 23.5);
    let h: Vec<f64> = (0..grid.len()).map(|i| 0.01 * (place(i % 48).powi(2) + place(i / 48).powi(2))).collect();
    let influence = Coefficients::from(HalfSpace::new(0.1, 0.1, 1.0));
    let mut problem = Problem::new(grid, influence, &Threads::One).expect("a problem");
    let mut state = State::new(grid, (Load::Approach(0.06), 0.0), &Threads::One).expect("a state");
    state.h = h;
    state.unload();
    assert_eq!(descend_to(&mut problem, &mut state, 1000, 1e-12), Outcome::Converged);
    let tolerance = 1e-9;
    let beside = (0..grid.len()).find(|&i| !state.contact[i]).expect("an exterior element");
    let scale = Survey::of(&state).scale;
    state.h[beside] -= state.deformed_distance(beside) + 5.0 * tolerance * scale;
    assert!(state.contact_count() > 600 && !Survey::of(&state).violation(NonNegative).le(&tolerance));
    assert_eq!(descend(&mut problem, &mut state, 1000), Outcome::Converged);
    assert!(Survey::of(&state).violation(NonNegative) <= tolerance);
}
