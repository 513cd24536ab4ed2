//! The loop: every promise about an answer is kept here, whichever method makes the steps.
//!
//! ```text
//! repeat
//!    2., 3.  p = 0 in E; a step of the method on C
//!    (4.1)   elements that would pull leave C, those above their limit go to it; then u = A p
//!    certify where the criterion seems met: u = A p by a fresh product in double precision
//!    (4.2)   elements that penetrate enter C
//!    5., 6.  done if the certificate holds and C stays; or go on
//! until max_cycles, a callback that cancels, or no progress: then the best iterate is the answer
//! ```
//!
//! The order of (4.1) and (4.2) matters: with the product before the truncation the loop cycles for ever.

use super::best::Best;
use crate::contact::{admit, truncate, AdmissibleSet, Freshness, Problem, State, Survey};
use crate::error::{Error, Result};
use crate::methods::{Change, Habits, Step};
use crate::progress::{Goal, Monitor, Stop};
use crate::scene::Load;

/// Runs one method on the grid of `problem` from what `state` holds. Unless it converges, `best` knows the best iterate.
pub fn iterate<S: AdmissibleSet>(
    method: &mut dyn Step<S>,
    problem: &mut Problem,
    state: &mut State,
    set: S,
    goal: &Goal,
    best: &mut Best,
    monitor: &mut Monitor<'_>,
) -> Result<Stop> {
    let habits = method.habits();
    method.begin(state)?;
    let (mut chatter, mut least, mut since) = (0, f64::INFINITY, 0);
    // A step need not take a cycle, but there are no more of them than cycles may be.
    for _ in 0..=goal.max_cycles {
        if monitor.count.cycles >= goal.max_cycles || monitor.is_cancelled() {
            break;
        }
        // 2. p = 0 in E. 3. A step of the method on C.
        let change = step(method, problem, state, set, goal, monitor)?;
        if change.gives_up && state.u_is != Freshness::Exact {
            return Ok(Stop::Stagnated);
        }

        // (4.1), the certificate, (4.2)
        let left = if habits.exchanged_by_loop { truncate(state, set) } else { 0 };
        let mut survey = certify(problem, state, set, goal, &change, left, monitor);
        let violation = violation(&survey, set);
        let mut entered = 0;
        if habits.exchanged_by_loop && !S::FIXED && survey.penetration > 0.0 {
            entered = admit(state, set);
            let penetration = survey.penetration;
            survey = Survey { penetration, ..Survey::of(state) };
        }
        let changes = change.changes + (left + entered) as u64;
        if habits.step_is_cycle {
            monitor.count.active_set_steps += 1;
            monitor.cycle_done(&state.grid, changes, change.update, survey.residual / survey.distance);
        }

        // 5. Go on if C has changed. 6. Go on if the accuracy is not reached.
        if state.u_is == Freshness::Exact && carries(state) && goal.holds(&survey, change.update, set) {
            chatter += u32::from(changes > 0);
            if changes == 0 || survives_chatter(&habits, chatter) {
                return Ok(Stop::Converged);
            }
        }
        if state.u_is == Freshness::Exact {
            best.note(state, violation)?;
        }
        since += 1;
        if violation < habits.progress * least {
            (least, since) = (violation, 0);
        }
        if since > habits.patience || change.gives_up || habits.step_is_cycle && !violation.is_finite() {
            return Ok(Stop::Stagnated);
        }
    }
    Ok(monitor.interrupted())
}

/// Round-off of the force, relative to the sum of all that pushes and pulls: that of a sum of 2^31 pressures in any order.
const ROUND_OFF: f64 = 1e-12;

/// Whether p carries a prescribed force.
fn carries(state: &State) -> bool {
    let Load::Force(force) = state.load else { return true };
    let (sum, all) = state.p.iter().fold((0.0, 0.0), |(sum, all), p| (sum + p, all + p.abs()));
    let area = state.grid.element_area();
    (sum * area - force).abs() <= ROUND_OFF * (all * area + force)
}

/// Whether the certificate decides although elements still change sides.
fn survives_chatter(habits: &Habits, chatter: u32) -> bool {
    habits.exchanged_by_loop && chatter > habits.chatter
}

/// A step and its products. Coefficients of an elastic body are positive definite: where round-off says otherwise the method is at its
/// end, and only a caller's table is refused for it.
fn step<S: AdmissibleSet>(
    method: &mut dyn Step<S>,
    problem: &mut Problem,
    state: &mut State,
    set: S,
    goal: &Goal,
    monitor: &mut Monitor<'_>,
) -> Result<Change> {
    let change = match method.step(problem, state, set, goal, monitor) {
        Err(Error::NotPositiveDefinite(message)) if !problem.given => {
            log::info!("{}: {message}", method.name());
            state.u_is = Freshness::Stale;
            Ok(Change { gives_up: true, ..Change::default() })
        }
        change => change,
    };
    monitor.count_products(problem.take_products(), problem.work);
    change
}

/// Surveys the state, by a fresh product where u is none of p, or where the criterion seems met: only a fresh product certifies.
fn certify<S: AdmissibleSet>(
    problem: &mut Problem,
    state: &mut State,
    set: S,
    goal: &Goal,
    change: &Change,
    left: usize,
    monitor: &mut Monitor<'_>,
) -> Survey {
    if left > 0 || state.u_is == Freshness::Stale {
        problem.refresh(state, set);
    } else {
        state.fit_approach();
    }
    let mut survey = Survey::of(state);
    let ends = monitor.is_cancelled() || monitor.count.cycles >= goal.max_cycles;
    if state.u_is == Freshness::Near && (ends || goal.holds(&survey, change.update, set)) {
        problem.refresh(state, set);
        survey = Survey::of(state);
    }
    monitor.count_products(problem.take_products(), problem.work);
    survey
}

/// How far the conditions are from being met: the larger of the relative residual and the relative penetration, p = 0 having 1; infinite
/// where pressures are not admissible. `max` alone would drop what is not a number.
pub fn violation<S: AdmissibleSet>(survey: &Survey, _: S) -> f64 {
    let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
    let residual = relative(survey.residual, survey.distance);
    let penetration = if S::FIXED { 0.0 } else { relative(survey.penetration, survey.scale) };
    let admissible = S::FIXED || survey.range.0 >= 0.0;
    match residual.max(penetration) {
        worst if admissible && worst >= residual && worst >= penetration => worst,
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
#[path = "../../tests/unit/iterate.rs"]
mod tests;
