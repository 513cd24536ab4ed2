//! The price list: the predicted cost of several accuracies of one quantity.
//!
//! The scene is solved on small grids, the samples. All samples together take a small part of the time of the most expensive accuracy. Errors and
//! seconds are extrapolated to finer grids: errors by their orders (module `estimates`), seconds by a power of the number of elements.

use std::time::Instant;

use super::accuracy::{require_target, tolerance_for, LEAST_TOLERANCE};
use super::next_grid::MOST_WITHOUT;
use super::outlook::History;
use super::price::{price, Counted, FEWEST_ACROSS};
pub use super::price::{Obstacle, Price};
use super::sample::{Callbacks, Sample, Taken};
use super::{check, Accuracy, SurfaceCallback};
use crate::error::Result;
use crate::scene::{scaled, Scene};
use crate::solver::quantities::Quantity;
use crate::solver::seconds::NEXT_GRID_RATIO;
use crate::solver::{Options, Outcome, ProgressCallback};

/// The samples may take this share of the predicted seconds of the most expensive accuracy, or [`SAMPLES_SECONDS`] if that is more. No sample is
/// begun that is predicted to exceed this.
const SAMPLES_SHARE: f64 = 0.014;
/// The seconds that samples may always take.
const SAMPLES_SECONDS: f64 = 0.035;
/// The first sample has from this many to twice as many elements in its longer direction, if the scene's grid has at least twice as many.
const FIRST_SAMPLE: usize = 32;
/// Lower bound on the ratio of the seconds of a grid to those of a grid with a quarter of the elements.
const LEAST_COST_RATIO: f64 = 2.0;

/// If a sample with more elements does not resolve the contact, no further sample is made.
const UNRESOLVED_ELEMENTS: f64 = 2e5;
/// While no row is known, samples may take about this many seconds.
const UNKNOWN_SECONDS: f64 = 2.0;
/// Most samples.
const MOST_SAMPLES: usize = 12;
/// Most seconds for counting the products of rows with small grids.
const FOR_COUNTS: f64 = 0.005;
/// The part of what remains of [`SAMPLES_SECONDS`] that repeated timings of a sample may take.
const FOR_TIMES: f64 = 0.5;

