//! The iteration with a [law](super::law) or a layer that yields: the nearest solution by Newton's method, a branch by turns, and each where the
//! other one ends.

use super::certificate::Certificate;
use super::forces::Forces;
use super::law::{branch, stages, March, Place};
use super::levels::Level;
use super::request::Request;
use super::shift::{Goal, Memory};
use super::solution::Report;
use super::solver::Solver;
use super::window::Window;
use crate::effects::Branch;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;
use crate::progress::Outcome;

/// Products in vain are kept back for the end of a solve, and of one in turns.
const KEPT_BACK: u64 = 3;
const KEPT_BACK_OF_TURNS: u64 = 5;
/// Coulomb's law with the coefficients at rest is solved to this, where forces are given, before the iteration with the law begins.
const FIRST: f64 = 1e-2;
/// Names its memory in messages.
const KEPT: &str = "the tractions before turns";

impl Solver {
    /// Iterates on the finest grid from what it holds, where forces are given from the solution of Coulomb's law. The report gets the certificate
    /// and what that took.
    pub(super) fn iterate_with_law(
        &mut self,
        request: &Request<'_>,
        (window, forces, began): (Window, Forces, (bool, bool)),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let friction = request.friction;
        if forces.any() && !request.is_cancelled {
            let first = Request { tolerance: request.tolerance.max(FIRST), ..*request };
            let end = self.iterate(&first, forces, began, watch, report)?;
            if end == Outcome::Cancelled {
                let Level { problem, state, .. } = &self.levels[0];
                report.certificate = Certificate::of(problem, state);
                return Ok(end);
            }
        }
        let (law, had, scales) = (self.law(friction), self.had(friction), self.scales);
        let problem = &self.levels[0].problem;
        let width = problem.grid.mx;
        let element = |k: usize| window.row(&self.grid, k / width).start + k % width;
        let place = |k: usize| Place {
            pressure: if problem.bound[k] > 0.0 { scales.traction(request.pressure[element(k)]) } else { 0.0 },
            coefficient: friction.coefficient.at(element(k)),
        };
        let particle = |k: usize| self.scaled(had.at(element(k)));
        let by = friction.elements_rolled(&self.grid);
        let mut march = March::new((problem.grid, law), friction.motion, by, place, particle)?;
        let largest = (0..problem.bound.len()).map(|k| problem.bound[k]).fold(0.0, f64::max);
        report.law_slope = law.steepest(largest) * problem.operators.self_influence;
        if request.is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        if friction.branch != Branch::Near {
            return self.in_turns((request, began), &mut march, watch, report);
        }
        let outcome = self.nearest(request, (&mut march, forces, forces.any()), watch, report)?;
        // Turns contract where bounds follow slips by less than those relieve tractions.
        let rises =
            march.law.layer.map_or(0.0, |layer| layer.hardening) * self.levels[0].problem.operators.self_influence;
        let contracts = report.law_slope.max(rises) < 1.0 && !forces.any();
        if outcome != Outcome::Stagnated || !contracts || report.products >= request.limit as f64 {
            return Ok(outcome);
        }
        let outcome = self.try_turns((request, began), &mut march, watch, report)?;
        if outcome != Outcome::Stagnated || report.products >= request.limit as f64 {
            return Ok(outcome);
        }
        self.nearest(request, (&mut march, forces, true), watch, report)
    }

    /// The nearest solution, by the stages of Newton's method. `has_slipped`: what slips is that of the state.
    fn nearest(
        &mut self,
        request: &Request<'_>,
        (march, forces, has_slipped): (&mut March, Forces, bool),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let scales = self.scales;
        let Level { problem, state, memory, .. } = &mut self.levels[0];
        let Memory { tangent, fields, .. } = memory;
        let grid = scales.own_grid(&problem.grid);
        let limit = request.limit.saturating_sub(KEPT_BACK + report.products.ceil() as u64).max(1);
        let watch = &mut |residual: f64| watch(&grid, residual);
        let goal = Goal { tolerance: request.tolerance, limit, certified: true, watch };
        let ended = stages::solve(problem, state, (tangent, fields), (march, forces, has_slipped), goal)?;
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual: ended.residual, ..Certificate::of(problem, state) };
        Ok(ended.outcome)
    }

    /// Where the iteration for the nearest solution found none: turns, whose bounds follow the slips by as much as `law_slope` says, or the state that
    /// there is, if it is better.
    fn try_turns(
        &mut self,
        (request, began): (&Request<'_>, (bool, bool)),
        march: &mut March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let Level { problem, state, .. } = &self.levels[0];
        let kept = (collected(state.q.iter().copied(), KEPT)?, collected(problem.bound.iter().copied(), KEPT)?);
        let before = report.certificate;
        let outcome = self.in_turns((request, (false, began.1)), march, watch, report)?;
        let is_worse = !(report.certificate.residual < before.residual) && before.residual.is_finite();
        if outcome != Outcome::Converged && is_worse {
            let Level { problem, state, .. } = &mut self.levels[0];
            state.q.copy_from_slice(&kept.0);
            problem.bound.copy_from_slice(&kept.1);
            problem.refresh_unclipped(state);
            report.products += problem.take_products() as f64;
            report.certificate = before;
        }
        Ok(outcome)
    }

    /// The solution of a branch: Coulomb's problem with the bounds of the last slips, in turns.
    fn in_turns(
        &mut self,
        (request, (nested, had_slip)): (&Request<'_>, (bool, bool)),
        march: &mut March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let (mut turns, mut best) = (branch::Turns::new(), branch::Best::new(self.levels[0].problem.bound.len())?);
        branch::begin(&mut self.levels[0].problem, march, request.friction.branch == Branch::High);
        // The way to the best of them and onto the circles takes products, too.
        let most = request.limit.saturating_sub(KEPT_BACK_OF_TURNS).max(1);
        let (outcome, residual) = loop {
            let limit = most.saturating_sub(report.products.ceil() as u64).max(1);
            let turn = Request { tolerance: turns.inner(request.tolerance), limit, ..*request };
            let begin = (nested && turns.made == 0, had_slip || turns.made > 0);
            let end = self.iterate(&turn, Forces::NONE, begin, watch, report)?;
            let left = branch::renew(&mut self.levels[0], march, &mut best)?;
            let mut ended = match turns.end(left, request.tolerance) {
                _ if end == Outcome::Cancelled => Some(end),
                None if report.products >= most as f64 => Some(Outcome::IterationLimit),
                ended => ended,
            };
            if ended == Some(Outcome::Converged) {
                let residual = branch::certify(&mut self.levels[0], march);
                ended = match () {
                    () if residual < request.tolerance => break (Outcome::Converged, residual),
                    () if report.products >= most as f64 => Some(Outcome::IterationLimit),
                    () if turns.are_in_vain() => Some(Outcome::Stagnated),
                    // The rest on the way to the circles is more than the tolerance: another turn follows.
                    () => None,
                };
            }
            if let Some(outcome) = ended {
                best.restore(&mut self.levels[0], march)?;
                break (outcome, branch::certify(&mut self.levels[0], march));
            }
        };
        let Level { problem, state, .. } = &mut self.levels[0];
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual, ..Certificate::of(problem, state) };
        Ok(outcome)
    }
}
