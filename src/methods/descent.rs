//! Projected descent: what takes over where a faster method goes round in circles. Every cycle lowers the energy
//! `(p, A p)/2 + (p, h - approach)`, so no state comes back.
//!
//! ```text
//! free elements: p > 0, or e < 0
//! r = -e on them               (prescribed force: W r of mean zero; the approach is the mean of h + u where p > 0)
//! t = W r + beta t             conjugate to the last direction while the free elements stay the same
//! alpha = (r, t)/(t, A t)
//! p = p + alpha t              if that is nowhere negative; otherwise whichever of these has less energy:
//!     max(p + alpha t, 0)      scaled to carry a prescribed force
//!     p + alpha' t             alpha' < alpha: as far as p stays >= 0
//! ```
//!
//! W is the inverse of A's diagonal, times its least entry: 1 where all elements are alike, less where a layer is softer.
//!
//! With limits, p = p_max ends a step as p = 0 does, and an element there is free if e > 0.
//!
//! The last of these always lowers the energy; the one before it moves many elements at once.

use std::ops::Range;

use crate::blocks;
use crate::contact::{AdmissibleSet, Freshness, Problem, State};
use crate::error::{Error, Result};
use crate::memory::reserve;
use crate::methods::{Change, Policy, Step, Task};
use crate::scene::Load;
use crate::threads::Threads;

/// The method, and its memory, kept from one solve to the next. A must be symmetric.
#[derive(Default)]
pub struct Descent {
    free: Vec<bool>,
    free_before: Vec<bool>,
    residual: Vec<f64>,
    /// W.
    weight: Vec<f64>,
    t: Vec<f64>,
    /// A t.
    q: Vec<f64>,
    /// The change of p by a truncated step, and its product.
    change: Vec<f64>,
    product: Vec<f64>,
    /// (r, W r) of the last direction; 0: the next is conjugate to none.
    last_rr: f64,
    began: bool,
}

impl<S: AdmissibleSet> Step<S> for Descent {
    fn name(&self) -> &'static str {
        "projected descent"
    }

    fn policy(&self) -> Policy {
        Policy { exchanged_by_loop: true, step_is_cycle: false, chatter: 0, patience: 100, progress: 1.0 }
    }

    fn begin(&mut self, state: &State) -> Result<()> {
        let Descent { free, free_before, residual, weight, t, q, change, product, .. } = self;
        for values in [residual, weight, t, q, change, product] {
            values.clear();
            reserve(values, state.p.len(), "the workspace of projected descent")?;
            values.resize(state.p.len(), 0.0);
        }
        for elements in [free, &mut *free_before] {
            reserve(elements, state.p.len(), "the workspace of projected descent")?;
        }
        free_before.clear();
        (self.last_rr, self.began) = (0.0, false);
        Ok(())
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        let Task { problem, state, monitor, .. } = task;
        let set = task.set;
        if !std::mem::replace(&mut self.began, true) {
            take_over(problem, state, set)?;
            self.weigh(problem);
        }
        if state.u_is == Freshness::Exact {
            self.last_rr = 0.0;
        }
        let rr = self.direct(state, set);
        problem.displace(&self.t, &mut self.q)?;
        let (rt, tq) = (dot(&self.residual, &self.t), dot(&self.t, &self.q));
        if rr > 0.0 && !(tq > 0.0) {
            return Err(Error::NotPositiveDefinite(format!(
                "influence coefficients: p'Ap is {tq} for some pressures p; it must be positive"
            )));
        }
        let alpha = if rr > 0.0 { rt / tq } else { 0.0 };
        let limit = longest(state, set, &self.t);
        let full = limit >= alpha;
        self.last_rr = if full { rr } else { 0.0 };
        let mut length = alpha.min(limit);
        if !full {
            let feasible = length * (0.5 * length * tq - rt);
            if self.try_truncated(problem, state, set, alpha)? < feasible {
                std::mem::swap(&mut self.t, &mut self.change);
                std::mem::swap(&mut self.q, &mut self.product);
                length = 1.0;
            }
        }
        let changes = take_step(state, set, &self.t, &self.q, length);
        state.u_is = Freshness::Near;
        monitor.count.active_set_steps += 1;
        let distance = crate::contact::norm_of_distance(state);
        let update = length * (dot(&self.t, &self.t) / state.contact_count().max(1) as f64).sqrt();
        monitor.cycle_done(&state.grid, changes, update, crate::contact::relative(rr.sqrt(), distance));
        Ok(Change { update, changes: 0, gives_up: rr == 0.0 })
    }
}