/// Predicts the cost of each of the relative errors `targets` of a quantity, from solves on small grids over the rectangle of the scene.
///
/// Of `accuracy` only the limits are used; a row tells which limit forbids it. `surface` is that of [`solve_to_accuracy`](super::solve_to_accuracy).
/// `progress` is called after each cycle. If one of them cancels, the rows hold the results so far. The outcome is ITERATION_LIMIT or STAGNATED if
/// neither the grid of the scene nor a coarser one could be solved. If there is no contact, a quantity of 0 is exact on the grid of the scene.
pub fn cost_of_accuracy(
    scene: &Scene<'_>,
    options: &Options,
    accuracy: &Accuracy,
    (quantity, targets): (Quantity, &[f64]),
    mut surface: Option<SurfaceCallback<'_>>,
    mut progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Vec<Price>)> {
    check_asked((scene, options, surface.is_some()), accuracy, (quantity, targets))?;
    let mut history = History::of(std::iter::once(quantity), scene);
    let (tolerance, loosest) = tolerances(quantity, targets, options);
    let options = Options { tolerance, estimates: true, ..*options };
    let one_thread = Options { threads: 1, ..options };
    let began = Instant::now();
    let (mut samples, mut doublings): (Vec<Sample>, i32) = (Vec::new(), first(scene));
    let list_with = |samples: &[Sample], counted: &[Counted], speed_up: f64| -> Vec<Price> {
        let row = |target: &f64| price(scene, (samples, counted), accuracy, (quantity, *target), speed_up);
        targets.iter().map(row).collect()
    };
    let list = |samples: &[Sample]| list_with(samples, &[], 1.0);
    let mut budget = Budget::default();
    while samples.len() < MOST_SAMPLES {
        let spare = FOR_TIMES * (SAMPLES_SECONDS - began.elapsed().as_secs_f64());
        let callbacks = (&mut surface, &mut progress);
        let sample = match Sample::take(scene, &one_thread, (doublings, spare), quantity, callbacks)? {
            Taken::Sample(sample) => sample.with_history(&mut history),
            Taken::Cancelled => return Ok((Outcome::Cancelled, list(&samples))),
            // A grid coarser than the scene's may fail; the next one may not.
            Taken::Unsolved(_) if samples.is_empty() && doublings < 0 => {
                doublings += 1;
                continue;
            }
            Taken::Unsolved(outcome) if samples.is_empty() => return Ok((outcome, list(&samples))),
            Taken::Unsolved(_) => break,
        };
        let next = sample.cost.seconds * NEXT_GRID_RATIO;
        samples.push(sample);
        doublings += 1;
        let most = budget.after(&list(&samples));
        let (loose, left) = (Options { tolerance: loosest, ..one_thread }, most - began.elapsed().as_secs_f64());
        if loosen(scene, &loose, (&mut samples, left), (&mut surface, &mut progress))? == Outcome::Cancelled {
            return Ok((Outcome::Cancelled, list(&samples)));
        }
        let ends = began.elapsed().as_secs_f64() + next;
        let is_over = ends > most && (ends > UNKNOWN_SECONDS || is_known(&samples, history.is_believed()));
        if is_over || is_apart(&samples) || scaled(scene, doublings).is_err() {
            break;
        }
    }
    let counted = count(scene, &one_thread, (&samples, &list(&samples)), (&mut surface, &mut progress))?;
    let Some(counted) = counted else { return Ok((Outcome::Cancelled, list(&samples))) };
    Ok(match speed_up(scene, &options, (&samples, quantity), (&mut surface, &mut progress))? {
        Some(speed_up) => (Outcome::Converged, list_with(&samples, &counted, speed_up)),
        None => (Outcome::Cancelled, list(&samples)),
    })
}

