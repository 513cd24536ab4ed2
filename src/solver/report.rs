//! The report of a solve: its results, their errors, and its cost.

use super::falling::Falling;
use super::Method;
use crate::adhesion;
use crate::friction;
use crate::grid::Grid;
use crate::progress::{Counters, DiscretisationError, Measures, Monitor, Outcome};
use crate::visco;

/// What limits the accuracy of a solution; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limit {
    /// Unknown: there is no estimate.
    #[default]
    Unknown,
    /// The grid: its error exceeds that of the residual. A smaller tolerance would not improve the accuracy.
    Grid,
    /// The tolerance: the error of the residual may exceed that of the grid.
    Tolerance,
}

/// Predicted cost and error with elements of half the size, if they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halving {
    /// Seconds of a solve, with the measured growth n^1.1 in the number of elements (docs/performance.md).
    pub seconds: Option<f64>,
    /// The error of the force, or of the approach if the force is prescribed, on this and finer grids.
    pub error: Option<Falling>,
}

impl Halving {
    /// The predicted error of the force, or of the approach if the force is prescribed, with elements of half the size.
    pub fn force(&self) -> Option<f64> {
        self.error.map(|error| error.after(1))
    }
}

/// Results and cost of a solve. [`Solver::ledger`](super::Solver::ledger) has them for each grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The counters of the finest grid.
    pub count: Counters,
    /// The result.
    pub measures: Measures,
    /// The estimated discretisation errors of the result.
    pub error: DiscretisationError,
    /// The tolerance of the solve: that of the options, or the one that follows from `error_ratio`.
    pub tolerance: f64,
    /// What limits the accuracy.
    pub limit: Limit,
    /// Predicted cost and error with elements of half the size.
    pub halving: Halving,
    /// Seconds of the set-up, in the first report after it. 0 in later reports.
    pub setup_seconds: f64,
    /// Seconds of the solve.
    pub solve_seconds: f64,
    /// The part of these seconds in which coefficients of coarser grids were set up.
    pub coarse_seconds: f64,
    /// Bytes held by operators and unknowns.
    pub bytes: u64,
    /// The report of the tangential problem, if the scene has friction.
    pub friction: Option<friction::Report>,
    /// The report of adhesion, if the scene has any.
    pub adhesion: Option<adhesion::Report>,
    /// The report of the step in time, if bodies relax.
    pub visco: Option<visco::Report>,
}

impl Report {
    /// A report from the counters of a solve and its last ledger row, that of the finest grid. It has no errors yet.
    pub(super) fn of(monitor: &Monitor<'_>, tolerance: f64) -> Report {
        let last = monitor.ledger.rows.last();
        let measures = last.map(|row| row.measures).unwrap_or_default();
        Report { count: monitor.count, measures, tolerance, ..Report::default() }
    }

    /// The number of products of the tangential problem, in work units. 0 without friction.
    pub(super) fn tangential_products(&self) -> f64 {
        self.friction.map_or(0.0, |found| found.products)
    }

    /// The larger of the relative residuals of the normal and the tangential problem.
    pub(super) fn residual(&self) -> f64 {
        let normal = self.measures.certificate.residual;
        self.friction.map_or(normal, |found| normal.max(found.certificate.residual))
    }

    /// Logs the summary of a solve.
    pub(super) fn log(&self, method: Method, grid: &Grid, outcome: Outcome) {
        let (Grid { mx, my, .. }, residual) = (grid, self.measures.certificate.residual);
        let Counters { cycles, work_units, .. } = self.count;
        log::info!(
            "{method:?} on {mx} x {my}: {outcome:?} after {cycles} cycles and {work_units:.1} work units, residual {residual:e}"
        );
        if log::log_enabled!(log::Level::Info) {
            self.advice().iter().for_each(|advice| log::info!("{advice}"));
        }
    }

    /// A sentence that tells what limits the accuracy, and what a finer grid would cost and gain. None if they are not known.
    pub fn advice(&self) -> Option<String> {
        let what = match self.limit {
            Limit::Unknown => return None,
            Limit::Grid => "the grid, not the tolerance,",
            Limit::Tolerance => "the tolerance, not the grid,",
        };
        let (seconds, force, error) = (self.halving.seconds?, self.halving.force()?, self.error.force?);
        Some(format!(
            "{what} limits this answer: halving the elements would cost about {seconds:.2e} s and bring the error of the force or \
             approach from {error:.2e} to {force:.2e}"
        ))
    }
}
