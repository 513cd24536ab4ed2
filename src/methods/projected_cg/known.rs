//! A direction whose displacement is known: the change of p since the last solution in time.
//!
//! Under a prescribed approach the residual has a part that is uniform over C. What removes it is the pressure of a flat punch on C, to
//! which no few products with M come near, because M knows nothing of the rim. A small change of the load changes p by nearly that
//! pressure, so the change `d` of the last step, and w = A d, serve for it:
//!
//! ```text
//! t has mean zero over C, as under a prescribed force
//! gamma = (r - alpha q, d)/(d, w),  p = p + alpha t + gamma d,  u = u + alpha q + gamma w
//! ```
//!
//! Elements that are not in C at the start are taken out of d, and by one product out of w. Those that leave later have no part of d any more, but
//! of w and of (d, w): u is owed the difference.

use super::formulas::{Moved, Residual, StepSums};
use super::known_passes::{measures, Change, Restrict, Subtract};
use super::passes::Step;
use super::scaling::Scaling;
use super::vectors::Iteration;
use super::Window;
use crate::contact::State;
use crate::error::Result;
use crate::memory::reserve;
use crate::operator::fft::Real;
use crate::sums::Sums;

/// A change carries force if its sum is at least this part of the sum of its absolute values; rolling moves pressures without any.
const CARRIES: f64 = 0.5;
/// A first step along d that changes e by less than this part of the residual waits for the next.
const WORTHWHILE: f64 = 0.1;
/// A change of less than this part of the pressures is their rounding.
const LEAST: f64 = 1e-6;

/// Pressures of an earlier solution and their displacements, on the whole grid, in the scene's units.
#[derive(Clone, Copy)]
pub struct Last<'a> {
    /// p.
    pub p: &'a [f64],
    /// u = A p.
    pub u: &'a [f64],
}

/// d and w = A d.
#[derive(Default)]
pub(super) struct Known<T> {
    pub(super) d: Vec<T>,
    pub(super) w: Vec<T>,
    /// (d, w); 0 while there is no such direction.
    energy: f64,
    /// The sums of d^2, and of w^2 over the elements of d.
    length: f64,
    size: f64,
    /// Whether d is a deflation direction (module `deflation`).
    pub(super) is_deflation: bool,
    /// Elements that left C, which are 0 in d but not in what w is of.
    outside: Vec<(usize, f64)>,
}

impl<T> Known<T> {
    /// There is no such direction.
    pub(super) fn forget(&mut self) {
        self.energy = 0.0;
    }

    /// Whether there is one.
    pub(super) fn is_there(&self) -> bool {
        self.energy > 0.0
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        2 * self.d.len() * size_of::<T>()
    }
}

impl<T: Real> Known<T> {
    /// d and w; t and q where gamma is 0, so that nothing else is read.
    pub(super) fn beside<'a>(&'a self, gamma: f64, t: &'a [T], q: &'a [T]) -> (&'a [T], &'a [T]) {
        if gamma == 0.0 {
            (t, q)
        } else {
            (&self.d, &self.w)
        }
    }

    /// Elements that left d.
    pub(super) fn left(&self) -> usize {
        self.outside.len()
    }

    /// The 2-norm of d.
    pub(super) fn norm(&self) -> f64 {
        self.length.sqrt()
    }

    /// Memory for d and w; elements that left are forgotten.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        for values in [&mut self.d, &mut self.w] {
            reserve(values, n, "the change of the last step")?;
            values.resize(n, T::zero());
        }
        self.outside.clear();
        Ok(())
    }

    /// w is A d from now on.
    pub(super) fn measure(&mut self) {
        let mut sums = Sums::new();
        sums.add([], [&self.d, &self.w], |[], [d, w]| measures(d, w));
        self.take_measures(sums.values());
    }

    /// Takes (d, w), and the sums of d^2 and of w^2, from a pass; no direction where single precision did not hold w.
    fn take_measures(&mut self, [energy, length, size]: [f64; 3]) {
        let energy = if energy.is_finite() { energy } else { 0.0 };
        (self.energy, self.length, self.size) = (energy, length, size);
    }
}

