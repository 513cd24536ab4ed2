//! The certificate: how well the conditions of friction hold, computed from q and a fresh product u = A q.
//!
//! ```text
//! n = q/|q|,  s_n = s.n;  on the circle: |q| >= g (1 - 1e-7)
//! rest = s                       inside the circle: the whole slip
//! rest = s - min(s_n, 0) n       on the circle: the slip without its part opposite to q
//! residual = rms_C(rest)/S,      S = max(rms_C(rigid slip), f rms_C(u))
//! gap      = sum_C (s.q + g |s|) / sum_C g |rigid slip|     >= 0, and 0 for the solution only
//! ```
//!
//! * u is the displacement of a shift, or that of a step of rolling.
//! * f is 1 for a shift and for steady rolling with a given force. Otherwise it is 1.5e-8, the level of round-off.
//! * S is at least 1.5e-8 times the rms_C of two slips that others may cancel: the displacement before the step, and with given forces the rigid slip
//!   without the found creepages.
//! * If there is no rigid slip, the gap is relative to `S sum_C g`.
//!
//! The error of q obeys `(q - q*)' A (q - q*) <= sum_C (s.q + g |s|)`, where q* is the solution.

use super::plane::{add, dot, square, Vector};
use super::problem::{Problem, State};
use crate::contact::relative;
use crate::methods::fields::{self, BLOCK};

/// Tractions of at least this part of the bound are on the circle. The round-off of the projection is far smaller.
pub const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;
/// A rigid slip counts as 0 below this part of the scale of residuals. If found creepages cancel a slip, its round-off is up to 2.5e-8 of the scale.
const NO_SLIP: f64 = 1e-6;

/// The certificate of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// The rms over C of the residual slip, relative to the scale S of the module.
    pub residual: f64,
    /// The gap of the module, relative to the work of mu p on the rigid slip: 0 for the solution only.
    pub gap: f64,
    /// The number of elements that stick: of those in C whose traction is inside the circle.
    pub stick_count: usize,
    /// The number of elements that slip: of those in C whose traction is on the circle.
    pub slip_count: usize,
}

/// The scale of residuals, S of the module.
pub fn scale(problem: &Problem, state: &State) -> f64 {
    problem.compared(problem.rms_rigid(), problem.rms(|i| state.u[i]))
}

impl Certificate {
    /// The gap relative to `work`, the sum of g times the rigid slip. If there is no rigid slip, or if found creepages cancel it, the gap is relative
    /// to `least`, the sum of g times the scale of residuals.
    pub fn relative_gap(gap: f64, work: f64, least: f64) -> f64 {
        relative(gap.max(0.0), if work > NO_SLIP * least { work } else { least })
    }

    /// Computes the certificate of a state whose u is a fresh product A q.
    pub fn of(problem: &Problem, state: &State) -> Certificate {
        let blocks = (0..problem.bound.len()).step_by(BLOCK);
        let sums = fields::over(problem.threads(), blocks, |start, _| {
            let [mut squares, mut gap, mut work, mut bounds, mut slips] = [0.0; 5];
            for i in start..(start + BLOCK).min(problem.bound.len()) {
                let g = problem.bound[i];
                if !(g > 0.0) {
                    continue;
                }
                let (q, s) = (state.q[i], problem.slip_at(i, &state.u));
                slips += f64::from(u8::from(is_on_circle(q, g)));
                squares += rest(s, q, g);
                gap += dot(s, q) + g * square(s).sqrt();
                work += g * square(add(problem.rigid[i], problem.weighted(i, problem.offset))).sqrt();
                bounds += g;
            }
            [squares, gap, work, bounds, slips]
        });
        let [squares, gap, work, bounds, slips] = sums;
        let rms = (squares / problem.count().max(1) as f64).sqrt();
        let scale = scale(problem, state);
        let least = bounds * scale;
        Certificate {
            residual: relative(rms, scale),
            gap: Certificate::relative_gap(gap, work, least),
            stick_count: problem.count() - slips as usize,
            slip_count: slips as usize,
        }
    }
}

/// Whether q is on the circle of radius g.
#[inline]
pub fn is_on_circle(q: Vector, g: f64) -> bool {
    square(q) >= (g * ON_THE_CIRCLE) * (g * ON_THE_CIRCLE)
}

/// The square of the residual slip: of the part of s across q if q is on the circle and `s.q < 0`, otherwise of s.
#[inline]
pub fn rest(s: Vector, q: Vector, g: f64) -> f64 {
    if dot(s, q) < 0.0 && is_on_circle(q, g) {
        let across = s[0] * q[1] - s[1] * q[0];
        return across * across / square(q);
    }
    square(s)
}
