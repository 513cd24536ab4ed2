//! Many tangential problems with the same pressures. The pressures are given or solved for once; then follows a
//! [table](super::friction_table) with one tangential problem for each motion or force.

use super::adhesive_friction::bounded;
use super::friction_table::Table;
pub use super::friction_table::{Ended, Entry, RUN};
use super::tangential_calls::{measures, positive};
use super::{Asked, Options, Outcome, ProgressCallback, Report, Solver};
use crate::effects::Previous;
use crate::error::{invalid, Result};
use crate::friction::Solution;
use crate::grid::Grid;
use crate::memory::collected;
use crate::scene::{Friction, Scene};
use crate::threads::Threads;

/// Solves the tangential problem of a scene for each of the entries. The pressures `[my][mx]` are given, or are those of the scene's normal problem,
/// which is solved once. `found(i, ended, solution)` is called for each entry i, on the thread that solved it and in no particular order, with a
/// solution where there is one. Returns the outcome and the report of the normal problem.
///
/// A refused entry does not affect the others. For unlike bodies the pressures displace the surfaces sideways, but here tractions do not change
/// the pressures. `progress` is called on the calling thread: after the cycles of the normal problem, and then after each entry, which counts as a
/// cycle. When `progress` cancels, unfinished entries end as `Outcome::Cancelled`.
pub fn solve_friction_batch(
    scene: &Scene<'_>,
    pressure: Option<&[f64]>,
    entries: &[Entry],
    options: &Options,
    mut progress: Option<ProgressCallback<'_>>,
    found: impl Fn(usize, Ended, Option<&Solution>) + Sync + Send,
) -> Result<(Outcome, Report)> {
    let (given, contact);
    let (outcome, mut report, pressure) = match pressure {
        Some(pressure) => {
            scene.check_tangential()?;
            options.check()?;
            given = positive(&scene.grid, pressure)?;
            (Outcome::Converged, of_pressures(&scene.grid, &given, options), &*given)
        }
        None => {
            scene.check(&Threads::One)?;
            options.check()?;
            scene.check_free_load(options.is_fixed())?;
            friction_of_table(scene)?;
            let normal = Scene { friction: None, ..scene.clone() };
            let (mut new, lowest) = Solver::for_scene(&normal, options)?;
            let watch = progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>);
            let (outcome, report) = new.solve_checked(Asked::new((&normal, lowest), options), watch)?;
            let split = new.adhesion();
            let q = |i: usize| split.as_ref().map_or(new.state().p[i], |split| split(i).0);
            contact = collected((0..scene.grid.len()).map(q), "the contact pressures of a table")?;
            (outcome, report, &contact[..])
        }
    };
    let threads = Threads::new(options.threads)?;
    let (outcome, seconds) = bounded(scene, friction_of_table(scene)?, pressure, |friction, pressing| {
        let table = Table::new(scene, friction, pressing, entries, options);
        table.solve(outcome, (&mut Vec::new(), &threads), progress, &found)
    })?;
    report.solve_seconds += seconds;
    Ok((outcome, report))
}

impl Solver {
    /// [`solve_friction_batch`] with the tangential coefficients of this solver and given pressures. The last result of the solver does not change.
    pub fn solve_friction_batch(
        &mut self,
        scene: &Scene<'_>,
        pressure: &[f64],
        entries: &[Entry],
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
        found: impl Fn(usize, Ended, Option<&Solution>) + Sync + Send,
    ) -> Result<(Outcome, Report)> {
        let own_tables = self.own_tables.clone();
        let scene = &*self.with_own_tables(scene, own_tables.as_deref())?;
        self.check_tangential(scene, options)?;
        let (friction, pressure) = (friction_of_table(scene)?, &*positive(&scene.grid, pressure)?);
        let threads = self.problem.threads.clone();
        let (outcome, solve_seconds) = bounded(scene, friction, pressure, |friction, pressing| {
            let table = Table::new(scene, friction, pressing, entries, options);
            table.solve(Outcome::Converged, (&mut self.crew, &threads), progress, &found)
        })?;
        Ok((outcome, Report { solve_seconds, ..of_pressures(&scene.grid, pressure, options) }))
    }
}

/// The friction of a scene. Refuses friction that continues a previous step, which the entries of a table do not have.
fn friction_of_table<'s>(scene: &'s Scene<'_>) -> Result<&'s Friction<'s>> {
    match &scene.friction {
        None => invalid("friction is not given: there is nothing to solve".into()),
        Some(friction) if friction.previous == Previous::Kept => {
            invalid("friction->continues is 1; in a table there is no step before".into())
        }
        Some(friction) => Ok(friction),
    }
}

/// A report on given pressures, which no normal problem was solved for.
fn of_pressures(grid: &Grid, pressure: &[f64], options: &Options) -> Report {
    Report { measures: measures(grid, pressure), tolerance: options.tolerance, ..Report::default() }
}
