//! Truncation without a product of its own. After step (4.1) u lacks `A d`, where d is the change of p by truncation. An extra product
//! would correct u, but it costs half an iteration. Two measures avoid it:
//!
//! - All eigenvalues of M A on C are at least 1 and few exceed 4, so alpha can be forecast to within some ten percent. Elements that the
//!   forecast step would truncate are clipped before the product. Then d is only the error of the forecast.
//! - If d is small compared with the step, the correction of u is deferred. The next direction is `t + d/alpha'`, so that its product contains
//!   `A d`. If alpha differs from alpha', the rest `d (1 - alpha/alpha')` remains to be corrected. It shrinks by this factor at each iteration.
//!   At the end the fresh product of the certificate corrects the remainder.

use super::step_sums::StepSums;
use crate::contact::State;
use crate::error::Result;
use crate::memory::{keep, reserve};
use crate::operator::fft::Real;

/// The truncated elements with their d. u still lacks `A d`.
#[derive(Default)]
pub(super) struct Truncation {
    gains: Vec<(usize, f64)>,
}

impl Truncation {
    /// Reserves capacity for n elements.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        Ok(reserve(&mut self.gains, n, "truncated elements")?)
    }

    /// Removes all: u needs no correction.
    pub(super) fn clear(&mut self) {
        self.gains.clear();
    }

    /// Adds element i, whose p changed by d.
    pub(super) fn push(&mut self, i: usize, d: f64) {
        self.gains.push((i, d));
    }

    /// The number of entries. Later entries follow them.
    pub(super) fn count(&self) -> usize {
        self.gains.len()
    }

    /// The entries: elements with their d.
    pub(super) fn gains(&self) -> &[(usize, f64)] {
        &self.gains
    }

    /// The sum of |d|.
    pub(super) fn sum(&self) -> f64 {
        self.gains.iter().map(|gain| gain.1.abs()).sum()
    }

    /// d times a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        self.gains.iter_mut().for_each(|gain| gain.1 *= factor);
    }

    /// Adds entries, and merges those of one element.
    pub(super) fn extend(&mut self, gains: impl Iterator<Item = (usize, f64)>) {
        self.gains.extend(gains);
        self.gains.sort_unstable_by_key(|gain| gain.0);
        self.gains.dedup_by(|next, gain| {
            let same = next.0 == gain.0;
            if same {
                gain.1 += next.1;
            }
            same
        });
    }

    /// Keeps the memory for later solves.
    pub(super) fn keep(&mut self) {
        keep([&mut self.gains]);
    }

    /// The direction t contains the deferred correction: t + d/alpha'.
    pub(super) fn include<T: Real>(&self, t: &mut [T], forecast: f64) {
        for &(i, d) in &self.gains {
            t[i] += T::of(d / forecast);
        }
    }

    /// After the product q = A t: removes the correction from t, and reduces the entries to the rest that alpha leaves.
    pub(super) fn exclude<T: Real>(
        &mut self,
        (t, q): (&mut [T], &[T]),
        state: &State,
        (forecast, alpha): (f64, f64),
        step: &mut StepSums,
    ) {
        for gain in &mut self.gains {
            let (i, included) = (gain.0, T::of(gain.1 / forecast));
            t[i] = if state.contact[i] { t[i] - included } else { T::zero() };
            if let Some(energy) = step.energy.as_mut().filter(|_| state.contact[i]) {
                let depth = state.approach - state.h[i];
                energy.leave_out(included.to_double(), (depth, state.u[i], q[i].to_double()));
            }
            gain.1 *= 1.0 - alpha / forecast;
        }
        self.gains.retain(|gain| gain.1 != 0.0);
    }

    /// Moves the entries to z = d.
    pub(super) fn take<T: Real>(&mut self, z: &mut [T]) {
        z.fill(T::zero());
        for (i, d) in self.gains.drain(..) {
            z[i] += T::of(d);
        }
    }
}
