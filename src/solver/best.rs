//! The best iterate of a solve. It is the result if no method reaches the goal.

use crate::contact::{truncate, AdmissibleSet, Freshness, Snapshot, State, Survey};
use crate::error::Result;
use crate::methods::Task;
use crate::scene::Load;

/// The iterate with the least violation so far.
#[derive(Default)]
pub struct Best {
    /// The least violation. Infinite without an iterate.
    pub violation: f64,
    found: Snapshot,
}

impl Best {
    /// Discards the iterate.
    pub fn forget(&mut self) {
        self.violation = f64::INFINITY;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.found.bytes()
    }

    /// Keeps an iterate whose u is A p, if it is better than those before.
    pub fn note(&mut self, state: &State, violation: f64) -> Result<()> {
        if violation < self.violation {
            self.found.reserve(state, "the best iterate")?;
            self.found.copy_from(state);
            self.violation = violation;
        }
        Ok(())
    }

    /// Sets the state to the best iterate, with admissible pressures, the prescribed force and a fresh u = A p. With a prescribed
    /// approach the result is never worse than p = 0. Returns the survey of the result.
    pub fn restore<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<Survey> {
        // The measures of the state are no longer valid.
        task.monitor.survey = None;
        let (state, set) = (&mut *task.state, task.set);
        for (i, p) in state.p.iter_mut().enumerate() {
            // The comparison is false for NaN.
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
        let now = survey.violation(set);
        let by_approach = matches!(state.load, Load::Approach(_));
        if self.violation < now || !(now <= f64::MAX) {
            if self.violation.is_finite() {
                self.found.restore_to(state);
            } else {
                state.p.fill(0.0);
                state.at_limit.fill(false);
            }
            task.problem.refresh(state, set)?;
            survey = Survey::of(state);
        }
        if !by_approach && !survey.violation(set).is_finite() {
            // A uniform pressure on C.
            state.p.fill(0.0);
            task.problem.refresh(state, set)?;
            survey = Survey::of(state);
        }
        let found = survey.violation(set);
        if by_approach && !(found <= 1.0) || !found.is_finite() {
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
