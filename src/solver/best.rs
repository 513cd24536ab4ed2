//! The best iterate of a solve: what is returned when no method reaches the goal.

use super::iterate::violation;
use crate::contact::{truncate, AdmissibleSet, Freshness, Problem, State, Survey};
use crate::error::Result;
use crate::memory::reserve;
use crate::progress::Monitor;
use crate::scene::Load;

/// The iterate of the least violation so far.
#[derive(Default)]
pub struct Best {
    violation: f64,
    p: Vec<f64>,
    contact: Vec<bool>,
    at_limit: Vec<bool>,
}

impl Best {
    /// There is none yet.
    pub fn forget(&mut self) {
        self.violation = f64::INFINITY;
    }

    /// The violation of the best iterate; infinite before there is one.
    pub fn violation(&self) -> f64 {
        self.violation
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.p.len() * (size_of::<f64>() + size_of::<bool>())
    }

    /// Keeps an iterate whose u is A p, if it is better than those before.
    pub fn note(&mut self, state: &State, violation: f64) -> Result<()> {
        if violation < self.violation {
            const MEMORY: &str = "the best iterate";
            reserve(&mut self.p, state.p.len(), MEMORY)?;
            reserve(&mut self.contact, state.p.len(), MEMORY)?;
            reserve(&mut self.at_limit, state.at_limit.len(), MEMORY)?;
            self.violation = violation;
            self.p.clone_from(&state.p);
            self.contact.clone_from(&state.contact);
            self.at_limit.clone_from(&state.at_limit);
        }
        Ok(())
    }

    /// The state becomes the best iterate, with admissible pressures, the prescribed force and a fresh u = A p. With a prescribed
    /// approach p = 0 is an iterate, too, and none worse than that is returned.
    pub fn restore<S: AdmissibleSet>(
        &mut self,
        problem: &mut Problem,
        state: &mut State,
        set: S,
        monitor: &mut Monitor<'_>,
    ) {
        for (i, p) in state.p.iter_mut().enumerate() {
            // NaN is not less than anything.
            *p = if p.abs() < f64::INFINITY { *p } else { 0.0 };
            if S::LIMITED && state.at_limit[i] {
                *p = set.limit(i);
            }
        }
        let left = truncate(state, set);
        if left > 0 || state.u_is != Freshness::Exact {
            problem.refresh(state, set);
        }
        let now = violation(&Survey::of(state), set);
        let by_approach = matches!(state.load, Load::Approach(_));
        if self.violation < now || !(now <= f64::MAX) {
            if self.violation.is_finite() {
                state.p.copy_from_slice(&self.p);
                state.contact.copy_from_slice(&self.contact);
                state.at_limit.copy_from_slice(&self.at_limit);
            } else {
                state.p.fill(0.0);
                state.at_limit.fill(false);
            }
            problem.refresh(state, set);
        }
        let found = violation(&Survey::of(state), set);
        if by_approach && !(found <= 1.0) {
            state.p.fill(0.0);
            state.u.fill(0.0);
            if !S::FIXED {
                state.unload();
                state.start(problem.self_influence());
            }
        }
        monitor.count_products(problem.take_products(), problem.work);
    }
}
