//! The measures of how well the contact conditions hold, all from p, h and a fresh u = A p.

use super::survey_pass::Pass;
pub use super::survey_pass::Survey;
use super::{AdmissibleSet, State};
use crate::blocks;
use crate::scene::Load;
use crate::threads::Threads;

/// The measures of a solution. Status OK means that they are within the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C.
    pub residual: f64,
    /// Largest `-e` over the exterior area, or e over the elements at their limit, 0 when there is none: a length.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|` over all elements: pressures times gaps, against the elastic energy.
    pub complementarity: f64,
    /// Smallest pressure.
    pub min_pressure: f64,
}

/// The relative round-off of `h - approach` for h equal to the approach: a sum and a mean of equal numbers. Distances below it count as 0
/// (the bodies fit exactly). Larger ones are kept even if they may be round-off of a huge offset.
pub const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl Survey {
    /// Surveys a state.
    pub fn of(state: &State) -> Survey {
        Survey::by(state, &Threads::One)
    }

    /// Surveys a state by several threads, in fixed blocks of rows: the bits do not depend on the number of threads.
    pub fn by(state: &State, threads: &Threads) -> Survey {
        let nothing = Survey { range: (f64::INFINITY, f64::NEG_INFINITY), ..Survey::default() };
        let of_block = |elements| {
            let mut survey = nothing;
            pulp::Arch::new().dispatch(Pass { state, elements, survey: &mut survey });
            survey
        };
        let mut survey = blocks::fold(&state.grid, threads, nothing, of_block, |so_far, block| so_far.joined(&block));
        let mut touching = survey.distance;
        if state.has_limited() {
            touching += survey.add_limited(state);
        }
        survey.scale = (touching / survey.contact_count.max(1) as f64).sqrt();
        survey.finish(state);
        survey
    }

    /// The survey of two parts of a grid together, as sums.
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

    /// Takes norms of the sums. Sets measures to 0 that are round-off of equal terms.
    fn finish(&mut self, state: &State) {
        (self.residual, self.distance) = (self.residual.sqrt(), self.distance.sqrt());
        let offset = ROUND_OFF * state.approach.abs();
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

    /// By force: whether the round-off of distances hides displacements that pressures cause. Nothing is then known of these pressures, unless they are
    /// at their limit.
    fn is_hidden(&self, state: &State) -> bool {
        if !matches!(state.load, Load::Force(_)) || state.has_limited() {
            return false;
        }
        // The force alone gives the pressure of one element whose neighbours are apart.
        let is_near =
            |i: usize| !state.contact[i] && state.deformed_distance(i) <= 2.0 * ROUND_OFF * state.approach.abs();
        if self.contact_count == 1 && !(0..state.p.len()).any(is_near) {
            return false;
        }
        let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
        let displaced = in_contact.map(|i| state.u[i].powi(2)).sum::<f64>().sqrt();
        displaced > state.round_off * self.squares.sqrt()
    }

    /// Adds the elements at their limit, whose e must not be positive. Returns their sum of `(h - approach)^2`.
    fn add_limited(&mut self, state: &State) -> f64 {
        let mut touching = 0.0;
        for i in (0..state.p.len()).filter(|&i| state.at_limit[i]) {
            self.contact_count += 1;
            self.violation = self.violation.max(state.deformed_distance(i));
            touching += (state.h[i] - state.approach).powi(2);
        }
        touching
    }

    /// The larger of the relative residual and the relative violation (1 for p = 0); infinite if pressures are not admissible or a measure is
    /// NaN, which `max` alone would drop.
    pub fn violation<S: AdmissibleSet>(&self, _: S) -> f64 {
        let residual = relative(self.residual, self.distance);
        let violation = if S::FIXED { 0.0 } else { relative(self.violation, self.scale) };
        let admissible = S::FIXED || self.range.0 >= 0.0;
        match residual.max(violation) {
            worst if admissible && worst >= residual && worst >= violation => worst,
            _ => f64::INFINITY,
        }
    }

    /// The residual, relative to the distances; 0 where there is none.
    pub fn relative_residual(&self) -> f64 {
        relative(self.residual, self.distance)
    }

    /// The measures of the solution.
    pub fn certificate(&self) -> Certificate {
        Certificate {
            residual: self.relative_residual(),
            violation: self.violation,
            complementarity: relative(self.work.0.max(0.0), self.work.1),
            min_pressure: self.range.0,
        }
    }
}

/// A value relative to a scale; 0 relative to any scale is 0, even to 0.
pub fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 {
        0.0
    } else {
        value / scale
    }
}

/// The largest of some measures, infinite if one is NaN.
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

fn over_contact(state: &State, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in state.rows_with_contact().flatten().filter(|&i| state.contact[i]) {
        sum += value(i) * value(i);
    }
    sum.sqrt()
}
