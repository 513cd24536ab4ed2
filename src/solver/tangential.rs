//! Friction, after the normal problem: the tangential problem with its pressures, and for unlike bodies both in turns.

use super::unlike_bodies::UnlikeBodies;
use super::{Options, Outcome};
use crate::error::{Error, Result};
use crate::friction::{
    Compliance, CrossTables, Last, Particle, Report, Request, Solution, Solver, Source, Start, Tangential, Vector,
};
use crate::grid::Grid;
use crate::operator::Precision;
use crate::progress::Monitor;
use crate::scene::{Friction, Prescribed, Scene};
use crate::threads::Threads;

/// If the prescribed force exceeds the traction bounds of the pressures, the problem is solved for this part of the largest
/// force within them. Nearly all elements slip then, and the next pressures carry the force of full slip to 1e-4
/// (tests/friction/unlike_forces.rs).
const IN_REACH: f64 = 1.0 - 1e-7;

/// The state of a solver for scenes with friction.
pub struct Tangent {
    solver: Solver,
    /// The coupling of unlike bodies.
    unlike: Option<UnlikeBodies>,
}

/// A step of another solver, from which friction may continue.
pub(crate) struct StepBefore {
    pub traction: Vec<Vector>,
    pub particles: Vec<Particle>,
    /// The pressures of the step, for unlike bodies.
    pub pressure: Option<Vec<f64>>,
}

/// The constant inputs of turns of the normal and the tangential problem.
pub struct Turn<'a> {
    /// The scene, with its own undeformed distance.
    pub scene: &'a Scene<'a>,
    /// The friction of the scene.
    pub friction: &'a Friction<'a>,
    /// The options.
    pub options: &'a Options,
    /// The threads.
    pub threads: &'a Threads,
}

impl<'a> Turn<'a> {
    /// The start: the caller's tractions, or those before the step.
    pub fn start(&self) -> Start<'a> {
        self.friction.initial.map_or(Start::Before, Start::Given)
    }
}

/// The coupling of the tractions of a scene with its pressures; none for like bodies.
fn coupling(scene: &Scene<'_>) -> Result<Option<Source>> {
    Ok(match scene.friction.as_ref().and_then(|friction| friction.influence) {
        Some(own) => CrossTables::new(&own)?.map(Source::Tables),
        None => Some(Compliance::of(&scene.bodies).unlike).filter(|unlike| *unlike != 0.0).map(Source::HalfSpace),
    })
}

/// Whether tractions change the pressures of a scene.
pub fn is_of_unlike_bodies(scene: &Scene<'_>) -> Result<bool> {
    Ok(coupling(scene)?.is_some())
}

impl Tangent {
    /// The tangential problem of a scene's grid and bodies.
    pub fn new(scene: &Scene<'_>, options: &Options, threads: &Threads) -> Result<Tangent> {
        let Grid { dx, dy, .. } = scene.grid;
        let own = scene.friction.as_ref().and_then(|friction| friction.influence);
        let plain = scene.plain();
        let coating = match (&own, &scene.coating) {
            (None, Some(coating)) => coating.of_both(&plain)?.map(|coat| (coat, coating.at_surface(&plain))),
            _ => None,
        };
        let below = Compliance::of(&scene.bodies);
        let tangential = match (&own, coating) {
            (Some(own), _) => Tangential::of_tables(dx, dy, own)?,
            (None, Some((coat, surface))) => Tangential::of_coated(dx, dy, Compliance::of(&surface), (coat, below)),
            (None, None) => Tangential::new(dx, dy, below),
        };
        let solver = Solver::new(scene.grid, tangential, options.precision != Precision::Double, threads);
        let unlike = coupling(scene)?.map(|source| UnlikeBodies::new(&scene.grid, source, threads));
        Ok(Tangent { solver, unlike: unlike.transpose()? })
    }

    /// The last result.
    pub fn solution(&self) -> Option<&Solution> {
        self.solver.solution()
    }

    /// The last result, or an empty one.
    pub(super) fn into_solution(self) -> Solution {
        self.solver.into_solution()
    }

    /// Takes over the last result of `other`, which has other coefficients.
    pub fn with_last_of(mut self, mut other: Tangent) -> Tangent {
        self.solver.take_last_of(&mut other.solver);
        if let (Some(unlike), Some(before)) = (&mut self.unlike, &mut other.unlike) {
            unlike.take_last_of(before);
        }
        self
    }

    /// Whether tractions do not change the pressures.
    pub fn is_of_like_bodies(&self) -> bool {
        self.unlike.is_none()
    }

    /// Whether both bodies have a coating.
    pub fn is_of_coated_bodies(&self) -> bool {
        self.solver.tangential().is_coated()
    }

    /// The pressures of the last step; none for like bodies.
    pub fn pressures_before(&self) -> Option<&[f64]> {
        self.last_step().and(self.unlike.as_ref()).map(UnlikeBodies::last_pressure)
    }

