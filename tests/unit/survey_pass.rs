//! A survey (the maxima and sums of a state that a certificate needs) equals a loop over the elements. All values are whole numbers, so that sums are
//! exact.

use super::super::certificate::Survey;
use super::super::State;
use crate::grid::Grid;
use crate::scene::Load;
use crate::threads::Threads;

const APPROACH: f64 = 3.0;

/// The kinds of random states. In each of them some elements have no surface, and the first 70 columns of wide grids have no pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Pressures of either sign; u is NaN on elements without a surface.
    Plain,
    /// Pressures of either sign, and elements at their limit.
    Limited,
    /// As `Limited`; elements at their limit would have the largest violation if they counted as exterior.
    DeepAtLimit,
    /// Pressures are positive or 0: the least one is that of an unloaded element.
    Positive,
    /// No element is loaded: p is 0 or -0. u is NaN on elements without a surface.
    Idle,
}

fn state(mx: usize, my: usize, kind: Kind) -> State {
    let mut seed = (7 * mx + my) as u64;
    let mut number = |below: u64| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) % below
    };
    let n = mx * my;
    let h = (0..n).map(|_| if number(9) == 0 { f64::INFINITY } else { number(30) as f64 }).collect();
    let mut state = State::new(Grid { mx, my, dx: 1.0, dy: 1.0 }, (Load::Approach(APPROACH), APPROACH), &Threads::One)
        .expect("memory");
    state.h = h;
    let limited = matches!(kind, Kind::Limited | Kind::DeepAtLimit);
    state.at_limit = vec![false; if limited { n } else { 0 }];
    state.reached_limit = limited;
    for i in 0..n {
        let (role, has_surface) = (if mx > 100 && i % mx < 70 { 9 } else { number(4) }, state.h[i].is_finite());
        let presses = role < 2 && has_surface && kind != Kind::Idle;
        let u = number(12) as f64 - 6.0;
        let is_number = has_surface || !matches!(kind, Kind::Plain | Kind::Idle);
        state.u[i] = if is_number { u } else { f64::NAN };
        state.contact[i] = presses && role == 0;
        let least = if kind == Kind::Positive { 1.0 } else { -3.0 };
        state.p[i] = match kind {
            _ if presses => number(20) as f64 + least,
            Kind::Idle if number(2) == 0 => -0.0,
            _ => 0.0,
        };
        if limited && presses && role == 1 {
            state.at_limit[i] = true;
            if kind == Kind::DeepAtLimit {
                (state.h[i], state.u[i]) = (0.0, -20.0);
            }
        }
    }
    state
}

#[test]
fn surveys_are_those_of_all_elements() {
    for kind in [Kind::Plain, Kind::Limited, Kind::DeepAtLimit, Kind::Positive, Kind::Idle] {
        for (mx, my) in [(1, 1), (1, 9), (5, 1), (7, 13), (64, 64), (131, 17), (300, 5)] {
            let state = state(mx, my, kind);
            let survey = Survey::of(&state);
            let e = |i: usize| state.h[i] - APPROACH + state.u[i];
            let all = 0..mx * my;
            let inside = || all.clone().filter(|&i| state.contact[i]);
            let held = |i: usize| state.at_limit.get(i) == Some(&true);
            let norm = |squares: f64| squares.sqrt();
            assert_eq!(survey.residual, norm(inside().map(|i| e(i) * e(i)).sum()), "residual, {mx} x {my}, {kind:?}");
            assert_eq!(
                survey.distance,
                norm(inside().map(|i| (state.h[i] - APPROACH).powi(2)).sum()),
                "{mx} x {my}, {kind:?}"
            );
            assert_eq!(survey.contact_count, all.clone().filter(|&i| state.contact[i] || held(i)).count());
            assert_eq!(survey.pressures, state.p.iter().sum::<f64>(), "pressures, {mx} x {my}, {kind:?}");
            assert_eq!(survey.squares, state.p.iter().map(|p| p * p).sum::<f64>(), "squares, {mx} x {my}, {kind:?}");
            let lowest = state.p.iter().copied().fold(f64::INFINITY, f64::min);
            let highest = state.p.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(survey.range, (lowest, highest), "range, {mx} x {my}, {kind:?}");
            let depth = |i: usize| if held(i) { e(i) } else { -e(i) };
            let outside = all.clone().filter(|&i| !state.contact[i]).map(depth);
            assert_eq!(survey.violation, outside.fold(0.0, f64::max), "violation, {mx} x {my}, {kind:?}");
            let presses = || all.clone().filter(|&i| state.p[i] != 0.0);
            let gap = |i: usize| if held(i) { e(i).max(0.0) } else { e(i).abs() };
            assert_eq!(
                survey.work.0,
                presses().map(|i| state.p[i] * gap(i)).sum::<f64>(),
                "gaps, {mx} x {my}, {kind:?}"
            );
            assert_eq!(
                survey.work.1,
                presses().map(|i| state.p[i] * state.u[i].abs()).sum::<f64>(),
                "{mx} x {my}, {kind:?}"
            );
        }
    }
}
