//! Projected, preconditioned conjugate gradients on one grid: pressures and contact area together.
//!
//! ```text
//! r = -e on C, 0 outside          (prescribed force: the approach is the mean of h + u over C)
//! z = M r on C                    M: the inverse of a circulant near A
//! t = z + beta t on C,            beta = max(0, -(z, q)/(t, q)): the new direction is conjugate to the last
//! t = max(t, -p/alpha')           alpha': a forecast of alpha
//! q = A t,                        alpha = (r, t)/(t, q)
//! p = p + alpha t, u = u + alpha q
//! 4.1  elements with p < 0, and those held at -p/alpha', leave C with p = 0
//! 4.2  elements with e < 0 enter C
//! ```
//!
//! With a prescribed force z and t have mean zero over C, and p is scaled to carry the force after a truncation.
//!
//! *Truncation without a product.* After step 4.1 u lacks `A d`, d being what the truncated elements gained. A product of its own
//! would repair that, and costs as much as half an iteration. Two things avoid it. All eigenvalues of M A on C are at least 1 and few
//! exceed 4, so alpha is known beforehand to within some ten percent: elements that the forecast step would truncate are held back
//! before the product, and d is only what the forecast was wrong by. And where d is small against the step, it is owed: the next
//! direction is `t + d/alpha'`, so that its product contains `A d`, and what `alpha /= alpha'` leaves, `d (1 - alpha/alpha')`, is owed
//! on. Debts shrink by that factor at each iteration; what is left of them at the end the fresh product of the certificate settles.
//!
//! *The first step* after a prolongation needs no direction: where u is only near A p, [`Iteration::correct`] makes one step of
//! the length forecast, truncates, and then computes u: one product for what would take three.
//!
//! *Precision.* p and u are double. t, q and z may be single: their rounding errors are relative to the change that is made, not to
//! p, so that directions of single precision lead to a solution of double precision.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::active_set::State;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::operator::fft::{good_length, Real};
use crate::operator::{zeros, Toeplitz, Workspace};
use crate::scene::Load;
use crate::threads::Threads;

/// A truncation is owed when it is at most this part of the step, both as sums of absolute pressures. Measured: between 0.02
/// and 0.4 the number of products hardly depends on it.
const OWED: f64 = 0.1;
/// The first forecast of alpha, `2/(1 + 4)`, and the range of the later ones: the last alpha of a preconditioned iteration.
const FIRST_FORECAST: f64 = 0.4;
const FORECASTS: (f64, f64) = (0.3, 0.5);
/// A forecast that alpha is further away from than by this factor was worth nothing.
const FAR_OFF: f64 = 3.0;
/// An element was held back if the forecast step leaves it this part of its pressure at most: single precision's rounding.
const HELD_BACK: f64 = 1e-6;

/// Operator, preconditioner and directions of one grid.
pub struct Iteration<T: Real> {
    operator: Toeplitz<T>,
    preconditioner: Option<Toeplitz<T>>,
    workspace: Workspace<T>,
    preconditioner_workspace: Option<Workspace<T>>,
    t: Vec<T>,
    q: Vec<T>,
    z: Vec<T>,
    /// The elements in contact, in order: contact is often a small part of the grid.
    elements: Vec<u32>,
    /// Truncated elements and the pressures that u still lacks.
    debts: Vec<(usize, f64)>,
    /// Whether an element of a row enters.
    entering: Vec<AtomicBool>,
    threads: Threads,
    pieces: Vec<()>,
}

/// When the iteration stops.
#[derive(Clone, Copy, Debug)]
pub struct Stopping {
    /// Of the relative residual, or of the update.
    pub tolerance: f64,
    /// Whether rms(last change of p) <= tolerance * rms(p) over C is asked for, instead of the residual.
    pub by_update: bool,
    /// Whether the contact area is given.
    pub fixed: bool,
    /// Iterations at most.
    pub iterations: u64,
}

impl Stopping {
    fn met_by(&self, cycle: &Cycle) -> bool {
        if self.by_update {
            cycle.update <= self.tolerance * cycle.pressure
        } else {
            cycle.residual <= self.tolerance
        }
    }
}

/// What one iteration did.
#[derive(Clone, Copy, Debug)]
pub struct Cycle {
    /// Elements that left or entered C.
    pub changes: u64,
    /// rms over C of the change of p.
    pub update: f64,
    /// rms over C of p before it.
    pub pressure: f64,
    /// Relative residual over C after it.
    pub residual: f64,
    /// Products it took.
    pub products: u64,
}

