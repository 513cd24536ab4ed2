//! The tangential problem of a solver, with the pressures of a normal problem. For unlike bodies it is coupled with the normal problem.

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

/// If the pressures cannot carry the prescribed force, the tangential problem is solved for this part of the largest force that they carry. Nearly
/// all elements slip then. The forces that the next pressures carry in full slip are correct to 1e-4 (tests/friction/unlike_forces.rs).
const IN_REACH: f64 = 1.0 - 1e-7;

/// The tangential problem of a grid and a pair of bodies, with its last result.
pub struct Tangent {
    solver: Solver,
    /// The coupling with the normal problem; None for like bodies.
    unlike: Option<UnlikeBodies>,
}

/// The end of a step of another solver, from which a step may continue.
pub(crate) struct StepBefore {
    /// The tractions of each element.
    pub traction: Vec<Vector>,
    /// The friction coefficient and the yield limit of each element.
    pub particles: Vec<Particle>,
    /// The pressures, for unlike bodies.
    pub pressure: Option<Vec<f64>>,
}

/// The inputs of a tangential solve that stay the same in all turns.
pub struct Turn<'a> {
    /// The scene, with its undeformed distance, not a displaced one.
    pub scene: &'a Scene<'a>,
    /// The friction to solve for: that of the scene, or one derived from it.
    pub friction: &'a Friction<'a>,
    /// Tolerance, limits and estimates.
    pub options: &'a Options,
    /// The threads of the solve.
    pub threads: &'a Threads,
}

impl<'a> Turn<'a> {
    /// Where the first turn starts: from the caller's initial tractions if there are any, else from the tractions before the step.
    pub fn start(&self) -> Start<'a> {
        self.friction.initial.map_or(Start::Before, Start::Given)
    }
}

/// The coefficients that couple tractions and pressures of a scene; None for like bodies.
fn coupling(scene: &Scene<'_>) -> Result<Option<Source>> {
    Ok(match scene.friction.as_ref().and_then(|friction| friction.influence) {
        Some(tables) => CrossTables::new(&tables)?.map(Source::Tables),
        None => Some(Compliance::of(&scene.bodies).unlike).filter(|unlike| *unlike != 0.0).map(Source::HalfSpace),
    })
}

/// Whether tractions displace the surfaces of a scene along the normal, and so change the pressures.
pub fn is_of_unlike_bodies(scene: &Scene<'_>) -> Result<bool> {
    Ok(coupling(scene)?.is_some())
}

impl Tangent {
    /// Sets up the tangential problem for the grid and the bodies of a scene. Its coefficients are the caller's if given, else those of coated bodies
    /// or of half-spaces.
    pub fn new(scene: &Scene<'_>, options: &Options, threads: &Threads) -> Result<Tangent> {
        let Grid { dx, dy, .. } = scene.grid;
        let given = scene.friction.as_ref().and_then(|friction| friction.influence);
        let plain = scene.plain();
        let coating = match (&given, &scene.coating) {
            (None, Some(coating)) => coating.of_both(&plain)?.map(|coat| (coat, coating.at_surface(&plain))),
            _ => None,
        };
        let below = Compliance::of(&scene.bodies);
        let tangential = match (&given, coating) {
            (Some(tables), _) => Tangential::of_tables(dx, dy, tables)?,
            (None, Some((coat, surface))) => Tangential::of_coated(dx, dy, Compliance::of(&surface), (coat, below)),
            (None, None) => Tangential::new(dx, dy, below),
        };
        let solver = Solver::new(scene.grid, tangential, options.precision != Precision::Double, threads);
        let unlike = coupling(scene)?.map(|source| UnlikeBodies::new(&scene.grid, source, threads));
        Ok(Tangent { solver, unlike: unlike.transpose()? })
    }

    /// The last result; None without one.
    pub fn solution(&self) -> Option<&Solution> {
        self.solver.solution()
    }

    /// The last result, or an empty one.
    pub(super) fn into_solution(self) -> Solution {
        self.solver.into_solution()
    }

    /// This tangential problem with the last result of `other`, which has other coefficients.
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

    /// The pressures of the last step of unlike bodies. None for like bodies, or without a step.
    pub fn pressures_before(&self) -> Option<&[f64]> {
        self.last_step().and(self.unlike.as_ref()).map(UnlikeBodies::last_pressure)
    }

    /// Sets the last step to that of another solver.
    pub fn take_step(&mut self, step: StepBefore) -> Result<()> {
        step.pressure.iter().for_each(|pressure| self.keep_pressures(pressure));
        self.solver.take_step(step.traction, step.particles)
    }

    /// Records that a scene without friction was solved: its result has no tractions. A later step may still continue from the last tractions.
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

    /// Solves the tangential problem with these pressures. If `again`, the last result is the start, and the state before the step is kept: the same
    /// step is solved with other pressures.
    pub fn solve(
        &mut self,
        turn: &Turn<'_>,
        pressure: &[f64],
        again: bool,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        self.solve_from(if again { Start::Again } else { turn.start() }, turn, pressure, monitor)
    }

    /// Solves the tangential problem with these pressures from a given start.
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

    /// Solves with the pressures of a normal problem that ended with `outcome`. If the pressures do not carry the prescribed forces, this is an
    /// error, unless the pressures are not final: the normal problem did not converge, or unlike bodies need further turns. Then the problem is
    /// solved for forces [slightly below](IN_REACH) those that the pressures carry, and the error is the third value.
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

    /// The last forces less the given ones, and the creepages of the last result times the length rolled.
    pub fn excess(&self, friction: &Friction<'_>, found: &Report) -> (Vector, Vector) {
        (self.solver.excess(friction, found), self.solver.offset())
    }

    /// The displacement by the tractions of full slip with the pressures of the last result.
    pub fn full_displacement(&self) -> f64 {
        self.solver.full_displacement()
    }

    /// Adds the displacements along the normal by the last tractions to an undeformed distance. For like bodies these are 0.
    pub fn displace(&mut self, distance: &mut [f64]) {
        if let (Some(unlike), Some(solution)) = (&mut self.unlike, self.solver.solution()) {
            unlike.displace(&solution.traction, distance);
        }
    }

    /// The tangential problem and the coupling of unlike bodies, for their linearised problem (see [`Solver::change`]). None for like bodies.
    pub fn both(&mut self) -> Option<(&mut Solver, &mut UnlikeBodies)> {
        Some((&mut self.solver, self.unlike.as_mut()?))
    }

    /// Keeps the pressures of a finished step of unlike bodies for the next step.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        if let Some(unlike) = &mut self.unlike {
            unlike.keep_pressures(p);
        }
    }

    /// A copy of the last result, which [`go_back`](Tangent::go_back) restores. None for like bodies: a failed solve does not replace their result.
    pub fn last(&self) -> Result<Option<Last>> {
        match self.unlike {
            Some(_) => self.solver.last(),
            None => Ok(None),
        }
    }

    /// Restores the last result after turns that failed.
    pub fn go_back(&mut self, last: Option<Last>) {
        if self.unlike.is_some() {
            self.solver.go_back(last);
        }
    }
}
