//! Truncation of pressures without an extra product. Step (4.1) changes p by d on the elements that leave C, and then u lacks `A d`. An extra product
//! would correct u, but it costs half an iteration. Two measures avoid the extra product:
//!
//! - All eigenvalues of M A on C are at least 1 and few exceed 4, so alpha can be forecast to within some ten percent. Elements that the forecast
//!   step would truncate are clipped before the product. Then d is only due to the error of the forecast alpha'.
//! - If d is small compared with the step, the correction of u is deferred. The next direction is `t + d/alpha'`, so that its product contains `A d`.
//!   If alpha differs from alpha', the rest `d (1 - alpha/alpha')` remains to be corrected, and the rest shrinks by this factor at each iteration. At
//!   the end the fresh product of the certificate corrects what remains.

use super::step_sums::StepSums;
use crate::contact::State;
use crate::error::Result;
use crate::memory::{keep, reserve};
use crate::operator::fft::Real;

/// The deferred corrections: the changes d of p by truncation for which u still lacks `A d`.
#[derive(Default)]
pub(super) struct Truncation {
    /// Elements, and the change d of p on each.
    gains: Vec<(usize, f64)>,
}

impl Truncation {
    /// Reserves capacity for n elements.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        Ok(reserve(&mut self.gains, n, "truncated elements")?)
    }

    /// Removes all entries: u needs no correction.
    pub(super) fn clear(&mut self) {
        self.gains.clear();
    }

    /// Adds element i, whose p changed by d.
    pub(super) fn push(&mut self, i: usize, d: f64) {
        self.gains.push((i, d));
    }

    /// The number of entries. Entries that are added later come after these.
    pub(super) fn count(&self) -> usize {
        self.gains.len()
    }

    /// The entries: elements, and the change d of p on each.
    pub(super) fn gains(&self) -> &[(usize, f64)] {
        &self.gains
    }

    /// The sum of |d|.
    pub(super) fn sum(&self) -> f64 {
        self.gains.iter().map(|gain| gain.1.abs()).sum()
    }

    /// Multiplies all d by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        self.gains.iter_mut().for_each(|gain| gain.1 *= factor);
    }

    /// Adds entries, and merges entries of the same element.
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

    /// Gives the memory to later solves, when this list is no longer used.
    pub(super) fn keep(&mut self) {
        keep([&mut self.gains]);
    }

    /// Adds the deferred corrections to the direction, before its product: t + d/alpha'. `forecast` is alpha'.
    pub(super) fn include<T: Real>(&self, t: &mut [T], forecast: f64) {
        for &(i, d) in &self.gains {
            t[i] += T::of(d / forecast);
        }
    }

    /// After the product q = A t: removes the deferred corrections from t and from the sums of the step, and reduces each entry to the rest that a
    /// step of the length alpha leaves.
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

    /// Moves all entries to an array: sets z = d on their elements, 0 elsewhere.
    pub(super) fn take<T: Real>(&mut self, z: &mut [T]) {
        z.fill(T::zero());
        for (i, d) in self.gains.drain(..) {
            z[i] += T::of(d);
        }
    }
}
