//! Friction, after the normal problem: the tangential problem with the pressures that were found, and for unlike bodies both in turns.

use std::borrow::Cow;

use super::coupled::Coupled;
use super::{InitialGuess, Measures, Options, Outcome, ProgressCallback, Solver as Handle};
use crate::contact::State;
use crate::error::{invalid, Error, Result};
use crate::friction::{Compliance, CrossTables, Last, Report, Request, Solution, Solver, Source, Start, Tangential};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::operator::Precision;
use crate::progress::Monitor;
use crate::scene::{Friction, Prescribed, Scene};
use crate::sums::in_blocks;
use crate::threads::Threads;

/// What a solver keeps for scenes with friction.
pub struct Tangent {
    solver: Solver,
    /// Of unlike bodies.
    coupled: Option<Coupled>,
}

/// What stands still while normal and tangential problem are solved in turns.
pub struct Turn<'a> {
    /// The scene, with its own undeformed distance.
    pub scene: &'a Scene<'a>,
    /// Its friction.
    pub friction: &'a Friction<'a>,
    /// The options.
    pub options: &'a Options,
    /// The threads.
    pub threads: &'a Threads,
}

impl<'a> Turn<'a> {
    /// From the tractions that the caller gave, or from those before the step.
    pub fn start(&self) -> Start<'a> {
        self.friction.initial.map_or(Start::Before, Start::Given)
    }
}

impl Tangent {
    /// For a scene's grid and bodies.
    pub fn new(scene: &Scene<'_>, options: &Options, threads: &Threads) -> Result<Tangent> {
        let Grid { dx, dy, .. } = scene.grid;
        let own = scene.friction.as_ref().and_then(|friction| friction.influence);
        let tangential = match &own {
            Some(own) => Tangential::of_tables(dx, dy, own)?,
            None => Tangential::new(dx, dy, Compliance::of(&scene.bodies)),
        };
        let compliance = tangential.compliance();
        let solver = Solver::new(scene.grid, tangential, options.precision != Precision::Double, threads);
        let source = match &own {
            Some(own) => CrossTables::new(own)?.map(Source::Tables),
            None => Some(compliance.unlike).filter(|unlike| *unlike != 0.0).map(Source::HalfSpace),
        };
        let coupled = source.map(|source| Coupled::new(&scene.grid, source, threads));
        Ok(Tangent { solver, coupled: coupled.transpose()? })
    }

    /// The last result.
    pub fn solution(&self) -> Option<&Solution> {
        self.solver.solution()
    }

    /// The last result, or an empty one.
    fn into_solution(self) -> Solution {
        self.solver.into_solution()
    }

    /// The same with the last result of another one, which had other coefficients.
    pub fn with_last_of(mut self, mut other: Tangent) -> Tangent {
        self.solver.take_last_of(&mut other.solver);
        if let (Some(coupled), Some(before)) = (&mut self.coupled, &mut other.coupled) {
            coupled.take_last_of(before);
        }
        self
    }

    /// Whether tractions do not change the pressures.
    pub fn is_of_like_bodies(&self) -> bool {
        self.coupled.is_none()
    }

