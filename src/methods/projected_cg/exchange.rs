//! Steps (4.1) and (4.2) within the iteration: who leaves C with p, and who enters it with u.

use super::passes::Update;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;

/// An element was held back if the forecast step leaves it this part of its pressure at most: single precision's rounding.
pub(super) const HELD_BACK: f64 = 1e-6;
/// Elements of a run that are looked at together.
const CHUNK: usize = 64;

impl<T: Real> Iteration<T> {
    /// p = p + alpha t + gamma d on C, and 4.1: elements beyond a bound, and those held back by the forecast, leave for it; what they gain
    /// is owed. Returns how many.
    pub(super) fn update_pressures<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        (alpha, gamma): (f64, f64),
        forecast: Option<f64>,
    ) -> u64 {
        let t = &self.t;
        let (d, _) = self.known.beside(gamma, t, &self.q);
        let to = |p: f64, t: T, d: T| p + (alpha * t.to_double() + gamma * d.to_double());
        let leaves = |i: usize, p: f64, t: T, d: T| {
            let held_back = forecast.is_some_and(|forecast| {
                let foreseen = p + forecast * t.to_double();
                foreseen <= HELD_BACK * p || S::LIMITED && foreseen >= set.limit(i) * (1.0 - HELD_BACK)
            });
            set.leaves(i, to(p, t, d)) | (held_back & !S::FIXED)
        };
        self.runs.list_changing(
            &mut state.p,
            #[inline(always)]
            |block, p, left| {
                for (run, local) in block.runs() {
                    let chunks = t[run.clone()].chunks(CHUNK).zip(d[run.clone()].chunks(CHUNK));
                    for ((p, (t, d)), first) in p[local].chunks_mut(CHUNK).zip(chunks).zip(run.step_by(CHUNK)) {
                        let elements = || p.iter().zip(t).zip(d).zip(first..);
                        // Few elements leave, at the rim: the others the compiler can vectorise.
                        if elements().fold(false, |some, (((p, t), d), i)| some | leaves(i, *p, *t, *d)) {
                            let leaving = elements().filter(|(((p, t), d), i)| leaves(*i, **p, **t, **d));
                            left.extend(leaving.map(|(_, i)| i as u32));
                        }
                        p.iter_mut().zip(t).zip(d).for_each(|((p, t), d)| *p = to(*p, *t, *d));
                    }
                }
            },
        );
        let before = self.debts.len();
        for i in self.runs.listed() {
            self.debts.push((i, leave(state, set, i, self.t[i] > T::zero())));
        }
        for &(i, _) in &self.debts[before..] {
            self.t[i] = T::zero();
            self.runs.change(i);
        }
        (self.debts.len() - before) as u64
    }

    /// u = factor (u + alpha q + gamma w + A d), and 4.2. Returns how many elements enter. One pass over the grid, because its arrays are longer
    /// than the caches.
    pub(super) fn update_displacements<S: AdmissibleSet>(&mut self, state: &mut State, set: S, update: &Update) -> u64 {
        let limited = S::LIMITED && state.has_limited();
        let State { h, u, contact, at_limit, approach, grid, .. } = state;
        let (mx, approach) = (grid.mx, *approach);
        let (q, z) = (&self.q, &self.z);
        let (_, w) = self.known.beside(update.gamma, &self.t, q);
        self.threads.for_each_row_pair((u, mx), (&mut self.entering, 1), |iy, u, entering| {
            let row = iy * mx..(iy + 1) * mx;
            let z = if update.settled { &z[row.clone()] } else { &[] };
            let (h_of_row, contact) = (&h[row.clone()], &contact[row.clone()]);
            let products = (&q[row.clone()], &w[row.clone()], z);
            let moves = Moves { u, products, update: *update, contact, h: h_of_row, approach, set };
            let mut any = pulp::Arch::new().dispatch(moves);
            if limited {
                for ((h, u), at_limit) in h[row.clone()].iter().zip(&*u).zip(&at_limit[row]) {
                    any |= set.enters(true, h - approach + *u) & at_limit;
                }
            }
            entering[0] = u32::from(any);
        });
        if !self.entering.contains(&1) {
            return 0;
        }
        let waits = limited && self.limits.waits(h, u, at_limit, approach);
        let (h, u, held) = (&h[..], &u[..], &at_limit[..]);
        self.threads.for_each_row_pair((contact, mx), (&mut self.entering, 1), |iy, contact, entering| {
            if std::mem::take(&mut entering[0]) == 0 {
                return;
            }
            for (contact, i) in contact.iter_mut().zip(iy * mx..) {
                let held = S::LIMITED && held[i];
                let stays = *contact || held && waits;
                if !stays && set.enters(held, h[i] - approach + u[i]) {
                    *contact = true;
                    entering[0] += 1;
                }
            }
        });
        let mut entered = 0;
        for (iy, count) in self.entering.iter().enumerate().filter(|(_, &count)| count > 0) {
            self.runs.change(iy * mx);
            entered += u64::from(*count);
            if limited {
                let row = iy * mx..(iy + 1) * mx;
                contact[row.clone()].iter().zip(&mut at_limit[row]).for_each(|(inside, held)| *held &= !inside);
            }
        }
        entered
    }
}

/// A row of u moves; returns whether an element enters. Compiled for the vectors of this machine, on which no bit depends.
struct Moves<'a, T, S> {
    u: &'a mut [f64],
    /// q, w, and A d or nothing.
    products: (&'a [T], &'a [T], &'a [T]),
    update: Update,
    contact: &'a [bool],
    h: &'a [f64],
    approach: f64,
    set: S,
}

impl<T: Real, S: AdmissibleSet> pulp::NullaryFnOnce for Moves<'_, T, S> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Moves { u, products: (q, w, z), update, contact, h, approach, set } = self;
        let Update { alpha, gamma, factor, .. } = update;
        for ((u, q), w) in u.iter_mut().zip(q).zip(w) {
            *u += alpha * q.to_double() + gamma * w.to_double();
        }
        u.iter_mut().zip(z).for_each(|(u, z)| *u += z.to_double());
        if factor != 1.0 {
            u.iter_mut().for_each(|u| *u *= factor);
        }
        any_enters(set, h, u, contact, approach)
    }
}

/// Whether an element enters. Of most blocks none does, because all are in contact or none penetrates: both the compiler can vectorise.
#[inline(always)]
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
