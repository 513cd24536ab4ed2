//! Steps along the deflation direction d (module `deflation`), in addition to those along t:
//!
//! ```text
//! t has mean zero over C, as under a prescribed force
//! gamma = (r - alpha q, d)/(d, w),  w = A d,  p = p + alpha t + gamma d,  u = u + alpha q + gamma w
//! ```
//!
//! Before the first step, elements outside C are removed from d, and by one product from w.

use super::deflation::{Deflation, Last};
use super::deflation_passes::{Change, Restrict, Subtract};
use super::formulas::{Moved, Residual, StepTerms};
use super::scaling::Scaling;
use super::step_sums::StepSums;
use super::vectors::Iteration;
use crate::contact::State;
use crate::error::Result;
use crate::operator::fft::Real;
use crate::rectangle::Rectangle;
use crate::sums::Sums;

/// A change of p carries force if its sum exceeds this part of the sum of its absolute values. Rolling, by contrast, moves pressures along without a
/// change of the force.
const CARRYING_RATIO: f64 = 0.5;
/// The first step along d is made if it changes e by more than this part of the residual.
const LEAST_FIRST_STEP: f64 = 0.1;
/// A change below this part of the pressures, both as sums of absolute values, is round-off.
const LEAST_CHANGE: f64 = 1e-6;

impl<T: Real> Iteration<T> {
    /// Sets the deflation direction to the change of p since the last solution. `state` is the part in the window of a grid with `mx` columns. There
    /// is no direction if there is no last solution, or if the change carries no force. Returns the number of products that this takes.
    pub fn deflate_by_change(
        &mut self,
        state: &State,
        last: Option<Last<'_>>,
        (window, mx): (&Rectangle, usize),
        units: &Scaling,
    ) -> Result<u64> {
        self.deflation.forget();
        let Some(last) = last else { return Ok(0) };
        self.deflation.reserve(state.p.len())?;
        self.deflation.is_uniform = false;
        let Some(last_u) = last.u else {
            self.displace_change(state, last.p, (window, mx), units);
            return Ok(1);
        };
        let Deflation { d, w, .. } = &mut self.deflation;
        let mut sums = Sums::new();
        let width = window.x.len();
        let rows = d.chunks_exact_mut(width).zip(w.chunks_exact_mut(width)).zip(window.y.clone()).enumerate();
        for (row, ((d, w), y)) in rows {
            let (here, whole) = (row * width..(row + 1) * width, y * mx + window.x.start..y * mx + window.x.end);
            pulp::Arch::new().dispatch(Change {
                p: (&state.p[here.clone()], &last.p[whole.clone()], units.pressure()),
                u: (&state.u[here], &last_u[whole], units.length),
                d,
                w,
                sums: &mut sums,
            });
        }
        let [sum, absolute, all, measures @ ..] = sums.values();
        if f64::abs(sum) > CARRYING_RATIO * absolute && absolute > LEAST_CHANGE * all {
            self.deflation.take_measures(measures);
        }
        Ok(0)
    }

    /// Sets d to the change of p from `last` on C, and w = A d by a product.
    fn displace_change(&mut self, state: &State, last: &[f64], (window, mx): (&Rectangle, usize), units: &Scaling) {
        let width = window.x.len();
        for (i, d) in self.deflation.d.iter_mut().enumerate() {
            let whole = (window.y.start + i / width) * mx + window.x.start + i % width;
            let change = state.p[i] - units.pressure() * last[whole];
            *d = T::of(if state.contact[i] { change } else { 0.0 });
        }
        self.operator.apply(&self.deflation.d, &mut self.deflation.w, &mut self.workspace);
        self.deflation.measure();
    }

    /// Removes elements outside C from d, and their displacements from w. Overwrites z. Returns the number of products that this takes.
    pub(super) fn restrict_deflation(&mut self, state: &State) -> u64 {
        let is_there = self.deflation.is_there();
        let (Deflation { d, .. }, z) = (&mut self.deflation, &mut self.z);
        if !is_there || !pulp::Arch::new().dispatch(Restrict { d, z, contact: &state.contact }) {
            return 0;
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
        let (Deflation { d, w, .. }, z) = (&mut self.deflation, &self.z);
        let measures = pulp::Arch::new().dispatch(Subtract { d, w, z });
        self.deflation.take_measures(measures);
        1
    }

    /// Computes the sums over C for alpha and for gamma.
    pub(super) fn step_sums_beside_deflation(&mut self, state: &State) -> StepSums {
        let (State { h, u, p, .. }, formula) = (state, StepTerms { approach: state.approach });
        let arrays = [&self.t[..], &self.q, &self.deflation.d];
        let [rt, tq, tt, t1, pp, rd, qd] = self.segments.sum_of(&state.contact, [h, u, p], arrays, formula);
        StepSums { rt, tq, tt, t1, pp, rd, qd, energy: None }
    }

    /// The length gamma of the step along d that accompanies a step of length alpha along t; 0 without a deflation direction.
    pub(super) fn gamma(&self, step: &StepSums, alpha: f64) -> f64 {
        let gamma = (step.rd - alpha * step.qd) / self.deflation.energy;
        if self.deflation.is_there() && gamma.is_finite() {
            gamma
        } else {
            0.0
        }
    }

    /// After a step of length gamma: elements that have just left C leave d, but w still contains their displacements. Therefore a correction is
    /// deferred for each element that left d before this step.
    pub(super) fn leave_deflation(&mut self, gamma: f64) {
        if !self.deflation.is_there() {
            return;
        }
        let Deflation { d, outside, .. } = &mut self.deflation;
        if gamma != 0.0 && !outside.is_empty() {
            self.truncation.extend(outside.iter().map(|&(i, d)| (i, -gamma * d)));
        }
        for &(i, _) in self.truncation.gains() {
            if d[i] != T::zero() {
                outside.push((i, d[i].to_double()));
                d[i] = T::zero();
            }
        }
    }

    /// Before the first step: moves p and u along d to the least energy, if the change is worth a loop over u.
    pub(super) fn step_along_deflation(&mut self, state: &mut State) {
        if !self.deflation.is_there() {
            return;
        }
        let Deflation { d, w, energy, size, .. } = &self.deflation;
        let (State { h, u, .. }, formula) = (&*state, Residual { approach: state.approach });
        let [rd, rr] = self.segments.sum_of(&state.contact, [h, u], [&d[..]], formula);
        let gamma = rd / energy;
        if !(gamma.is_finite() && gamma * gamma * size > LEAST_FIRST_STEP * LEAST_FIRST_STEP * rr) {
            return;
        }
        let State { p, contact, .. } = state;
        self.segments.change(contact, p, ([], [&d[..], d]), Moved { alpha: gamma, gamma: 0.0 });
        let mx = state.grid.mx;
        self.threads.for_each_plain_row(&mut state.u, mx, |y, u| {
            u.iter_mut().zip(&w[y * mx..]).for_each(|(u, w)| *u += gamma * w.to_double());
        });
    }
}
