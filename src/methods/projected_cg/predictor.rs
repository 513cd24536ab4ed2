//! Time stepping: where to start from, given the last two solutions.
//!
//! With p_1 the last solution and p_0 the one before it, the start is `p_1 + s_1 p_1 + s_2 d`: what grows or shrinks with the load, and
//! d, the change of the last step, for bodies go on rolling as they rolled. The s are those of the least energy
//! `(p, A p)/2 + (p, h - approach)` (Fischer 1998 projects on earlier solutions so); as all u are known, they cost no product.
//! With a prescribed force s_1 follows from the force, and d carries none.

use super::known::Last;
use super::segments::Sums;
use crate::contact::{Freshness, State};
use crate::error::Result;
use crate::memory::keep;
use crate::operator::zeros;
use crate::scene::Load;
use crate::threads::Threads;

/// A change whose energy is this part of its own without what is of p is that of rounding.
const NOISE: f64 = 1e-9;

/// The solution before the last; empty before there is one.
#[derive(Default)]
pub struct Predictor {
    p: Vec<f64>,
    u: Vec<f64>,
    /// Whether u is of other coefficients than those of now.
    is_of_others: bool,
}

impl Predictor {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.p.len() + self.u.len()) * size_of::<f64>()
    }

    /// The coefficients are others from now on: u is near A p.
    pub fn forget_coefficients(&mut self) {
        self.is_of_others = true;
    }

    /// The solution from which `state` was moved on.
    pub fn last(&self) -> Last<'_> {
        Last { p: &self.p, u: &self.u }
    }

    /// Moves `state` from the last solution (its u is A p) on, and keeps that. Returns what u is then. p may be negative: the
    /// iteration truncates it, and owes u the change.
    pub fn predict(&mut self, state: &mut State, threads: &Threads) -> Result<Freshness> {
        let is_of_others = std::mem::take(&mut self.is_of_others);
        let n = state.p.len();
        if self.p.is_empty() {
            // A change of nothing.
            (self.p, self.u) = (zeros(n, "the solution before")?, zeros(n, "the solution before")?);
            self.p.copy_from_slice(&state.p);
            self.u.copy_from_slice(&state.u);
        }
        let (now, before) = self.shares(state);
        let mx = state.grid.mx;
        let move_on = |values: &mut [f64], last: &mut [f64]| {
            for (value, last) in values.iter_mut().zip(last) {
                (*value, *last) = (now * *value - before * *last, *value);
            }
        };
        let threads = threads.for_a_pass(n);
        threads.for_each_row_pair((&mut state.p, mx), (&mut self.p, mx), |_, p, last| move_on(p, last));
        threads.for_each_row_pair((&mut state.u, mx), (&mut self.u, mx), |_, u, last| move_on(u, last));
        let mut displacement = if is_of_others && before != 0.0 { Freshness::Near } else { Freshness::Exact };
        for ((p, inside), h) in state.p.iter_mut().zip(&mut state.contact).zip(&state.h) {
            *inside = *p != 0.0;
            if *inside && h.is_infinite() {
                (*p, *inside) = (0.0, false);
                displacement = Freshness::Stale;
            }
        }
        Ok(displacement)
    }

    /// a and b of the start `a p_1 - b p_0`.
    fn shares(&self, state: &State) -> (f64, f64) {
        let by_force = matches!(state.load, Load::Force(_));
        // (p, u), (p, e), (d, u), (d, A d), (d, e); without branches but for rows: h may be infinite where nothing presses.
        let mut sums = Sums::<5>::new();
        let rows = self.p.chunks_exact(state.grid.mx).zip(self.u.chunks_exact(state.grid.mx)).enumerate();
        for (y, (p_0, u_0)) in rows {
            let row = y * state.grid.mx..(y + 1) * state.grid.mx;
            let (p, u, h) = (&state.p[row.clone()], &state.u[row.clone()], &state.h[row]);
            if p.iter().zip(p_0).fold(true, |none, (p, p_0)| none & (*p == 0.0) & (*p_0 == 0.0)) {
                continue;
            }
            sums.add(p.len(), |i| {
                let (d, v) = (p[i] - p_0[i], u[i] - u_0[i]);
                let e = if (p[i] != 0.0) | (d != 0.0) { h[i] - state.approach + u[i] } else { 0.0 };
                [p[i] * u[i], p[i] * e, d * u[i], d * v, d * e]
            });
        }
        let [pu, pe, du, dv, de] = sums.values();
        let (mut scale, mut share) = (1.0 - pe / pu, du / pu);
        if by_force {
            let sum = |p: &[f64]| p.iter().sum::<f64>();
            (scale, share) = (1.0, 1.0 - sum(&self.p) / sum(&state.p));
        }
        if !(scale.is_finite() && scale > 0.0) {
            scale = 1.0;
        }
        // d - share p, conjugate to p, or without a force of its own
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

impl Drop for Predictor {
    fn drop(&mut self) {
        keep([&mut self.p, &mut self.u]);
    }
}
