//! The estimated discretisation errors of a solve: of its normal problem, and of its friction.

use super::estimates::{self, Curvature, Parts};
use super::options::Options;
use super::report::Report;
use super::tangential_estimates::{self, Solved};
use super::Solver;
use crate::progress::Monitor;
use crate::scene::Scene;

impl Solver {
    /// Writes the estimated errors of the report and the ledger. There are none in three cases: elements are at their pressure limit, which changes
    /// the pressures at the rim of the contact; coefficients are not symmetric; and the contact area is given.
    pub(super) fn estimate(
        &self,
        scene: &Scene<'_>,
        options: &Options,
        monitor: &mut Monitor<'_>,
        report: &mut Report,
    ) {
        if !self.problem.symmetric || options.is_fixed() || self.state.has_limited() {
            return;
        }
        let (seconds, ledger) = (monitor.seconds(), &mut monitor.ledger);
        let (rows, outline) = (&mut ledger.rows, &ledger.outline);
        let (problem, state) = (&self.problem, &self.state);
        let curvature = &Curvature::of(problem, state, outline);
        let parts = Parts::of(problem, state, curvature, outline);
        (report.limit, report.halving) =
            estimates::estimate(rows, (problem, state, outline), (curvature, parts), seconds);
        report.error = ledger.rows.last().map(|row| row.error).unwrap_or_default();
        let Some(tangent) = self.friction.as_deref() else { return };
        let found = (&scene.friction, &mut report.friction, tangent.solution());
        if let (Some(friction), Some(found), Some(solution)) = found {
            let (alike, coated) = (tangent.is_of_like_bodies(), tangent.is_of_coated_bodies());
            let solved = Solved { problem, state, outline, curvature, parts, friction, solution, alike, coated };
            found.error = tangential_estimates::estimate(&solved, found);
        }
    }
}