/// Refuses invalid limits, scenes, targets and quantities.
fn check_asked(
    (scene, options, has_surface): (&Scene<'_>, &Options, bool),
    accuracy: &Accuracy,
    (quantity, targets): (Quantity, &[f64]),
) -> Result<()> {
    accuracy.check_limits()?;
    check(scene, options, has_surface)?;
    targets.iter().try_for_each(|target| require_target(*target))?;
    quantity.check(scene)
}

/// The seconds that samples may take.
#[derive(Default)]
struct Budget {
    /// The least prediction so far for the seconds of the most expensive row. Samples of few elements may predict too many seconds.
    least: Option<f64>,
}

impl Budget {
    /// Most seconds of all samples, after a sample that predicts these rows.
    fn after(&mut self, rows: &[Price]) -> f64 {
        let reachable = rows.iter().filter(|price| price.obstacle.is_none()).filter_map(|price| price.seconds);
        let most_expensive = reachable.reduce(f64::max);
        self.least = self.least.into_iter().chain(most_expensive).reduce(f64::min);
        SAMPLES_SECONDS.max(SAMPLES_SHARE * self.least.unwrap_or(0.0))
    }
}

/// Whether the samples suffice to predict the rows, or the last one is so large that no further one is made.
fn is_known(samples: &[Sample], is_believed: bool) -> bool {
    let Some(last) = samples.last() else { return false };
    // Errors that follow from several grids need three of them, or four if the first two changes are equal by chance.
    let has_error = last.error().is_some() && is_believed || samples.len() > 3;
    last.across >= FEWEST_ACROSS && has_error || last.cost.elements > UNRESOLVED_ELEMENTS
}

/// Whether there is no contact on so many grids that a search for an accuracy would end.
fn is_apart(samples: &[Sample]) -> bool {
    samples.iter().rev().take_while(|sample| sample.across == 0 && sample.doublings >= 0).count() >= MOST_WITHOUT
}

/// The tolerances that suffice for the least and for the greatest target.
fn tolerances(quantity: Quantity, targets: &[f64], options: &Options) -> (f64, f64) {
    let least = targets.iter().copied().fold(f64::INFINITY, f64::min);
    let tolerance = tolerance_for(quantity, least).min(options.tolerance.max(LEAST_TOLERANCE));
    let greatest = targets.iter().copied().fold(0.0, f64::max);
    (tolerance, tolerance_for(quantity, greatest).max(tolerance))
}

/// Solves the last sample again to a loose tolerance, to learn the cost of that. If a solve takes more than the seconds `left`, the relative cost of
/// the sample before is taken instead.
fn loosen(
    scene: &Scene<'_>,
    options: &Options,
    (samples, left): (&mut [Sample], f64),
    callbacks: Callbacks<'_, '_, '_>,
) -> Result<Outcome> {
    let Some((last, before)) = samples.split_last_mut() else { return Ok(Outcome::Converged) };
    let before = before.last().filter(|_| last.cost.seconds > left);
    last.loosen(scene, options, before, callbacks)
}

/// Measures the speed-up by the threads of the options, on the last sample that takes little time. None: a callback cancelled.
fn speed_up(
    scene: &Scene<'_>,
    options: &Options,
    (samples, quantity): (&[Sample], Quantity),
    callbacks: Callbacks<'_, '_, '_>,
) -> Result<Option<f64>> {
    let last = samples.last().filter(|last| options.threads != 1 && last.cost.seconds < SAMPLES_SECONDS);
    let Some(last) = last else { return Ok(Some(1.0)) };
    Ok(match Sample::take(scene, options, (last.doublings, last.cost.seconds), quantity, callbacks)? {
        Taken::Sample(again) => Some((last.cost.seconds / again.cost.seconds).max(1.0)),
        Taken::Cancelled => None,
        Taken::Unsolved(_) => Some(1.0),
    })
}

/// Counts the products of those rows whose grids take little time, by solving them. None: a callback cancelled.
fn count(
    scene: &Scene<'_>,
    options: &Options,
    (samples, rows): (&[Sample], &[Price]),
    (surface, progress): Callbacks<'_, '_, '_>,
) -> Result<Option<Vec<Counted>>> {
    let (began, mut counted) = (Instant::now(), Vec::<Counted>::new());
    let Some(last) = samples.last() else { return Ok(Some(counted)) };
    for row in rows.iter().filter(|row| row.obstacle.is_none()) {
        let (Some(grid), tolerance) = (row.grid, row.tolerance) else { continue };
        let doublings = (grid.mx.max(grid.my) as f64 / scene.grid.mx.max(scene.grid.my) as f64).log2().round() as i32;
        let finer = doublings - last.doublings;
        let seconds = last.solve * if finer > 0 { NEXT_GRID_RATIO } else { LEAST_COST_RATIO }.powi(finer);
        let is_known = counted.iter().any(|one| one.is_of(&grid, tolerance));
        if is_known || began.elapsed().as_secs_f64() + seconds > FOR_COUNTS {
            continue;
        }
        let options = Options { tolerance, ..*options };
        match Sample::count(scene, &options, doublings, (surface, progress))? {
            Ok(Some(products)) => counted.push(Counted { grid, tolerance, products }),
            Ok(None) => {}
            Err(_) => return Ok(None),
        }
    }
    Ok(Some(counted))
}

/// The doublings from the scene's grid to the first sample; negative numbers are halvings.
fn first(scene: &Scene<'_>) -> i32 {
    let most = scene.grid.mx.max(scene.grid.my);
    let halves = (0..).take_while(|k| most >> k >= 2 * FIRST_SAMPLE && scaled(scene, -(k + 1)).is_ok());
    -(halves.count() as i32)
}

#[cfg(test)]
#[path = "../../../tests/unit/price_list.rs"]
mod tests;
