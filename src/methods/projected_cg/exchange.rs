//! Steps (4.1) and (4.2) within the iteration: elements leave C in the update of p, and enter C in the update of u.

use super::formulas::{Entering, Leaving, Moved, MovedU};
use super::step_sums::Update;
use super::vectors::Iteration;
use crate::contact::{enter, leave, AdmissibleSet, State};
use crate::operator::fft::Real;

impl<T: Real> Iteration<T> {
    /// Sets p = p + alpha t + gamma d on C, and makes step (4.1): elements beyond a bound, and elements that were clipped for the `forecast`, leave C
    /// for this bound. The correction of u for their truncation is deferred. Returns the number of elements that leave C.
    pub(super) fn update_pressures<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        (alpha, gamma): (f64, f64),
        forecast: Option<f64>,
    ) -> u64 {
        let (t, moved) = (&self.t[..], Moved { alpha, gamma });
        let (d, _) = self.deflation.beside(gamma, t, &self.q);
        let State { p, contact, .. } = state;
        let leaving = Leaving { moved, forecast, set, elements: p.len() };
        self.segments.list_changing(
            contact,
            p,
            #[inline(always)]
            |block, p, left| {
                if !S::FIXED {
                    block.list(left, p, [t, d], leaving);
                }
                block.change(p, [], [t, d], moved);
            },
        );
        let before = self.truncation.count();
        let (t, truncation) = (&mut self.t, &mut self.truncation);
        self.segments.change_listed(|i| {
            let (to, rises) = (state.p[i], t[i] > T::zero());
            let for_limit = S::LIMITED && (to > set.limit(i) || to >= 0.0 && rises);
            truncation.push(i, leave(state, set, i, for_limit));
            t[i] = T::zero();
            true
        });
        (truncation.count() - before) as u64
    }

    /// Sets z = A d by a product, where d are the deferred corrections of p. No correction is deferred any more.
    pub(super) fn correct_now(&mut self) {
        self.truncation.take(&mut self.z);
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
    }

    /// Sets u = factor (u + alpha q + gamma w + A d), and makes step (4.2). Returns the number of elements that enter C. Both are done in one loop
    /// over the grid, because its arrays exceed the caches.
    pub(super) fn update_displacements<S: AdmissibleSet>(&mut self, state: &mut State, update: &Update) -> u64 {
        let (q, (_, w)) = (&self.q[..], self.deflation.beside(update.gamma, &self.t, &self.q));
        let limited = S::LIMITED && state.has_limited();
        let State { h, u, contact, at_limit, .. } = state;
        let held = if limited { &at_limit[..] } else { &[] };
        // The allowance is for exterior elements. It would have the wrong sign for elements at their limit, which enter if e > 0.
        let approach = if limited { state.approach } else { state.approach - self.allowance };
        let (moved, entering) = (MovedU(update), Entering { approach, is_fixed: S::FIXED, held });
        self.segments.list_changing(
            contact,
            u,
            #[inline(always)]
            |block, u, list| match update.gamma != 0.0 || update.is_corrected {
                true => block.change_and_list_outside(u, list, [h], [q, w, &self.z], moved, entering),
                false => block.change_and_list_outside(u, list, [h], [q], moved, entering),
            },
        );
        let some_may_wait = limited && self.segments.listed().any(|i| at_limit[i]);
        let wait = some_may_wait && self.limits.waits(h, u, at_limit, state.approach);
        let mut entered = 0;
        self.segments.change_listed(|i| {
            let enters = !(wait && state.at_limit[i]);
            if enters {
                enter::<S>(state, i);
                entered += 1;
            }
            enters
        });
        entered
    }
}
