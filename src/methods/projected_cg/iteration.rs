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
//! *After a large truncation.* What is truncated adds to the pressures; from pressures that are far too large (a coarse grid's h is a
//! mean, which sees full contact of white noise) all of C may go and come back in turn, for ever. With a prescribed force its scaling
//! stops that. With a prescribed approach p is scaled to the least energy, by `(p, approach - h)/(p, u)`, wherever a product has just
//! paid all debts: it costs none of its own. Measured on 66 scenes of white noise: 19 were not solved without it, none with it, and the
//! rough surface by approach takes 11 to 32 % less work.
//!
//! *Limits of the pressures* (`0 <= p <= p_max`) are a second bound: elements are held back and truncated at both, and what was truncated
//! at its limit enters C again where e > 0. The pressures there cannot be scaled, so that with a prescribed force C alone is, and u is
//! owed the change as it is owed truncations. As a scene with limits has no scaling that stops C from going and coming back, the step
//! itself is shortened to the least energy wherever a product has just paid all debts: both ends of it are known exactly then. Without
//! that, 34 of 84 scenes cycled. Large debts the next product pays whole, by a step of the length of the forecast.
//!
//! *The first step* after a prolongation needs no direction: where u is only near A p, [`Iteration::correct`] makes one step of
//! a fixed length, truncates, and then computes u: one product for what would take three. A prediction from earlier solutions, whose u
//! is A p, may be negative; it is truncated, and where what that owes is large the first step has the length of the forecast: then its
//! product pays all.
//!
//! *Precision.* p and u are double. t, q and z may be single: their rounding errors are relative to the change that is made, not to
//! p, so that directions of single precision lead to a solution of double precision.

use super::preconditioner::Preconditioner;
use super::segments::Segments;
use crate::contact::AdmissibleSet;
use crate::contact::State;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::Real;
use crate::operator::{reserve, zeros, Operator, Workspace};
use crate::scene::Load;
use crate::threads::Threads;

/// A truncation is owed when it is at most this part of the step, both as sums of absolute pressures. Measured: between 0.02
/// and 0.4 the number of products hardly depends on it.
const OWED: f64 = 0.1;
/// The length of a first step that is not searched for: `2/(1 + 4)`, the best for all eigenvalues between 1 and 4.
const FIRST_STEP: f64 = 0.4;
/// The forecast of the first alpha: that step leaves what is smooth, of which the eigenvalues are near 1. And the range of the later
/// forecasts, each the last alpha.
const FIRST_FORECAST: f64 = 0.9;
const FORECASTS: (f64, f64) = (0.3, 1.0);
/// A forecast that alpha is further away from than by this factor was worth nothing.
const FAR_OFF: f64 = 3.0;
/// The rounding of directions leaves short waves in p that the residual hardly shows: residuals are not reduced by more than this
/// many roundings without a fresh u.
const ROUNDINGS: f64 = 200.0;
/// Iterations without a new least residual after which the contact area may be cycling.
const PATIENCE: u32 = 40;
/// With a limit a step goes back where the least energy lies before this part of it. Measured over 84 scenes: at 0.5 one is not solved,
/// at 1 the work is 4 % more in the mean and 20 % more in the worst.
const STEP_BACK: f64 = 0.7;
/// An element was held back if the forecast step leaves it this part of its pressure at most: single precision's rounding.
const HELD_BACK: f64 = 1e-6;

