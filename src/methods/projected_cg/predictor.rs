//! Steps in time: a solve starts from an extrapolation of the last two solutions.
//!
//! Let p_1 be the last solution, p_0 the one before, and d = p_1 - p_0 the change of the last step. The solve starts from `p_1 + s_1 p_1 + s_2 d`.
//! The first correction follows a change of the load, the second a motion. The factors s_1 and s_2 minimise the energy
//! `(p, A p)/2 + (p, h - approach)`, which is a projection on earlier solutions (Fischer 1998). They take no product, because A p_1 and A p_0 are
//! known. If the force is prescribed, s_1 follows from the force, and the second correction has the sum 0.

use std::mem::{swap, take};
use std::sync::atomic::{AtomicBool, Ordering};

use super::deflation::Last;
use crate::contact::{presses, Freshness, State};
use crate::error::Result;
use crate::memory::{copied, keep};
use crate::rectangle::Rectangle;
use crate::scene::Load;
use crate::sums::Sums;
use crate::threads::Threads;

/// If d minus its component along p has at most this fraction of the energy of d, this rest is round-off.
const NOISE: f64 = 1e-9;
/// The name of the memory of the earlier solution in messages.
const LAST: &str = "the solution before";

/// The solution before the last: its pressures and displacements. Empty if there is none.
#[derive(Default)]
pub struct Predictor {
    p: Vec<f64>,
    u: Vec<f64>,
    /// Whether u belongs to earlier coefficients, so that u only approximates A p.
    is_of_others: bool,
}

impl Predictor {
    /// Bytes of the solution before the last.
    pub fn bytes(&self) -> usize {
        (self.p.len() + self.u.len()) * size_of::<f64>()
    }

    /// Returns a copy, or an error without memory for it.
    pub fn copy(&self) -> Result<Predictor> {
        Ok(Predictor { p: copied(&self.p, LAST)?, u: copied(&self.u, LAST)?, is_of_others: self.is_of_others })
    }

    /// Marks u as approximate, after a change of coefficients.
    pub fn forget_coefficients(&mut self) {
        self.is_of_others = true;
    }

    /// The solution from which [`Predictor::predict`] extrapolated.
    pub fn last(&self) -> Last<'_> {
        Last { p: &self.p, u: Some(&self.u) }
    }

    /// Replaces the last solution in `state`, whose u is A p, by the extrapolation, and keeps the last solution. u is extrapolated in the window that
    /// `window` chooses, and unknown elsewhere. Returns how accurately u equals A p in the window. p may be negative: the iteration truncates p and
    /// corrects u.
    pub fn predict(
        &mut self,
        state: &mut State,
        window: impl FnOnce(&State) -> Rectangle,
        threads: &Threads,
    ) -> Result<Freshness> {
        let is_of_others = take(&mut self.is_of_others);
        let n = state.p.len();
        if self.p.is_empty() {
            // There is one solution only: d is 0.
            (self.p, self.u) = (copied(&state.p, LAST)?, copied(&state.u, LAST)?);
        }
        let (last_share, share_before) = self.shares(state);
        // The last solution replaces the one before it, which the state's memory now holds.
        swap(&mut self.p, &mut state.p);
        swap(&mut self.u, &mut state.u);
        let (last_p, last_u, mx) = (&self.p[..], &self.u[..], state.grid.mx);
        let State { h, p, contact, .. } = state;
        let (threads, h, presses_on_nothing) = (threads.for_a_pass(n), &h[..], AtomicBool::new(false));
        threads.for_each_row_pair(
            (p, mx),
            (contact, mx),
            #[inline(always)]
            |y, p, contact| {
                let row = y * mx..(y + 1) * mx;
                let (last, h) = (&last_p[row.clone()], &h[row]);
                if presses(p) | presses(last) {
                    p.iter_mut().zip(last).for_each(|(p, last)| *p = last_share * last - share_before * *p);
                    if touch(p, h, contact) {
                        presses_on_nothing.store(true, Ordering::Relaxed);
                    }
                } else {
                    contact.fill(false);
                }
            },
        );
        let Rectangle { x, y: rows } = window(state);
        let part = rows.start * mx..rows.end * mx;
        threads.for_each_plain_row(
            &mut state.u[part.clone()],
            mx,
            #[inline(always)]
            |y, u| {
                let last = &last_u[part.start + y * mx..][x.clone()];
                u[x.clone()].iter_mut().zip(last).for_each(|(u, last)| *u = last_share * last - share_before * *u);
            },
        );
        Ok(match presses_on_nothing.into_inner() {
            true => Freshness::Stale,
            false if is_of_others && share_before != 0.0 => Freshness::Near,
            false => Freshness::Exact,
        })
    }

    /// The factors a and b of the extrapolation `a p_1 - b p_0`.
    fn shares(&self, state: &State) -> (f64, f64) {
        let by_force = matches!(state.load, Load::Force(_));
        let [pu, pe, du, dv, de, sum, sum_before] =
            pulp::Arch::new().dispatch(Products { state, before: (&self.p, &self.u) });
        let (mut scale, mut share) = (1.0 - pe / pu, du / pu);
        if by_force {
            (scale, share) = (1.0, 1.0 - sum_before / sum);
        }
        if !(scale.is_finite() && scale > 0.0) {
            scale = 1.0;
        }
        // The second correction is along d - share p, which is conjugate to p, or has the sum 0 if the force is prescribed.
        let work = share * pe - de;
        let energy = dv - share * (2.0 * du - share * pu);
        let step = work / energy;
        if energy > NOISE * dv && step.is_finite() {
            (scale + step * (1.0 - share), step)
        } else {
            (scale, 0.0)
        }
    }
}

