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
use super::passes::Update;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;

/// Sums over C for the energy of p + alpha t: (p, d), (t, d), d = approach - h, (p, u), (p, q) + (t, u), (t, q).
#[derive(Clone, Copy)]
pub(super) struct Energy {
    pub(super) pd: f64,
    pub(super) td: f64,
    pub(super) pu: f64,
    pub(super) pq_tu: f64,
    pub(super) tq: f64,
}

impl Energy {
    /// What is owed, t on an element of C, is no part of the step.
    pub(super) fn leave_out(&mut self, owed: f64, (depth, u, q): (f64, f64, f64)) {
        self.td -= owed * depth;
        self.pq_tu -= owed * u;
        self.tq -= owed * q;
    }

    /// `(p, d)` and `(p, u)` after a step of length alpha.
    pub(super) fn after(&self, alpha: f64) -> (f64, f64) {
        (self.pd + alpha * self.td, self.pu + alpha * (self.pq_tu + alpha * self.tq))
    }
}

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
                self.least_energy::<S>(state, update, sums.filter(|_| !update.settled && update.gamma == 0.0))
            }
        }
    }

    /// By approach: scales p, and the debts with it, to the least energy `(p, u)/2 + (p, h - approach)`, u as `update` will leave it; `update` takes
    /// the factor. It costs no product. Where p moves along a known direction instead, or pressures have reached a limit, only a truncation that a
    /// product has paid is followed by it. `sums`: `(p, approach - h)` and `(p, u)`, if they are known.
    pub(super) fn least_energy<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        update: &mut Update,
        sums: Option<(f64, f64)>,
    ) {
        self.is_scaled = false;
        let scales = !(self.known.is_there() || S::LIMITED && state.reached_limit);
        if matches!(state.load, Load::Force(_)) || S::FIXED || !(scales || update.settled) {
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
        let (_, w) = self.known.beside(update.gamma, &self.t, &self.q);
        let (State { h, u, p, .. }, products) = (state, [&self.q[..], &self.z, w]);
        let formula = WorkAndEnergy { approach: state.approach, update };
        let [work, energy] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([h, u, p], products, formula),
        );
        (work, energy)
    }

    /// `(p, approach - h)` and `(p, u)` after a step that truncated the debts from the first `paid` on.
    pub(super) fn after_truncation(
        &self,
        state: &State,
        (work, energy): (f64, f64),
        alpha: f64,
        paid: usize,
    ) -> (f64, f64) {
        self.debts[paid..].iter().fold((work, energy), |(work, energy), &(i, d)| {
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
