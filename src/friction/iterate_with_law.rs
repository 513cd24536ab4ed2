//! The iteration with a [law](super::law) of friction or a yielding layer, if the problem may have several solutions.
//!
//! The solution near the start is found by the stages of Newton's method ([`stages`]), in alternation with turns if that fails. The solutions LOW and
//! HIGH are found by turns ([`branch`]): a turn solves Coulomb's problem with bounds from the slips of the turn before.

use super::certificate::Certificate;
use super::forces::Forces;
use super::law::{branch, slope, stages, March, Place};
use super::levels::Level;
use super::nested::KEPT_BACK;
use super::plane::Vector;
use super::request::Request;
use super::shift::{Goal, Memory};
use super::solution::Report;
use super::solver::Solver;
use crate::effects::Branch;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::copied;
use crate::progress::Outcome;
use crate::rectangle::Rectangle;

/// With given forces the iteration starts from the solution of Coulomb's law with the coefficients at rest, to this tolerance.
const FIRST_TOLERANCE: f64 = 1e-2;

/// If Newton's method fails again, the next turns reduce the residual to this times that of the turns before.
const TURNS_RESIDUAL_RATIO: f64 = 0.1;
/// The name of this memory in messages.
const KEPT: &str = "the tractions before turns";

/// A copy of the finest grid's state.
struct StateCopy {
    q: Vec<Vector>,
    bound: Vec<f64>,
    certificate: Certificate,
}

impl StateCopy {
    /// Whether this state has the smaller residual.
    fn is_better(&self, other: &StateCopy) -> bool {
        self.certificate.residual < other.certificate.residual || !other.certificate.residual.is_finite()
    }
}

impl Solver {
    /// Iterates on the finest grid from its state, or with given forces from the solution of Coulomb's law. Writes the certificate, the slope of the
    /// law and the products to the report.
    pub(super) fn iterate_with_law(
        &mut self,
        request: &Request<'_>,
        (window, forces, began): (&Rectangle, Forces, (bool, bool)),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let friction = request.friction;
        if forces.any() && !request.is_cancelled {
            let first = Request { tolerance: request.tolerance.max(FIRST_TOLERANCE), ..*request };
            let end = self.iterate(&first, forces, began, watch, report)?;
            // The result of the coarser grid is that of Coulomb's law, which does not serve estimates.
            report.coarser = None;
            if end == Outcome::Cancelled {
                let Level { problem, state, .. } = &self.levels[0];
                report.certificate = Certificate::of(problem, state);
                return Ok(end);
            }
        }
        let (law, before, scales) =
            (self.law(friction), self.particles_before_step(friction, &self.particles_before), self.scales);
        let problem = &self.levels[0].problem;
        let width = problem.grid.mx;
        let element = |k: usize| window.row(&self.grid, k / width).start + k % width;
        let place = |k: usize| Place {
            pressure: if problem.bound[k] > 0.0 { scales.traction(request.pressure[element(k)]) } else { 0.0 },
            coefficient: friction.coefficient.at(element(k)),
        };
        let particle = |k: usize| self.scaled(before.at(element(k)));
        let by = friction.elements_rolled(&self.grid);
        let mut march = March::new((problem.grid, law), friction.motion, by, place, particle)?;
        slope::measure(&mut march, |k| problem.operators.influence_on_itself(k))?;
        report.law_slope = march.falls;
        if request.is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        // If no bound falls with the slip, there is one solution, whatever branch is wanted.
        if friction.branch != Branch::Near && march.falls > 0.0 {
            return self.in_turns((request, began), (&mut march, true), watch, report);
        }
        let outcome = self.nearest(request, (&mut march, forces, forces.any()), watch, report)?;
        if outcome != Outcome::Stagnated || forces.any() || report.products >= request.limit as f64 {
            return Ok(outcome);
        }
        self.alternate((request, began.1), &mut march, watch, report)
    }

