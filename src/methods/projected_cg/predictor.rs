//! Time stepping: where to start from, given the last two solutions.
//!
//! With p_1 the last solution and p_0 the one before it, the start is `p_1 + s_1 p_1 + s_2 d`: what grows or shrinks with the load, and
//! d, the change of the last step, for bodies go on rolling as they rolled. The s are those of the least energy
//! `(p, A p)/2 + (p, h - approach)` (Fischer 1998 projects on earlier solutions so); as all u are known, they cost no product.
//! With a prescribed force s_1 follows from the force, and d carries none.

use crate::contact::{Freshness, State};
use crate::error::Result;
use crate::memory::keep;
use crate::operator::zeros;
use crate::scene::Load;
use crate::threads::Threads;

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

    /// Moves `state` from the last solution (its u is A p) on, and keeps that. Returns what u is then. p may be negative: the
    /// iteration truncates it, and owes u the change.
    pub fn predict(&mut self, state: &mut State, threads: &Threads) -> Result<Freshness> {
        state.scale_to_approach();
        let displacement = if std::mem::take(&mut self.is_of_others) { Freshness::Near } else { Freshness::Exact };
        if self.p.is_empty() {
            let n = state.p.len();
            (self.p, self.u) = (zeros(n, "the solution before")?, zeros(n, "the solution before")?);
            self.p.copy_from_slice(&state.p);
            self.u.copy_from_slice(&state.u);
            return Ok(Freshness::Exact);
        }

        // d = (p_1 - p_0) - share p_1, conjugate to p_1, or without a force of its own
        let (mut with_last, mut last) = (0.0, 0.0);
        let by_force = matches!(state.load, Load::Force(_));
        for i in 0..state.p.len() {
            let weight = if by_force { 1.0 } else { state.u[i] };
            with_last += weight * (state.p[i] - self.p[i]);
            last += weight * state.p[i];
        }
        let share = with_last / last;
        if !share.is_finite() {
            return Ok(Freshness::Exact);
        }
        let (mut work, mut energy) = (0.0, 0.0);
        for i in 0..state.p.len() {
            let change = (1.0 - share) * state.p[i] - self.p[i];
            if change != 0.0 {
                let displacement = (1.0 - share) * state.u[i] - self.u[i];
                work -= change * state.deformed_distance(i);
                energy += change * displacement;
            }
        }
        let step = work / energy;
        let step = if energy > 0.0 && step.is_finite() { step } else { 0.0 };

        let mx = state.grid.mx;
        let move_on = |now: &mut [f64], before: &mut [f64]| {
            for (now, before) in now.iter_mut().zip(before) {
                (*now, *before) = (*now + step * ((1.0 - share) * *now - *before), *now);
            }
        };
        let threads = threads.for_a_pass(state.p.len());
        threads.for_each_row_pair((&mut state.p, mx), (&mut self.p, mx), |_, now, before| move_on(now, before));
        threads.for_each_row_pair((&mut state.u, mx), (&mut self.u, mx), |_, now, before| move_on(now, before));
        let mut displacement = if step == 0.0 { Freshness::Exact } else { displacement };
        for ((p, inside), h) in state.p.iter_mut().zip(&mut state.contact).zip(&state.h) {
            *inside = *p != 0.0;
            if *inside && h.is_infinite() {
                (*p, *inside) = (0.0, false);
                displacement = Freshness::Stale;
            }
        }
        Ok(displacement)
    }
}

impl Drop for Predictor {
    fn drop(&mut self) {
        keep([&mut self.p, &mut self.u]);
    }
}
