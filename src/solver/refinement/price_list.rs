//! The price list: predicted costs of accuracies.
//!
//! The scene is solved on small grids, the last of which takes a small part of the time of the most expensive accuracy. Errors and seconds are
//! extrapolated to finer grids: errors by their orders (module `estimates`), seconds by a power of the number of elements.

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

/// Most seconds of all samples, including those predicted for the next one: SAMPLES_SECONDS, or this share of the
/// seconds of the most expensive accuracy if that is more.
const SAMPLES_SHARE: f64 = 0.014;
const SAMPLES_SECONDS: f64 = 0.035;
/// The first sample has from this many to twice as many elements in its longer direction, if the grid can be halved so
/// often.
const FIRST_SAMPLE: usize = 32;
/// Lower bound on the cost ratio of a grid with four times the elements.
const LEAST_COST_RATIO: f64 = 2.0;

/// Elements of a sample beyond which an unresolved contact is accepted. Up to there samples go on for UNKNOWN_SECONDS.
const UNRESOLVED_ELEMENTS: f64 = 2e5;
/// About the most seconds of the samples while no row is known.
const UNKNOWN_SECONDS: f64 = 2.0;
/// Most samples.
const MOST_SAMPLES: usize = 12;
/// Most seconds for counting the products of small rows.
const FOR_COUNTS: f64 = 0.005;
/// Share of the remaining SAMPLES_SECONDS for repeated timings of a sample.
const FOR_TIMES: f64 = 0.5;

/// Predicts the cost of each of the relative errors `targets` of a quantity, from solves on small grids over the rectangle of the scene. Uses
/// the limits of `accuracy`; a row names the limit that forbids it. `surface` as in [`solve_to_accuracy`](super::solve_to_accuracy). After
/// a cancel by the surface or by `progress`, which is called after each cycle, the rows hold the results so far. ITERATION_LIMIT, STAGNATED: neither
/// the grid of the scene nor a coarser one was solved. A quantity that is 0 as nothing touches is exact on the grid of the scene.
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
    let one = Options { threads: 1, ..options };
    let began = Instant::now();
    let (mut samples, mut doublings): (Vec<Sample>, i32) = (Vec::new(), first(scene));
    let list_with = |samples: &[Sample], counted: &[Counted], speed_up: f64| -> Vec<Price> {
        let one = |target: &f64| price(scene, (samples, counted), accuracy, (quantity, *target), speed_up);
        targets.iter().map(one).collect()
    };
    let list = |samples: &[Sample]| list_with(samples, &[], 1.0);
    let mut budget = Budget::default();
    while samples.len() < MOST_SAMPLES {
        let spare = FOR_TIMES * (SAMPLES_SECONDS - began.elapsed().as_secs_f64());
        let sample = match Sample::take(scene, &one, (doublings, spare), quantity, (&mut surface, &mut progress))? {
            Taken::Sample(sample) => sample.carried_on(&mut history),
            Taken::Cancelled => return Ok((Outcome::Cancelled, list(&samples))),
            // A coarser grid may be refused where the scene's is not.
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
        let (loose, left) = (Options { tolerance: loosest, ..one }, most - began.elapsed().as_secs_f64());
        if loosen(scene, &loose, (&mut samples, left), (&mut surface, &mut progress))? == Outcome::Cancelled {
            return Ok((Outcome::Cancelled, list(&samples)));
        }
        let ends = began.elapsed().as_secs_f64() + next;
        let is_over = ends > most && (ends > UNKNOWN_SECONDS || is_known(&samples, history.is_believed()));
        if is_over || is_apart(&samples) || scaled(scene, doublings).is_err() {
            break;
        }
    }
    let counted = count(scene, &one, (&samples, &list(&samples)), (&mut surface, &mut progress))?;
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

/// The least of the seconds that samples predicted for the most expensive row so far. Samples of few elements may predict too many.
#[derive(Default)]
struct Budget {
    least: Option<f64>,
}

impl Budget {
    /// Most seconds of all samples, after a sample with these rows.
    fn after(&mut self, rows: &[Price]) -> f64 {
        let had = rows.iter().filter(|price| price.obstacle.is_none()).filter_map(|price| price.seconds);
        let dearest = had.reduce(f64::max);
        self.least = self.least.into_iter().chain(dearest).reduce(f64::min);
        SAMPLES_SECONDS.max(SAMPLES_SHARE * self.least.unwrap_or(0.0))
    }
}

/// Whether the samples determine the rows, or the last one is too large for another.
fn is_known(samples: &[Sample], is_believed: bool) -> bool {
    let Some(last) = samples.last() else { return false };
    // Without estimates from one grid, errors need three grids, or four if two changes happen to be equal. A search needs as many.
    let has_error = last.falling().is_some() && is_believed || samples.len() > 3;
    last.across >= FEWEST_ACROSS && has_error || last.cost.elements > UNRESOLVED_ELEMENTS
}

/// Whether nothing touches on so many grids that a search would end.
fn is_apart(samples: &[Sample]) -> bool {
    samples.iter().rev().take_while(|sample| sample.across == 0 && sample.doublings >= 0).count() >= MOST_WITHOUT
}

/// Tolerances of solves for the least and the greatest target.
fn tolerances(quantity: Quantity, targets: &[f64], options: &Options) -> (f64, f64) {
    let least = targets.iter().copied().fold(f64::INFINITY, f64::min);
    let tolerance = tolerance_for(quantity, least).min(options.tolerance.max(LEAST_TOLERANCE));
    let greatest = targets.iter().copied().fold(0.0, f64::max);
    (tolerance, tolerance_for(quantity, greatest).max(tolerance))
}

/// Solves the last sample to a loose tolerance if that takes at most the seconds `left`; else it takes the cost of the sample before.
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

/// The speed-up by more threads. None: cancelled by a callback.
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

/// The products of rows whose grids take little time, from solves. None: cancelled by a callback.
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

/// Doublings from the scene's grid to the first sample; negative: halvings.
fn first(scene: &Scene<'_>) -> i32 {
    let most = scene.grid.mx.max(scene.grid.my);
    let halves = (0..).take_while(|k| most >> k >= 2 * FIRST_SAMPLE && scaled(scene, -(k + 1)).is_ok());
    -(halves.count() as i32)
}

#[cfg(test)]
#[path = "../../../tests/unit/price_list.rs"]
mod tests;
