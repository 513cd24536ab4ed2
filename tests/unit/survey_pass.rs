//! A survey against a loop over the elements. All values are whole numbers, the sums of which have no rounding.

use super::super::certificate::Survey;
use super::super::State;
use crate::grid::Grid;
use crate::scene::Load;

const APPROACH: f64 = 3.0;

/// A state of the numbers of a generator: contact in the middle of the rows of some grids, elements without a surface, and a deepest element.
fn state(mx: usize, my: usize, limited: bool) -> State {
    let mut seed = (7 * mx + my) as u64;
    let mut number = |below: u64| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) % below
    };
    let n = mx * my;
    let h = (0..n).map(|_| if number(9) == 0 { f64::INFINITY } else { number(30) as f64 }).collect();
    let mut state =
        State::new(Grid { mx, my, dx: 1.0, dy: 1.0 }, h, Load::Approach(APPROACH), APPROACH).expect("memory");
    state.at_limit = vec![false; if limited { n } else { 0 }];
    state.reached_limit = limited;
    for i in 0..n {
        let kind = if mx > 100 && i % mx < 70 { 9 } else { number(4) };
        state.u[i] = number(12) as f64 - 6.0;
        state.contact[i] = kind == 0 && state.h[i].is_finite();
        if limited {
            state.at_limit[i] = kind == 1 && state.h[i].is_finite();
        }
        state.p[i] =
            if state.contact[i] || kind == 1 && state.h[i].is_finite() { number(20) as f64 - 3.0 } else { 0.0 };
    }
    state
}

#[test]
fn surveys_are_those_of_all_elements() {
    for limited in [false, true] {
        for (mx, my) in [(1, 1), (1, 9), (5, 1), (7, 13), (64, 64), (131, 17), (300, 5)] {
            let state = state(mx, my, limited);
            let survey = Survey::of(&state);
            let e = |i: usize| state.h[i] - APPROACH + state.u[i];
            let all = 0..mx * my;
            let inside = || all.clone().filter(|&i| state.contact[i]);
            let held = |i: usize| limited && state.at_limit[i];
            let norm = |squares: f64| squares.sqrt();
            assert_eq!(survey.residual, norm(inside().map(|i| e(i) * e(i)).sum()), "residual, {mx} x {my}");
            assert_eq!(survey.distance, norm(inside().map(|i| (state.h[i] - APPROACH).powi(2)).sum()), "{mx} x {my}");
            assert_eq!(survey.contact_count, all.clone().filter(|&i| state.contact[i] || held(i)).count());
            assert_eq!(survey.pressures, state.p.iter().sum::<f64>(), "pressures, {mx} x {my}");
            assert_eq!(survey.squares, state.p.iter().map(|p| p * p).sum::<f64>(), "squares, {mx} x {my}");
            let lowest = state.p.iter().copied().fold(f64::INFINITY, f64::min);
            let highest = state.p.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(survey.range, (lowest, highest), "range, {mx} x {my}");
            let depth = |i: usize| if held(i) { e(i) } else { -e(i) };
            let outside = all.clone().filter(|&i| !state.contact[i]).map(depth);
            assert_eq!(survey.violation, outside.fold(0.0, f64::max), "violation, {mx} x {my}");
            let presses = || all.clone().filter(|&i| state.p[i] != 0.0);
            let gap = |i: usize| if held(i) { e(i).max(0.0) } else { e(i).abs() };
            assert_eq!(survey.work.0, presses().map(|i| state.p[i] * gap(i)).sum::<f64>(), "gaps, {mx} x {my}");
            assert_eq!(survey.work.1, presses().map(|i| state.p[i] * state.u[i].abs()).sum::<f64>(), "{mx} x {my}");
        }
    }
}
