//! The loops over the contact area: residual, search direction, step length. Module `formulas` has the formulas for one element.

use super::formulas::{Conjugate, Direction, Distance, Free, Lowered, Residual, Scale, StepTerms};
use super::step_sums::{Energy, StepSums, Update};
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::scene::Load;

/// A direction counts as one without force if its sum is at most this part of the sum of |t|.
const SMALL_FORCE: f64 = 1e-2;
/// The largest number of Newton steps that lower t.
const NEWTON_STEPS: u32 = 8;

/// An empty list of arrays in the precision T.
pub(super) const fn none<'a, T>() -> [&'a [T]; 0] {
    []
}

impl<T: Real> Iteration<T> {
    /// Finds the segments of the whole contact area, whatever has changed.
    pub(super) fn find_contact(&mut self, state: &State) {
        self.segments.change_all();
        self.segments.find(&state.contact);
    }

    /// If the force is prescribed: sets the approach to the mean over C of h + u, where u is that after `update`. With pressure limits the shift for
    /// the missing force is added (module `limits`). With a prescribed force there is no deflation direction, so `update` has no part along it.
    pub(super) fn fit_approach(&mut self, state: &mut State, update: &Update) {
        if matches!(state.load, Load::Approach(_)) {
            return;
        }
        let (q, z) = (&self.q[..], &self.z[..]);
        let [sum] = self.segments.sum_of(
            &state.contact,
            [&state.h, &state.u],
            [q, z],
            Distance { update, approach: state.approach },
        );
        if self.segments.count() > 0 {
            state.approach += sum / self.segments.count() as f64 + self.limits.shift;
        }
    }

    /// Sets z = r = -e on C, 0 outside. Returns the relative residual, `||e|| / ||h - approach||` over C.
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
        if self.is_plane_strain() {
            self.find_allowance();
        }
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// Whether directions carry no force, because p is scaled to the force or to the least energy, or moves along the deflation direction.
    fn is_without_force(&self, state: &State) -> bool {
        matches!(state.load, Load::Force(_)) || self.deflation.is_there() || self.is_scaled
    }

    /// Replaces z by E^T M E z (module [`extension`](crate::methods::extension)).
    pub(super) fn precondition(&mut self, state: &State) {
        let without_force = self.is_without_force(state);
        self.count_near(state);
        if let Some(m) = &mut self.preconditioner {
            m.apply(&mut self.z, (&state.contact, without_force), &mut self.extension, &mut self.workspace);
        }
    }

    /// Updates the preconditioner after a change of C: the counts of the extension, and the pieces of C on a line in plane strain.
    pub(super) fn count_near(&mut self, state: &State) {
        let Some(preconditioner) = &mut self.preconditioner else { return };
        let (segments, before) = (&self.segments, self.counted.replace(self.segments.version()));
        if before == self.counted {
            return;
        }
        preconditioner.find_pieces(&state.contact);
        if let Some(extension) = &mut self.extension {
            let has_changed = |elements| before.is_none_or(|before| segments.changed_since(before, elements));
            extension.count(&state.contact, |inside| inside, has_changed);
        }
    }

    /// Sets t = z + beta t on C, 0 outside. If directions carry no force, the sum of t is 0, or that of the missing force. If there is a `forecast`,
    /// t is clipped so that the forecast step does not take p below 0. `tq` is (t, q) of the last direction, or 0 if t is not to be conjugate to it.
    pub(super) fn direct(&mut self, state: &State, tq: f64, forecast: Option<f64>) {
        let without_force = self.is_without_force(state);
        let missing = self.limits.missing / forecast.unwrap_or(1.0);
        let (mean, beta) = self.conjugate(state, without_force.then_some(missing), tq);
        let (z, formula) = (&self.z[..], Direction { mean, beta, forecast });
        self.segments.change(&state.contact, &mut self.t, ([&state.p], [z]), formula);
        if let Some(forecast) = forecast.filter(|_| without_force) {
            self.remove_force(state, missing, forecast);
        }
    }

    /// Lowers t by a constant where it is not clipped, until the sum of t over C is `missing`: clipping has increased this sum. The sum is a convex
    /// function of the constant, so Newton's method converges from one side.
    fn remove_force(&mut self, state: &State, missing: f64, forecast: f64) {
        for _ in 0..NEWTON_STEPS {
            let (t, formula) = (&self.t[..], Free { forecast });
            let [sum, absolute, free] = self.segments.sum_of(&state.contact, [&state.p], [t], formula);
            let excess = sum - missing;
            if !(excess > SMALL_FORCE * absolute && free > 0.0) {
                return;
            }
            let formula = Lowered { shift: excess / free, forecast };
            self.segments.change(&state.contact, &mut self.t, ([&state.p], none::<T>()), formula);
        }
    }

    /// Returns the constant that is subtracted from z + beta t, and beta. The constant gives t the sum `missing`; it is 0 if `missing` is None, when
    /// directions may carry force.
    fn conjugate(&mut self, state: &State, missing: Option<f64>, tq: f64) -> (f64, f64) {
        if missing.is_none() && tq <= 0.0 {
            return (0.0, 0.0);
        }
        let arrays = [&self.t[..], &self.z, &self.q];
        let [t1, z1, q1, zq] = self.segments.sum_of(&state.contact, [], arrays, Conjugate);
        let count = self.segments.count() as f64;
        let mean = if missing.is_some() { z1 / count } else { 0.0 };
        let beta = if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 };
        (missing.map_or(0.0, |missing| (z1 + beta * t1 - missing) / count), beta)
    }

    /// Computes the sums over C for the step length, and those for the energy if p is scaled to the least energy.
    pub(super) fn step_sums(&mut self, state: &State) -> StepSums {
        if self.deflation.is_there() {
            return self.step_sums_beside_deflation(state);
        }
        let State { h, u, p, contact, .. } = state;
        let (tq, formula) = ([&self.t[..], &self.q], StepTerms { approach: state.approach });
        if !self.is_scaled {
            let [rt, tq, tt, t1, pp] = self.segments.sum_of(contact, [h, u, p], tq, formula);
            return StepSums { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: None };
        }
        let [rt, tq, tt, t1, pp, pd, td, pu, pq] = self.segments.sum_of(contact, [h, u, p], tq, formula);
        let energy = Energy { pd, td, pu, pq_tu: pq + td - rt, tq };
        StepSums { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: Some(energy) }
    }

    /// Multiplies p on C, and the deferred corrections, by a factor.
    pub(super) fn scale(&mut self, state: &mut State, factor: f64) {
        self.truncation.scale(factor);
        let State { p, contact, .. } = state;
        self.segments.change(contact, p, ([], none::<T>()), Scale { factor });
    }
}
