//! Effect `pressure_limit`: an active set of elements at the limit, around the solve of a scene without one.
//!
//! With L the elements at the limit, `p_L` the limits on them and 0 elsewhere, what is left is a scene like any other:
//!
//! ```text
//! h' = h + A p_L outside L, no surface on L;    force' = force - sum of p_L dx dy, or the same approach
//! elements with p > p_max enter L, elements of L with e > 0 leave it, until none does
//! ```
//!
//! L is empty at first: where the limit is never reached nothing else is done, and the solution has the bits of one without it. Each
//! further solve starts from the pressures of the one before.

use super::report::Stop;
use super::start::Start;
use super::{Options, Solver};
use crate::contact::admissible::Limited;
use crate::contact::{ExchangeGuard, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::progress::{Monitor, Rule};
use crate::scene::{Load, PressureLimit};

/// Changes of L at most.
const ROUNDS: u32 = 200;
/// A force that is left over of this part is round-off of the sum of limits.
const NO_FORCE: f64 = 1e-12;
/// What the memory is for.
const MEMORY: &str = "the pressure limit";

/// Memory, kept from one solve to the next; none before a scene has a limit that is reached.
#[derive(Default)]
pub(super) struct Workspace {
    /// L.
    at_limit: Vec<bool>,
    /// The scene's undeformed distance.
    h: Vec<f64>,
    /// p_L and A p_L.
    limits: Vec<f64>,
    displacement: Vec<f64>,
}

impl Workspace {
    pub fn bytes(&self) -> usize {
        self.h.len() * (3 * size_of::<f64>() + size_of::<bool>())
    }
}

impl Solver {
    /// The box inside the projected conjugate gradients, from the projected pressures of the scene without limit.
    fn limit_inside(
        &mut self,
        limit: PressureLimit<'_>,
        options: &Options,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let state = &mut self.states[0];
        reserve(&mut state.at_limit, state.p.len(), MEMORY)?;
        state.at_limit.resize(state.p.len(), false);
        let set = match limit {
            PressureLimit::Uniform(limit) => Limited::Uniform(limit),
            PressureLimit::PerElement(limits) => Limited::PerElement(limits),
        };
        state.balance_force_within(set);
        self.projected.displace(&state.p, &mut state.u);
        monitor.count_products(1, 1.0);
        state.fit_approach();
        self.projected.solve(&mut self.states[0], set, rule, Start::Given, options.error_ratio, monitor)
    }

    /// Goes on from the solution without a limit, `stop` being how that ended.
    pub(super) fn limit_pressures(
        &mut self,
        limit: PressureLimit<'_>,
        stop: Stop,
        options: &Options,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        if (0..self.grid.len()).all(|i| self.states[0].p[i] <= limit.at(i)) {
            return Ok(stop);
        }
        if self.symmetric && matches!(options.method, super::Method::Auto | super::Method::ProjectedCg) {
            return self.limit_inside(limit, options, rule, monitor);
        }
        let mut work = std::mem::take(&mut self.limited);
        let stop = self.settle_limit(&mut work, limit, stop, options, rule, monitor);
        self.limited = work;
        stop
    }

    /// Elements enter and leave L, each time with a solve for what is outside it, until none does.
    fn settle_limit(
        &mut self,
        work: &mut Workspace,
        limit: PressureLimit<'_>,
        mut stop: Stop,
        options: &Options,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let load = self.states[0].load;
        work.begin(&self.states[0])?;
        let (mut guard, mut rounds) = (ExchangeGuard::default(), 0);
        loop {
            let changes = work.exchange(&mut self.states[0], limit, rule.tolerance, &mut guard);
            if stop != Stop::Converged || changes == 0 {
                break;
            }
            if rounds == ROUNDS {
                // Not settled: what is above the limit is cut off.
                stop = Stop::Stagnated;
                break;
            }
            rounds += 1;
            monitor.active_set_changes += changes;
            monitor.active_set_steps += 1;
            stop = self.solve_outside(work, limit, load, options, rule, monitor)?;
        }
        log::info!("the pressure limit: {rounds} changes of the elements at it");
        self.join(work, load, monitor)?;
        Ok(stop)
    }

    /// Solves for what is outside L.
    fn solve_outside(
        &mut self,
        work: &mut Workspace,
        limit: PressureLimit<'_>,
        load: Load,
        options: &Options,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let Workspace { at_limit, h, limits, displacement } = work;
        for (i, p) in limits.iter_mut().enumerate() {
            *p = if at_limit[i] { limit.at(i) } else { 0.0 };
        }
        self.projected.displace(limits, displacement);
        let state = &mut self.states[0];
        for i in 0..h.len() {
            state.h[i] = if at_limit[i] { f64::INFINITY } else { h[i] + displacement[i] };
            if at_limit[i] {
                state.p[i] = 0.0;
            }
            state.contact[i] = state.p[i] > 0.0;
        }
        if let Load::Force(force) = load {
            let left = force - limits.iter().sum::<f64>() * self.grid.element_area();
            state.load = Load::Force(if left > NO_FORCE * force { left } else { 0.0 });
        }
        let load = state.load;
        if self.without_contact(load, rule.fixed) {
            return Ok(Stop::Converged);
        }
        let state = &mut self.states[0];
        if state.contact_count() == 0 {
            // The starting area for what is left, all of which it is to carry.
            state.start(self.projected.influence().at(0, 0));
        }
        state.balance_force();
        self.projected.displace(&state.p, &mut state.u);
        state.fit_approach();
        monitor.count_products(2, 1.0);
        self.run(options, rule, Start::Given, monitor)
    }

    /// The whole state again: p of both, u = A p anew, and L beside C.
    fn join(&mut self, work: &Workspace, load: Load, monitor: &mut Monitor<'_>) -> Result<()> {
        let state = &mut self.states[0];
        state.load = load;
        reserve(&mut state.at_limit, work.at_limit.len(), MEMORY)?;
        state.at_limit.clone_from(&work.at_limit);
        state.h.copy_from_slice(&work.h);
        for i in 0..work.h.len() {
            if work.at_limit[i] {
                (state.p[i], state.contact[i]) = (work.limits[i], false);
            }
        }
        self.projected.displace(&state.p, &mut state.u);
        monitor.count_products(1, 1.0);
        if matches!(load, Load::Force(_)) && !state.contact.contains(&true) {
            // Nothing is in elastic contact: the least approach that holds all elements at the limit.
            let held = (0..work.h.len()).filter(|&i| work.at_limit[i]).map(|i| state.h[i] + state.u[i]);
            state.approach = held.fold(f64::NEG_INFINITY, f64::max);
        }
        Ok(())
    }
}

impl Workspace {
    /// No element is at the limit of the scene that `state` has.
    fn begin(&mut self, state: &State) -> Result<()> {
        let n = state.h.len();
        reserve(&mut self.at_limit, n, MEMORY)?;
        for values in [&mut self.h, &mut self.limits, &mut self.displacement] {
            reserve(values, n, MEMORY)?;
        }
        self.at_limit.clear();
        self.at_limit.resize(n, false);
        self.h.clone_from(&state.h);
        self.limits.resize(n, 0.0);
        self.displacement.resize(n, 0.0);
        Ok(())
    }

    /// Whether element i is on the wrong side of the limit: inside L a deformed distance above `allowed` is judged as penetrations
    /// outside C are.
    fn violates(&self, i: usize, state: &State, limit: PressureLimit<'_>, allowed: f64) -> bool {
        match self.at_limit[i] {
            true => self.h[i] - state.approach + state.u[i] + self.displacement[i] > allowed,
            false => state.p[i] > limit.at(i),
        }
    }

    /// Who enters L and who leaves it; all of them, or one if that may cycle. Returns how many.
    fn exchange(
        &mut self,
        state: &mut State,
        limit: PressureLimit<'_>,
        tolerance: f64,
        guard: &mut ExchangeGuard,
    ) -> u64 {
        let n = self.h.len();
        let (mut sum, mut count) = (0.0, 0.0);
        for i in 0..n {
            if self.at_limit[i] || state.contact[i] {
                sum += (self.h[i] - state.approach).powi(2);
                count += 1.0;
            }
        }
        let allowed = tolerance * (sum / f64::max(count, 1.0)).sqrt();
        let violators = (0..n).filter(|&i| self.violates(i, state, limit, allowed)).count();
        if violators == 0 {
            return 0;
        }
        let first = if guard.allows_all(violators) {
            0
        } else {
            (0..n).rfind(|&i| self.violates(i, state, limit, allowed)).unwrap_or(0)
        };
        let mut changes = 0;
        for i in first..n {
            if self.violates(i, state, limit, allowed) {
                self.at_limit[i] = !self.at_limit[i];
                state.p[i] = if self.at_limit[i] { 0.0 } else { limit.at(i) };
                self.limits[i] = if self.at_limit[i] { limit.at(i) } else { 0.0 };
                changes += 1;
            }
        }
        changes
    }
}
