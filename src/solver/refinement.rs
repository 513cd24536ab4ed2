//! Solves a scene to a given accuracy: on finer and finer grids, until the estimated errors are small enough.

mod accuracy;
mod next_grid;
mod outlook;
mod price;
mod price_list;
mod sample;
mod solved;

use std::time::Instant;

pub use accuracy::Accuracy;
pub(super) use accuracy::LEAST_TOLERANCE;
pub use price_list::{cost_of_accuracy, Obstacle, Price};

use super::quantities::{values, Quantity};
use super::{Asked, Options, Outcome, Progress, ProgressCallback, Report, Solver};
use crate::effects;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::operator::zeros;
use crate::scene::{scaled, Regridded, Scene};
use crate::threads::Threads;
use next_grid::{Next, Past};
use outlook::{History, Outlook, Values};
use solved::Solved;

/// The caller's function that writes the undeformed distance of a grid over the rectangle of the scene. It returns true to cancel.
pub type SurfaceCallback<'a> = &'a mut dyn FnMut(&Grid, &mut [f64]) -> bool;

/// The end of a search for an accuracy.
pub struct Refinement {
    /// Why the search ended:
    ///
    /// - Converged: the targets are met, or there is no contact on three grids.
    /// - IterationLimit: a limit of the caller forbids the next grid, or ended its solve.
    /// - Cancelled: the surface or the progress callback cancelled.
    /// - Stagnated: a target is below round-off, there is no estimate, or a solve stagnated.
    pub stop: Outcome,
    /// The reason, and the best error reached, in words.
    pub reason: String,
    /// The solver of the grid whose result is returned; `None` if nothing was solved.
    pub solver: Option<Solver>,
    /// The last solve of that solver.
    pub report: Report,
    /// Estimated relative error of the force, or of the approach if the force is prescribed; `None` if it is unknown.
    pub reached: Option<f64>,
    /// Seconds for all grids together.
    pub seconds: f64,
}

/// A solve on one grid: the result, or the outcome, the reason and the unfinished result, if there is one.
type OnGrid = std::result::Result<Solved, (Outcome, String, Option<Solved>)>;

/// Solves on the grid of `scene`, then on [finer](scaled) grids with 2, 4 or 8 times the elements in both directions. The search ends when the
/// estimated relative errors are at most the targets, and the contact has [enough](Quantity::enough_across) elements across in both directions.
///
/// `surface` writes the undeformed distance of each grid, and that of `scene` is not read. Without `surface`, the undeformed distance of the scene is
/// [refined](crate::scene::refine).
///
/// The first grid is solved regardless of the limits. The result is that of the last grid that was solved. If a finer grid runs out of time or
/// cycles, its unfinished result is used instead if its estimated error is smaller. A cancelled or stagnated result is used only if there is no
/// other.
pub fn solve_to_accuracy(
    scene: &Scene<'_>,
    options: &Options,
    accuracy: &Accuracy,
    mut surface: Option<SurfaceCallback<'_>>,
    mut progress: Option<ProgressCallback<'_>>,
) -> Result<Refinement> {
    let began = Instant::now();
    accuracy.check()?;
    check(scene, options, surface.is_some())?;
    let options = Options { tolerance: accuracy.tolerance(options.tolerance), estimates: true, ..*options };
    let (mut best, mut before): (Option<Solved>, Option<Past>) = (None, None);
    let mut history = History::of(accuracy.wanted().map(|(quantity, _)| quantity), scene);
    let wanted = history.wanted();
    wanted.iter().try_for_each(|quantity| quantity.check(scene))?;
    let mut doublings = if history.needs_coarser() { first_of_history(&scene.grid, history.least(scene)) } else { 0 };
    let (mut without_estimate, mut without_contact) = (0, 0);
    let (stop, why) = loop {
        let (entered, is_first) = (began.elapsed().as_secs_f64(), best.is_none());
        let late = |_: &Progress| !is_first && accuracy.is_late(began.elapsed().as_secs_f64());
        let solved = match on_grid(scene, (&options, &wanted), doublings, &mut surface, &mut progress, &late) {
            Ok(Ok(mut solved)) => {
                history.add(doublings, &solved.values, &mut solved.outlook);
                solved
            }
            // Grids coarser than the scene's only serve the error estimates, so they may fail.
            Ok(Err((stop, ..))) if doublings < 0 && stop != Outcome::Cancelled => {
                doublings += 1;
                continue;
            }
            Ok(Err((stop, why, unfinished))) => {
                let counts = stop == Outcome::IterationLimit || best.is_none();
                best = better(best, unfinished.filter(|_| counts), accuracy);
                break (stop, why);
            }
            Err(Error::OutOfMemory(message)) if !is_first => break (Outcome::IterationLimit, message),
            Err(error) => return Err(error),
        };
        let now = began.elapsed().as_secs_f64();
        let past = Past::of((&solved, history.is_believed()), (accuracy, scene), (entered, now), before.as_ref());
        if doublings < 0 {
            doublings += 1;
            continue;
        }
        best = Some(solved);
        without_contact = if past.across == (0, 0) { without_contact + 1 } else { 0 };
        without_estimate += usize::from(past.lacks_estimate());
        if let Some(end) = accuracy.end(&past, without_contact, without_estimate) {
            break end;
        }
        match accuracy.next(&past) {
            Next::Refine(more) => doublings += more as i32,
            Next::Limit(why) => break (Outcome::IterationLimit, why),
        }
        log::info!("on {} x {}: {past}; refining", past.grid.mx, past.grid.my);
        before = Some(past);
    };
    Ok(Refinement::of(best, accuracy, (stop, why), began.elapsed().as_secs_f64()))
}

