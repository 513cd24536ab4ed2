//! The deferred correction of u after truncations (module `truncation`), within a step.

use super::sums::Step;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;

impl<T: Real> Iteration<T> {
    /// The direction contains the deferred correction: t + d/alpha'.
    pub(super) fn include_correction(&mut self, forecast: f64) {
        for &(i, d) in &self.truncation.gains {
            self.t[i] += T::of(d / forecast);
        }
    }

    /// After the product: t without the correction, and what alpha leaves of it.
    pub(super) fn exclude_correction(&mut self, state: &State, forecast: f64, alpha: f64, step: &mut Step) {
        for gain in &mut self.truncation.gains {
            let (i, included) = (gain.0, T::of(gain.1 / forecast));
            self.t[i] = if state.contact[i] { self.t[i] - included } else { T::zero() };
            if let Some(energy) = step.energy.as_mut().filter(|_| state.contact[i]) {
                let depth = state.approach - state.h[i];
                energy.leave_out(included.to_double(), (depth, state.u[i], self.q[i].to_double()));
            }
            gain.1 *= 1.0 - alpha / forecast;
        }
        self.truncation.gains.retain(|gain| gain.1 != 0.0);
    }

    /// z = A d: a product corrects all of u.
    pub(super) fn correct_now(&mut self) {
        self.z.fill(T::zero());
        for (i, d) in self.truncation.gains.drain(..) {
            self.z[i] += T::of(d);
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
    }
}