    /// Takes a step of another solver.
    pub fn take_step(&mut self, step: StepBefore) -> Result<()> {
        step.pressure.iter().for_each(|pressure| self.keep_pressures(pressure));
        self.solver.take_step(step.traction, step.particles)
    }

    /// Records a solve without friction: its result has no tractions, and those of the last step stay.
    pub fn pass_over(&mut self) {
        self.solver.pass_over();
    }

    /// The last step, from which another one may continue.
    pub fn last_step(&self) -> Option<&Solution> {
        self.solver.last_step()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.solver.bytes() + self.unlike.as_ref().map_or(0, UnlikeBodies::bytes)
    }

    /// Solves the tangential problem with pressures; `again`: the same step with other pressures.
    pub fn solve(
        &mut self,
        turn: &Turn<'_>,
        pressure: &[f64],
        again: bool,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        self.solve_from(if again { Start::Again } else { turn.start() }, turn, pressure, monitor)
    }

    pub(super) fn solve_from(
        &mut self,
        start: Start<'_>,
        turn: &Turn<'_>,
        pressure: &[f64],
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        if let Some(unlike) = &mut self.unlike {
            unlike.displace_sideways(&turn.scene.grid, turn.friction, pressure, turn.threads)?;
        }
        let request = Request {
            limit: turn.options.max_cycles as u64,
            sideways: self.unlike.as_ref().map(UnlikeBodies::sideways),
            start,
            is_cancelled: monitor.is_cancelled(),
            estimates: turn.options.estimates,
            ..Request::new(pressure, turn.friction, turn.options.tolerance)
        };
        self.solver.solve(&request, &mut |grid, residual| monitor.uncounted_done(grid, residual))
    }

    /// Solves with the pressures of a normal problem that ended with `outcome`. If it did not converge, or is to be solved again for unlike bodies,
    /// its pressures may be too small for the forces. Then the forces are [a little less](IN_REACH) than the pressures carry, and the refusal is returned
    /// as well.
    pub fn solve_after(
        &mut self,
        outcome: Outcome,
        turn: &Turn<'_>,
        pressure: &[f64],
        start: Start<'_>,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report, Option<Error>)> {
        match self.solve_from(start, turn, pressure, monitor) {
            Err(refusal @ Error::Infeasible(_)) if outcome != Outcome::Converged || self.unlike.is_some() => {
                let request = Request { start, ..Request::new(pressure, turn.friction, turn.options.tolerance) };
                let part = IN_REACH * self.solver.part_in_reach(&request)?;
                let in_reach = |prescribed: Prescribed| match prescribed {
                    Prescribed::Force(force) => Prescribed::Force(part * force),
                    given => given,
                };
                let friction = Friction { prescribed: turn.friction.prescribed.map(in_reach), ..*turn.friction };
                let turn = Turn { friction: &friction, ..*turn };
                let (ended, report) = self.solve_from(start, &turn, pressure, monitor)?;
                Ok((ended, report, Some(refusal)))
            }
            found => found.map(|(ended, report)| (ended, report, None)),
        }
    }

    /// The excess of the last forces over the given ones, and the creepages found with them, times the length rolled.
    pub fn excess(&self, friction: &Friction<'_>, found: &Report) -> (Vector, Vector) {
        (self.solver.excess(friction, found), self.solver.offset())
    }

    /// The displacement by the tractions of full slip at the pressures of the last result.
    pub fn full_displacement(&self) -> f64 {
        self.solver.full_displacement()
    }

    /// Adds the displacements along the normal by the last tractions to an undeformed distance: none for like bodies.
    pub fn displace(&mut self, distance: &mut [f64]) {
        if let (Some(unlike), Some(solution)) = (&mut self.unlike, self.solver.solution()) {
            unlike.displace(&solution.traction, distance);
        }
    }

    /// The parts of the linearised problem of unlike bodies: see [`UnlikeBodies`] and [`Solver::change`]. None for like bodies.
    pub fn both(&mut self) -> Option<(&mut Solver, &mut UnlikeBodies)> {
        Some((&mut self.solver, self.unlike.as_mut()?))
    }

    /// Keeps the pressures of a finished step for the next one.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        if let Some(unlike) = &mut self.unlike {
            unlike.keep_pressures(p);
        }
    }

    /// A copy of the last result, to [restore](Tangent::go_back) it; none for like bodies, whose result is replaced only by a completed solve.
    pub fn last(&self) -> Result<Option<Last>> {
        match self.unlike {
            Some(_) => self.solver.last(),
            None => Ok(None),
        }
    }

    /// Restores the last result after turns without a result.
    pub fn go_back(&mut self, last: Option<Last>) {
        if self.unlike.is_some() {
            self.solver.go_back(last);
        }
    }
}