    /// There is no last result any more.
    pub fn forget(&mut self) {
        self.solver.forget();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.solver.bytes() + self.coupled.as_ref().map_or(0, Coupled::bytes)
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

    fn solve_from(
        &mut self,
        start: Start<'_>,
        turn: &Turn<'_>,
        pressure: &[f64],
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        let Tangent { solver, coupled } = self;
        if let Some(coupled) = coupled {
            coupled.displace(&turn.scene.grid, turn.friction, pressure, turn.threads)?;
        }
        let request = Request {
            pressure,
            friction: turn.friction,
            tolerance: turn.options.tolerance,
            limit: turn.options.max_cycles as u64,
            sideways: coupled.as_ref().map(Coupled::sideways),
            start,
            is_cancelled: monitor.is_cancelled(),
            estimates: turn.options.estimates,
        };
        solver.solve(&request, &mut |grid, residual| monitor.tangential_done(grid, residual))
    }

    /// The same with the pressures of a normal problem that ended with `stop`. Those of one that did not converge may be too small for
    /// the force: then nothing moves in the directions in which it is given.
    pub fn solve_after(
        &mut self,
        stop: Outcome,
        turn: &Turn<'_>,
        pressure: &[f64],
        start: Start<'_>,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        match self.solve_from(start, turn, pressure, monitor) {
            Err(Error::Infeasible(message)) if stop != Outcome::Converged => {
                log::info!("the normal problem is not solved: {message}");
                let stays = |prescribed: Prescribed| match prescribed {
                    Prescribed::Force(_) => Prescribed::Creepage(0.0),
                    given => given,
                };
                let friction = Friction { prescribed: turn.friction.prescribed.map(stays), ..*turn.friction };
                self.solve_from(start, &Turn { friction: &friction, ..*turn }, pressure, monitor)
            }
            found => found,
        }
    }

    /// The distance of a scene whose normal problem is solved.
    pub fn take_distance(&mut self, h: &[f64]) {
        if let Some(coupled) = &mut self.coupled {
            coupled.take_distance(h);
        }
    }

    /// See [`Coupled::distance`]. None where bodies are alike.
    pub fn distance(&mut self, state: &State) -> Option<(&[f64], Option<f64>)> {
        let traction = &self.solver.solution()?.traction;
        Some(self.coupled.as_mut()?.distance(traction, state))
    }

    /// Both problems of unlike bodies, linear: see [`Coupled`] and [`Solver::change`]. None where bodies are alike.
    pub fn both(&mut self) -> Option<(&mut Solver, &mut Coupled)> {
        Some((&mut self.solver, self.coupled.as_mut()?))
    }

    /// The step is done: the next one may continue from its pressures.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        if let Some(coupled) = &mut self.coupled {
            coupled.keep_pressures(p);
        }
    }

    /// The last result, to [go back](Tangent::go_back) to; of like bodies nothing: it is replaced only when a solve has come to its end.
    pub fn last(&self) -> Result<Option<Last>> {
        match self.coupled {
            Some(_) => self.solver.last(),
            None => Ok(None),
        }
    }

    /// Several turns ended without a result: there is the last one.
    pub fn go_back(&mut self, last: Option<Last>) {
        if self.coupled.is_some() {
            self.solver.go_back(last);
        }
    }
}

impl Handle {
    /// What solves friction, to be put back; made where there is none.
    pub(super) fn take_tangent(&mut self, scene: &Scene<'_>, options: &Options) -> Result<Box<Tangent>> {
        match self.friction.take() {
            Some(tangent) => Ok(tangent),
            None => Ok(Box::new(Tangent::new(scene, options, &self.problem.threads)?)),
        }
    }

    /// [`solve_tangential`] with what this solver keeps: coefficients, and the tractions of the step before.
    pub fn solve_tangential(
        &mut self,
        scene: &Scene<'_>,
        pressure: &[f64],
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, &Solution, super::Report)> {
        let own = self.own_tables.clone();
        let scene = &*self.with_own_tables(scene, own.as_deref())?;
        let friction = self.check_tangential(scene, options)?;
        let pressure = &*positive(&scene.grid, pressure)?;
        let threads = self.problem.threads.clone();
        let mut tangent = self.take_tangent(scene, options)?;
        let turn = Turn { scene, friction, options, threads: &threads };
        let solved = alone(&mut tangent, &turn, pressure, progress);
        let tangent = &*self.friction.insert(tangent);
        let (stop, report) = solved?;
        // A solve that ends has a result.
        let Some(solution) = tangent.solution() else { return invalid("there is no result".into()) };
        Ok((stop, solution, report))
    }

