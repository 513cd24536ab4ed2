//! The passes over the contact area, each over its segments; what they compute is in `formulas`.

use super::energy::Energy;
use super::extension::Area;
use super::formulas::{Conjugate, Direction, Distance, Free, Lowered, Residual, Scale, StepSums};
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::scene::Load;

/// A direction without force has at most this part of the sum of |t|.
const SMALL_FORCE: f64 = 1e-2;
/// Steps of Newton's method at most.
const LOWERINGS: u32 = 8;

/// No array of the iteration's precision.
pub(super) const fn none<'a, T>() -> [&'a [T]; 0] {
    []
}

/// What becomes of u: factor (u + alpha q + gamma w + A d), w of the known change.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    pub(super) gamma: f64,
    /// Whether z holds A d.
    pub(super) settled: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, gamma: 0.0, settled: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p); and (r, d), (q, d), 0 where no change is known.
pub(super) struct Step {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    pub(super) t1: f64,
    pub(super) pp: f64,
    pub(super) rd: f64,
    pub(super) qd: f64,
    pub(super) energy: Option<Energy>,
}

impl Step {
    /// The 2-norm of the change of p, at most: the sum of what the step along t, that along d, of which the length is given, and the scaling change.
    pub(super) fn change(&self, alpha: f64, along_d: f64, factor: f64) -> f64 {
        alpha.abs() * self.tt.sqrt() + along_d + (factor - 1.0).abs() * self.pp.sqrt()
    }
}

impl<T: Real> Iteration<T> {
    /// The segments of a contact area of which nothing is known.
    pub(super) fn find_contact(&mut self, state: &State) {
        self.segments.change_all();
        self.segments.find(&state.contact);
        if let (Some(_), Some(extension)) = (&self.preconditioner, &mut self.extension) {
            extension.suit(&state.contact);
        }
    }

    /// With a prescribed force, where no change is known: the approach is the mean over C of h + u, u as `update` will leave it.
    pub(super) fn fit_approach(&mut self, state: &mut State, update: &Update) {
        if matches!(state.load, Load::Approach(_)) {
            return;
        }
        let (q, z) = (&self.q[..], &self.z[..]);
        let [sum] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([&state.h, &state.u], [q, z], Distance(update)),
        );
        if self.segments.count() > 0 {
            state.approach = sum / self.segments.count() as f64 + self.limits.shift;
        }
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    pub(super) fn residual(&mut self, state: &State) -> f64 {
        let (State { h, u, contact, .. }, formula) = (state, Residual { approach: state.approach });
        let [rr, hh] = self.segments.sum_changing(
            contact,
            &mut self.z,
            #[inline(always)]
            |block, z| {
                z.fill(T::zero());
                block.change(z, [h, u], none::<T>(), formula);
                block.sum([h, u], none::<T>(), formula)
            },
        );
        self.limits.residual = rr;
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// Whether directions need not carry force: p is scaled to it, or to the least energy, or moves along a known change.
    fn is_without_force(&self, state: &State) -> bool {
        matches!(state.load, Load::Force(_)) || self.known.is_there() || self.is_scaled
    }

    /// z = E^T M E r, r being what z holds (module `extension`).
    pub(super) fn precondition(&mut self, state: &State) {
        let without_force = self.is_without_force(state);
        if let Some(m) = &mut self.preconditioner {
            let area = Area { contact: &state.contact, segments: &self.segments };
            m.apply(&mut self.z, (area, without_force), &mut self.extension, &mut self.workspace);
        }
    }

    /// t = z + beta t on C, 0 outside; of mean zero over C, but for what is missing, where it need not carry force; held back by the forecast,
    /// if there is one, at p = 0. `tq` is (t, q) of the last direction, 0 if there is none.
    pub(super) fn direct(&mut self, state: &State, tq: f64, forecast: Option<f64>) {
        let without_force = self.is_without_force(state);
        let missing = self.limits.missing / forecast.unwrap_or(1.0);
        let (mean, beta) = self.conjugate(state, without_force.then_some(missing), tq);
        let (z, formula) = (&self.z[..], Direction { mean, beta, forecast });
        let [] = self.segments.sum_changing(
            &state.contact,
            &mut self.t,
            #[inline(always)]
            |block, t| {
                block.change(t, [&state.p], [z], formula);
                []
            },
        );
        if let Some(forecast) = forecast.filter(|_| without_force) {
            self.remove_force(state, missing, forecast);
        }
    }

    /// Lowers t where it is not held back until its sum over C is `missing`: elements that are held back would add to the force. The sum falls
    /// with the shift, convex: Newton's method comes from one side.
    fn remove_force(&mut self, state: &State, missing: f64, forecast: f64) {
        for _ in 0..LOWERINGS {
            let (t, formula) = (&self.t[..], Free { forecast });
            let [sum, absolute, free] = self.segments.sum(
                &state.contact,
                #[inline(always)]
                |block| block.sum([&state.p], [t], formula),
            );
            let excess = sum - missing;
            if !(excess > SMALL_FORCE * absolute && free > 0.0) {
                return;
            }
            let formula = Lowered { shift: excess / free, forecast };
            let [] = self.segments.sum_changing(
                &state.contact,
                &mut self.t,
                #[inline(always)]
                |block, t| {
                    block.change(t, [&state.p], none::<T>(), formula);
                    []
                },
            );
        }
    }

    /// The mean over C that is taken from z + beta t, and beta. Directions without force have the sum `missing`; others may have any.
    fn conjugate(&mut self, state: &State, missing: Option<f64>, tq: f64) -> (f64, f64) {
        if missing.is_none() && tq <= 0.0 {
            return (0.0, 0.0);
        }
        let arrays = [&self.t[..], &self.z, &self.q];
        let [t1, z1, q1, zq] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([], arrays, Conjugate),
        );
        let count = self.segments.count() as f64;
        let mean = if missing.is_some() { z1 / count } else { 0.0 };
        let beta = if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 };
        (missing.map_or(0.0, |missing| (z1 + beta * t1 - missing) / count), beta)
    }

    /// The sums over C that the step length needs, and those of the energy where p is scaled.
    pub(super) fn step(&mut self, state: &State) -> Step {
        if self.known.is_there() {
            return self.step_beside_change(state);
        }
        let State { h, u, p, contact, .. } = state;
        let (tq, formula) = ([&self.t[..], &self.q], StepSums { approach: state.approach });
        if !self.is_scaled {
            let [rt, tq, tt, t1, pp] = self.segments.sum(
                contact,
                #[inline(always)]
                |block| block.sum([h, u, p], tq, formula),
            );
            return Step { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: None };
        }
        let [rt, tq, tt, t1, pp, pd, td, pu, pq] = self.segments.sum(
            contact,
            #[inline(always)]
            |block| block.sum([h, u, p], tq, formula),
        );
        let energy = Energy { pd, td, pu, pq_tu: pq + td - rt, tq };
        Step { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: Some(energy) }
    }

    /// p = factor p on C, and the debts likewise.
    pub(super) fn scale(&mut self, state: &mut State, factor: f64) {
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        let State { p, contact, .. } = state;
        let [] = self.segments.sum_changing(
            contact,
            p,
            #[inline(always)]
            |block, p| {
                block.change(p, [], none::<T>(), Scale { factor });
                []
            },
        );
    }
}
