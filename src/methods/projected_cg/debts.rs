//! Truncation without a product. After step 4.1 u lacks `A d`, d being what the truncated elements gained. A product of its own
//! would repair that, and costs as much as half an iteration. Two things avoid it. All eigenvalues of M A on C are at least 1 and few
//! exceed 4, so alpha is known beforehand to within some ten percent: elements that the forecast step would truncate are held back
//! before the product, and d is only what the forecast was wrong by. And where d is small against the step, it is owed: the next
//! direction is `t + d/alpha'`, so that its product contains `A d`, and what `alpha /= alpha'` leaves, `d (1 - alpha/alpha')`, is owed
//! on. Debts shrink by that factor at each iteration; what is left of them at the end the fresh product of the certificate settles.

use super::passes::Step;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;

impl<T: Real> Iteration<T> {
    /// The direction has what is owed, too: t + d/alpha'.
    pub(super) fn owe(&mut self, forecast: f64) {
        for &(i, d) in &self.debts {
            self.t[i] += T::of(d / forecast);
        }
    }

    /// What alpha leaves of the debts, which are no part of the direction.
    pub(super) fn pay(&mut self, state: &State, forecast: f64, alpha: f64, step: &mut Step) {
        for debt in &mut self.debts {
            let (i, owed) = (debt.0, T::of(debt.1 / forecast));
            self.t[i] = if state.contact[i] { self.t[i] - owed } else { T::zero() };
            if let Some(energy) = step.energy.as_mut().filter(|_| state.contact[i]) {
                energy.leave_out(owed.to_double(), (state.approach - state.h[i], state.u[i], self.q[i].to_double()));
            }
            debt.1 *= 1.0 - alpha / forecast;
        }
        self.debts.retain(|debt| debt.1 != 0.0);
    }

    /// The sum of |d|.
    pub(super) fn owed(&self) -> f64 {
        self.debts.iter().map(|debt| debt.1.abs()).sum()
    }

    /// z = A d: a product pays all debts.
    pub(super) fn settle(&mut self) {
        self.z.fill(T::zero());
        for (i, d) in self.debts.drain(..) {
            self.z[i] += T::of(d);
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
    }
}
