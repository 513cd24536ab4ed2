//! NORM as a [`Step`] of the loop: step 3 of section 3 of the paper, then step 2. The inner solve on C starts from p = 0 as in the paper. Only the
//! first one starts from the initial pressures of the solve.

use super::{conjugate_gradients, minimal_residual, InnerStop};
use crate::contact::{admit, norm_of_distance, residual_norm, truncate};
use crate::contact::{AdmissibleSet, ExchangeGuard, Freshness, Snapshot, State, Survey};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::{Change, Policy, Step, Task};
use crate::progress::Goal;
use crate::scene::Load;
use crate::sums::ROUND_OFF;

/// The largest number of restarts of an inner solve. It is restarted if its recursive residual is small enough, but the true residual is not.
const RESTARTS: u32 = 8;

/// NORM, and its memory, which the next solve reuses.
///
/// If the guard allows the exchange of one element only, NORM first makes a *trial*: all elements with p < 0 leave C, and the loop tests whether the
/// contact conditions then hold within the tolerance. If they do not, NORM goes back to the state before the trial and exchanges one element.
#[derive(Default)]
pub struct Norm {
    /// The memory of inner solves.
    inner: super::Workspace,
    /// Decides whether all elements may be exchanged at once.
    guard: ExchangeGuard,
    /// The number of restarts of the current inner solve.
    restarts: u32,
    /// The true residual at the last restart; infinite before the first.
    last_residual: f64,
    /// The tolerance of inner solves, relative to that of the solve. It is halved if the residual is small enough but another measure of the result
    /// is not.
    aim: f64,
    /// The rms over C of the last change of p.
    update: f64,
    /// How the next step begins.
    next: Next,
    /// p, C and the approach before the trial.
    before: Snapshot,
    /// u before the trial.
    u_before: Vec<f64>,
}

/// How the next step begins.
#[derive(Clone, Copy, Default, PartialEq)]
enum Next {
    /// With an inner solve from the current pressures.
    #[default]
    GoOn,
    /// With step 3: elements enter and leave C by the result of an inner solve.
    Exchange,
    /// With the state before the trial, of which one element enters or leaves C.
    ExchangeOne,
}

impl Norm {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.before.bytes() + self.u_before.len() * size_of::<f64>() + self.inner.bytes()
    }

    /// Step 2: solves the equations on C from the current pressures. Returns the rms over C of the last change of p.
    fn solve<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<f64> {
        let Task { problem, state, goal, monitor, .. } = task;
        if state.contact_count() == 0 {
            return Ok(0.0);
        }
        let distance = norm_of_distance(state);
        let stop = InnerStop {
            residual: if goal.by_update() { 0.0 } else { self.aim * goal.tolerance * distance },
            update: if goal.by_update() { goal.tolerance } else { 0.0 },
            believed: self.aim * goal.residual() * distance,
            distance,
            iterations: goal.max_cycles.saturating_sub(monitor.count.cycles) as usize,
        };
        let update = match problem.symmetric {
            true => conjugate_gradients(task, stop, &mut self.inner)?,
            false => minimal_residual(task, stop, &mut self.inner)?,
        };
        task.monitor.count.update = update;
        // Search directions of mean zero change the force by round-off only, but this round-off accumulates over many directions.
        refresh(task)?;
        Ok(update)
    }

    /// Chooses how the next step begins, after an inner solve with `violators` elements that would have to enter or leave C. The inner solve stops by
    /// its recursive residual, which may be smaller than the true one. If the true residual is too large, the inner solve is restarted. Returns false
    /// if nothing is left to do.
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

    /// Step 3: elements with p < 0 leave C, and exterior elements with e < 0 enter C, if the guard allows to exchange all of them at once. Returns
    /// true if an inner solve follows. Otherwise the state is a trial (see [`Norm`]): the violations may be within the tolerance.
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

    /// Goes back to the state before the trial, and exchanges its violator with the highest index.
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

/// Whether the violations of a trial are within the tolerance or round-off, so that there is nothing to exchange.
fn is_at_round_off<S: AdmissibleSet>(task: &Task<'_, '_, S>) -> bool {
    let attainable = Goal { tolerance: ROUND_OFF.max(task.goal.tolerance), ..task.goal };
    attainable.holds(&Survey::of(task.state), 0.0, task.set)
}

/// Sets p = 0 and u = A p for the start of an inner solve. Elements at their limit keep their pressures, and a prescribed force is carried by a
/// uniform pressure.
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

/// Makes p carry a prescribed force, and computes u = A p and the approach. If elements are at their limit, a uniform pressure is added on C;
/// otherwise p is multiplied by a factor. If a p then exceeds its limit, the element stays in C until the next step 3.
fn refresh<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) -> Result<()> {
    let Task { problem, state, set, .. } = task;
    let beside_limits = S::LIMITED && state.has_limited();
    match state.load {
        Load::Force(force) if beside_limits && state.contact.contains(&true) => {
            let missing = force / state.grid.element_area() - state.pressures(&problem.threads);
            let uniform = missing / state.contact_count() as f64;
            state.p.iter_mut().zip(&state.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += uniform);
        }
        Load::Force(_) if S::LIMITED && !beside_limits => _ = state.balance_force(&problem.threads),
        _ => _ = state.carry_force(*set, &problem.threads),
    }
    problem.displace(&state.p, &mut state.u)?;
    state.u_is = Freshness::Exact;
    state.fit_approach(&problem.threads);
    Ok(())
}

/// The number of elements that have to enter or leave C.
fn violators<S: AdmissibleSet>(state: &State, set: S) -> usize {
    (0..state.p.len()).filter(|&i| violates(state, set, i)).count()
}

/// Whether element i has to enter or leave C.
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
        // The guard against cycling bounds the number of steps. With pressure limits and a prescribed force the guard may fail. Then `max_cycles`
        // bounds the number of steps.
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
        // 3. Elements enter and leave C. The first contact area (step 1) is that of the state.
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
        // 2. The equations on C are solved.
        let update = self.solve(task)?;
        self.update = update;
        // 4. The steps are repeated if the contact conditions do not hold.
        let Task { state, set, goal, monitor, .. } = task;
        monitor.count.active_set_steps += 1;
        let changes = if S::FIXED { 0 } else { violators(state, *set) as u64 };
        monitor.count.active_set_changes += changes;
        let gives_up = !self.judge(state, *set, goal, update, changes);
        Ok(Change { update, changes, gives_up })
    }
}