impl Descent {
    /// W.
    fn weigh(&mut self, problem: &Problem) {
        let own = |i: usize| problem.coefficients.entry(&problem.grid, i, i);
        let least = (0..self.weight.len()).map(own).fold(f64::INFINITY, f64::min);
        self.weight.iter_mut().enumerate().for_each(|(i, weight)| *weight = least / own(i));
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        6 * self.t.len() * size_of::<f64>()
    }

    /// The free elements, r and t; returns (r, W r).
    fn direct<S: AdmissibleSet>(&mut self, state: &State, set: S) -> f64 {
        find_free(state, set, &self.weight, &mut self.free, &mut self.residual);
        if self.free != self.free_before {
            self.last_rr = 0.0;
            self.free_before.clone_from(&self.free);
        }
        let weighted = self.residual.iter().zip(&self.weight);
        let rr = weighted.clone().map(|(r, w)| r * w * r).sum();
        let beta = if self.last_rr > 0.0 { rr / self.last_rr } else { 0.0 };
        self.t.iter_mut().zip(weighted).for_each(|(t, (r, w))| *t = w * r + beta * *t);
        rr
    }

    /// The step cut off at the bounds, in `change`, and what it does to the energy.
    fn try_truncated<S: AdmissibleSet>(
        &mut self,
        problem: &mut Problem,
        state: &State,
        set: S,
        alpha: f64,
    ) -> Result<f64> {
        truncated_step(state, set, (&self.t, &self.free), alpha, &mut self.change);
        problem.displace(&self.change, &mut self.product)?;
        // A change without force does not see the approach.
        let gain = |i: usize| self.change[i] * (state.deformed_distance(i) + 0.5 * self.product[i]);
        Ok((0..self.t.len()).map(gain).sum())
    }
}

/// Admissible pressures that carry a prescribed force, C where they are positive, u = A p.
fn take_over<S: AdmissibleSet>(problem: &mut Problem, state: &mut State, set: S) -> Result<()> {
    let project = |(i, p): (usize, &mut f64)| *p = if p.is_finite() { set.project(i, *p) } else { 0.0 };
    state.p.iter_mut().enumerate().for_each(project);
    state.carry_force(set, &problem.threads);
    find_contact(state, set);
    problem.refresh(state, set)
}

/// Up to where t may be followed before an element reaches a bound.
fn longest<S: AdmissibleSet>(state: &State, set: S, t: &[f64]) -> f64 {
    let mut limit = f64::INFINITY;
    for (i, (t, p)) in t.iter().zip(&state.p).enumerate() {
        if *t < 0.0 {
            limit = limit.min(-p / t);
        } else if S::LIMITED && *t > 0.0 {
            limit = limit.min((set.limit(i) - p) / t);
        }
    }
    limit
}

/// C = {0 < p < limit}; returns how many elements changed sides.
fn find_contact<S: AdmissibleSet>(state: &mut State, set: S) -> u64 {
    let mut changes = 0;
    for i in 0..state.p.len() {
        let at_limit = S::LIMITED && state.p[i] >= set.limit(i);
        if S::LIMITED {
            state.at_limit[i] = at_limit;
            state.reached_limit |= at_limit;
        }
        let inside = state.p[i] > 0.0 && !at_limit;
        changes += u64::from(state.contact[i] != inside);
        state.contact[i] = inside;
    }
    changes
}

