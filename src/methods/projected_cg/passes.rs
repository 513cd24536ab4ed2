//! The passes over the contact area, each over its segments, and over the grid.

use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;

/// An element was held back if the forecast step leaves it this part of its pressure at most: single precision's rounding.
pub(super) const HELD_BACK: f64 = 1e-6;
/// Elements of a run that are looked at together.
const CHUNK: usize = 64;

/// What becomes of u: factor (u + alpha q + A d).
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    /// Whether z holds A d.
    pub(super) settled: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, settled: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p).
pub(super) struct Step {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    pub(super) t1: f64,
    pub(super) pp: f64,
}

impl<T: Real> Iteration<T> {
    /// The runs of a contact area of which nothing is known.
    pub(super) fn find_contact(&mut self, state: &State) {
        self.runs.change_all();
        self.runs.find(&state.contact);
    }

    /// With a prescribed force: the approach is the mean over C of h + u, u as `update` will leave it.
    pub(super) fn fit_approach(&mut self, state: &mut State, update: &Update) {
        if matches!(state.load, Load::Approach(_)) {
            return;
        }
        let (q, z, Update { alpha, settled, factor }) = (&self.q, &self.z, *update);
        let [sum] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, q, z) = (&state.h[run.clone()], &state.u[run.clone()], &q[run.clone()], &z[run]);
                sums.add(h.len(), |i| {
                    let repair = if settled { z[i].to_double() } else { 0.0 };
                    [h[i] + factor * (u[i] + alpha * q[i].to_double() + repair)]
                });
            }
        });
        if self.runs.count() > 0 {
            state.approach = sum / self.runs.count() as f64 + self.limits.shift;
        }
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    pub(super) fn residual(&mut self, state: &State) -> f64 {
        let approach = state.approach;
        let [rr, hh] = self.runs.sum_changing(&mut self.z, |block, z, sums| {
            z.fill(T::zero());
            for (run, local) in block.runs() {
                let (h, u, z) = (&state.h[run.clone()], &state.u[run], &mut z[local]);
                sums.add(h.len(), |i| {
                    let distance = h[i] - approach;
                    let e = distance + u[i];
                    z[i] = T::of(-e);
                    [e * e, distance * distance]
                });
            }
        });
        self.limits.residual = rr;
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// z = M r, r being what z holds.
    pub(super) fn precondition(&mut self, state: &State) {
        if let Some(m) = &mut self.preconditioner {
            let by_force = matches!(state.load, Load::Force(_));
            m.apply(&mut self.z, by_force.then_some(&state.contact[..]), &mut self.workspace);
        }
    }

    /// t = z + beta t on C, 0 outside; with a prescribed force of mean zero over C, but for what is missing; held back by the forecast,
    /// if there is one. `tq` is (t, q) of the last direction, 0 if there is none.
    pub(super) fn direct<S: AdmissibleSet>(&mut self, state: &State, set: S, tq: f64, forecast: Option<f64>) {
        let by_force = matches!(state.load, Load::Force(_));
        let (mean, beta) = self.conjugate(by_force, tq);
        let (z, mean, beta) = (&self.z, T::of(mean), T::of(beta));
        let held = |i: usize, p: f64, t: T| match forecast {
            Some(forecast) if p + forecast * t.to_double() < 0.0 => T::of(-p / forecast),
            Some(forecast) if S::LIMITED && p + forecast * t.to_double() > set.limit(i) => {
                T::of((set.limit(i) - p) / forecast)
            }
            _ => t,
        };
        let [sum] = self.runs.sum_changing(&mut self.t, |block, t, sums| {
            for (run, local) in block.runs() {
                let (start, p, z, t) = (run.start, &state.p[run.clone()], &z[run], &mut t[local]);
                sums.add(z.len(), |i| {
                    let direction = z[i] - mean + beta * t[i];
                    t[i] = if by_force { direction } else { held(start + i, p[i], direction) };
                    [direction.to_double()]
                });
            }
        });
        if by_force {
            let missing = self.limits.missing / forecast.unwrap_or(1.0);
            let mean = T::of((sum - missing) / self.runs.count() as f64);
            let [] = self.runs.sum_changing(&mut self.t, |block, t, _| {
                for (run, local) in block.runs() {
                    for ((t, p), i) in t[local].iter_mut().zip(&state.p[run.clone()]).zip(run) {
                        *t = held(i, *p, *t - mean);
                    }
                }
            });
        }
    }

    /// The mean of z over C with a prescribed force, else 0, and beta.
    fn conjugate(&mut self, by_force: bool, tq: f64) -> (f64, f64) {
        if !by_force && tq <= 0.0 {
            return (0.0, 0.0);
        }
        let (z, q) = (&self.z, &self.q);
        let [z1, q1, zq] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (z, q) = (&z[run.clone()], &q[run]);
                sums.add(z.len(), |i| {
                    let (z, q) = (z[i].to_double(), q[i].to_double());
                    [z, q, z * q]
                });
            }
        });
        let mean = if by_force { z1 / self.runs.count() as f64 } else { 0.0 };
        (mean, if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 })
    }

    /// The sums over C that the step length needs.
    pub(super) fn step(&mut self, state: &State) -> Step {
        let (t, q) = (&self.t, &self.q);
        let [rt, tq, tt, t1, pp] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                let (t, q) = (&t[run.clone()], &q[run]);
                sums.add(h.len(), |i| {
                    let (t, e) = (t[i].to_double(), h[i] - state.approach + u[i]);
                    [-e * t, t * q[i].to_double(), t * t, t.abs(), p[i] * p[i]]
                });
            }
        });
        Step { rt, tq, tt, t1, pp }
    }

    /// p = p + alpha t on C, and 4.1: elements beyond a bound, and those held back by the forecast, leave for it; what they gain is
    /// owed. Returns how many.
    pub(super) fn update_pressures<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        alpha: f64,
        forecast: Option<f64>,
    ) -> u64 {
        let t = &self.t;
        let leaves = |i: usize, p: f64, t: T| {
            let held_back = forecast.is_some_and(|forecast| {
                let to = p + forecast * t.to_double();
                to <= HELD_BACK * p || S::LIMITED && to >= set.limit(i) * (1.0 - HELD_BACK)
            });
            set.leaves(i, p + alpha * t.to_double()) | (held_back & !S::FIXED)
        };
        // Blocks that no element leaves; the others have a sum of 1.
        let [_] = self.runs.sum_changing(&mut state.p, |block, p, sums| {
            let some_leave = block.runs().any(|(run, local)| {
                let elements = p[local].iter().zip(&t[run.clone()]).zip(run);
                elements.fold(false, |some, ((p, t), i)| some | leaves(i, *p, *t))
            });
            if some_leave {
                sums.add(1, |_| [1.0]);
                return;
            }
            for (run, local) in block.runs() {
                p[local].iter_mut().zip(&t[run]).for_each(|(p, t)| *p += alpha * t.to_double());
            }
        });
        let before = self.debts.len();
        // Of these few elements leave, at the rim: the others the compiler can vectorise.
        let chunks = self
            .runs
            .of_blocks_with_sum()
            .flat_map(|run| run.clone().step_by(CHUNK).map(move |start| start..run.end.min(start + CHUNK)));
        for chunk in chunks {
            let (p, t) = (&mut state.p[chunk.clone()], &self.t[chunk.clone()]);
            let some_leave = |some, ((p, t), i): ((&f64, &T), usize)| some | leaves(i, *p, *t);
            if !p.iter().zip(t).zip(chunk.clone()).fold(false, some_leave) {
                p.iter_mut().zip(t).for_each(|(p, t)| *p += alpha * t.to_double());
                continue;
            }
            for i in chunk {
                let (p, t) = (state.p[i], self.t[i]);
                state.p[i] = p + alpha * t.to_double();
                if leaves(i, p, t) {
                    self.debts.push((i, leave(state, set, i, t > T::zero())));
                    self.t[i] = T::zero();
                }
            }
        }
        for debt in &self.debts[before..] {
            self.runs.change(debt.0);
        }
        (self.debts.len() - before) as u64
    }

    /// By approach, where nothing is owed: scales p to the least energy `(p, u)/2 + (p, h - approach)`, u as `update` will leave it;
    /// returns the factor, with which u is to be scaled. It costs no product.
    pub(super) fn least_energy(&mut self, state: &mut State, update: &Update) -> f64 {
        self.runs.find(&state.contact);
        let (q, z, Update { alpha, settled, .. }) = (&self.q, &self.z, *update);
        let [work, energy] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                let (q, z) = (&q[run.clone()], &z[run]);
                sums.add(h.len(), |i| {
                    let repair = if settled { z[i].to_double() } else { 0.0 };
                    let u = u[i] + alpha * q[i].to_double() + repair;
                    [p[i] * (state.approach - h[i]), p[i] * u]
                });
            }
        });
        let factor = work / energy;
        if !(factor.is_finite() && factor > 0.0) {
            return 1.0;
        }
        self.scale(state, factor);
        factor
    }

    /// p = factor p on C.
    pub(super) fn scale(&mut self, state: &mut State, factor: f64) {
        let [] = self.runs.sum_changing(&mut state.p, |block, p, _| {
            for (_, local) in block.runs() {
                p[local].iter_mut().for_each(|p| *p *= factor);
            }
        });
    }

    /// u = factor (u + alpha q + A d), and 4.2. Returns how many elements enter. One pass over the grid, because its arrays are longer
    /// than the caches.
    pub(super) fn update_displacements<S: AdmissibleSet>(&mut self, state: &mut State, set: S, update: &Update) -> u64 {
        let limited = S::LIMITED && state.has_limited();
        let State { h, u, contact, at_limit, approach, grid, .. } = state;
        let (mx, approach) = (grid.mx, *approach);
        let (q, z) = (&self.q, &self.z);
        let Update { alpha, settled, factor } = *update;
        self.threads.for_each_row_pair((u, mx), (&mut self.entering, 1), |iy, u, entering| {
            let row = iy * mx..(iy + 1) * mx;
            for (u, q) in u.iter_mut().zip(&q[row.clone()]) {
                *u += alpha * q.to_double();
            }
            if settled {
                u.iter_mut().zip(&z[row.clone()]).for_each(|(u, z)| *u += z.to_double());
            }
            if factor != 1.0 {
                u.iter_mut().for_each(|u| *u *= factor);
            }
            let mut any = any_enters(set, &h[row.clone()], u, &contact[row.clone()], approach);
            if limited {
                for ((h, u), at_limit) in h[row.clone()].iter().zip(&*u).zip(&at_limit[row]) {
                    any |= set.enters(true, h - approach + *u) & at_limit;
                }
            }
            entering[0] = any;
        });
        let waits = limited && self.limits.waits(h, u, at_limit, approach);
        let mut entered = 0;
        for (iy, _) in self.entering.iter().enumerate().filter(|(_, &any)| any) {
            self.runs.change(iy * mx);
            for i in iy * mx..(iy + 1) * mx {
                let held = S::LIMITED && at_limit[i];
                let stays = contact[i] || held && waits;
                if !stays && set.enters(held, h[i] - approach + u[i]) {
                    contact[i] = true;
                    entered += 1;
                    if held {
                        at_limit[i] = false;
                    }
                }
            }
        }
        entered
    }
}

