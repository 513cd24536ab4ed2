//! By approach: p scaled to the least energy.
//!
//! ```text
//! p = c p, u = c u,  c = (p, approach - h)/(p, u)
//! ```
//!
//! The sums after a step are known before it, from sums over C that the step length needs anyway, but for the few elements that are truncated:
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
    /// After a step: p carries the prescribed force, or is scaled to the least energy; `update` takes the factor. `limited`: whether an element was
    /// at its limit, for then p is not scaled by approach; `sums` as below.
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

    /// By approach: scales p, and the deferred corrections with it, to the least energy `(p, u)/2 + (p, h - approach)`, u as `update` will leave it; `update` takes
    /// the factor. It costs no product. Where p moves along the deflation direction instead, or pressures have reached a limit, it only follows a
    /// product that corrected a truncation. `sums`: `(p, approach - h)` and `(p, u)`, if they are known.
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
        debug_assert!(sums.is_none_or(|sums| near(sums, self.work_and_energy(state, update))), "the sums after a step");
        let (work, energy) = sums.unwrap_or_else(|| self.work_and_energy(state, update));
        let factor = work / energy;
        if factor.is_finite() && factor > 0.0 {
            // On one element that is the solution, and no direction is left.
            self.is_scaled = scales && self.segments.count() > 1;
            update.factor = factor;
            self.scale(state, factor);
        }
    }

    /// `(p, approach - h)` and `(p, u)`, u as `update` will leave it.
    fn work_and_energy(&mut self, state: &State, update: &Update) -> (f64, f64) {
        let (_, w) = self.deflation.beside(update.gamma, &self.t, &self.q);
        let (State { h, u, p, .. }, products) = (state, [&self.q[..], &self.z, w]);
        let formula = WorkAndEnergy { approach: state.approach, update };
        let [work, energy] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([h, u, p], products, formula),
        );
        (work, energy)
    }

    /// `(p, approach - h)` and `(p, u)` after a step that truncated elements: those behind the first `included`.
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

/// Whether sums that were predicted are those of a pass, to the rounding of the larger: the first may nearly cancel.
fn near((a, b): (f64, f64), (c, d): (f64, f64)) -> bool {
    let size = c.abs().max(d.abs());
    !((a - c).abs() > 1e-6 * size || (b - d).abs() > 1e-6 * size)
}
