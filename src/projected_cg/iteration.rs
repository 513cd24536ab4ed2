//! Projected, preconditioned conjugate gradients on one grid: pressures and contact area together.
//!
//! ```text
//! r = -e on C, 0 outside          (prescribed force: the approach is the mean of h + u over C)
//! z = M r on C                    M: the inverse of a circulant near A
//! t = z + beta t on C,            beta = max(0, -(z, q)/(t, q)): the new direction is conjugate to the last
//! q = A t,                        alpha = (r, t)/(t, q)
//! p = p + alpha t, u = u + alpha q
//! 4.1  elements with p < 0 leave C with p = 0
//! 4.2  elements with e < 0 enter C
//! ```
//!
//! With a prescribed force z and t have mean zero over C, and p is scaled to carry the force after a truncation.
//!
//! *Truncation without a product.* After step 4.1 u lacks `A d`, d being what the truncated elements gained. A product of its own
//! would repair that, and costs as much as half an iteration. Where d is small against the step, it is owed instead: the next
//! direction is `t + d/alpha'` with the last alpha' as a forecast, so that its product contains `A d`, and what
//! `alpha /= alpha'` leaves, `d (1 - alpha/alpha')`, is owed on. Debts shrink by that factor at each iteration; what is left of
//! them at the end the fresh product of the certificate settles.
//!
//! *Precision.* p and u are double. t, q and z may be single: their rounding errors are relative to the change that is made, not to
//! p, so that directions of single precision lead to a solution of double precision.

use crate::active_set::State;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::operator::fft::{good_length, Real};
use crate::operator::{zeros, Toeplitz, Workspace};
use crate::scene::Load;
use crate::threads::Threads;

