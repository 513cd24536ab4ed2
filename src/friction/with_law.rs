//! A solve with a [law](super::law) or a layer that yields: in the units of the iterations, and what particles carry from step to step.

use super::certificate::Certificate;
use super::forces::Forces;
use super::law::{branch, stages, Law, March, Particle, Place};
use super::levels::Level;
use super::request::Request;
use super::shift::{Goal, Memory};
use super::solution::{Report, PLASTIC, SLIP};
use super::solver::Solver;
use super::sweep::{Rolling, Sweep};
use super::window::Window;
use crate::effects::{Branch, Friction, Motion, PlasticLayer, Previous};
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

/// The state of the particles before a step, on the whole grid, in the caller's units.
struct Had<'a> {
    friction: &'a Friction<'a>,
    kept: &'a [Particle],
    grid: Grid,
    /// How a step of transient rolling takes them along.
    sweep: Option<Sweep>,
}

impl Had<'_> {
    /// Of the particle that lies on element i after the step.
    fn at(&self, i: usize) -> Particle {
        if self.friction.motion == Motion::SteadyRolling {
            return self.fresh(i);
        }
        let Some(sweep) = &self.sweep else { return self.before(i) };
        let (x, y) = (i % self.grid.mx, i / self.grid.mx);
        let mut sum = self.times(sweep.own(), self.before(i));
        for &(in_x, in_y, weight) in sweep.neighbours() {
            let (jx, jy) = (x.wrapping_add_signed(in_x), y.wrapping_add_signed(in_y));
            let is_there = jx < self.grid.mx && jy < self.grid.my;
            let there = if is_there { self.before(jy * self.grid.mx + jx) } else { self.fresh(i) };
            let part = self.times(weight, there);
            sum.coefficient += part.coefficient;
            sum.yield_limit += part.yield_limit;
        }
        sum
    }

    fn times(&self, weight: f64, particle: Particle) -> Particle {
        Particle { coefficient: weight * particle.coefficient, yield_limit: weight * particle.yield_limit }
    }

    fn fresh(&self, i: usize) -> Particle {
        let yield_limit = self.friction.layer.map_or(0.0, |layer| layer.yield_limit);
        Particle { coefficient: self.friction.coefficient.at(i), yield_limit }
    }

    fn before(&self, i: usize) -> Particle {
        let kept = self.kept.get(i).copied().unwrap_or(self.fresh(i));
        Particle {
            coefficient: self.friction.coefficients_before.map_or(kept.coefficient, |of| of[i]),
            yield_limit: self.friction.yield_limits.map_or(kept.yield_limit, |of| of[i]),
        }
    }
}

impl Solver {
    /// The state of the particles at the end of the last step becomes that before this one.
    pub(super) fn keep_particles(&mut self) {
        self.particles_before.clone_from(&self.solution.particles);
    }

    /// The law in the units of the iterations.
    fn law(&self, friction: &Friction<'_>) -> Law {
        let ([displacement, _], duration) = (self.scales.own_displacement([1.0, 0.0]), friction.duration(&self.grid));
        let layer = friction.layer.map(|layer| PlasticLayer {
            yield_limit: self.scales.traction(layer.yield_limit),
            hardening: self.scales.traction(layer.hardening * displacement),
        });
        Law { fall: friction.law, layer, rate: displacement / duration, duration }
    }