impl<T: Real> Iteration<T> {
    /// Takes the change from the last solution, if there is one, to `state`, the part of a grid of `mx` columns in the window; none if it
    /// carries no force.
    pub fn know(
        &mut self,
        state: &State,
        last: Option<Last<'_>>,
        (window, mx): (&Window, usize),
        units: &Scaling,
    ) -> Result<()> {
        self.known.forget();
        let Some(last) = last else { return Ok(()) };
        self.known.reserve(state.p.len())?;
        self.known.is_deflation = false;
        let Known { d, w, .. } = &mut self.known;
        let mut sums = Sums::new();
        let width = window.x.len();
        let rows = d.chunks_exact_mut(width).zip(w.chunks_exact_mut(width)).zip(window.y.clone()).enumerate();
        for (row, ((d, w), y)) in rows {
            let (here, whole) = (row * width..(row + 1) * width, y * mx + window.x.start..y * mx + window.x.end);
            pulp::Arch::new().dispatch(Change {
                p: (&state.p[here.clone()], &last.p[whole.clone()], units.pressure()),
                u: (&state.u[here], &last.u[whole], units.length),
                d,
                w,
                sums: &mut sums,
            });
        }
        let [sum, absolute, all, measures @ ..] = sums.values();
        if f64::abs(sum) > CARRIES * absolute && absolute > LEAST * all {
            self.known.take_measures(measures);
        }
        Ok(())
    }

    /// d becomes the change on C alone; z loses what it held. Returns the products that this takes.
    pub(super) fn restrict_known(&mut self, state: &State) -> u64 {
        let is_there = self.known.is_there();
        let (Known { d, .. }, z) = (&mut self.known, &mut self.z);
        if !is_there || !pulp::Arch::new().dispatch(Restrict { d, z, contact: &state.contact }) {
            return 0;
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
        let (Known { d, w, .. }, z) = (&mut self.known, &self.z);
        let measures = pulp::Arch::new().dispatch(Subtract { d, w, z });
        self.known.take_measures(measures);
        1
    }

    /// The sums of a step, and those of gamma.
    pub(super) fn step_beside_change(&mut self, state: &State) -> Step {
        let (State { h, u, p, .. }, formula) = (state, StepSums { approach: state.approach });
        let arrays = [&self.t[..], &self.q, &self.known.d];
        let [rt, tq, tt, t1, pp, rd, qd] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([h, u, p], arrays, formula),
        );
        Step { rt, tq, tt, t1, pp, rd, qd, energy: None }
    }

    /// gamma beside a step of length alpha; 0 where no change is known.
    pub(super) fn gamma(&self, step: &Step, alpha: f64) -> f64 {
        let gamma = (step.rd - alpha * step.qd) / self.known.energy;
        if self.known.is_there() && gamma.is_finite() {
            gamma
        } else {
            0.0
        }
    }

    /// After a step of length gamma: elements that left d before are owed their part of it, which u has and p has not; those that have just left
    /// C leave d, too.
    pub(super) fn leave_known(&mut self, gamma: f64) {
        if !self.known.is_there() {
            return;
        }
        let Known { d, outside, .. } = &mut self.known;
        if gamma != 0.0 && !outside.is_empty() {
            self.debts.extend(outside.iter().map(|&(i, d)| (i, -gamma * d)));
            merge(&mut self.debts);
        }
        for &(i, _) in &self.debts {
            if d[i] != T::zero() {
                outside.push((i, d[i].to_double()));
                d[i] = T::zero();
            }
        }
    }

    /// Before the first step: p and u move along d to the least energy, if that is worth a pass over u.
    pub(super) fn step_along_known(&mut self, state: &mut State) {
        if !self.known.is_there() {
            return;
        }
        let Known { d, w, energy, size, .. } = &self.known;
        let (State { h, u, .. }, formula) = (&*state, Residual { approach: state.approach });
        let [rd, rr] = self.segments.sum(
            &state.contact,
            #[inline(always)]
            |block| block.sum([h, u], [&d[..]], formula),
        );
        let gamma = rd / energy;
        if !(gamma.is_finite() && gamma * gamma * size > WORTHWHILE * WORTHWHILE * rr) {
            return;
        }
        let State { p, contact, .. } = state;
        let [] = self.segments.sum_changing(
            contact,
            p,
            #[inline(always)]
            |block, p| {
                block.change(p, [], [&d[..], d], Moved { alpha: gamma, gamma: 0.0 });
                []
            },
        );
        let mx = state.grid.mx;
        self.threads.for_each_plain_row(&mut state.u, mx, |y, u| {
            u.iter_mut().zip(&w[y * mx..]).for_each(|(u, w)| *u += gamma * w.to_double());
        });
    }
}

/// One debt for each element.
fn merge(debts: &mut Vec<(usize, f64)>) {
    debts.sort_unstable_by_key(|debt| debt.0);
    debts.dedup_by(|next, debt| {
        let same = next.0 == debt.0;
        if same {
            debt.1 += next.1;
        }
        same
    });
}
