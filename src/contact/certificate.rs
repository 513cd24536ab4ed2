//! How well the contact conditions hold: everything here is computed from p, h and a fresh u = A p.

use super::survey_pass::Pass;
pub use super::survey_pass::Survey;
use super::{AdmissibleSet, State};
use crate::blocks;
use crate::threads::Threads;

/// The measures of a solution. Status OK means that they hold to the tolerance.
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

/// The round-off of `h - approach` where h is the approach: a sum and a mean of equal numbers. Distances below it are those of bodies that
/// fit exactly; larger ones, though round-off of a huge offset they may be, are not taken for none.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl Survey {
    /// Surveys a state.
    pub fn of(state: &State) -> Survey {
        Survey::by(state, &Threads::One)
    }

    /// The same by several threads: block of rows by block, so that they make no difference.
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

    /// Of two parts of a grid, before norms are made of sums.
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

    /// Norms from sums. What is a difference of terms that are equal but for round-off is 0.
    fn finish(&mut self, state: &State) {
        (self.residual, self.distance) = (self.residual.sqrt(), self.distance.sqrt());
        let offset = ROUND_OFF * state.approach.abs();
        let noise = offset * (self.contact_count as f64).sqrt() + state.round_off * self.squares.sqrt();
        if noise.is_finite() && self.distance <= noise && self.residual <= noise {
            self.residual = 0.0;
            let largest = offset + state.round_off * self.range.1;
            if self.violation <= largest {
                self.violation = 0.0;
            }
            self.work.0 = 0.0;
        }
    }

    /// Elements at their limit: their e must not be positive. Returns their sum of `(h - approach)^2`.
    fn add_limited(&mut self, state: &State) -> f64 {
        let mut touching = 0.0;
        for i in (0..state.p.len()).filter(|&i| state.at_limit[i]) {
            let (p, e) = (state.p[i], state.deformed_distance(i));
            self.contact_count += 1;
            self.violation = self.violation.max(e);
            self.work.0 += p * (e.max(0.0) - e.abs());
            touching += (state.h[i] - state.approach).powi(2);
        }
        touching
    }

    /// How far the conditions are from being met: the larger of the relative residual and the relative violation, p = 0 having 1; infinite
    /// where pressures are not admissible. `max` alone would drop what is not a number.
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

/// A value relative to a scale: 0 is 0 on any scale, also on one of 0.
pub fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 {
        0.0
    } else {
        value / scale
    }
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
