//! The best iterate of a solve. It is the result if no method reaches the goal.

use crate::contact::{truncate, AdmissibleSet, Freshness, Snapshot, State, Survey};
use crate::error::Result;
use crate::methods::Task;
use crate::scene::Load;

/// The iterate with the least [violation](Survey::violation) so far.
#[derive(Default)]
pub struct Best {
    /// The violation of this iterate: the larger of its relative residual and relative violation. Infinite without an iterate.
    pub violation: f64,
    /// Its pressures, contact area and approach.
    snapshot: Snapshot,
}

impl Best {
    /// Discards the iterate.
    pub fn forget(&mut self) {
        self.violation = f64::INFINITY;
    }

    /// Bytes of the iterate.
    pub fn bytes(&self) -> usize {
        self.snapshot.bytes()
    }

    /// Copies an iterate if its violation is less than that of all iterates before. Its u must be A p.
    pub fn note(&mut self, state: &State, violation: f64) -> Result<()> {
        if violation < self.violation {
            self.snapshot.reserve(state, "the best iterate")?;
            self.snapshot.copy_from(state);
            self.violation = violation;
        }
        Ok(())
    }

    /// Sets the state to the better of itself and the best iterate, with admissible pressures, the prescribed force and u = A p by a product. With a
    /// prescribed approach, the result is p = 0 if both are worse. Returns the survey of the result.
    pub fn restore<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<Survey> {
        // The monitor's survey belongs to the state before.
        task.monitor.survey = None;
        let (state, set) = (&mut *task.state, task.set);
        for (i, p) in state.p.iter_mut().enumerate() {
            // Infinite pressures become 0, and so does NaN, for which the comparison is false.
            *p = if p.abs() < f64::INFINITY { *p } else { 0.0 };
            if S::LIMITED && state.at_limit[i] {
                *p = set.limit(i);
            }
        }
        let left = truncate(state, set, &task.problem.threads);
        if left > 0 || state.u_is != Freshness::Exact {
            task.problem.refresh(state, set)?;
        }
        let mut survey = Survey::of(state);
        let of_state = survey.violation(set);
        let by_approach = matches!(state.load, Load::Approach(_));
        if self.violation < of_state || !(of_state <= f64::MAX) {
            if self.violation.is_finite() {
                self.snapshot.restore_to(state);
            } else {
                state.p.fill(0.0);
                state.at_limit.fill(false);
            }
            task.problem.refresh(state, set)?;
            survey = Survey::of(state);
        }
        if !by_approach && !survey.violation(set).is_finite() {
            // From p = 0, `refresh` makes the pressures carry the force: a uniform pressure on C.
            state.p.fill(0.0);
            task.problem.refresh(state, set)?;
            survey = Survey::of(state);
        }
        let restored = survey.violation(set);
        // p = 0 has the violation 1.
        if by_approach && !(restored <= 1.0) || !restored.is_finite() {
            state.p.fill(0.0);
            state.u.fill(0.0);
            if !S::FIXED {
                state.unload();
                state.start(task.problem.self_influence());
            }
            survey = Survey::of(state);
        }
        task.count_products();
        Ok(survey)
    }
}
