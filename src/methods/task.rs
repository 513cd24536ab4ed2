//! A problem on one grid, its unknowns, and the goal of its solution.

use crate::contact::{AdmissibleSet, Problem, State, Survey};
use crate::progress::{Goal, Monitor};

/// A problem on one grid, its unknowns, and the goal of its solution.
pub struct Task<'a, 'm, S> {
    /// The grid, the influence coefficients and the operator.
    pub problem: &'a mut Problem,
    /// The unknowns, and the undeformed distance.
    pub state: &'a mut State,
    /// The smallest undeformed distance; infinite if all elements are excluded.
    pub lowest: f64,
    /// The set of admissible pressures.
    pub set: S,
    /// The tolerance, the criterion and the largest number of cycles.
    pub goal: Goal,
    /// Counts products and cycles, reports progress, and asks whether the caller cancels.
    pub monitor: &'a mut Monitor<'m>,
}

impl<S: AdmissibleSet> Task<'_, '_, S> {
    /// Whether p carries the prescribed force up to round-off. True if the approach is prescribed.
    pub fn carries(&self) -> bool {
        self.state.carries(&self.problem.threads)
    }

    /// Computes the survey of the state, with the threads of the solve.
    pub fn survey(&self) -> Survey {
        Survey::by(self.state, &self.problem.threads)
    }

    /// Whether the caller has cancelled the solve, or all cycles are used up.
    pub fn is_interrupted(&self) -> bool {
        self.monitor.is_cancelled() || self.monitor.count.cycles >= self.goal.max_cycles
    }

    /// Adds the products on this grid since the last call to the monitor's count.
    pub fn count_products(&mut self) {
        self.monitor.count_products(self.problem.take_products(), self.problem.work);
    }
}