/// The coarsest grid of a sequence that ends with the scene's grid, in doublings of the latter (a number <= 0): two halvings, or fewer if the shorter
/// direction would have less than `least` elements.
fn first_of_history(grid: &Grid, least: usize) -> i32 {
    // A line has one row or column, and its other direction counts.
    let elements = if grid.mx.min(grid.my) == 1 { grid.mx.max(grid.my) } else { grid.mx.min(grid.my) };
    -[4, 2].into_iter().filter(|parts| elements / parts >= least).count().try_into().unwrap_or(0)
}

/// The last solution or the unfinished one, whichever has the smaller estimated error. The errors include those of the residual.
fn better(last: Option<Solved>, unfinished: Option<Solved>, accuracy: &Accuracy) -> Option<Solved> {
    let worst =
        |solved: &Option<Solved>| solved.as_ref().map_or(f64::INFINITY, |solved| accuracy.farthest(&solved.outlook).1);
    match (worst(&unfinished) < worst(&last), last.is_some()) {
        (false, true) => last,
        _ => unfinished,
    }
}

impl Refinement {
    /// The end of a search with the result `best`, for the reason `why`.
    fn of(best: Option<Solved>, accuracy: &Accuracy, (stop, why): (Outcome, String), seconds: f64) -> Refinement {
        let Some(Solved { solver, report, outlook, .. }) = best else {
            let reason = format!("{why}; nothing was solved");
            return Refinement { stop, reason, solver: None, report: Report::default(), reached: None, seconds };
        };
        // Without contact the result is exact.
        let without = report.measures.is_apart() && stop == Outcome::Converged;
        let error = |quantity: Quantity| outlook.relative(quantity).or(without.then_some(0.0));
        let (quantity, _) = accuracy.farthest(&outlook);
        let number = error(quantity).map_or("not known".into(), |error| format!("{error:.2e}"));
        let of = if quantity == Quantity::Force { String::new() } else { format!(" for {}", quantity.name()) };
        let Grid { mx, my, .. } = solver.problem.grid;
        let reason = format!("{why}; the best reached{of} is {number} on {mx} x {my} elements");
        let reached = error(Quantity::Force);
        log::info!("{stop:?}: {reason}");
        Refinement { stop, reason, solver: Some(solver), report, reached, seconds }
    }
}

/// Refuses scenes and options that cannot be solved on several grids. With a surface callback the undeformed distance of the scene is not checked.
fn check(scene: &Scene<'_>, options: &Options, has_surface: bool) -> Result<()> {
    options.check_several_grids()?;
    scene.grid.check()?;
    effects::check_effects(scene)?;
    effects::check_other_grids(scene)?;
    scene.load.check_sign(scene.attraction().is_some())?;
    if has_surface {
        effects::check_bodies(scene)?;
        return scene.load.check();
    }
    scene.check(&Threads::One)?;
    scene.check_area(None)
}

