//! What a solve found, what it cost, and what it knew when.

use crate::contact::{Certificate, State, Survey};
use crate::scene::Load;

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The certificate holds.
    Converged,
    /// `max_cycles` was reached.
    IterationLimit,
    /// The progress callback said so.
    Cancelled,
    /// No further progress: the method does not converge on this scene, or round-off is reached.
    Stagnated,
}

/// The state of affairs on one grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// How well the conditions hold.
    pub certificate: Certificate,
    /// The approach.
    pub approach: f64,
    /// `sum of p dx dy`.
    pub force: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// Elements in contact.
    pub contact_count: usize,
    /// Those of them on the first or last row or column of the grid.
    pub edge_count: usize,
    /// Their area.
    pub contact_area: f64,
    /// The same, corrected for the elements along the outline; negative when errors are not estimated.
    pub corrected_area: f64,
}

impl Measures {
    /// Measures a state whose u is A p; without the corrected area.
    pub fn of(state: &State) -> Measures {
        let survey = Survey::of(state);
        Measures {
            certificate: survey.certificate(),
            approach: state.approach,
            force: survey.pressures * state.grid.element_area(),
            max_pressure: survey.range.1.max(0.0),
            contact_count: survey.contact_count,
            edge_count: state.edge_count(),
            contact_area: survey.contact_count as f64 * state.grid.element_area(),
            corrected_area: -1.0,
        }
    }

    /// What the load does not prescribe: the force or the approach.
    pub fn found(&self, load: Load) -> f64 {
        match load {
            Load::Approach(_) => self.force,
            Load::Force(_) => self.approach,
        }
    }
}

/// Estimated errors (module `estimates`). Negative: not known, because it was not asked for, or there are no coarser grids, or, with
/// its bit in `untrusted`, because the values on the coarser grids do not converge as an estimate needs them to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscretisationError {
    /// Of the force (of the approach, when the force is prescribed).
    pub force: f64,
    /// Of the largest pressure.
    pub max_pressure: f64,
    /// Of the contact area by counting elements.
    pub contact_area: f64,
    /// Of the corrected contact area.
    pub corrected_area: f64,
    /// Of the pressures: rms of the error over that of p.
    pub pressure: f64,
    /// Bits: see [`DiscretisationError::FORCE`] and the following.
    pub untrusted: u32,
}

impl DiscretisationError {
    /// In `untrusted`: the error of the force or the approach.
    pub const FORCE: u32 = 1;
    /// Of the largest pressure.
    pub const MAX_PRESSURE: u32 = 2;
    /// Of the pressures.
    pub const PRESSURE: u32 = 4;
}

impl Default for DiscretisationError {
    fn default() -> DiscretisationError {
        let unknown = -1.0;
        DiscretisationError {
            force: unknown,
            max_pressure: unknown,
            contact_area: unknown,
            corrected_area: unknown,
            pressure: unknown,
            untrusted: 0,
        }
    }
}

/// What limits the accuracy of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limit {
    /// Not known.
    #[default]
    Unknown,
    /// The grid: a smaller tolerance would change nothing.
    Grid,
    /// The tolerance: the residual may hide an error larger than that of the grid.
    Tolerance,
}

/// What elements of half the size would cost and bring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halving {
    /// Seconds of a solve, at the growth of the time with the number of elements that was measured: n^1.13 (docs/performance.md).
    pub seconds: f64,
    /// Error of the force (or the approach) that would be left.
    pub force: f64,
}

impl Default for Halving {
    fn default() -> Halving {
        Halving { seconds: -1.0, force: -1.0 }
    }
}

/// One row of the ledger: what was known on one grid, and what it had cost by then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgerRow {
    /// Elements in x.
    pub mx: usize,
    /// Elements in y.
    pub my: usize,
    /// Cycles on this grid.
    pub cycles: u64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since then: products, each weighted by its elements over those of the finest grid.
    pub work_units: f64,
    /// What was known.
    pub measures: Measures,
    /// And how far it was off.
    pub error: DiscretisationError,
}

/// What a solve found and what it cost; grid by grid: [`Solver::ledger`](super::Solver::ledger).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Cycles (of multigrid) or iterations (of conjugate gradients) on the finest grid.
    pub cycles: u64,
    /// Elements that entered or left the contact area on the finest grid, in all.
    pub active_set_changes: u64,
    /// Active-set steps on the finest grid.
    pub active_set_steps: u64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// Products on the finest grid.
    pub matrix_products: u64,
    /// Products on all grids, in products on the finest.
    pub work_units: f64,
    /// The result.
    pub measures: Measures,
    /// And how far it is off.
    pub error: DiscretisationError,
    /// What limits the accuracy.
    pub limit: Limit,
    /// What the next finer grid would bring; negative: not known.
    pub halving: Halving,
    /// Seconds of set-up: 0 when the solver was set up before.
    pub setup_seconds: f64,
    /// Seconds of the solve.
    pub solve_seconds: f64,
    /// Bytes held by operators and unknowns.
    pub bytes: u64,
    /// The tolerance that the stop speaks of: that of the options, or a larger one where `error_ratio` allows it.
    pub tolerance: f64,
}

impl Report {
    /// What limits the answer, and what a finer grid would bring; none when it is not known.
    pub fn advice(&self) -> Option<String> {
        let what = match self.limit {
            Limit::Unknown => return None,
            Limit::Grid => "the grid, not the tolerance,",
            Limit::Tolerance => "the tolerance, not the grid,",
        };
        let Halving { seconds, force } = self.halving;
        let error = self.error.force;
        Some(format!(
            "{what} limits this answer: halving the elements would cost about {seconds:.2e} s and bring the error of the force or \
             approach from {error:.2e} to {force:.2e}"
        ))
    }
}
