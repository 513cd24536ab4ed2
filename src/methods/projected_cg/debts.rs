//! Truncation without a product. After step 4.1 u lacks `A d`, d being what the truncated elements gained. A product of its own
//! would repair that, and costs as much as half an iteration. Two things avoid it. All eigenvalues of M A on C are at least 1 and few
//! exceed 4, so alpha is known beforehand to within some ten percent: elements that the forecast step would truncate are held back
//! before the product, and d is only what the forecast was wrong by. And where d is small against the step, it is owed: the next
//! direction is `t + d/alpha'`, so that its product contains `A d`, and what `alpha /= alpha'` leaves, `d (1 - alpha/alpha')`, is owed
//! on. Debts shrink by that factor at each iteration. At the end a product of the window settles them where the certificate, a product of the
//! full grid, would not hold for them; what is less, the certificate settles.

use super::passes::Step;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::progress::Goal;

/// The 2-norm over C of what one element at the rim adds to e, relative to what it adds to its own. Measured: 0.66 on ellipses of 256 to 1024.
const TOGETHER: f64 = 0.65;
/// What is owed and the residual together may be that many times the tolerance that the iteration aims at.
const ALLOWED: f64 = 1.3;

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

    /// Whether the certificate would hardly hold for what is owed, where the residual by u is `residual`. What is owed adds to e, in the 2-norm over
    /// C, as much as its sum on one element at the rim would where its signs agree, and as each element alone does where they do not. Outside C,
    /// most is added to e of the element that owes it.
    pub(super) fn owes_too_much(&self, state: &State, residual: f64, goal: &Goal) -> bool {
        let (itself, allowed) = (self.self_influence, ALLOWED * goal.tolerance * self.distance);
        let deepest = -allowed / (self.runs.count() as f64).sqrt();
        let (mut sum, mut squares, mut penetrates) = (0.0, 0.0, false);
        for &(i, d) in &self.debts {
            (sum, squares) = (sum + d, squares + d * d);
            penetrates |= !state.contact[i] && state.deformed_distance(i) + itself * d < deepest;
        }
        let owed = itself * f64::max(TOGETHER * f64::abs(sum), f64::sqrt(squares));
        penetrates || (residual * self.distance).hypot(owed) > allowed
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
