//! Friction, after the normal problem: the tangential problem with the pressures that were found, and for unlike bodies both in turns.

use super::{Measures, Options, Outcome, ProgressCallback};
use crate::contact::State;
use crate::effects::Previous;
use crate::error::{invalid, Error, Result};
use crate::friction::{
    Compliance, Coupling, CrossTables, Report, Request, Solution, Solver, Source, Start, Tangential, Vector,
};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::operator::Precision;
use crate::progress::Monitor;
use crate::scene::{Friction, Motion, Prescribed, Scene};
use crate::threads::Threads;

/// What memory is for.
const FIELDS: &str = "the coupling of unlike bodies";

/// What a solver keeps for scenes with friction.
pub struct Tangent {
    solver: Solver,
    /// Of unlike bodies.
    coupled: Option<Coupled>,
}

/// What unlike bodies need beside: see [`Coupling`].
struct Coupled {
    source: Source,
    here: Coupling,
    /// Of rolling: at the places before the step, which are so many elements away.
    there: Option<((f64, f64), Coupling)>,
    sideways: Vec<Vector>,
    along_normal: Vec<f64>,
    /// The scene's own undeformed distance, a copy, and the one with what tractions displace.
    own: Vec<f64>,
    displaced: Vec<f64>,
    /// Pressures of the last step.
    last_pressure: Vec<f64>,
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

    /// Whether it has the coefficients that a scene asks for.
    pub fn suits(&self, friction: &Friction<'_>) -> bool {
        let cross = self.coupled.as_ref().map(|coupled| &coupled.source);
        let has_cross = match (cross, &friction.influence) {
            (Some(Source::Tables(tables)), Some(influence)) => tables.are_of(influence),
            (_, Some(influence)) => influence.cross.is_none(),
            _ => true,
        };
        has_cross && self.solver.tangential().are_of(friction.influence.as_ref())
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
        self.solve_from(if again { Start::Again } else { Start::Before }, turn, pressure, monitor)
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
            coupled.displace(turn, pressure)?;
        }
        let request = Request {
            pressure,
            friction: turn.friction,
            tolerance: turn.options.tolerance,
            limit: turn.options.max_cycles as u64,
            sideways: coupled.as_ref().map(|coupled| &coupled.sideways[..]),
            start,
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

    /// The distance of a scene whose normal problem is solved. Of unlike bodies a copy is made: a callback may change the caller's.
    pub fn take_distance(&mut self, h: &[f64]) {
        if let Some(coupled) = &mut self.coupled {
            coupled.own.copy_from_slice(h);
        }
    }

    /// The undeformed distance with what the tractions displace along the normal, and by how much that has changed where pressures act (in C and
    /// at a limit): rms relative to `h - approach`. No change at all: none on the whole grid. None where bodies are alike.
    pub fn distance(&mut self, state: &State) -> Option<(&[f64], Option<f64>)> {
        let Tangent { solver, coupled: Some(Coupled { here, along_normal, own, displaced, .. }) } = self else {
            return None;
        };
        here.along_normal(&solver.solution()?.traction, along_normal);
        let (mut changes, mut distances, mut differs) = (0.0, 0.0, false);
        for i in 0..along_normal.len() {
            displaced[i] = own[i] + along_normal[i];
            // One element alone displaces others, not itself.
            differs |= displaced[i] != state.h[i];
            if state.touches(i) {
                changes += (displaced[i] - state.h[i]).powi(2);
                distances += (state.h[i] - state.approach).powi(2);
            }
        }
        let change = if changes == 0.0 { 0.0 } else { (changes / distances).sqrt() };
        Some((&displaced[..], differs.then_some(change)))
    }

    /// The step is done: the next one may continue from its pressures.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        if let Some(coupled) = &mut self.coupled {
            coupled.last_pressure.copy_from_slice(p);
        }
    }
}

