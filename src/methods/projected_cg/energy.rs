//! With a prescribed approach: p is scaled to the least energy `(p, u)/2 + (p, h - approach)`.
//!
//! ```text
//! p = c p, u = c u,  c = (p, approach - h)/(p, u)
//! ```
//!
//! The sums over C after a step follow from those that the step length needs. Only the few truncated elements are added one by one:
//!
//! ```text
//! (p + alpha t, approach - h) = (p, approach - h) + alpha (t, approach - h)
//! (p + alpha t, u + alpha q)  = (p, u) + alpha ((p, q) + (t, u)) + alpha^2 (t, q)
//! ```

use super::formulas::WorkAndEnergy;
use super::step_sums::Update;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;

impl<T: Real> Iteration<T> {
    /// After a step: scales p to carry the prescribed force, or to the least energy, and stores the factor in `update`. If `limited`, elements were
    /// at their limit before: then p is not scaled with a prescribed approach. `sums` are those of [`Iteration::least_energy`].
    pub(super) fn scale_to_load<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        update: &mut Update,
        limited: bool,
        sums: Option<(f64, f64)>,
    ) {
        self.is_scaled = false;
        match state.load {
            Load::Force(_) => update.factor = self.carry_force::<S>(state),
            Load::Approach(_) if limited => {}
            Load::Approach(_) => {
                self.least_energy::<S>(state, update, sums.filter(|_| !update.is_corrected && update.gamma == 0.0))
            }
        }
    }

    /// If the approach is prescribed: scales p and the deferred corrections to the least energy, where u is that after `update`, and stores the
    /// factor in `update`. This takes no product. If there is a deflation direction, or pressures have reached a limit, p is scaled only after a
    /// product that corrected a truncation. `sums` are `(p, approach - h)` and `(p, u)`, if known.
    pub(super) fn least_energy<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        update: &mut Update,
        sums: Option<(f64, f64)>,
    ) {
        self.is_scaled = false;
        let scales = !(self.deflation.is_there() || S::LIMITED && state.reached_limit);
        if matches!(state.load, Load::Force(_)) || S::FIXED || !(scales || update.is_corrected) {
            return;
        }
        self.segments.find(&state.contact);
        let mut found = || (self.work_and_energy(state, update), size_of_terms(state));
        debug_assert!(sums.is_none_or(|sums| near(sums, found())), "the sums after a step");
        let (work, energy) = sums.unwrap_or_else(|| self.work_and_energy(state, update));
        let factor = work / energy;
        if factor.is_finite() && factor > 0.0 {
            // On one element the scaled p is the solution, and there is no direction without force.
            self.is_scaled = scales && self.segments.count() > 1;
            update.factor = factor;
            self.scale(state, factor);
        }
    }

    /// Computes `(p, approach - h)` and `(p, u)`, where u is that after `update`.
    fn work_and_energy(&mut self, state: &State, update: &Update) -> (f64, f64) {
        let (_, w) = self.deflation.beside(update.gamma, &self.t, &self.q);
        let (State { h, u, p, .. }, products) = (state, [&self.q[..], &self.z, w]);
        let formula = WorkAndEnergy { approach: state.approach, update };
        let [work, energy] = self.segments.sum_of(&state.contact, [h, u, p], products, formula);
        (work, energy)
    }

    /// `(p, approach - h)` and `(p, u)` after a step that truncated elements. `(work, energy)` are these sums with the first `included` entries of
    /// the truncation; the other entries are added here.
    pub(super) fn after_truncation(
        &self,
        state: &State,
        (work, energy): (f64, f64),
        alpha: f64,
        included: usize,
    ) -> (f64, f64) {
        self.truncation.gains()[included..].iter().fold((work, energy), |(work, energy), &(i, d)| {
            let u = state.u[i] + alpha * self.q[i].to_double();
            (work + d * (state.approach - state.h[i]), energy + d * u)
        })
    }
}

/// The sum of the absolute values of the terms of `(p, approach - h)` and `(p, u)`.
fn size_of_terms(state: &State) -> f64 {
    let of_element = |i: usize| state.p[i].abs() * ((state.approach - state.h[i]).abs() + state.u[i].abs());
    (0..state.p.len()).filter(|&i| state.contact[i]).map(of_element).sum()
}

/// Whether predicted sums (a, b) equal computed sums (c, d) up to round-off of single precision: 1e-6 of `size`, the sum of the absolute values of
/// the terms. The terms of either sum may nearly cancel.
fn near((a, b): (f64, f64), ((c, d), size): ((f64, f64), f64)) -> bool {
    !((a - c).abs() > 1e-6 * size || (b - d).abs() > 1e-6 * size)
}