/// Sets C to the elements whose p is not 0. Where there is no surface, sets p to 0 and leaves the element outside C; returns whether this happened.
#[inline(always)]
fn touch(p: &mut [f64], h: &[f64], contact: &mut [bool]) -> bool {
    let mut none = false;
    for ((p, h), inside) in p.iter().zip(h).zip(&mut *contact) {
        *inside = *p != 0.0;
        none |= *inside & h.is_infinite();
    }
    if none {
        for ((p, _), inside) in p.iter_mut().zip(h).zip(contact).filter(|((_, h), _)| h.is_infinite()) {
            (*p, *inside) = (0.0, false);
        }
    }
    none
}

/// Computes (p, u), (p, e), (d, u), (d, A d), (d, e), and the sums of p_1 and p_0, where p = p_1 and u = A p_1. The loop is compiled for the vector
/// length of this machine, on which no bit depends.
struct Products<'a> {
    /// The last solution, p_1 and u_1.
    state: &'a State,
    /// The solution before, p_0 and u_0.
    before: (&'a [f64], &'a [f64]),
}

impl pulp::NullaryFnOnce for Products<'_> {
    type Output = [f64; 7];

    #[inline(always)]
    fn call(self) -> [f64; 7] {
        let (Products { state, before }, mut sums) = (self, Sums::new());
        let approach = state.approach;
        for start in (0..state.p.len()).step_by(state.grid.mx) {
            let row = start..start + state.grid.mx;
            let (p, u, h) = (&state.p[row.clone()], &state.u[row.clone()], &state.h[row.clone()]);
            let (p_0, u_0) = (&before.0[row.clone()], &before.1[row]);
            if !(presses(p) | presses(p_0)) {
                continue;
            }
            // h may be infinite where p and d are 0: e is then set to 0, without a branch.
            sums.add::<f64, 5, 0>([p, u, h, p_0, u_0], [], |[p, u, h, p_0, u_0], []| {
                let (d, v) = (p - p_0, u - u_0);
                let e = if (p != 0.0) | (d != 0.0) { h - approach + u } else { 0.0 };
                [p * u, p * e, d * u, d * v, d * e, p, p_0]
            });
        }
        sums.values()
    }
}

impl Drop for Predictor {
    fn drop(&mut self) {
        keep([&mut self.p, &mut self.u]);
    }
}
