//! NORM as a step: steps 3 and 2 of section 3. The inner solve on C starts from p = 0 as in the paper, or from the initial pressures of the
//! solve.

use super::{conjugate_gradients, minimal_residual, InnerStop};
use crate::contact::{admit, norm_of_distance, residual_norm, truncate};
use crate::contact::{AdmissibleSet, ExchangeGuard, Freshness, Snapshot, State, Survey};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::{Change, Policy, Step, Task};
use crate::progress::Goal;
use crate::scene::Load;
use crate::sums::ROUND_OFF;

/// Restarts of an inner solve whose recursive residual was met but the true one was not.
const RESTARTS: u32 = 8;

/// The method, and its memory, kept from one solve to the next.
#[derive(Default)]
pub struct Norm {
    inner: super::Workspace,
    guard: ExchangeGuard,
    /// Restarts of this inner solve, and the true residual before the last.
    restarts: u32,
    last_residual: f64,
    /// The inner tolerance as a fraction of the tolerance. It shrinks if the residual is within the tolerance, but another measure of the result is
    /// not.
    aim: f64,
    /// rms over C of the last change of p.
    update: f64,
    /// The beginning of the next step.
    next: Next,
    /// The state before a trial.
    before: Snapshot,
    u_before: Vec<f64>,
}

/// The beginning of the next step.
#[derive(Clone, Copy, Default, PartialEq)]
enum Next {
    /// An inner solve from the current pressures.
    #[default]
    GoOn,
    /// Step 3: the contact conditions after an inner solve.
    Exchange,
    /// Step 3 for one element of the state before the trial.
    ExchangeOne,
}

impl Norm {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        2 * self.u_before.len() * size_of::<f64>() + self.inner.bytes()
    }

    /// Step 2: solves the equations on the contact area from the current pressures. Returns the update.
    fn solve<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<f64> {
        let Task { problem, state, goal, monitor, .. } = task;
        if state.contact_count() == 0 {
            return Ok(0.0);
        }
        let h = norm_of_distance(state);
        let stop = InnerStop {
            residual: if goal.by_update() { 0.0 } else { self.aim * goal.tolerance * h },
            update: if goal.by_update() { goal.tolerance } else { 0.0 },
            believed: self.aim * goal.residual() * h,
            distance: h,
            iterations: goal.max_cycles.saturating_sub(monitor.count.cycles) as usize,
        };
        let update = match problem.symmetric {
            true => conjugate_gradients(task, stop, &mut self.inner)?,
            false => minimal_residual(task, stop, &mut self.inner)?,
        };
        task.monitor.count.update = update;
        // Directions of mean zero keep the force except for round-off, which accumulates over many directions.
        refresh(task)?;
        Ok(update)
    }

    /// Chooses the next action after an inner solve that leaves `violators`. The recursive residual is no certificate. If the true residual is too
    /// large, the inner solve continues. Returns false if nothing is left to do.
    fn judge<S: AdmissibleSet>(&mut self, state: &State, set: S, goal: &Goal, update: f64, violators: u64) -> bool {
        let residual = residual_norm(state);
        let residual_holds = residual <= goal.residual() * norm_of_distance(state);
        let holds = match violators {
            0 => goal.holds(&Survey::of(state), update, set),
            _ => residual_holds,
        };
        let gains = residual < 0.5 * self.last_residual || residual_holds || goal.by_update();
        if !holds && gains && self.restarts < RESTARTS {
            self.aim *= if residual_holds { 0.5 } else { 1.0 };
            (self.restarts, self.last_residual, self.next) = (self.restarts + 1, residual, Next::GoOn);
            return true;
        }
        (self.restarts, self.last_residual, self.aim) = (0, f64::INFINITY, 1.0);
        self.next = Next::Exchange;
        violators > 0
    }

    /// Step 3: elements with p < 0 leave, and elements with e < 0 enter. All change at once, or only one if that may cycle. Returns whether an inner
    /// solve follows. If not, the state is a trial, because the violations may be within the tolerance.
    fn exchange<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<bool> {
        let (state, set) = (&mut *task.state, task.set);
        if self.guard.allows_all(violators(state, set)) {
            admit(state, set);
            truncate(state, set, &task.problem.threads);
            return Ok(true);
        }
        self.before.copy_from(state);
        self.u_before.clone_from(&state.u);
        truncate(state, set, &task.problem.threads);
        task.problem.refresh(task.state, task.set)?;
        self.next = Next::ExchangeOne;
        Ok(false)
    }

    /// Exchanges one element: the last violator.
    fn exchange_one<S: AdmissibleSet>(&mut self, state: &mut State, set: S) {
        self.before.restore_to(state);
        state.u.copy_from_slice(&self.u_before);
        if let Some(i) = (0..state.p.len()).rfind(|&i| violates(state, set, i)) {
            let at_limit = S::LIMITED && state.at_limit[i];
            if S::LIMITED {
                state.at_limit[i] = state.contact[i] && state.p[i] > 0.0;
                state.reached_limit |= state.at_limit[i];
            }
            state.p[i] = if at_limit { state.p[i] } else { set.project(i, state.p[i]) };
            state.contact[i] = !state.contact[i];
        }
    }
}

