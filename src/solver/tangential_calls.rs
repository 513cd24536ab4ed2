//! Public calls that solve the tangential problem alone, with given pressures.

use std::borrow::Cow;

use super::adhesive_friction::bounded;
use super::tangential::{StepBefore, Tangent, Turn};
use super::{InitialGuess, Measures, Options, Outcome, ProgressCallback, Report, Solver};
use crate::error::{self, invalid, Result};
use crate::friction::{Solution, Start};
use crate::grid::{check_values, Grid};
use crate::memory::zeros;
use crate::progress::Monitor;
use crate::scene::{Friction, Scene};
use crate::sums::in_blocks;
use crate::threads::Threads;

impl Solver {
    /// Moves the tangential problem out of this solver, or sets one up. The caller of this function puts it back into `friction`.
    pub(super) fn take_tangent(&mut self, scene: &Scene<'_>, options: &Options) -> Result<Box<Tangent>> {
        match self.friction.take() {
            Some(tangent) => Ok(tangent),
            None => {
                let mut tangent = Box::new(Tangent::new(scene, options, &self.problem.threads)?);
                self.step_before.take().map_or(Ok(()), |step| tangent.take_step(step))?;
                Ok(tangent)
            }
        }
    }

    /// Sets the step from which the first step with friction may continue: that of another solver on the same grid. This solver must not have solved
    /// friction yet.
    pub(crate) fn take_step(&mut self, step: StepBefore) {
        self.step_before = Some(step);
    }

    /// The pressures of the last step with friction of unlike bodies. None for like bodies, or without a step.
    pub(crate) fn pressures_before(&self) -> Option<&[f64]> {
        self.friction.as_deref().and_then(Tangent::pressures_before)
    }

    /// [`solve_tangential`] with the tangential coefficients of this solver. The step may continue from the tractions of the last one.
    pub fn solve_tangential(
        &mut self,
        scene: &Scene<'_>,
        pressure: &[f64],
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, &Solution, Report)> {
        let own_tables = self.own_tables.clone();
        let scene = &*self.with_own_tables(scene, own_tables.as_deref())?;
        let friction = self.check_tangential(scene, options)?;
        let pressure = &*positive(&scene.grid, pressure)?;
        let threads = self.problem.threads.clone();
        let mut tangent = self.take_tangent(scene, options)?;
        let turn = Turn { scene, friction, options, threads: &threads };
        let solved = solve_alone(&mut tangent, &turn, pressure, progress);
        let tangent = &*self.friction.insert(tangent);
        let (outcome, report) = solved?;
        // This error cannot occur: a completed solve has a result.
        let Some(solution) = tangent.solution() else { return invalid("there is no result".into()) };
        Ok((outcome, solution, report))
    }

    /// Checks a scene and options against the set-up, and returns the friction of the scene. The distance and the load of the scene are not checked.
    pub(super) fn check_tangential<'s>(&self, scene: &'s Scene<'_>, options: &Options) -> Result<&'s Friction<'s>> {
        let friction = scene.tangential()?;
        self.set_up.check_options(options)?;
        self.set_up.check_scene(scene, &self.problem)?;
        Ok(friction)
    }

    /// Tractions, slip and stick area of the last step with friction. The step may be one of [`solve`](Self::solve) or of
    /// [`solve_tangential`](Self::solve_tangential).
    pub fn tractions(&self) -> Option<&Solution> {
        self.friction.as_deref().and_then(Tangent::last_step)
    }
}

/// Solves the tangential problem of a scene alone, with given pressures `[my][mx]`. Elements without positive pressure are not in contact. The
/// distance and the load of the scene are not used. For unlike bodies the pressures displace the surfaces sideways, but here tractions do not change
/// the pressures. With adhesion the pressures are contact pressures q.
pub fn solve_tangential(
    scene: &Scene<'_>,
    pressure: &[f64],
    options: &Options,
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Solution, Report)> {
    let friction = scene.check_tangential()?;
    options.check()?;
    let pressure = &*positive(&scene.grid, pressure)?;
    let threads = Threads::new(options.threads)?;
    let mut tangent = Tangent::new(scene, options, &threads)?;
    let turn = Turn { scene, friction, options, threads: &threads };
    let (outcome, report) = solve_alone(&mut tangent, &turn, pressure, progress)?;
    Ok((outcome, tangent.into_solution(), report))
}

/// Solves one step with given pressures, and keeps them for the next step.
fn solve_alone(
    tangent: &mut Tangent,
    turn: &Turn<'_>,
    pressure: &[f64],
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Report)> {
    let mut monitor = Monitor::new(progress, Vec::new(), false);
    let start = match turn.options.initial_guess {
        InitialGuess::Previous if tangent.last_step().is_some() => Start::Last,
        _ => turn.start(),
    };
    let (outcome, found) = bounded(turn.scene, turn.friction, pressure, |friction, pressing| {
        tangent.solve_from(start, &Turn { friction, ..*turn }, pressing, &mut monitor)
    })?;
    tangent.keep_pressures(pressure);
    let measures = measures(&turn.scene.grid, pressure);
    let (friction, tolerance, solve_seconds) = (Some(found), turn.options.tolerance, monitor.seconds());
    Ok((outcome, Report { measures, friction, tolerance, solve_seconds, ..Report::default() }))
}

/// Returns the pressures with negative ones set to 0. Refuses arrays that have not one finite value per element.
pub(super) fn positive<'a>(grid: &Grid, pressure: &'a [f64]) -> Result<Cow<'a, [f64]>> {
    finite(grid, pressure)?;
    if pressure.iter().all(|p| *p >= 0.0) {
        return Ok(Cow::Borrowed(pressure));
    }
    let mut positive: Vec<f64> = zeros(pressure.len(), "the pressures of what is in contact")?;
    positive.iter_mut().zip(pressure).for_each(|(to, p)| *to = p.max(0.0));
    Ok(Cow::Owned(positive))
}

/// Refuses arrays of pressures that have not one finite value per element.
pub(super) fn finite(grid: &Grid, pressure: &[f64]) -> Result<()> {
    check_values("pressure", pressure, grid, error::finite)
}

/// Force, largest pressure and number of elements in contact of given pressures. The other measures are 0.
pub(super) fn measures(grid: &Grid, pressure: &[f64]) -> Measures {
    let pressing = || pressure.iter().filter(|p| **p > 0.0);
    Measures {
        force: in_blocks(pressing().copied()) * grid.element_area(),
        max_pressure: pressing().copied().fold(0.0, f64::max),
        contact_count: pressing().count(),
        ..Measures::default()
    }
}
