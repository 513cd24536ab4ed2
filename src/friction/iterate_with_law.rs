//! The iteration with a [law](super::law) or a yielding layer: the nearest solution by Newton's method, in alternation
//! with turns if that fails; a branch by turns.

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

/// With given forces: tolerance of the first solve, of Coulomb's law with the coefficients at rest.
const FIRST_TOLERANCE: f64 = 1e-2;

/// The ratio of the residuals at which Newton's method is tried again.
const TURNS_RESIDUAL_RATIO: f64 = 0.1;
/// The name of this memory in messages.
const KEPT: &str = "the tractions before turns";

/// A state of the finest grid.
struct Kept {
    q: Vec<Vector>,
    bound: Vec<f64>,
    certificate: Certificate,
}

impl Kept {
    fn is_better(&self, other: &Kept) -> bool {
        self.certificate.residual < other.certificate.residual || !other.certificate.residual.is_finite()
    }
}

impl Solver {
    /// Iterates on the finest grid from its state, with given forces from the solution of Coulomb's law. Writes certificate and products to the
    /// report.
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
            // The coarser result is that of Coulomb's law.
            report.coarser = None;
            if end == Outcome::Cancelled {
                let Level { problem, state, .. } = &self.levels[0];
                report.certificate = Certificate::of(problem, state);
                return Ok(end);
            }
        }
        let (law, had, scales) = (self.law(friction), self.had(friction, &self.particles_before), self.scales);
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
        slope::measure(&mut march, |k| problem.operators.influence_on_itself(k))?;
        report.law_slope = march.falls;
        if request.is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        // Where no bound falls there is one solution.
        if friction.branch != Branch::Near && march.falls > 0.0 {
            return self.in_turns((request, began), (&mut march, true), watch, report);
        }
        let outcome = self.nearest(request, (&mut march, forces, forces.any()), watch, report)?;
        if outcome != Outcome::Stagnated || forces.any() || report.products >= request.limit as f64 {
            return Ok(outcome);
        }
        self.alternate((request, began.1), &mut march, watch, report)
    }

    /// After Newton's method found no solution: turns of the branch LOW down to [`NEWTON_RESIDUAL`](stages::NEWTON_RESIDUAL), then Newton's
    /// method from there. If this fails, the next turns go ten times as far, and so on. Ends with the best state if all
    /// fail.
    fn alternate(
        &mut self,
        (request, mostly_slips): (&Request<'_>, bool),
        march: &mut March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let (mut best, mut aim, mut begins) =
            (self.keep(report)?, stages::NEWTON_RESIDUAL.max(request.tolerance), true);
        loop {
            let turns = Request { tolerance: aim, ..*request };
            let turned = self.in_turns((&turns, (false, mostly_slips)), (march, begins), watch, report)?;
            let kept = self.keep(report)?;
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
                best = if kept.is_better(&best) { kept } else { best };
                if end != Outcome::Converged && best.certificate.residual < report.certificate.residual {
                    self.put_back(&best, report);
                }
                return Ok(end);
            }
            let last = self.keep(report)?;
            best = if last.is_better(&best) { last } else { best };
            self.put_back(&kept, report);
            best = if kept.is_better(&best) { kept } else { best };
            (aim, begins) = ((TURNS_RESIDUAL_RATIO * aim).max(request.tolerance), false);
        }
    }

    /// A copy of the finest grid's state.
    fn keep(&self, report: &Report) -> Result<Kept> {
        let Level { problem, state, .. } = &self.levels[0];
        let (q, bound) = (copied(&state.q, KEPT)?, copied(&problem.bound, KEPT)?);
        Ok(Kept { q, bound, certificate: report.certificate })
    }

    fn put_back(&mut self, kept: &Kept, report: &mut Report) {
        let Level { problem, state, .. } = &mut self.levels[0];
        state.q.copy_from_slice(&kept.q);
        problem.bound.copy_from_slice(&kept.bound);
        problem.refresh_unclipped(state);
        report.products += problem.take_products() as f64;
        report.certificate = kept.certificate;
    }

    /// The nearest solution, by the stages of Newton's method. `has_slipped`: the slip area is that of the state.
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

    /// The solution of a branch: Coulomb's problem with the bounds of the last slips, in turns. `begins`: from the bounds of the branch, else from
    /// the present ones.
    fn in_turns(
        &mut self,
        (request, (nested, mostly_slips)): (&Request<'_>, (bool, bool)),
        (march, begins): (&mut March, bool),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let (mut turns, mut best) = (branch::Turns::new(), branch::Best::new(self.levels[0].problem.bound.len())?);
        if begins {
            branch::begin(&mut self.levels[0].problem, march, request.friction.branch == Branch::High);
        }
        // The return to the best turn and onto the circles takes products as well.
        let most = request.limit.saturating_sub(KEPT_BACK).max(1);
        let (outcome, residual) = loop {
            let limit = most.saturating_sub(report.products.ceil() as u64).max(1);
            let turn = Request { tolerance: turns.inner(request.tolerance), limit, ..*request };
            let begin = (nested && turns.made == 0, mostly_slips || turns.made > 0);
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
                    // The residual after the step onto the circles exceeds the tolerance: another turn follows.
                    () => None,
                };
            }
            if let Some(outcome) = ended {
                best.restore(&mut self.levels[0], march)?;
                break (outcome, branch::certify(&mut self.levels[0], march));
            }
            branch::go_on(&mut self.levels[0], march, (&turns, &best));
        };
        let Level { problem, state, .. } = &mut self.levels[0];
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual, ..Certificate::of(problem, state) };
        Ok(outcome)
    }
}