/// How the iteration on one grid ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The criterion holds, as far as the recursively updated u tells.
    Met,
    /// The iterations allowed are used up.
    Limit,
    /// The caller cancelled.
    Cancelled,
    /// The search direction is no longer one: round-off, or an operator that is not positive definite.
    Breakdown,
}

impl<T: Real> Iteration<T> {
    /// Sets up the iteration on `grid`. The preconditioner's circulant has the period of the grid itself, a quarter of the work of a
    /// padded one at the same number of iterations. Where it is not positive, the iteration does without.
    pub fn new(influence: &Influence, grid: &Grid, threads: &Threads) -> Result<Iteration<T>> {
        let operator = Toeplitz::new(influence, grid, threads)?;
        let periods = (good_length(grid.mx + 1), good_length(grid.my + 1));
        let preconditioner = Toeplitz::inverse_circulant(influence, grid, periods, threads)?;
        if preconditioner.is_none() {
            log::info!("the circulant of the influence coefficients is not positive: no preconditioner");
        }
        let n = grid.len();
        let directions = || zeros(n, "search directions");
        Ok(Iteration {
            workspace: operator.workspace()?,
            preconditioner_workspace: preconditioner.as_ref().map(Toeplitz::workspace).transpose()?,
            operator,
            preconditioner,
            t: directions()?,
            q: directions()?,
            z: directions()?,
            elements: Vec::with_capacity(n),
            debts: Vec::with_capacity(n / 4 + 16),
            entering: (0..grid.my).map(|_| AtomicBool::new(false)).collect(),
            threads: threads.clone(),
            pieces: vec![(); threads.pieces()],
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, Toeplitz::bytes);
        let workspaces = self.workspace.bytes() + self.preconditioner_workspace.as_ref().map_or(0, Workspace::bytes);
        self.operator.bytes() + preconditioner + workspaces + self.t.len() * (3 * size_of::<T>() + 2 * size_of::<u32>())
    }

    /// `u = A p` in the iteration's precision.
    pub fn displace(&mut self, state: &mut State) {
        for (t, p) in self.t.iter_mut().zip(&state.p) {
            *t = T::of(*p);
        }
        self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
        for (u, q) in state.u.iter_mut().zip(&self.q) {
            *u = q.to_double();
        }
    }

    /// One step of the forecast length from a u that is near A p, with 4.2 before and 4.1 after it; then u = A p.
    pub fn correct(&mut self, state: &mut State) {
        if self.preconditioner.is_some() {
            state.fit_approach();
            self.update_displacements(state, &Update::default(), false);
            self.list_contact(state);
            self.residual(state);
            self.precondition();
            self.direct(0.0, matches!(state.load, Load::Force(_)));
            self.update_pressures(state, FIRST_FORECAST, None);
            self.debts.clear();
            state.balance_force();
        }
        self.displace(state);
    }

    /// Iterates from a state whose u is A p. `after_cycle` is told of every iteration and says whether to go on.
    pub fn run(&mut self, state: &mut State, stop: &Stopping, mut after_cycle: impl FnMut(&Cycle) -> bool) -> End {
        let by_force = matches!(state.load, Load::Force(_));
        self.t.fill(T::zero());
        self.q.fill(T::zero());
        self.debts.clear();
        // Without a preconditioner the first forecast is missing.
        let mut forecast = self.preconditioner.as_ref().map(|_| FIRST_FORECAST);
        let mut tq = 0.0;
        let mut cycle: Option<Cycle> = None;
        let mut iterations = 0;
        state.fit_approach();
        // 4.2
        self.update_displacements(state, &Update::default(), stop.fixed);
        self.list_contact(state);
        loop {
            // r = -e on C
            let residual = self.residual(state);
            if let Some(cycle) = &mut cycle {
                cycle.residual = residual;
                if !after_cycle(cycle) {
                    return End::Cancelled;
                }
            }
            if residual == 0.0 || cycle.as_ref().is_some_and(|cycle| stop.met_by(cycle)) {
                return End::Met;
            }
            if iterations == stop.iterations {
                return End::Limit;
            }
            iterations += 1;

            // z = M r
            self.precondition();

            // t = z + beta t, held back, and the debts
            self.direct(tq, by_force);
            if let (Some(forecast), false) = (forecast, stop.fixed) {
                self.hold_back(state, forecast);
            }
            let before = forecast.unwrap_or(1.0);
            for &(i, d) in &self.debts {
                self.t[i] += T::of(d / before);
            }

            // q = A t, alpha = (r, t)/(t, q)
            self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
            let step = self.step(state);
            if !(step.tq > 0.0 && step.rt.is_finite()) {
                return End::Breakdown;
            }
            tq = step.tq;
            let alpha = step.rt / step.tq;
            for debt in &mut self.debts {
                // What it is owed is no part of its direction.
                let owed = T::of(debt.1 / before);
                self.t[debt.0] = if state.contact[debt.0] { self.t[debt.0] - owed } else { T::zero() };
                debt.1 *= 1.0 - alpha / before;
            }
            self.debts.retain(|debt| debt.1 != 0.0);

            // p = p + alpha t, 4.1
            let mut update = Update { alpha, ..Update::default() };
            let left = if stop.fixed {
                self.update_fixed_pressures(state, alpha)
            } else {
                // A forecast that was far off holds nobody back.
                self.update_pressures(
                    state,
                    alpha,
                    forecast.filter(|forecast| within_factor(alpha, *forecast, FAR_OFF)),
                )
            };
            forecast = Some(alpha).filter(|alpha| *alpha > 0.0);
            if let (Some(alpha), Some(_)) = (&mut forecast, &self.preconditioner) {
                let usual = alpha.clamp(FORECASTS.0, FORECASTS.1);
                if within_factor(*alpha, usual, FAR_OFF) {
                    *alpha = usual;
                }
            }
            let owed: f64 = self.debts.iter().map(|debt| debt.1.abs()).sum();
            let mut products = 1;
            if owed > OWED * alpha.abs() * step.t1 || forecast.is_none() && owed > 0.0 {
                self.settle();
                update.settled = true;
                products += 1;
            }

            // u = u + alpha q, 4.2
            if by_force {
                update.factor = self.carry_force(state);
                self.fit_approach(state, &update);
            }
            let entered = self.update_displacements(state, &update, stop.fixed);
            if entered > 0 {
                self.list_contact(state);
            }
            let mean_square = |sum: f64| (sum / step.count).sqrt();
            cycle = Some(Cycle {
                changes: left + entered,
                update: alpha.abs() * mean_square(step.tt),
                pressure: mean_square(step.pp),
                residual,
                products,
            });
        }
    }

    fn list_contact(&mut self, state: &State) {
        self.elements.clear();
        self.elements.extend((0u32..).zip(&state.contact).filter(|(_, &inside)| inside).map(|(i, _)| i));
    }

    /// With a prescribed force: the approach is the mean over C of h + u, u as `update` will leave it.
    fn fit_approach(&self, state: &mut State, update: &Update) {
        if self.elements.is_empty() {
            return;
        }
        let mut sum = 0.0;
        for &i in &self.elements {
            let i = i as usize;
            let change =
                update.alpha * self.q[i].to_double() + if update.settled { self.z[i].to_double() } else { 0.0 };
            sum += state.h[i] + update.factor * (state.u[i] + change);
        }
        state.approach = sum / self.elements.len() as f64;
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    fn residual(&mut self, state: &State) -> f64 {
        self.z.fill(T::zero());
        let (mut rr, mut hh) = (0.0, 0.0);
        for &i in &self.elements {
            let i = i as usize;
            let distance = state.h[i] - state.approach;
            let e = distance + state.u[i];
            self.z[i] = T::of(-e);
            rr += e * e;
            hh += distance * distance;
        }
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// z = M r, r being what z holds.
    fn precondition(&mut self) {
        if let (Some(m), Some(workspace)) = (&self.preconditioner, &mut self.preconditioner_workspace) {
            m.apply_in_place(&mut self.z, workspace);
        }
    }

    /// t = z + beta t on C, 0 outside; with a prescribed force of mean zero over C. `tq` is (t, q) of the last direction, 0 if there
    /// is none.
    fn direct(&mut self, tq: f64, by_force: bool) {
        let count = self.elements.len() as f64;
        let (mut mean, mut beta) = (0.0, 0.0);
        if by_force {
            mean = self.elements.iter().map(|&i| self.z[i as usize].to_double()).sum::<f64>() / count;
        }
        if tq > 0.0 {
            let zq = |i: usize| (self.z[i].to_double() - mean) * self.q[i].to_double();
            beta = (-self.elements.iter().map(|&i| zq(i as usize)).sum::<f64>() / tq).max(0.0);
        }
        let (z_mean, beta) = (T::of(mean), T::of(beta));
        let mut sum = 0.0;
        for &i in &self.elements {
            let i = i as usize;
            self.t[i] = self.z[i] - z_mean + beta * self.t[i];
            sum += self.t[i].to_double();
        }
        if by_force {
            let mean = T::of(sum / count);
            for &i in &self.elements {
                self.t[i as usize] = self.t[i as usize] - mean;
            }
        }
    }

    /// t = max(t, -p/forecast).
    fn hold_back(&mut self, state: &State, forecast: f64) {
        for &i in &self.elements {
            let i = i as usize;
            if state.p[i] + forecast * self.t[i].to_double() < 0.0 {
                self.t[i] = T::of(-state.p[i] / forecast);
            }
        }
    }

    /// The sums over C that the step length needs.
    fn step(&self, state: &State) -> Step {
        let mut step = Step { rt: 0.0, tq: 0.0, tt: 0.0, t1: 0.0, pp: 0.0, count: self.elements.len() as f64 };
        for &i in &self.elements {
            let i = i as usize;
            let t = self.t[i].to_double();
            step.rt -= state.deformed_distance(i) * t;
            step.tq += t * self.q[i].to_double();
            step.tt += t * t;
            step.t1 += t.abs();
            step.pp += state.p[i] * state.p[i];
        }
        step
    }

    /// p = p + alpha t on C, and 4.1: elements with p < 0, and those held back by the forecast, leave; what they gain is owed.
    /// Returns how many.
    fn update_pressures(&mut self, state: &mut State, alpha: f64, forecast: Option<f64>) -> u64 {
        let mut left = 0;
        for &i in &self.elements {
            let i = i as usize;
            let (p, t) = (state.p[i], self.t[i].to_double());
            let after = p + alpha * t;
            if after < 0.0 || forecast.is_some_and(|forecast| p + forecast * t <= HELD_BACK * p) {
                if after != 0.0 {
                    self.debts.push((i, -after));
                }
                state.p[i] = 0.0;
                self.t[i] = T::zero();
                state.contact[i] = false;
                left += 1;
            } else {
                state.p[i] = after;
            }
        }
        if left > 0 {
            self.elements.retain(|&i| state.contact[i as usize]);
        }
        left
    }

    /// p = p + alpha t on C.
    fn update_fixed_pressures(&self, state: &mut State, alpha: f64) -> u64 {
        for &i in &self.elements {
            state.p[i as usize] += alpha * self.t[i as usize].to_double();
        }
        0
    }

    /// z = A d: a product pays all debts.
    fn settle(&mut self) {
        self.z.fill(T::zero());
        for (i, d) in self.debts.drain(..) {
            self.z[i] += T::of(d);
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
    }

    /// Scales p, and the debts with it, to carry the prescribed force; returns the factor, with which u is to be scaled.
    fn carry_force(&mut self, state: &mut State) -> f64 {
        let Load::Force(force) = state.load else { return 1.0 };
        let carried: f64 = self.elements.iter().map(|&i| state.p[i as usize]).sum();
        let factor = force / (carried * state.grid.element_area());
        if !factor.is_finite() {
            return 1.0;
        }
        for &i in &self.elements {
            state.p[i as usize] *= factor;
        }
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        factor
    }

    /// u = factor (u + alpha q + A d), and 4.2: exterior elements with e < 0 enter. Returns how many. One pass over the grid,
    /// because its arrays are longer than the caches.
    fn update_displacements(&mut self, state: &mut State, update: &Update, fixed: bool) -> u64 {
        let State { h, u, contact, approach, grid, .. } = state;
        let (mx, approach) = (grid.mx, *approach);
        let (q, z, entering) = (&self.q, &self.z, &self.entering);
        let Update { alpha, settled, factor } = *update;
        self.threads.for_each_row(u, mx, &mut self.pieces, |iy, u, ()| {
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
            // Most rows have no element that enters, and this the compiler can vectorise.
            let mut any = false;
            for ((h, u), inside) in h[row.clone()].iter().zip(u).zip(&contact[row]) {
                any |= (h - approach + *u < 0.0) & !inside;
            }
            entering[iy].store(any, Ordering::Relaxed);
        });
        let mut entered = 0;
        for (iy, _) in self.entering.iter().enumerate().filter(|(_, any)| !fixed && any.load(Ordering::Relaxed)) {
            for i in iy * mx..(iy + 1) * mx {
                if !contact[i] && h[i] - approach + u[i] < 0.0 {
                    contact[i] = true;
                    entered += 1;
                }
            }
        }
        entered
    }
}

fn within_factor(value: f64, other: f64, factor: f64) -> bool {
    value * factor > other && value < factor * other
}

/// What becomes of u: factor (u + alpha q + A d).
struct Update {
    alpha: f64,
    /// Whether z holds A d.
    settled: bool,
    factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, settled: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p), and the number of elements.
struct Step {
    rt: f64,
    tq: f64,
    tt: f64,
    t1: f64,
    pp: f64,
    count: f64,
}