/// Operator, preconditioner and directions of one grid.
pub struct Iteration<T: Real> {
    operator: Operator<T>,
    preconditioner: Option<Preconditioner<T>>,
    workspace: Workspace<T>,
    t: Vec<T>,
    q: Vec<T>,
    z: Vec<T>,
    runs: Segments,
    /// Truncated elements and the pressures that u still lacks.
    debts: Vec<(usize, f64)>,
    /// With a limit and a prescribed force: what C gained to carry the force, and u still lacks; else empty.
    lacking: Vec<f64>,
    /// With a limit: the pressures that u knows of, those of before the iteration without what was owed then.
    known: Vec<f64>,
    /// Whether an element of a row enters.
    entering: Vec<bool>,
    threads: Threads,
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
    fn met_by(&self, cycle: &Cycle, floor: f64) -> bool {
        if self.by_update {
            cycle.update <= self.tolerance * cycle.pressure
        } else {
            cycle.residual <= self.tolerance.max(floor)
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
    /// The search direction is no longer one (round-off, or an operator that is not positive definite), or nothing is gained any more.
    Breakdown,
}

impl<T: Real> Iteration<T> {
    /// Sets up the iteration on `grid`, the operator of which is given: that of the coefficients times `factor`. Where the preconditioner's circulant is not positive, the
    /// iteration does without.
    pub fn new(
        operator: Operator<T>,
        influence: &Coefficients,
        factor: f64,
        grid: &Grid,
        threads: &Threads,
    ) -> Result<Iteration<T>> {
        let preconditioner = Preconditioner::new(influence, factor, grid, threads)?;
        if preconditioner.is_none() {
            log::info!("the circulant of the influence coefficients is not positive: no preconditioner");
        }
        let n = grid.len();
        // A pass takes about a tenth of the time of a product.
        let threads = &threads.suited_to(n / 10);
        let directions = || zeros(n, "search directions");
        let mut debts = Vec::new();
        reserve(&mut debts, n, "truncated elements")?;
        Ok(Iteration {
            workspace: operator.workspace()?,
            operator,
            preconditioner,
            t: directions()?,
            q: directions()?,
            z: directions()?,
            runs: Segments::new(grid, threads)?,
            debts,
            lacking: Vec::new(),
            known: Vec::new(),
            entering: vec![false; grid.my],
            threads: threads.clone(),
        })
    }

    /// Memory that a scene with a limit of the pressures needs beyond that of one without.
    pub fn reserve_for_limits(&mut self) -> Result<()> {
        self.lacking.clear();
        reserve(&mut self.known, self.t.len(), "pressures with a limit")?;
        reserve(&mut self.lacking, self.t.len(), "pressures with a limit")
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, Preconditioner::bytes);
        self.operator.bytes() + preconditioner + self.workspace.bytes() + self.t.len() * 3 * size_of::<T>()
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

    /// One step of a fixed length from a u that is near A p, with 4.2 before and 4.1 after it. Then u is no longer near A p.
    pub fn correct<S: AdmissibleSet>(&mut self, state: &mut State, set: S) {
        if self.preconditioner.is_some() {
            state.fit_approach();
            self.update_displacements::<S>(state, &Update::default(), false);
            self.find_contact(state);
            self.residual(state);
            self.precondition(state);
            self.direct(state, set, 0.0, None);
            self.update_pressures(state, set, FIRST_STEP, None, false);
            self.debts.clear();
            state.carry_force(set);
        }
    }

    /// Iterates from a state whose u is A p; p may be negative. `after_cycle` is told of every iteration and says whether to go on.
    pub fn run<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        stop: &Stopping,
        mut after_cycle: impl FnMut(&Cycle) -> bool,
    ) -> End {
        let by_force = matches!(state.load, Load::Force(_));
        self.t.fill(T::zero());
        self.q.fill(T::zero());
        self.debts.clear();
        self.lacking.clear();
        // Without a preconditioner the first forecast is missing.
        let mut forecast = self.preconditioner.as_ref().map(|_| FIRST_FORECAST);
        // Directions that are held back may fail to descend: then the next is not, nor conjugate to this one.
        let mut may_hold_back = true;
        let mut tq = 0.0;
        let mut cycle: Option<Cycle> = None;
        let (mut iterations, mut floor) = (0, None);
        let (mut least, mut since_least) = (f64::INFINITY, 0);
        // 4.1 and 4.2
        self.find_contact(state);
        let mut update = Update::default();
        if self.update_pressures(state, set, 0.0, None, stop.fixed) > 0 {
            self.runs.find(&state.contact);
            update.factor = self.carry_force::<S>(state);
        }
        if by_force {
            self.fit_approach(state, &update);
        }
        self.update_displacements::<S>(state, &update, stop.fixed);
        self.runs.find(&state.contact);
        if self.owed() > 0.0 {
            forecast = forecast.map(|_| FIRST_STEP);
        }
        loop {
            // r = -e on C
            let residual = self.residual(state);
            if let Some(cycle) = &mut cycle {
                cycle.residual = residual;
                if !after_cycle(cycle) {
                    return End::Cancelled;
                }
            }
            let floor = *floor.get_or_insert(ROUNDINGS * T::epsilon().to_double() * residual);
            if residual == 0.0 || cycle.as_ref().is_some_and(|cycle| stop.met_by(cycle, floor)) {
                return End::Met;
            }
            if iterations == stop.iterations {
                return End::Limit;
            }
            if residual < least {
                (least, since_least) = (residual, 0);
            }
            since_least += 1;
            if since_least > PATIENCE {
                return End::Breakdown;
            }
            iterations += 1;

            // z = M r
            self.precondition(state);

            // t = z + beta t, held back, and the debts
            self.direct(state, set, tq, forecast.filter(|_| may_hold_back && !stop.fixed));
            let before = forecast.unwrap_or(1.0);
            for &(i, d) in &self.debts {
                self.t[i] += T::of(d / before);
            }
            self.add_lacking(1.0 / before);

            if S::LIMITED {
                self.remember(state);
            }

            // q = A t, alpha = (r, t)/(t, q)
            self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
            let step = self.step(state);
            let count = self.runs.count() as f64;
            if !(step.tq > 0.0 && step.rt.is_finite()) {
                return End::Breakdown;
            }
            tq = step.tq;
            let mut alpha = step.rt / step.tq;
            if (iterations == 1 || S::LIMITED) && self.owed() > OWED * alpha.abs() * step.t1 {
                (alpha, tq) = (before, 0.0);
            }
            self.add_lacking(-1.0 / before);
            self.lacking.iter_mut().for_each(|d| *d *= 1.0 - alpha / before);
            for debt in &mut self.debts {
                // What it is owed is no part of its direction.
                let owed = T::of(debt.1 / before);
                self.t[debt.0] = if state.contact[debt.0] { self.t[debt.0] - owed } else { T::zero() };
                debt.1 *= 1.0 - alpha / before;
            }
            self.debts.retain(|debt| debt.1 != 0.0);

            // p = p + alpha t, 4.1
            let mut update = Update { alpha, ..Update::default() };
            // A forecast that was far off holds nobody back.
            let good_forecast = forecast.filter(|forecast| may_hold_back && within_factor(alpha, *forecast, FAR_OFF));
            may_hold_back = !may_hold_back || good_forecast.is_some();
            if !may_hold_back {
                tq = 0.0;
            }
            let left = self.update_pressures(state, set, alpha, good_forecast, stop.fixed);
            forecast = Some(alpha).filter(|alpha| *alpha > 0.0);
            if let (Some(alpha), Some(_)) = (&mut forecast, &self.preconditioner) {
                let usual = alpha.clamp(FORECASTS.0, FORECASTS.1);
                if within_factor(*alpha, usual, FAR_OFF) {
                    *alpha = usual;
                }
            }
            if S::LIMITED && by_force && state.at_limit.contains(&true) {
                self.scale_free(state);
            }
            let owed = self.owed();
            let mut products = 1;
            if owed > OWED * alpha.abs() * step.t1 || forecast.is_none() && owed > 0.0 {
                self.settle();
                update.settled = true;
                products += 1;
                if S::LIMITED && !stop.fixed {
                    self.step_back(state, set, &mut update);
                    tq = 0.0;
                }
            }

            // u = u + alpha q, 4.2
            if by_force {
                if left > 0 {
                    self.runs.find(&state.contact);
                }
                update.factor = self.carry_force::<S>(state);
                self.fit_approach(state, &update);
            } else if update.settled && !stop.fixed && !S::LIMITED {
                if left > 0 {
                    self.runs.find(&state.contact);
                }
                update.factor = self.least_energy(state, &update);
            }
            let entered = self.update_displacements::<S>(state, &update, stop.fixed);
            self.runs.find(&state.contact);
            let mean_square = |sum: f64| (sum / count).sqrt();
            cycle = Some(Cycle {
                changes: left + entered,
                update: alpha.abs() * mean_square(step.tt),
                pressure: mean_square(step.pp),
                residual,
                products,
            });
        }
    }

    /// The runs of a contact area of which nothing is known.
    fn find_contact(&mut self, state: &State) {
        self.runs.change_all();
        self.runs.find(&state.contact);
    }

    /// With a prescribed force: the approach is the mean over C of h + u, u as `update` will leave it.
    fn fit_approach(&mut self, state: &mut State, update: &Update) {
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
            state.approach = sum / self.runs.count() as f64;
        }
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    fn residual(&mut self, state: &State) -> f64 {
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
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// z = M r, r being what z holds.
    fn precondition(&mut self, state: &State) {
        if let Some(m) = &mut self.preconditioner {
            let by_force = matches!(state.load, Load::Force(_));
            m.apply(&mut self.z, by_force.then_some(&state.contact[..]));
        }
    }

    /// t = z + beta t on C, 0 outside; with a prescribed force of mean zero over C; held back by the forecast, if there is one.
    /// `tq` is (t, q) of the last direction, 0 if there is none.
    fn direct<S: AdmissibleSet>(&mut self, state: &State, set: S, tq: f64, forecast: Option<f64>) {
        let by_force = matches!(state.load, Load::Force(_));
        let count = self.runs.count() as f64;
        let (mut mean, mut beta) = (0.0, 0.0);
        if by_force || tq > 0.0 {
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
            mean = if by_force { z1 / count } else { 0.0 };
            beta = if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 };
        }
        let (z, z_mean, beta) = (&self.z, T::of(mean), T::of(beta));
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
                    let direction = z[i] - z_mean + beta * t[i];
                    t[i] = if by_force { direction } else { held(start + i, p[i], direction) };
                    [direction.to_double()]
                });
            }
        });
        if by_force {
            let mean = T::of(sum / count);
            let [] = self.runs.sum_changing(&mut self.t, |block, t, _| {
                for (run, local) in block.runs() {
                    for ((t, p), i) in t[local].iter_mut().zip(&state.p[run.clone()]).zip(run) {
                        *t = held(i, *p, *t - mean);
                    }
                }
            });
        }
    }

    /// The sums over C that the step length needs.
    fn step(&mut self, state: &State) -> Step {
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

    /// p = p + alpha t on C, and 4.1 unless C is fixed: elements beyond a bound, and those held back by the forecast, leave for it;
    /// what they gain is owed. Returns how many.
    fn update_pressures<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        alpha: f64,
        forecast: Option<f64>,
        fixed: bool,
    ) -> u64 {
        let t = &self.t;
        let leaves = |i: usize, p: f64, t: T| {
            let held = forecast.is_some_and(|forecast| {
                let to = p + forecast * t.to_double();
                to <= HELD_BACK * p || S::LIMITED && to >= set.limit(i) * (1.0 - HELD_BACK)
            });
            !fixed & (set.leaves(i, p + alpha * t.to_double()) | held)
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
        let mut left = 0;
        let n = state.p.len();
        for i in self.runs.blocks_with_sum().flatten().filter(|&i| i < n) {
            if !state.contact[i] {
                continue;
            }
            let (p, t) = (state.p[i], self.t[i]);
            let to = p + alpha * t.to_double();
            state.p[i] = to;
            if leaves(i, p, t) {
                let mut bound = 0.0;
                if S::LIMITED && (to > set.limit(i) || to >= 0.0 && t > T::zero()) {
                    bound = set.limit(i);
                    state.at_limit[i] = true;
                }
                self.debts.push((i, bound - to));
                state.p[i] = bound;
                self.t[i] = T::zero();
                state.contact[i] = false;
                left += 1;
            }
        }
        for debt in &self.debts[before..] {
            self.runs.change(debt.0);
        }
        left
    }

    /// The sum of |d|.
    fn owed(&self) -> f64 {
        let truncated: f64 = self.debts.iter().map(|debt| debt.1.abs()).sum();
        if self.lacking.is_empty() {
            return truncated;
        }
        truncated + self.lacking.iter().map(|d| d.abs()).sum::<f64>()
    }

    /// t = t + factor d, d being what u lacks of the force.
    fn add_lacking(&mut self, factor: f64) {
        for (t, d) in self.t.iter_mut().zip(&self.lacking) {
            *t += T::of(factor * d);
        }
    }

    /// z = A d: a product pays all debts.
    fn settle(&mut self) {
        self.z.fill(T::zero());
        for (i, d) in self.debts.drain(..) {
            self.z[i] += T::of(d);
        }
        for (z, d) in self.z.iter_mut().zip(&mut self.lacking) {
            *z += T::of(std::mem::take(d));
        }
        self.operator.apply_in_place(&mut self.z, &mut self.workspace);
    }

    /// Scales p, and the debts with it, to carry the prescribed force; returns the factor, with which u is to be scaled.
    fn carry_force<S: AdmissibleSet>(&mut self, state: &mut State) -> f64 {
        let Load::Force(force) = state.load else { return 1.0 };
        if S::LIMITED && state.at_limit.contains(&true) {
            return self.carry_force_beside_limits(state, force / state.grid.element_area());
        }
        let p = &state.p;
        let [carried] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let p = &p[run];
                sums.add(p.len(), |i| [p[i]]);
            }
        });
        let factor = force / (carried * state.grid.element_area());
        if !factor.is_finite() {
            return 1.0;
        }
        self.scale(state, factor);
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        factor
    }

    /// The same where elements are at their limit: only C is scaled, and u lacks what it gains. Where C is left nothing to carry, or
    /// carries nothing, all pressures are scaled, and what was at its limit enters C.
    fn carry_force_beside_limits(&mut self, state: &mut State, pressures: f64) -> f64 {
        if self.scale_free(state) {
            return 1.0;
        }
        let factor = pressures / state.p.iter().sum::<f64>();
        state.p.iter_mut().chain(&mut self.lacking).for_each(|p| *p *= factor);
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        for (inside, at_limit) in state.contact.iter_mut().zip(&mut state.at_limit) {
            *inside |= std::mem::take(at_limit);
        }
        self.find_contact(state);
        factor
    }

    /// Scales p of C alone to carry a prescribed force, and owes u the change; false where C cannot.
    fn scale_free(&mut self, state: &mut State) -> bool {
        let Load::Force(force) = state.load else { return true };
        let (mut free, mut all) = (0.0, 0.0);
        for (p, &inside) in state.p.iter().zip(&state.contact) {
            all += p;
            free += if inside { *p } else { 0.0 };
        }
        let factor = 1.0 + (force / state.grid.element_area() - all) / free;
        if !(factor.is_finite() && factor > 0.0) {
            return false;
        }
        // In the memory of `reserve_for_limits`.
        self.lacking.resize(state.p.len(), 0.0);
        for ((p, d), _) in state.p.iter_mut().zip(&mut self.lacking).zip(&state.contact).filter(|(_, &inside)| inside) {
            *d += (factor - 1.0) * *p;
            *p *= factor;
        }
        true
    }

    /// With a limit: keeps the pressures that u knows of.
    fn remember(&mut self, state: &State) {
        self.known.clear();
        self.known.extend_from_slice(&state.p);
        self.known.iter_mut().zip(&self.lacking).for_each(|(p, d)| *p -= d);
        for &(i, d) in &self.debts {
            self.known[i] -= d;
        }
    }

    /// With a limit, where a product has just paid all debts: goes back along the change d of the pressures that u learns of, to the
    /// least energy between, `s = -(d, e)/(d, A d)` of it. Elements that left for a bound return to C.
    fn step_back<S: AdmissibleSet>(&mut self, state: &mut State, set: S, update: &mut Update) {
        let (mut work, mut energy) = (0.0, 0.0);
        for i in 0..state.p.len() {
            let d = state.p[i] - self.known[i];
            if d != 0.0 {
                work -= d * (state.h[i] - state.approach + state.u[i]);
                energy += d * (update.alpha * self.q[i].to_double() + self.z[i].to_double());
            }
        }
        let s = work / energy;
        if !(s > 0.0 && s < STEP_BACK) {
            return;
        }
        update.alpha *= s;
        self.z.iter_mut().for_each(|z| *z = T::of(s * z.to_double()));
        for i in 0..state.p.len() {
            let d = state.p[i] - self.known[i];
            if d == 0.0 {
                continue;
            }
            let to = self.known[i] + s * d;
            state.p[i] = set.project(i, to);
            if state.p[i] != to {
                self.debts.push((i, state.p[i] - to));
            }
            let at_limit = state.p[i] >= set.limit(i);
            state.at_limit[i] = at_limit;
            state.contact[i] = state.p[i] > 0.0 && !at_limit;
        }
        self.find_contact(state);
    }

    /// By approach, where nothing is owed: scales p to the least energy `(p, u)/2 + (p, h - approach)`, u as `update` will leave it;
    /// returns the factor, with which u is to be scaled. It costs no product.
    fn least_energy(&mut self, state: &mut State, update: &Update) -> f64 {
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
    fn scale(&mut self, state: &mut State, factor: f64) {
        let [] = self.runs.sum_changing(&mut state.p, |block, p, _| {
            for (_, local) in block.runs() {
                p[local].iter_mut().for_each(|p| *p *= factor);
            }
        });
    }

    /// u = factor (u + alpha q + A d), and 4.2: exterior elements with e < 0 enter. Returns how many. One pass over the grid,
    /// because its arrays are longer than the caches.
    fn update_displacements<S: AdmissibleSet>(&mut self, state: &mut State, update: &Update, fixed: bool) -> u64 {
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
            // Most rows have no element that enters, and this the compiler can vectorise.
            let mut any = false;
            for ((h, u), inside) in h[row.clone()].iter().zip(&*u).zip(&contact[row.clone()]) {
                any |= (h - approach + *u < 0.0) & !inside;
            }
            if S::LIMITED {
                for ((h, u), at_limit) in h[row.clone()].iter().zip(&*u).zip(&at_limit[row]) {
                    any |= (h - approach + *u > 0.0) & at_limit;
                }
            }
            entering[0] = any;
        });
        let mut entered = 0;
        for (iy, _) in self.entering.iter().enumerate().filter(|(_, &any)| !fixed && any) {
            self.runs.change(iy * mx);
            for i in iy * mx..(iy + 1) * mx {
                let e = h[i] - approach + u[i];
                let enters = if S::LIMITED && at_limit[i] { e > 0.0 } else { !contact[i] && e < 0.0 };
                if enters {
                    contact[i] = true;
                    entered += 1;
                    if S::LIMITED {
                        at_limit[i] = false;
                    }
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
#[derive(Clone, Copy)]
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

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p).
struct Step {
    rt: f64,
    tq: f64,
    tt: f64,
    t1: f64,
    pp: f64,
}
