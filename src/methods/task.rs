//! A problem on one grid and its goal.

use crate::contact::{AdmissibleSet, Problem, State, Survey};
use crate::progress::{Goal, Monitor};

/// A problem on one grid and its goal.
pub struct Task<'a, 'm, S> {
    /// The grid and the operator.
    pub problem: &'a mut Problem,
    /// The unknowns.
    pub state: &'a mut State,
    /// The least undeformed distance of the state; infinite if there is no surface.
    pub lowest: f64,
    /// The admissible pressures.
    pub set: S,
    /// The goal.
    pub goal: Goal,
    /// Counts products and reports progress.
    pub monitor: &'a mut Monitor<'m>,
}

impl<S: AdmissibleSet> Task<'_, '_, S> {
    /// Whether p carries a prescribed force.
    pub fn carries(&self) -> bool {
        self.state.carries(&self.problem.threads)
    }

    /// A survey of the state, by the threads of the solve.
    pub fn survey(&self) -> Survey {
        Survey::by(self.state, &self.problem.threads)
    }

    /// Whether the caller cancelled, or no cycle is left.
    pub fn is_interrupted(&self) -> bool {
        self.monitor.is_cancelled() || self.monitor.count.cycles >= self.goal.max_cycles
    }

    /// Counts the products on this grid since the last call.
    pub fn count_products(&mut self) {
        self.monitor.count_products(self.problem.take_products(), self.problem.work);
    }
}