/// Solves on the grid [scaled] by `doublings`, and computes the values of the `wanted` quantities. `late` is called after each cycle and returns true
/// to end the solve.
fn on_grid(
    scene: &Scene<'_>,
    options_and_wanted: (&Options, &[Quantity]),
    doublings: i32,
    surface: &mut Option<SurfaceCallback<'_>>,
    progress: &mut Option<ProgressCallback<'_>>,
    late: &dyn Fn(&Progress) -> bool,
) -> Result<OnGrid> {
    let grid = scaled(scene, doublings)?;
    match solve_on(scene, options_and_wanted, (grid, doublings), surface, progress, late) {
        // An error on a grid coarser than the scene's does not end the search.
        Err(error) if doublings < 0 => Ok(Err((Outcome::Stagnated, error.to_string(), None))),
        Err(Error::Infeasible(message)) => {
            Err(Error::Infeasible(format!("on {} x {} elements: {message}", grid.mx, grid.my)))
        }
        found => found,
    }
}

/// [`on_grid`], but an error on a grid coarser than the scene's is returned as an error.
fn solve_on(
    scene: &Scene<'_>,
    (options, wanted): (&Options, &[Quantity]),
    (grid, doublings): (Grid, i32),
    surface: &mut Option<SurfaceCallback<'_>>,
    progress: &mut Option<ProgressCallback<'_>>,
    late: &dyn Fn(&Progress) -> bool,
) -> Result<OnGrid> {
    let on = |what: &str| format!("{what} on {} x {} elements", grid.mx, grid.my);
    let mut written = None;
    if let Some(surface) = surface {
        let mut h = zeros(grid.len(), "undeformed distances")?;
        // If the callback leaves an element unwritten, its NaN is refused below.
        h.fill(f64::NAN);
        if surface(&grid, &mut h) {
            return Ok(Err((Outcome::Cancelled, on("the surface callback cancelled"), None)));
        }
        written = Some(h);
    }
    let is_given = doublings == 0 && written.is_none();
    let regridded = (!is_given).then(|| Regridded::new(scene, grid, written)).transpose()?;
    let scene = &regridded.as_ref().map_or_else(|| scene.clone(), |regridded| regridded.scene(scene));
    let of_surface = |error| match error {
        Error::NotFinite(message) if surface.is_some() => Error::NotFinite(format!("surface: {message}")),
        other => other,
    };
    let (mut solver, lowest) = Solver::for_scene(scene, options).map_err(of_surface)?;
    let mut is_late = false;
    let mut watch = |told: &Progress| {
        is_late = late(told);
        is_late || progress.as_mut().is_some_and(|progress| progress(told))
    };
    // Without a callback the surface is that of the scene's elements: on finer grids it ends exactly on edges of elements. Where the scene's heights
    // jump, a grid with more elements has a slope over several of them, not a jump.
    let [exact_edges, exact_jumps] = [0, 1].map(|least| surface.is_none() && doublings >= least);
    let asked = Asked { exact_edges, exact_jumps, ..Asked::new((scene, lowest), options) };
    let (mut stop, report) = solver.solve_checked(asked, Some(&mut watch))?;
    let outlook = Outlook::of(&solver, &report, scene.load);
    let computed = match stop {
        Outcome::Cancelled => None,
        _ => values(&mut solver, scene, &report, wanted, &mut watch)?,
    };
    let of_wanted = computed.unwrap_or_else(|| {
        stop = Outcome::Cancelled;
        vec![]
    });
    let values = Values { of_wanted, residual: report.residual(), lack_estimates: solver.lacks_estimates() };
    let solved = Solved { solver, report, outlook, values };
    Ok(match stop {
        Outcome::Converged => Ok(solved),
        Outcome::Cancelled if is_late => Err((Outcome::IterationLimit, on("max_seconds was reached"), Some(solved))),
        Outcome::Cancelled => Err((stop, on("the progress callback cancelled"), Some(solved))),
        Outcome::IterationLimit => Err((stop, on("max_cycles was reached"), Some(solved))),
        Outcome::Stagnated => Err((stop, on("the solver made no further progress"), Some(solved))),
    })
}
