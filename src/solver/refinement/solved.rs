//! The result on one grid.

use super::outlook::Outlook;
use crate::solver::quantities::Lack;
use crate::solver::{Report, Solver};

/// The result on one grid.
pub(super) struct Solved {
    pub(super) solver: Solver,
    pub(super) report: Report,
    pub(super) outlook: Outlook,
    /// Of the quantities that were asked for beside.
    pub(super) values: Vec<Result<f64, Lack>>,
    /// Whether nothing is estimated from one such grid: a limit is reached, or something attracts.
    pub(super) lacks_estimates: bool,
}

impl Solved {
    /// The largest relative residual.
    pub(super) fn residual(&self) -> f64 {
        let residual = self.report.measures.certificate.residual;
        self.report.friction.map_or(residual, |found| residual.max(found.certificate.residual))
    }
}