/// Solves the tangential problem of a scene alone, with pressures that are given: `[my][mx]`; those that are not positive count as no
/// contact. Of unlike bodies the pressures displace the surfaces sideways, but the tractions do not change the pressures.
pub fn solve_tangential(
    scene: &Scene<'_>,
    pressure: &[f64],
    options: &Options,
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Solution, super::Report)> {
    scene.check(&Threads::One)?;
    options.check()?;
    let Some(friction) = &scene.friction else {
        return invalid("friction is not given: there is nothing to solve".into());
    };
    check_pressures(&scene.grid, pressure)?;
    let threads = Threads::new(options.threads)?;
    let mut monitor = Monitor::new(progress, Vec::new(), false);
    let mut tangent = Tangent::new(scene, options, &threads)?;
    let turn = Turn { scene, friction, options, threads: &threads };
    let (stop, found) = tangent.solve(&turn, pressure, false, &mut monitor)?;
    let measures = measures(&scene.grid, pressure);
    let (friction, tolerance, solve_seconds) = (Some(found), options.tolerance, monitor.seconds());
    let report = super::Report { measures, friction, tolerance, solve_seconds, ..super::Report::default() };
    Ok((stop, tangent.into_solution(), report))
}

/// Refuses pressures that are not one finite value per element.
pub(super) fn check_pressures(grid: &Grid, pressure: &[f64]) -> Result<()> {
    if pressure.len() != grid.len() {
        let (values, elements) = (pressure.len(), grid.len());
        return invalid(format!("pressure has {values} values; the grid has {elements} elements"));
    }
    if let Some(i) = pressure.iter().position(|p| !p.is_finite()) {
        let (element, p) = (grid.element(i), pressure[i]);
        return Err(Error::NotFinite(format!("pressure of {element} is {p}; it must be finite")));
    }
    Ok(())
}

/// What is to be said of pressures that are given.
pub(super) fn measures(grid: &Grid, pressure: &[f64]) -> Measures {
    let positive = || pressure.iter().filter(|p| **p > 0.0);
    Measures {
        force: positive().sum::<f64>() * grid.element_area(),
        max_pressure: positive().copied().fold(0.0, f64::max),
        contact_count: positive().count(),
        ..Measures::default()
    }
}

impl Coupled {
    fn new(grid: &Grid, source: Source, threads: &Threads) -> Result<Coupled> {
        let n = grid.len();
        Ok(Coupled {
            here: Coupling::new(grid, &source, (0.0, 0.0), threads)?,
            source,
            there: None,
            sideways: zeros(n, FIELDS)?,
            along_normal: zeros(n, FIELDS)?,
            own: zeros(n, FIELDS)?,
            displaced: zeros(n, FIELDS)?,
            last_pressure: zeros(n, FIELDS)?,
        })
    }

    /// Bytes held.
    fn bytes(&self) -> usize {
        let there = self.there.as_ref().map_or(0, |(_, there)| there.bytes());
        let fields = size_of::<Vector>() + 4 * size_of::<f64>();
        self.source.bytes() + self.here.bytes() + there + self.own.len() * fields
    }

    /// The sideways displacements by pressures p, less those before the step: from rest none; where tractions are given, the pressures
    /// before were the same.
    fn displace(&mut self, turn: &Turn<'_>, p: &[f64]) -> Result<()> {
        let Turn { scene, friction, threads, .. } = turn;
        self.sideways.fill([0.0; 2]);
        self.here.add_sideways(p, 1.0, &mut self.sideways);
        let before = match (friction.motion, friction.previous) {
            (Motion::SteadyRolling, _) | (_, Previous::Given(_)) => p,
            (_, Previous::None) => return Ok(()),
            (_, Previous::Kept) => &self.last_pressure,
        };
        if friction.motion == Motion::Shift {
            self.here.add_sideways(before, -1.0, &mut self.sideways);
            return Ok(());
        }
        let by = friction.elements_rolled(&scene.grid);
        if !self.there.as_ref().is_some_and(|(known, _)| *known == by) {
            self.there = Some((by, Coupling::new(&scene.grid, &self.source, by, threads)?));
        }
        if let Some((_, there)) = &mut self.there {
            there.add_sideways(before, -1.0, &mut self.sideways);
        }
        Ok(())
    }
}