/// A truncation is owed when it is at most this part of the step, both as sums of absolute pressures. Measured: with 0.02 no
/// iteration is lost on smooth and rough surfaces, with 0.05 some are.
const OWED: f64 = 0.02;

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
            debts: Vec::with_capacity(n.min(1 << 16)),
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, Toeplitz::bytes);
        let workspaces = self.workspace.bytes() + self.preconditioner_workspace.as_ref().map_or(0, Workspace::bytes);
        self.operator.bytes() + preconditioner + workspaces + self.t.len() * (3 * size_of::<T>() + size_of::<u32>())
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

    /// Iterates from a state whose u is A p. `after_cycle` is told of every iteration and says whether to go on.
    pub fn run(&mut self, state: &mut State, stop: &Stopping, mut after_cycle: impl FnMut(&Cycle) -> bool) -> End {
        let by_force = matches!(state.load, Load::Force(_));
        self.t.fill(T::zero());
        self.q.fill(T::zero());
        self.debts.clear();
        let (mut tq, mut forecast) = (0.0, 1.0);
        let mut cycle: Option<Cycle> = None;
        let mut iterations = 0;
        state.fit_approach();
        loop {
            // 4.2, and r = -e on C
            let entered = if stop.fixed { 0 } else { admit(state) };
            if entered > 0 || iterations == 0 {
                self.list_contact(state);
            }
            let residual = self.residual(state);
            if let Some(cycle) = &mut cycle {
                cycle.changes += entered as u64;
                cycle.residual = residual;
                if !after_cycle(cycle) {
                    return End::Cancelled;
                }
            }
            if residual == 0.0 || cycle.as_ref().is_some_and(|cycle| cycle.changes == 0 && stop.met_by(cycle)) {
                return End::Met;
            }
            if iterations == stop.iterations {
                return End::Limit;
            }
            iterations += 1;

            // z = M r
            if let (Some(m), Some(workspace)) = (&self.preconditioner, &mut self.preconditioner_workspace) {
                m.apply_in_place(&mut self.z, workspace);
            }

            // t = z + beta t, and the debts
            self.direct(tq, by_force);
            for &(i, d) in &self.debts {
                self.t[i] += T::of(d / forecast);
            }

            // q = A t, alpha = (r, t)/(t, q)
            self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
            let step = self.step(state);
            if !(step.tq > 0.0 && step.rt.is_finite()) {
                return End::Breakdown;
            }
            tq = step.tq;
            let alpha = step.rt / step.tq;

            // p = p + alpha t, u = u + alpha q, 4.1
            for debt in &mut self.debts {
                // What it is owed is no part of its direction.
                let owed = T::of(debt.1 / forecast);
                self.t[debt.0] = if state.contact[debt.0] { self.t[debt.0] - owed } else { T::zero() };
                debt.1 *= 1.0 - alpha / forecast;
            }
            forecast = alpha;
            let left = self.update(state, alpha, stop.fixed);
            let owed: f64 = self.debts.iter().map(|debt| debt.1.abs()).sum();
            let mut products = 1;
            if owed > OWED * alpha.abs() * step.t1 {
                self.settle(state);
                products += 1;
            }
            if left > 0 {
                self.list_contact(state);
                if by_force {
                    self.carry_force(state);
                }
            }
            self.fit_approach(state);
            let mean_square = |sum: f64| (sum / step.count).sqrt();
            cycle = Some(Cycle {
                changes: left,
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

    /// With a prescribed force: the approach is the mean of h + u over C.
    fn fit_approach(&self, state: &mut State) {
        if let (Load::Force(_), false) = (state.load, self.elements.is_empty()) {
            let sum: f64 = self.elements.iter().map(|&i| state.h[i as usize] + state.u[i as usize]).sum();
            state.approach = sum / self.elements.len() as f64;
        }
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

    /// t = z + beta t on C, 0 outside; with a prescribed force of mean zero over C. `tq` is (t, q) of the last direction.
    fn direct(&mut self, tq: f64, by_force: bool) {
        let (mut zq, mut z1, mut q1) = (0.0, 0.0, 0.0);
        for &i in &self.elements {
            let (z, q) = (self.z[i as usize].to_double(), self.q[i as usize].to_double());
            zq += z * q;
            z1 += z;
            q1 += q;
        }
        let count = self.elements.len() as f64;
        let mean = if by_force { z1 / count } else { 0.0 };
        let beta = if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 };
        let (beta, mean) = (T::of(beta), T::of(mean));
        let mut t1 = 0.0;
        for &i in &self.elements {
            let i = i as usize;
            self.t[i] = self.z[i] - mean + beta * self.t[i];
            t1 += self.t[i].to_double();
        }
        if by_force {
            let mean = T::of(t1 / count);
            for &i in &self.elements {
                self.t[i as usize] = self.t[i as usize] - mean;
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

    /// p = p + alpha t, u = u + alpha q, and 4.1. Returns how many elements leave; what they gain is owed.
    fn update(&mut self, state: &mut State, alpha: f64, fixed: bool) -> u64 {
        for (u, q) in state.u.iter_mut().zip(&self.q) {
            *u += alpha * q.to_double();
        }
        self.debts.retain(|debt| debt.1 != 0.0);
        let mut left = 0;
        for &i in &self.elements {
            let i = i as usize;
            let p = &mut state.p[i];
            *p += alpha * self.t[i].to_double();
            if *p < 0.0 && !fixed {
                self.debts.push((i, -*p));
                *p = 0.0;
                self.t[i] = T::zero();
                state.contact[i] = false;
                left += 1;
            }
        }
        left
    }

    /// u = u + A d: all debts are paid by a product of their own.
    fn settle(&mut self, state: &mut State) {
        self.z.fill(T::zero());
        for (i, d) in self.debts.drain(..) {
            self.z[i] += T::of(d);
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
        for (u, z) in state.u.iter_mut().zip(&self.z) {
            *u += z.to_double();
        }
    }

    /// Scales p, and u and the debts with it, to carry the prescribed force.
    fn carry_force(&mut self, state: &mut State) {
        let Load::Force(force) = state.load else { return };
        let carried: f64 = self.elements.iter().map(|&i| state.p[i as usize]).sum();
        let factor = force / (carried * state.grid.element_area());
        if !factor.is_finite() {
            return;
        }
        for &i in &self.elements {
            state.p[i as usize] *= factor;
        }
        state.u.iter_mut().for_each(|u| *u *= factor);
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
    }
}

/// 4.2: exterior elements with e < 0 enter. Returns how many.
fn admit(state: &mut State) -> usize {
    let (mx, approach) = (state.grid.mx, state.approach);
    let rows = state.h.chunks_exact(mx).zip(state.u.chunks_exact(mx)).zip(state.contact.chunks_exact_mut(mx));
    let mut entered = 0;
    for ((h, u), contact) in rows {
        // Most rows have no element with e < 0, and this the compiler can vectorise.
        let mut any = false;
        for (h, u) in h.iter().zip(u) {
            any |= h - approach + u < 0.0;
        }
        if !any {
            continue;
        }
        for ((h, u), inside) in h.iter().zip(u).zip(contact) {
            if !*inside && h - approach + u < 0.0 {
                *inside = true;
                entered += 1;
            }
        }
    }
    entered
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
