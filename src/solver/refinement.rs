//! Accuracy instead of a grid: finer and finer grids until the estimated error of the force or the approach is small enough.

mod next_grid;

use std::time::Instant;

pub use next_grid::Accuracy;

use super::{InitialGuess, Options, Progress, ProgressCallback, Report, Solver, Stop};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::operator::zeros;
use crate::scene::{refine, Load, Scene};
use next_grid::{Next, Past};

/// Writes the undeformed distance of a grid over the rectangle of the scene; says whether to cancel.
pub type SurfaceCallback<'a> = &'a mut dyn FnMut(&Grid, &mut [f64]) -> bool;

/// What asking for an accuracy led to.
pub struct Outcome {
    /// Converged: the target is met. IterationLimit: a limit is in the way of the next grid. Cancelled: by the surface or the
    /// progress callback. Stagnated: the target is below round-off, or no estimate is to be had.
    pub stop: Stop,
    /// Why, and the best that was reached, in words.
    pub reason: String,
    /// The solver of the grid that was used, with its result and ledger; `None` when cancelled before there was one.
    pub solver: Option<Solver>,
    /// The last solve of that solver.
    pub report: Report,
    /// Estimated relative error of the force (of the approach, when the force is prescribed), if known.
    pub reached: Option<f64>,
    /// Seconds for all grids together.
    pub seconds: f64,
}

/// The result on one grid.
struct Solved {
    solver: Solver,
    report: Report,
    relative: Option<f64>,
}

/// How a solve on one grid went: it is solved, or `stop` and words say what kept it from that.
type OnGrid = std::result::Result<Solved, (Stop, String, Option<Solved>)>;

/// Below this no estimate means anything: some hundred units of round-off.
const ROUND_OFF: f64 = 1e-13;
/// Residuals below this are not asked for.
const LEAST_TOLERANCE: f64 = 1e-12;
/// The residual, relative to the target: what it adds to the error does not count.
const TOLERANCE_PER_TARGET: f64 = 0.1;
/// With fewer elements across, a grid's estimate is not believed, and need not be there.
const ENOUGH_ACROSS: usize = 32;
/// Grids with more that have none, before it is given up.
const MOST_WITHOUT_ESTIMATE: usize = 3;

/// Solves on the grid of `scene`, then on finer ones with twice (4, 8 times) the elements in both directions, each from
/// nothing, until the estimated relative error is at most the target. `surface` writes the undeformed distance of each grid (that
/// of `scene` is then not read); without one the scene's is [refined](refine).
///
/// The first grid is solved whatever the limits are. What a finer grid does not get solved to the tolerance, cancelled
/// or out of time or memory, is dropped: the result is then that of the grid before.
pub fn solve_to_accuracy(
    scene: &Scene<'_>,
    options: &Options,
    accuracy: &Accuracy,
    mut surface: Option<SurfaceCallback<'_>>,
    mut progress: Option<ProgressCallback<'_>>,
) -> Result<Outcome> {
    let began = Instant::now();
    accuracy.check()?;
    check(scene, options, surface.is_some())?;
    let tolerance = options.tolerance.min(TOLERANCE_PER_TARGET * accuracy.target).max(LEAST_TOLERANCE);
    let options = Options { tolerance, estimates: true, ..*options };
    let mut best: Option<Solved> = None;
    let (mut parts, mut without_estimate, mut without_contact) = (1, 0, 0);
    let (stop, why) = loop {
        let (entered, before) = (began.elapsed().as_secs_f64(), best.is_some());
        let late = |_: &Progress| before && accuracy.is_late(began.elapsed().as_secs_f64());
        let solved = match on_grid(scene, &options, parts, &mut surface, &mut progress, &late) {
            Ok(Ok(solved)) => solved,
            Ok(Err((stop, why, unfinished))) => {
                best = best.or(unfinished);
                break (stop, why);
            }
            Err(Error::OutOfMemory(message)) if before => break (Stop::IterationLimit, message),
            Err(error) => return Err(error),
        };
        let (grid, report, relative) = (solved.solver.problem.grid, solved.report, solved.relative);
        best = Some(solved);

        let judged = grid.mx.max(grid.my) >= ENOUGH_ACROSS;
        without_contact = if report.measures.contact_count == 0 { without_contact + 1 } else { 0 };
        without_estimate += usize::from(judged && relative.is_none());
        let met = judged && relative.is_some_and(|relative| relative <= accuracy.target);
        if met && accuracy.target >= ROUND_OFF {
            break (Stop::Converged, "the target is met".into());
        }
        if without_contact == MOST_WITHOUT_ESTIMATE {
            break (Stop::Converged, "there is no contact on three grids".into());
        }
        if accuracy.target < ROUND_OFF {
            break (Stop::Stagnated, format!("target is {:e}, below round-off", accuracy.target));
        }
        if without_estimate == MOST_WITHOUT_ESTIMATE {
            break (Stop::Stagnated, "no estimate of the error can be trusted".into());
        }
        let now = began.elapsed().as_secs_f64();
        let falls_by = relative.map(|_| report.error.force / report.halving.force).filter(|ratio| *ratio > 0.0);
        let past = Past { grid, relative, falls_by, bytes: report.bytes, seconds: now - entered, elapsed: now };
        match accuracy.next(&past) {
            Next::Refine(doublings) => parts <<= doublings,
            Next::Limit(why) => break (Stop::IterationLimit, why),
        }
        let next = relative.map_or("unknown".into(), |relative| format!("{relative:.1e}"));
        log::info!("estimated relative error {next} on {} x {}: refining", grid.mx, grid.my);
    };
    Ok(Outcome::of(best, stop, why, began.elapsed().as_secs_f64()))
}

