//! The traction bounds of all elements from their slips by a law, and the residuals with these bounds.

use super::super::certificate::{scale, Certificate};
use super::super::plane::{clip, dot, square};
use super::super::problem::{Problem, State};
use super::super::tangent::{Side, Tangent};
use super::element::Particle;
use super::march::March;
use super::RISING;
use crate::methods::fields;

/// Computes the bounds from the present slips of elements that the tangent predicts to slip. The other bounds are those at rest.
pub(super) fn lag(problem: &mut Problem, state: &State, tangent: &Tangent, march: &mut March) {
    follow(problem, state, tangent, march, None);
}

/// As [`lag`]. With rho, a bound g that rises with the slip is computed at the slip' at which `g(slip') + rho slip' = |q| + rho slip`: as the bound
/// rises, the slip becomes smaller.
pub(super) fn follow(problem: &mut Problem, state: &State, tangent: &Tangent, march: &mut March, rho: Option<f64>) {
    let law = march.law;
    let mut bound = std::mem::take(&mut problem.bound);
    march.go(|k, place, before| {
        let slips = place.pressure > 0.0 && tangent.side[k] == Side::Slip;
        let slip = if slips { square(problem.slip_at(k, &state.u)).sqrt() } else { 0.0 };
        let mut response = law.at(slip, place, before);
        if let Some(rho) = rho.filter(|_| place.pressure > 0.0 && response.slope[0] > 0.0) {
            response = law.resolve(square(state.q[k]).sqrt() + rho * slip, rho, place, before).response;
        }
        bound[k] = response.bound;
        response.particle
    });
    problem.bound = bound;
}

/// The larger one of the residuals of the slips and of the bounds. Where elements slip: the slip across q, or all of it if it is not opposite to q,
/// and `|q| - g`. Where they stick: the slip, and `|q|` beyond g.
pub(super) fn worst(problem: &Problem, state: &State, tangent: &Tangent) -> f64 {
    let of = |k: usize| {
        let (q, g) = (state.q[k], problem.bound[k]);
        match tangent.side[k] {
            Side::Outside => [0.0; 2],
            Side::Stick => [square(problem.slip_at(k, &state.u)), (square(q).sqrt() - g).max(0.0).powi(2)],
            Side::Slip => {
                let s = problem.slip_at(k, &state.u);
                let across = s[0] * q[1] - s[1] * q[0];
                let is_against = dot(s, q) < 0.0;
                let rest = if is_against { across * across / square(q) } else { square(s) };
                [rest, (square(q).sqrt() - g).powi(2)]
            }
        }
    };
    let [slips, bounds] = fields::sum(problem.threads(), state.q.len(), of).map(|sum| problem.rms_of(sum));
    let slips = if slips > 0.0 { slips / scale(problem, state) } else { 0.0 };
    let bounds = if bounds > 0.0 { bounds / problem.rms_bound() } else { 0.0 };
    if slips.is_nan() || bounds.is_nan() {
        return f64::NAN;
    }
    slips.max(bounds)
}

/// Moves tractions onto their circles, and computes their displacements by a fresh product, for a certificate. If bounds rise steeply, tractions are
/// left unchanged: a move to the circles would change the slips, and by them the bounds by more than the move.
pub(super) fn settle(problem: &mut Problem, state: &mut State, tangent: &Tangent, march: &March) {
    match march.rises > RISING {
        true => problem.refresh_unclipped(state),
        false => onto_circles(problem, state, tangent),
    }
}

/// Moves the tractions of slipping elements onto their circles, projects those of sticking ones onto their discs, and computes the displacements by a
/// fresh product.
pub(super) fn onto_circles(problem: &mut Problem, state: &mut State, tangent: &Tangent) {
    let (bound, threads) = (&problem.bound, problem.threads().clone());
    fields::map(&threads, &mut state.q, |k, q| match tangent.side[k] {
        Side::Slip => {
            let length = square(q).sqrt();
            let q = if length > 0.0 { q } else { tangent.normal[k] };
            let length = if length > 0.0 { length } else { 1.0 };
            clip(q.map(|q| q * (bound[k] / length)), bound[k])
        }
        Side::Stick => clip(q, bound[k]),
        Side::Outside => [0.0; 2],
    });
    problem.refresh_unclipped(state);
}

/// Clips tractions to p times the largest coefficient that a particle can have: that at rest or, with a memory, that before the step if it is larger.
/// If any traction was longer, a fresh product follows.
fn clip_to_largest(problem: &mut Problem, state: &mut State, march: &mut March) {
    let has_memory = march.law.fall.is_some_and(|law| law.memory_distance > 0.0);
    let mut is_clipped = false;
    march.go(|k, place, before| {
        let coefficient = if has_memory { place.coefficient.max(before.coefficient) } else { place.coefficient };
        let largest = place.pressure * coefficient;
        if square(state.q[k]).sqrt() > largest {
            (state.q[k], is_clipped) = (clip(state.q[k], largest), true);
        }
        Particle { coefficient, ..before }
    });
    if is_clipped {
        problem.refresh_unclipped(state);
    }
}

/// Finishes a solve: clips tractions to their largest bounds, sets the bounds of slipping elements to their |q|, and raises those of sticking
/// elements to their |q| if that is larger. Returns the larger of the residuals of the slips and of the bounds.
pub(super) fn freeze(problem: &mut Problem, state: &mut State, tangent: &Tangent, march: &mut March) -> f64 {
    clip_to_largest(problem, state, march);
    lag(problem, state, tangent, march);
    let of = |k: usize| match tangent.side[k] {
        Side::Slip => [(square(state.q[k]).sqrt() - problem.bound[k]).powi(2)],
        Side::Stick => [(square(state.q[k]).sqrt() - problem.bound[k]).max(0.0).powi(2)],
        Side::Outside => [0.0],
    };
    let [left] = fields::sum(problem.threads(), state.q.len(), of).map(|sum| problem.rms_of(sum));
    let bounds = if left > 0.0 { left / problem.rms_bound() } else { 0.0 };
    for (k, side) in tangent.side.iter().enumerate() {
        if *side == Side::Slip {
            problem.bound[k] = square(state.q[k]).sqrt();
        } else if *side == Side::Stick {
            problem.bound[k] = problem.bound[k].max(square(state.q[k]).sqrt());
        }
    }
    Certificate::of(problem, state).residual.max(bounds)
}