/// Whether an element enters. Of most blocks none does, because all are in contact or none penetrates: both the compiler can vectorise.
fn any_enters<S: AdmissibleSet>(set: S, h: &[f64], u: &[f64], contact: &[bool], approach: f64) -> bool {
    const BLOCK: usize = 8;
    let exactly = |h: &[f64], u: &[f64], contact: &[bool]| {
        let elements = h.iter().zip(u).zip(contact);
        elements.fold(false, |any, ((h, u), inside)| any | (set.enters(false, h - approach + u) & !inside))
    };
    let (blocks_h, blocks_u, blocks_c) = (h.chunks_exact(BLOCK), u.chunks_exact(BLOCK), contact.chunks_exact(BLOCK));
    let mut any = exactly(blocks_h.remainder(), blocks_u.remainder(), blocks_c.remainder());
    for ((h, u), contact) in blocks_h.zip(blocks_u).zip(blocks_c) {
        if *contact == [true; BLOCK] {
            continue;
        }
        let signs = h.iter().zip(u).fold(0, |signs, (h, u)| signs | (h - approach + u).to_bits());
        any |= signs >> 63 == 1 && exactly(h, u, contact);
    }
    any
}

/// Element i leaves C for a bound; `rises`: its pressure does. Returns what it gains.
fn leave<S: AdmissibleSet>(state: &mut State, set: S, i: usize, rises: bool) -> f64 {
    let to = state.p[i];
    let at_limit = S::LIMITED && (to > set.limit(i) || to >= 0.0 && rises);
    if at_limit {
        (state.at_limit[i], state.reached_limit) = (true, true);
    }
    state.p[i] = if at_limit { set.limit(i) } else { 0.0 };
    state.contact[i] = false;
    state.p[i] - to
}