/// Whether the violations of a trial are round-off. Then there is nothing to exchange.
fn is_at_round_off<S: AdmissibleSet>(task: &Task<'_, '_, S>) -> bool {
    let floor = Goal { tolerance: ROUND_OFF.max(task.goal.tolerance), ..task.goal };
    floor.holds(&Survey::of(task.state), 0.0, task.set)
}

/// Sets p = 0 on C for the start of an inner solve. Elements at their limit keep their pressures.
fn start_from_zero<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) -> Result<()> {
    let (state, set) = (&mut *task.state, task.set);
    let held = S::LIMITED && state.has_limited();
    for i in 0..state.p.len() {
        state.p[i] = if held && state.at_limit[i] { set.limit(i) } else { 0.0 };
        state.u[i] = 0.0;
    }
    state.u_is = Freshness::Exact;
    if held || matches!(state.load, Load::Force(_)) {
        return refresh(task);
    }
    Ok(())
}

/// Makes p on C carry the force that elements at their limit leave, by an added uniform pressure. If none is at its limit, a factor on p makes it
/// carry the force. Then computes u = A p. No element is exchanged: the next exchange handles a p beyond its limit.
fn refresh<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) -> Result<()> {
    let Task { problem, state, set, .. } = task;
    let beside_limits = S::LIMITED && state.has_limited();
    match state.load {
        Load::Force(force) if beside_limits && state.contact.contains(&true) => {
            let missing = force / state.grid.element_area() - state.pressures(&problem.threads);
            let even = missing / state.contact_count() as f64;
            state.p.iter_mut().zip(&state.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += even);
        }
        Load::Force(_) if S::LIMITED && !beside_limits => _ = state.balance_force(&problem.threads),
        _ => _ = state.carry_force(*set, &problem.threads),
    }
    problem.displace(&state.p, &mut state.u)?;
    state.u_is = Freshness::Exact;
    state.fit_approach(&problem.threads);
    Ok(())
}

fn violators<S: AdmissibleSet>(state: &State, set: S) -> usize {
    (0..state.p.len()).filter(|&i| violates(state, set, i)).count()
}

fn violates<S: AdmissibleSet>(state: &State, set: S, i: usize) -> bool {
    match state.contact[i] {
        true => set.leaves(i, state.p[i]),
        false => set.enters(S::LIMITED && state.at_limit[i], state.deformed_distance(i)),
    }
}

impl<S: AdmissibleSet> Step<S> for Norm {
    fn name(&self) -> &'static str {
        "NORM"
    }

    fn policy(&self) -> Policy {
        // The guard against cycling bounds the number of steps. With limits and a prescribed force it may fail. Then max_cycles bounds them.
        Policy { exchanged_by_loop: false, step_is_cycle: false, chatter: 0, patience: u32::MAX, progress: 1.0 }
    }

    fn begin(&mut self, state: &State) -> Result<()> {
        (self.guard, self.next) = (ExchangeGuard::default(), Next::GoOn);
        (self.restarts, self.last_residual, self.aim) = (0, f64::INFINITY, 1.0);
        self.inner.reserve(state.p.len())?;
        reserve(&mut self.u_before, state.u.len(), "NORM's workspace")?;
        self.before.reserve(state, "NORM's workspace")
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        // 3. A new contact area by the contact conditions. The first one (step 1) is given.
        let from_zero = match self.next {
            Next::GoOn => task.state.p.iter().all(|p| *p == 0.0),
            Next::Exchange => {
                if !self.exchange(task)? {
                    return Ok(Change { update: self.update, ..Change::default() });
                }
                true
            }
            Next::ExchangeOne => {
                if is_at_round_off(task) {
                    return Ok(Change { gives_up: true, ..Change::default() });
                }
                self.exchange_one(task.state, task.set);
                true
            }
        };
        if from_zero {
            start_from_zero(task)?;
        }
        // 2. The equations on the contact area.
        let update = self.solve(task)?;
        self.update = update;
        // 4. Repeat if the conditions do not hold.
        let Task { state, set, goal, monitor, .. } = task;
        monitor.count.active_set_steps += 1;
        let changes = if S::FIXED { 0 } else { violators(state, *set) as u64 };
        monitor.count.active_set_changes += changes;
        let gives_up = !self.judge(state, *set, goal, update, changes);
        Ok(Change { update, changes, gives_up })
    }
}