    /// The friction of a scene, which must be as at the set-up. Its distance and its load are not looked at.
    pub(super) fn check_tangential<'s>(&self, scene: &'s Scene<'_>, options: &Options) -> Result<&'s Friction<'s>> {
        let friction = scene.tangential()?;
        self.set_up.check_options(options)?;
        self.set_up.check_scene(scene, &self.problem)?;
        Ok(friction)
    }

    /// The tractions, slip and stick area that were found last, with pressures of the normal problem or with given ones.
    pub fn tractions(&self) -> Option<&Solution> {
        self.friction.as_deref().and_then(Tangent::solution)
    }
}

/// Solves the tangential problem of a scene alone, with pressures that are given: `[my][mx]`; those that are not positive count as no
/// contact. Its distance and its load are not looked at. Of unlike bodies the pressures displace the surfaces sideways, but the tractions do not
/// change the pressures.
pub fn solve_tangential(
    scene: &Scene<'_>,
    pressure: &[f64],
    options: &Options,
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Solution, super::Report)> {
    let friction = scene.check_tangential()?;
    options.check()?;
    let pressure = &*positive(&scene.grid, pressure)?;
    let threads = Threads::new(options.threads)?;
    let mut tangent = Tangent::new(scene, options, &threads)?;
    let turn = Turn { scene, friction, options, threads: &threads };
    let (stop, report) = alone(&mut tangent, &turn, pressure, progress)?;
    Ok((stop, tangent.into_solution(), report))
}

/// One step with pressures that are given.
fn alone(
    tangent: &mut Tangent,
    turn: &Turn<'_>,
    pressure: &[f64],
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, super::Report)> {
    let mut monitor = Monitor::new(progress, Vec::new(), false);
    let start = match turn.options.initial_guess {
        InitialGuess::Previous if tangent.solution().is_some() => Start::Last,
        _ => turn.start(),
    };
    let (stop, found) = tangent.solve_from(start, turn, pressure, &mut monitor)?;
    tangent.keep_pressures(pressure);
    let measures = measures(&turn.scene.grid, pressure);
    let (friction, tolerance, solve_seconds) = (Some(found), turn.options.tolerance, monitor.seconds());
    Ok((stop, super::Report { measures, friction, tolerance, solve_seconds, ..super::Report::default() }))
}

/// The pressures of what is in contact: negative ones are 0. Refuses those that are not one finite value per element.
pub(super) fn positive<'a>(grid: &Grid, pressure: &'a [f64]) -> Result<Cow<'a, [f64]>> {
    if pressure.len() != grid.len() {
        let (values, elements) = (pressure.len(), grid.len());
        return invalid(format!("pressure has {values} values; the grid has {elements} elements"));
    }
    finite(grid, pressure)?;
    if pressure.iter().all(|p| *p >= 0.0) {
        return Ok(Cow::Borrowed(pressure));
    }
    let mut positive: Vec<f64> = zeros(pressure.len(), "the pressures of what is in contact")?;
    positive.iter_mut().zip(pressure).for_each(|(to, p)| *to = p.max(0.0));
    Ok(Cow::Owned(positive))
}

/// Refuses pressures that are not finite.
pub(super) fn finite(grid: &Grid, pressure: &[f64]) -> Result<()> {
    let Some(i) = pressure.iter().position(|p| !p.is_finite()) else { return Ok(()) };
    let (element, p) = (grid.element(i), pressure[i]);
    Err(Error::NotFinite(format!("pressure of {element} is {p}; it must be finite")))
}

/// What is to be said of pressures that are given.
pub(super) fn measures(grid: &Grid, pressure: &[f64]) -> Measures {
    let pressing = || pressure.iter().filter(|p| **p > 0.0);
    Measures {
        force: in_blocks(pressing().copied()) * grid.element_area(),
        max_pressure: pressing().copied().fold(0.0, f64::max),
        contact_count: pressing().count(),
        ..Measures::default()
    }
}