impl Outcome {
    fn of(best: Option<Solved>, stop: Stop, why: String, seconds: f64) -> Outcome {
        let Some(Solved { solver, report, relative }) = best else {
            let reason = format!("{why}; nothing was solved");
            return Outcome { stop, reason, solver: None, report: Report::default(), reached: None, seconds };
        };
        // Without contact there is nothing to be off.
        let reached = relative.or((stop == Stop::Converged).then_some(0.0));
        let number = reached.map_or("not known".into(), |reached| format!("{reached:.2e}"));
        let grid = solver.problem.grid;
        let reason = format!("{why}; the best reached is {number} on {} x {} elements", grid.mx, grid.my);
        log::info!("{stop:?}: {reason}");
        Outcome { stop, reason, solver: Some(solver), report, reached, seconds }
    }
}

fn check(scene: &Scene<'_>, options: &Options, has_surface: bool) -> Result<()> {
    options.check()?;
    let own = [("influence", scene.influence.is_some()), ("row_tables", scene.row_tables.is_some())];
    if let Some((name, _)) = own.into_iter().find(|(_, is_given)| *is_given) {
        return Err(Error::Unsupported(format!(
            "{name} is given; own coefficients are those of one grid, and an accuracy needs several"
        )));
    }
    if options.is_fixed() {
        return Err(Error::Unsupported("active_set is FIXED; the contact area of finer grids is not known".into()));
    }
    if options.initial_guess != InitialGuess::None {
        return invalid("initial_guess must be NONE: each grid is solved from nothing".into());
    }
    if has_surface {
        scene.bodies.check()?;
        return scene.load.check();
    }
    scene.check()
}

/// Solves on the grid with `parts` elements for each of the scene's. `late`: asked after each cycle; true ends the solve.
fn on_grid(
    scene: &Scene<'_>,
    options: &Options,
    parts: usize,
    surface: &mut Option<SurfaceCallback<'_>>,
    progress: &mut Option<ProgressCallback<'_>>,
    late: &dyn Fn(&Progress) -> bool,
) -> Result<OnGrid> {
    let Grid { mx, my, dx, dy } = scene.grid;
    let grid = Grid::new(mx * parts, my * parts, dx / parts as f64, dy / parts as f64)?;
    let on = |what: &str| format!("{what} on {} x {} elements", grid.mx, grid.my);
    let refined = match surface {
        Some(surface) => {
            let mut h = zeros(grid.len(), "undeformed distances")?;
            // What the callback leaves out is refused.
            h.fill(f64::NAN);
            if surface(&grid, &mut h) {
                return Ok(Err((Stop::Cancelled, on("the surface callback cancelled"), None)));
            }
            h
        }
        None if parts == 1 => Vec::new(),
        None => refine(scene.undeformed_distance, &scene.grid, parts)?,
    };
    let h = if refined.is_empty() { scene.undeformed_distance } else { &refined };
    let scene = Scene { grid, undeformed_distance: h, ..scene.clone() };
    let said = |error| match error {
        Error::NotFinite(message) if surface.is_some() => Error::NotFinite(format!("surface: {message}")),
        other => other,
    };
    let mut solver = Solver::new(&scene, options).map_err(said)?;
    let mut is_late = false;
    let mut watch = |told: &Progress| {
        is_late = late(told);
        is_late || progress.as_mut().is_some_and(|progress| progress(told))
    };
    let (stop, report) = solver.solve(&scene, options, None, Some(&mut watch))?;
    // What is not solved has no estimate.
    let relative = if stop == Stop::Converged { relative_error(scene.load, &report) } else { None };
    let solved = Solved { solver, report, relative };
    Ok(match stop {
        Stop::Converged => Ok(solved),
        Stop::Cancelled if is_late => Err((Stop::IterationLimit, on("max_seconds was reached"), Some(solved))),
        Stop::Cancelled => Err((stop, on("the progress callback cancelled"), Some(solved))),
        Stop::IterationLimit => Err((stop, on("max_cycles was reached"), Some(solved))),
        Stop::Stagnated => Err((stop, on("the solver made no further progress"), Some(solved))),
    })
}

/// Estimated error of the force, or of the approach when the force is prescribed, over its value.
fn relative_error(load: Load, report: &Report) -> Option<f64> {
    let relative = report.error.force / report.measures.found(load).abs();
    (relative >= 0.0 && relative.is_finite()).then_some(relative)
}