    /// Alternates turns and Newton's method, after Newton's method alone found no solution. The first turns are those of the branch LOW, down to the
    /// residual [`NEWTON_RESIDUAL`](stages::NEWTON_RESIDUAL). Newton's method follows from there. If it fails, the turns continue from where they
    /// ended, down to a tenth of their last residual, and so on. If all fail, the state with the least residual is the result.
    fn alternate(
        &mut self,
        (request, mostly_slips): (&Request<'_>, bool),
        march: &mut March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let (mut best, mut aim, mut begins) =
            (self.copy_state(report)?, stages::NEWTON_RESIDUAL.max(request.tolerance), true);
        loop {
            let turns = Request { tolerance: aim, ..*request };
            let turned = self.in_turns((&turns, (false, mostly_slips)), (march, begins), watch, report)?;
            let after_turns = self.copy_state(report)?;
            let is_open = |end: Outcome, report: &Report| match end {
                Outcome::Converged => !(report.certificate.residual < request.tolerance),
                Outcome::Stagnated => report.products < request.limit as f64,
                _ => false,
            };
            let mut end = turned;
            if is_open(turned, report) {
                end = self.nearest(request, (march, Forces::NONE, true), watch, report)?;
            }
            let is_over = turned == Outcome::Stagnated || aim <= request.tolerance;
            if is_over || !is_open(end, report) {
                best = if after_turns.is_better(&best) { after_turns } else { best };
                if end != Outcome::Converged && best.certificate.residual < report.certificate.residual {
                    self.restore_state(&best, report);
                }
                return Ok(end);
            }
            let after_newton = self.copy_state(report)?;
            best = if after_newton.is_better(&best) { after_newton } else { best };
            self.restore_state(&after_turns, report);
            best = if after_turns.is_better(&best) { after_turns } else { best };
            (aim, begins) = ((TURNS_RESIDUAL_RATIO * aim).max(request.tolerance), false);
        }
    }

    /// Copies the state of the finest grid.
    fn copy_state(&self, report: &Report) -> Result<StateCopy> {
        let Level { problem, state, .. } = &self.levels[0];
        let (q, bound) = (copied(&state.q, KEPT)?, copied(&problem.bound, KEPT)?);
        Ok(StateCopy { q, bound, certificate: report.certificate })
    }

    /// Restores the state of the finest grid from a copy, with fresh displacements.
    fn restore_state(&mut self, copy: &StateCopy, report: &mut Report) {
        let Level { problem, state, .. } = &mut self.levels[0];
        state.q.copy_from_slice(&copy.q);
        problem.bound.copy_from_slice(&copy.bound);
        problem.refresh_unclipped(state);
        report.products += problem.take_products() as f64;
        report.certificate = copy.certificate;
    }

    /// Finds the solution near the start by the stages of Newton's method. If `has_slipped`, the first slip area is that of the state; otherwise no
    /// element slips at first.
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
        let grid = scales.callers_grid(&problem.grid);
        let limit = request.limit.saturating_sub(KEPT_BACK + report.products.ceil() as u64).max(1);
        let watch = &mut |residual: f64| watch(&grid, residual);
        let goal = Goal { tolerance: request.tolerance, limit, certified: true, watch };
        let ended = stages::solve(problem, state, (tangent, fields), (march, forces, has_slipped), goal)?;
        report.products += problem.take_products() as f64;
        let missing = forces.missing(problem, &state.q);
        report.certificate = Certificate { residual: ended.residual.max(missing), ..Certificate::of(problem, state) };
        Ok(ended.outcome)
    }

    /// Finds the solution of a branch in turns, each of which solves Coulomb's problem with the bounds of the last slips. If `begins`, the first
    /// bounds are those of the branch, otherwise the present ones.
    fn in_turns(
        &mut self,
        (request, (nested, mostly_slips)): (&Request<'_>, (bool, bool)),
        (march, begins): (&mut March, bool),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let mut turns = branch::Turns::new();
        let mut best = branch::BestTurn::new(self.levels[0].problem.bound.len())?;
        if begins {
            branch::begin(&mut self.levels[0].problem, march, request.friction.branch == Branch::High);
        }
        // Some products are reserved for the return to the best turn and the step onto the circles.
        let most = request.limit.saturating_sub(KEPT_BACK).max(1);
        let (outcome, residual) = loop {
            let limit = most.saturating_sub(report.products.ceil() as u64).max(1);
            let turn = Request { tolerance: turns.inner(request.tolerance), limit, ..*request };
            let begin = (nested && turns.made == 0, mostly_slips || turns.made > 0);
            let end = self.iterate(&turn, Forces::NONE, begin, watch, report)?;
            let residual = branch::renew(&mut self.levels[0], march, &mut best)?;
            let mut ended = match turns.end(residual, request.tolerance) {
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
                    // The residual after the step onto the circles exceeds the tolerance: another turn follows.
                    () => None,
                };
            }
            if let Some(outcome) = ended {
                best.restore(&mut self.levels[0], march)?;
                break (outcome, branch::certify(&mut self.levels[0], march));
            }
            branch::set_bounds(&mut self.levels[0], march, (&turns, &best));
        };
        let Level { problem, state, .. } = &mut self.levels[0];
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual, ..Certificate::of(problem, state) };
        Ok(outcome)
    }
}
