//! The iteration loop of all methods. It alone checks the conditions that a result must satisfy.
//!
//! ```text
//! repeat
//!    2., 3.  p = 0 in the exterior area E; a step of the method on C
//!    (4.1)   elements with p < 0 leave C, those above their limit go to it; then u = A p
//!    certify if the criterion seems met: u = A p by a fresh product in double precision
//!    (4.2)   elements that penetrate enter C, and so do elements at their limit with e > 0
//!    5., 6.  done if the certificate holds and C has not changed; otherwise go on
//! until max_cycles, a callback that cancels, or no progress: then the best iterate is the result
//! ```
//!
//! Numbers of steps are those of the paper. The product comes after (4.1) and before (4.2): with a product before (4.1), u would belong to pressures
//! that (4.1) then changes, and the loop would cycle between contact areas.

use super::best::Best;
use crate::contact::{admit, all_stay, truncate, AdmissibleSet, Freshness, Survey};
use crate::error::{Error, Result};
use crate::methods::{Change, Step, Task};
use crate::progress::Outcome;

/// Iterates with one method from the state until an outcome is reached. Unless this is Converged, `best` then holds the best iterate.
pub fn iterate<S: AdmissibleSet>(
    method: &mut dyn Step<S>,
    task: &mut Task<'_, '_, S>,
    best: &mut Best,
) -> Result<Outcome> {
    let (policy, set, goal) = (method.policy(), task.set, task.goal);
    method.begin(task.state)?;
    // `chatter`: steps in which the certificate held but C changed. `since`: steps since the violation was last notably below `least`.
    let (mut chatter, mut least, mut since) = (0, f64::INFINITY, 0);
    // Some steps count no cycle. Therefore the number of steps is limited as well.
    for _ in 0..=goal.max_cycles {
        if task.is_interrupted() {
            break;
        }
        // 2. p = 0 in E. 3. A step of the method on C.
        let products = task.monitor.count.matrix_products;
        let change = method.step(task).or_else(|error| given_up(error, method.name(), task));
        task.count_products();
        let change = change?;
        // A fresh product of this step. An exact u may also be a linear combination of earlier displacements, which certifies nothing.
        let is_certain = task.state.u_is == Freshness::Exact && task.monitor.count.matrix_products > products;
        if change.gives_up && !is_certain {
            return Ok(Outcome::Stagnated);
        }

        // (4.1), the certificate, (4.2)
        let left = if policy.exchanged_by_loop { truncate(task.state, set, &task.problem.threads) } else { 0 };
        let mut survey = certify(task, &change, left)?;
        let violation = survey.violation(set);
        let (entered, last) = if policy.exchanged_by_loop { let_enter(task, survey) } else { (0, survey) };
        survey = Survey { violation: survey.violation, ..last };
        let changes = change.changes + (left + entered) as u64;
        if policy.step_is_cycle {
            task.monitor.count.active_set_steps += 1;
            task.monitor.cycle_done(&task.state.grid, changes, change.update, survey.relative_residual());
        }

        // 5. Go on if C has changed. 6. Go on if the accuracy is not reached.
        if task.state.u_is == Freshness::Exact && goal.holds(&survey, change.update, set) && task.carries() {
            chatter += u32::from(changes > 0);
            // If the bodies fit up to round-off, elements may change sides without end. Then, and after some steps, the certificate alone decides.
            let fits = survey.residual == 0.0 && survey.violation == 0.0 && all_stay(task.state, set);
            if changes == 0 || fits || policy.exchanged_by_loop && chatter > policy.chatter {
                task.monitor.survey = Some(last);
                return Ok(Outcome::Converged);
            }
        }
        if task.state.u_is == Freshness::Exact {
            best.note(task.state, violation)?;
        }
        since += 1;
        if violation < policy.progress * least {
            (least, since) = (violation, 0);
        }
        if since > policy.patience || change.gives_up || policy.step_is_cycle && !violation.is_finite() {
            return Ok(Outcome::Stagnated);
        }
    }
    Ok(task.monitor.interrupted())
}

/// The change of a step that failed with `error`. The operator of elastic bodies is positive definite. If a step finds that it is not, round-off is
/// the cause, and the method gives up. The caller's coefficients may truly not be positive definite: then the solve fails with the error.
fn given_up<S: AdmissibleSet>(error: Error, method: &str, task: &mut Task<'_, '_, S>) -> Result<Change> {
    match error {
        Error::NotPositiveDefinite(message) if !task.problem.given => {
            log::info!("{method}: {message}");
            task.state.u_is = Freshness::Stale;
            Ok(Change { gives_up: true, ..Change::default() })
        }
        error => Err(error),
    }
}

/// Returns the survey of the state after `left` elements have left C. u is recomputed by a product if C has changed or u is stale, and also if the
/// criterion seems met or the solve ends here and u is only near A p.
fn certify<S: AdmissibleSet>(task: &mut Task<'_, '_, S>, change: &Change, left: usize) -> Result<Survey> {
    if left > 0 || task.state.u_is == Freshness::Stale {
        task.problem.refresh(task.state, task.set)?;
    } else {
        task.state.fit_approach(&task.problem.threads);
    }
    let mut survey = task.survey();
    if task.state.u_is == Freshness::Near
        && (task.is_interrupted() || task.goal.holds(&survey, change.update, task.set))
    {
        task.problem.refresh(task.state, task.set)?;
        survey = task.survey();
    }
    task.count_products();
    Ok(survey)
}

/// Step (4.2). Returns the number of elements that enter C, and the survey with the new C.
fn let_enter<S: AdmissibleSet>(task: &mut Task<'_, '_, S>, survey: Survey) -> (usize, Survey) {
    let penetrates = !S::FIXED && survey.violation > 0.0;
    match if penetrates { admit(task.state, task.set) } else { 0 } {
        0 => (0, survey),
        entered => (entered, task.survey()),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/iterate.rs"]
mod tests;
