//! Truncation without a product. After step (4.1) u lacks `A d`, d being what the truncated elements gained. A product of its own
//! would repair that, and costs as much as half an iteration. Two things avoid it:
//!
//! - All eigenvalues of M A on C are at least 1 and few exceed 4, so alpha is known beforehand to within some ten percent. Elements that the
//!   forecast step would truncate are clipped before the product, and d is only the error of the forecast.
//! - Where d is small against the step, the correction of u is deferred: the next direction is `t + d/alpha'`, so that its product contains `A d`. If
//!   alpha differs from alpha', the rest `d (1 - alpha/alpha')` stays to be corrected. It shrinks by that factor at each iteration; the fresh product of
//!   the certificate corrects what is left of it at the end.

use super::step_sums::Step;
use crate::contact::State;
use crate::error::Result;
use crate::memory::{keep, reserve};
use crate::operator::fft::Real;

/// Truncated elements, and the d of each: u still lacks `A d`.
#[derive(Default)]
pub(super) struct Truncation {
    gains: Vec<(usize, f64)>,
}

impl Truncation {
    /// Room for n elements.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        Ok(reserve(&mut self.gains, n, "truncated elements")?)
    }

    /// Nothing is to be corrected.
    pub(super) fn clear(&mut self) {
        self.gains.clear();
    }

    /// Element i has gained d.
    pub(super) fn push(&mut self, i: usize, d: f64) {
        self.gains.push((i, d));
    }

    /// How many there are; those that come later stand behind them.
    pub(super) fn count(&self) -> usize {
        self.gains.len()
    }

    /// The elements and their d.
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

    /// Elements that gain once more; each then stands once.
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

    /// For later iterations.
    pub(super) fn keep(&mut self) {
        keep([&mut self.gains]);
    }

    /// The direction t contains the deferred correction: t + d/alpha'.
    pub(super) fn include<T: Real>(&self, t: &mut [T], forecast: f64) {
        for &(i, d) in &self.gains {
            t[i] += T::of(d / forecast);
        }
    }

    /// After the product q = A t: t without the correction, and what alpha leaves of it.
    pub(super) fn exclude<T: Real>(
        &mut self,
        (t, q): (&mut [T], &[T]),
        state: &State,
        (forecast, alpha): (f64, f64),
        step: &mut Step,
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

    /// z = d, and nothing is to be corrected.
    pub(super) fn take<T: Real>(&mut self, z: &mut [T]) {
        z.fill(T::zero());
        for (i, d) in self.gains.drain(..) {
            z[i] += T::of(d);
        }
    }
}
