//! The certificate: measures of how well the contact conditions hold, computed from p, h and a fresh u = A p.

use super::survey_pass::Pass;
pub use super::survey_pass::Survey;
use super::{AdmissibleSet, State};
use crate::blocks;
use crate::scene::Load;
use crate::threads::Threads;

/// The measures that decide the status of a solution. Status OK means that they are within the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// `||h - approach + A p|| / ||h - approach||`, with 2-norms over C.
    pub residual: f64,
    /// The largest `-e` in the exterior area or e of an element at its limit, a length. 0 if neither is positive.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|` over all elements: pressures times gaps, relative to twice the elastic energy.
    pub complementarity: f64,
    /// The smallest pressure.
    pub min_pressure: f64,
}

/// The round-off of `h - approach`, relative to the approach, if the bodies fit exactly: then all h are equal, and the approach is their mean.
/// Distances below this round-off count as 0. Larger distances count, even if they may be round-off of a huge offset that all h have in common.
pub const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl Survey {
    /// Computes the survey of a state.
    pub fn of(state: &State) -> Survey {
        Survey::by(state, &Threads::One)
    }

    /// Computes the survey of a state by several threads. Sums are taken in fixed blocks of rows, so no bit depends on the number of threads.
    pub fn by(state: &State, threads: &Threads) -> Survey {
        let nothing = Survey { range: (f64::INFINITY, f64::NEG_INFINITY), ..Survey::default() };
        let of_block = |elements| {
            let mut survey = nothing;
            pulp::Arch::new().dispatch(Pass { state, elements, survey: &mut survey });
            survey
        };
        let mut survey = blocks::fold(&state.grid, threads, nothing, of_block, |so_far, block| so_far.joined(&block));
        let mut squares_of_distance = survey.distance;
        if state.has_limited() {
            squares_of_distance += survey.add_limited(state);
        }
        survey.scale = (squares_of_distance / survey.contact_count.max(1) as f64).sqrt();
        survey.finish(state);
        survey
    }

    /// Joins the surveys of two parts of a grid, before [`finish`](Survey::finish): `residual` and `distance` are still sums of squares.
    fn joined(self, other: &Survey) -> Survey {
        Survey {
            residual: self.residual + other.residual,
            distance: self.distance + other.distance,
            scale: 0.0,
            violation: self.violation.max(other.violation),
            contact_count: self.contact_count + other.contact_count,
            pressures: self.pressures + other.pressures,
            squares: self.squares + other.squares,
            range: (self.range.0.min(other.range.0), self.range.1.max(other.range.1)),
            work: (self.work.0 + other.work.0, self.work.1 + other.work.1),
        }
    }

    /// Takes the roots of the sums of squares. If the bodies fit exactly, so that the norms of distances and of e are round-off, the measures become
    /// 0.
    fn finish(&mut self, state: &State) {
        (self.residual, self.distance) = (self.residual.sqrt(), self.distance.sqrt());
        let offset = ROUND_OFF * state.approach.abs();
        // The norms over C of the round-off of h - approach and of the round-off of u.
        let noise = offset * (self.contact_count as f64).sqrt() + state.round_off * self.squares.sqrt();
        if noise.is_finite() && self.distance <= noise && self.residual <= noise && !self.is_hidden(state) {
            self.residual = 0.0;
            let largest = offset + state.round_off * self.range.1;
            if self.violation <= largest {
                self.violation = 0.0;
            }
            self.work.0 = 0.0;
        }
    }

    /// If the force is prescribed: whether the round-off of distances hides displacements that pressures cause. Then nothing is known of these
    /// pressures, unless elements are at their limit.
    fn is_hidden(&self, state: &State) -> bool {
        if !matches!(state.load, Load::Force(_)) || state.has_limited() {
            return false;
        }
        // If only one element is in contact and no other one nearly touches, the force alone gives its pressure.
        let is_near =
            |i: usize| !state.contact[i] && state.deformed_distance(i) <= 2.0 * ROUND_OFF * state.approach.abs();
        if self.contact_count == 1 && !(0..state.p.len()).any(is_near) {
            return false;
        }
        let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
        let displaced = in_contact.map(|i| state.u[i].powi(2)).sum::<f64>().sqrt();
        displaced > state.round_off * self.squares.sqrt()
    }

    /// Adds the elements at their limit, whose e must not be positive, to the count and to the violation. Returns the sum of `(h - approach)^2` over
    /// these elements.
    fn add_limited(&mut self, state: &State) -> f64 {
        let mut squares_of_distance = 0.0;
        for i in (0..state.p.len()).filter(|&i| state.at_limit[i]) {
            self.contact_count += 1;
            self.violation = self.violation.max(state.deformed_distance(i));
            squares_of_distance += (state.h[i] - state.approach).powi(2);
        }
        squares_of_distance
    }

    /// The larger of the relative residual and the relative violation. The residual of p = 0 is 1. The result is infinite if a pressure is negative
    /// or a measure is NaN (which `f64::max` alone would drop).
    pub fn violation<S: AdmissibleSet>(&self, _: S) -> f64 {
        let residual = relative(self.residual, self.distance);
        let violation = if S::FIXED { 0.0 } else { relative(self.violation, self.scale) };
        let admissible = S::FIXED || self.range.0 >= 0.0;
        match residual.max(violation) {
            worst if admissible && worst >= residual && worst >= violation => worst,
            _ => f64::INFINITY,
        }
    }

    /// `||e|| / ||h - approach||` over C; 0 if the residual is 0.
    pub fn relative_residual(&self) -> f64 {
        relative(self.residual, self.distance)
    }

    /// The certificate that belongs to this survey.
    pub fn certificate(&self) -> Certificate {
        Certificate {
            residual: self.relative_residual(),
            violation: self.violation,
            complementarity: relative(self.work.0.max(0.0), self.work.1),
            min_pressure: self.range.0,
        }
    }
}

/// `value / scale`, or 0 if `value` is 0, even if the scale is 0, too.
pub fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 {
        0.0
    } else {
        value / scale
    }
}

/// The largest of several measures, or 0 if all are negative. It is infinite if one of them is NaN.
pub fn largest<const K: usize>(values: [f64; K]) -> f64 {
    values.into_iter().fold(0.0, |worst: f64, value| match value {
        value if value <= worst => worst,
        value if value.is_nan() => f64::INFINITY,
        value => value,
    })
}

/// 2-norm over C of `h - approach`.
pub fn norm_of_distance(state: &State) -> f64 {
    over_contact(state, |i| state.h[i] - state.approach)
}

/// 2-norm over C of `h - approach + u`.
pub fn residual_norm(state: &State) -> f64 {
    over_contact(state, |i| state.deformed_distance(i))
}

/// The 2-norm over C of `value(i)`.
fn over_contact(state: &State, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in state.rows_with_contact().flatten().filter(|&i| state.contact[i]) {
        sum += value(i) * value(i);
    }
    sum.sqrt()
}