/// The free elements and r; r = 0 on the others. An element at a bound is free where its r leads away from that.
fn find_free<S: AdmissibleSet>(state: &State, set: S, weight: &[f64], free: &mut Vec<bool>, residual: &mut [f64]) {
    let at_limit = |i: usize| S::LIMITED && state.p[i] >= set.limit(i);
    free.clear();
    free.extend((0..state.p.len()).map(|i| match (at_limit(i), state.deformed_distance(i)) {
        (true, e) => e > 0.0,
        (false, e) => state.p[i] > 0.0 || e < 0.0,
    }));
    loop {
        let (mut mean, mut count) = (0.0, 0.0);
        if let Load::Force(_) = state.load {
            for i in (0..free.len()).filter(|&i| free[i]) {
                mean -= weight[i] * state.deformed_distance(i);
                count += weight[i];
            }
            mean = if count > 0.0 { mean / count } else { 0.0 };
        }
        let mut dropped = false;
        for i in 0..free.len() {
            residual[i] = if free[i] { -state.deformed_distance(i) - mean } else { 0.0 };
            // Drop elements that would leave their bound the wrong way, then recompute the mean.
            let blocked = state.p[i] == 0.0 && residual[i] <= 0.0 || at_limit(i) && residual[i] >= 0.0;
            if free[i] && blocked {
                (free[i], residual[i], dropped) = (false, 0.0, true);
            }
        }
        if !dropped || matches!(state.load, Load::Approach(_)) {
            return;
        }
    }
}

/// The change from p to p + alpha t, projected: with a prescribed force scaled to carry it, or with limits moved on by the constant on
/// the free elements with which it does.
fn truncated_step<S: AdmissibleSet>(
    state: &State,
    set: S,
    (t, free): (&[f64], &[bool]),
    alpha: f64,
    change: &mut [f64],
) {
    let moved = |i: usize, constant: f64| match free[i] {
        true => set.project(i, state.p[i] + alpha * t[i] + constant),
        false => state.p[i],
    };
    let sum = |constant: f64| {
        let of_block = |block: Range<usize>| block.map(|i| moved(i, constant)).sum::<f64>();
        blocks::fold(&state.grid, &Threads::One, 0.0, of_block, |sum, block| sum + block)
    };
    let (mut factor, mut constant) = (1.0, 0.0);
    if let Load::Force(force) = state.load {
        let wanted = force / state.grid.element_area();
        match S::LIMITED {
            false => factor = wanted / sum(0.0),
            true => constant = constant_for(wanted, sum, state.p.iter().copied().fold(0.0, f64::max)),
        }
    }
    let factor = if factor.is_finite() { factor } else { 1.0 };
    for (i, change) in change.iter_mut().enumerate() {
        *change = factor * moved(i, constant) - state.p[i];
    }
}

/// The constant with which the sum, which grows with it, is `wanted`, by bisection; `size` is that of a pressure.
fn constant_for(wanted: f64, sum: impl Fn(f64) -> f64, size: f64) -> f64 {
    let (mut low, mut high) = (-size, size);
    for _ in 0..60 {
        let reach = high - low;
        if sum(low) > wanted {
            low -= reach;
        } else if sum(high) < wanted {
            high += reach;
        } else {
            break;
        }
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if sum(middle) < wanted { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// p = p + length t, u = u + length A t, and the contact area with them. Returns how many elements changed sides.
fn take_step<S: AdmissibleSet>(state: &mut State, set: S, t: &[f64], q: &[f64], length: f64) -> u64 {
    for i in 0..t.len() {
        // The element that ends the step is put at its bound, whatever the rounding.
        let blocked = t[i] < 0.0 && state.p[i] <= -length * t[i];
        state.p[i] = if blocked { 0.0 } else { state.p[i] + length * t[i] };
        if S::LIMITED {
            let reaches = t[i] > 0.0 && state.p[i] >= (1.0 - f64::EPSILON) * set.limit(i);
            state.p[i] = if reaches { set.limit(i) } else { state.p[i].min(set.limit(i)) };
        }
        state.u[i] += length * q[i];
    }
    let changes = find_contact(state, set);
    state.fit_approach(&Threads::One);
    changes
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