    fn had<'a>(&'a self, friction: &'a Friction<'a>) -> Had<'a> {
        let grid = self.grid;
        let sweep = (friction.motion == Motion::TransientRolling).then(|| {
            let by = friction.elements_rolled(&grid);
            Sweep::new(&Rolling { distance: friction.distance(&grid), by })
        });
        let kept = if friction.previous == Previous::Kept { &self.particles_before[..] } else { &[] };
        Had { friction, kept, grid, sweep }
    }

    /// The state of the particle of element i before the step, in the units of the iterations.
    fn scaled(&self, particle: Particle) -> Particle {
        Particle { yield_limit: self.scales.traction(particle.yield_limit), ..particle }
    }

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
        if friction.branch != Branch::Near && !request.is_cancelled {
            return self.in_turns((request, began), march, watch, report);
        }
        let Level { problem, state, memory, .. } = &mut self.levels[0];
        let Memory { tangent, fields, .. } = memory;
        if request.is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        let grid = scales.own_grid(&problem.grid);
        let limit = request.limit.saturating_sub(KEPT_BACK + report.products.ceil() as u64).max(1);
        let tell = &mut |residual: f64| watch(&grid, residual);
        let goal = Goal { tolerance: request.tolerance, limit, certified: true, watch: tell };
        let ended = stages::solve(problem, state, (tangent, fields), (&mut march, forces), goal)?;
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual: ended.residual, ..Certificate::of(problem, state) };
        // Turns contract where bounds follow slips by less than those relieve tractions.
        let rises = march.law.layer.map_or(0.0, |layer| layer.hardening) * problem.operators.self_influence;
        let contracts = report.law_slope.max(rises) < 1.0 && !forces.any();
        if ended.outcome != Outcome::Stagnated || !contracts || report.products >= request.limit as f64 {
            return Ok(ended.outcome);
        }
        self.try_turns((request, began), march, watch, report)
    }

    /// Where the iteration for the nearest solution found none: turns, whose bounds follow the slips by as much as `law_slope` says, or the state that
    /// there is, if it is better.
    fn try_turns(
        &mut self,
        (request, began): (&Request<'_>, (bool, bool)),
        march: March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let Level { problem, state, .. } = &self.levels[0];
        let kept = (collected(state.q.iter().copied(), KEPT)?, collected(problem.bound.iter().copied(), KEPT)?);
        let before = report.certificate;
        let outcome = self.in_turns((request, (false, began.1)), march, watch, report)?;
        if outcome != Outcome::Converged && !(report.certificate.residual < before.residual) {
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
        mut march: March,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let (mut turns, mut best) = (branch::Turns::new(), branch::Best::new(self.levels[0].problem.bound.len())?);
        branch::begin(&mut self.levels[0].problem, &mut march, request.friction.branch == Branch::High);
        // The way to the best of them and onto the circles takes products, too.
        let most = request.limit.saturating_sub(KEPT_BACK_OF_TURNS).max(1);
        let (outcome, residual) = loop {
            let limit = most.saturating_sub(report.products.ceil() as u64).max(1);
            let turn = Request { tolerance: turns.inner(request.tolerance), limit, ..*request };
            let begin = (nested && turns.made == 0, had_slip || turns.made > 0);
            let end = self.iterate(&turn, Forces::NONE, begin, watch, report)?;
            let left = branch::renew(&mut self.levels[0], &mut march, &mut best)?;
            let mut ended = match turns.end(left, request.tolerance) {
                _ if end == Outcome::Cancelled => Some(end),
                None if report.products >= most as f64 => Some(Outcome::IterationLimit),
                ended => ended,
            };
            if ended == Some(Outcome::Converged) {
                let residual = branch::certify(&mut self.levels[0], &mut march);
                ended = match () {
                    () if residual < request.tolerance => break (Outcome::Converged, residual),
                    () if report.products >= most as f64 => Some(Outcome::IterationLimit),
                    () if turns.are_in_vain() => Some(Outcome::Stagnated),
                    // The rest on the way to the circles is more than the tolerance: another turn follows.
                    () => None,
                };
            }
            if let Some(outcome) = ended {
                best.restore(&mut self.levels[0], &mut march)?;
                break (outcome, branch::certify(&mut self.levels[0], &mut march));
            }
        };
        let Level { problem, state, .. } = &mut self.levels[0];
        report.products += problem.take_products() as f64;
        report.certificate = Certificate { residual, ..Certificate::of(problem, state) };
        Ok(outcome)
    }

    /// Room for what particles carry after the step, and what they had before; none without a law and a layer.
    pub(super) fn march(&self, friction: &Friction<'_>, pressure: &[f64]) -> Result<Option<(March, Vec<Particle>)>> {
        if friction.law.is_none() && friction.layer.is_none() {
            return Ok(None);
        }
        let (law, scales, had) = (self.law(friction), self.scales, self.had(friction));
        let place = |i: usize| Place {
            pressure: scales.traction(pressure[i].max(0.0)),
            coefficient: friction.coefficient.at(i),
        };
        let by = friction.elements_rolled(&self.grid);
        let march = March::new((self.grid, law), friction.motion, by, place, |i| self.scaled(had.at(i)))?;
        let particles = collected((0..self.grid.len()).map(|_| Particle::default()), "what particles carry")?;
        Ok(Some((march, particles)))
    }

    /// The state of the particles after the step, and the elements that the layer bounds.
    pub(super) fn write_particles(&mut self, march: Option<(March, Vec<Particle>)>) {
        let (solution, scales) = (&mut self.solution, self.scales);
        let Some((mut march, mut particles)) = march else { return solution.particles.clear() };
        let law = march.law;
        march.go(|i, place, had| {
            // Elements without friction are those outside of contact for particles, as in the iteration.
            let slips = solution.stick_slip[i] == SLIP && place.coefficient > 0.0;
            let [x, y] = if slips { scales.displacement(solution.slip[i]) } else { [0.0; 2] };
            let response = law.at(x.hypot(y), place, had);
            if slips && response.yields {
                solution.stick_slip[i] = PLASTIC;
            }
            let Particle { coefficient, yield_limit } = response.particle;
            particles[i] = Particle { coefficient, yield_limit: scales.own_traction([yield_limit, 0.0])[0] };
            response.particle
        });
        solution.particles = particles;
    }
}
