//! What accuracies cost, before they are paid for: the price list.
//!
//! The scene is solved on small grids, the last of which takes a small part of what the dearest accuracy does. Its errors and seconds
//! are carried on to finer grids: errors by their orders (module `estimates`), seconds by a power of the number of elements.

use std::time::Instant;

use super::next_grid::{require_target, tolerance_for, ENOUGH_ACROSS, MOST_ELEMENTS, ROUND_OFF};
use super::outlook::{across, Falling};
use super::solved::Solved;
use super::{check, on_grid, scaled, Accuracy, Quantity, SurfaceCallback};
use crate::error::Result;
use crate::grid::Grid;
use crate::scene::Scene;
use crate::solver::{Options, Outcome, Progress, ProgressCallback};

/// What keeps an accuracy from being had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// The largest pressure is singular, or contact on single elements: no grid is known to do.
    Singular,
    /// The target is below round-off.
    RoundOff,
    /// It takes more elements than `max_elements`.
    Elements,
    /// It takes more memory than `max_bytes`.
    Memory,
    /// It takes longer than `max_seconds`.
    Time,
}

/// What one accuracy costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// The relative error that is wanted.
    pub target: f64,
    /// The coarsest grid that is predicted to do, if that is known.
    pub grid: Option<Grid>,
    /// The tolerance to ask for: more would be wasted.
    pub tolerance: f64,
    /// Relative error that this grid and tolerance are predicted to leave; negative: not known.
    pub error: f64,
    /// Seconds of set-up and solve with the threads of the options; negative: not known.
    pub seconds: f64,
    /// Seconds with one thread; negative: not known.
    pub seconds_one_thread: f64,
    /// Bytes held by the solver; 0: not known.
    pub bytes: u64,
    /// What keeps it from being had.
    pub obstacle: Option<Obstacle>,
}

/// The samples take at most this part of the seconds of the dearest accuracy, or these seconds; less a margin for the last of them.
const PART: f64 = 0.014;
const SECONDS: f64 = 0.035;
/// The first sample has about so many elements in a direction.
const FIRST: usize = 32;
/// Elements across the contact on a sample that can be carried on.
const ACROSS: usize = 12;
/// The power of the number of elements with which seconds grow (docs/performance.md).
const GROWTH: f64 = 1.08;
/// That of set-ups, at least.
const SETUP_GROWTH: f64 = 0.4;
/// What a grid of four times as many elements takes at most, where samples have not shown it.
const NEXT: f64 = 5.0;

/// On more elements contact that is still on fewer across is left alone, whatever is known.
const UNRESOLVED: f64 = 2e5;
/// Samples at most.
const MOST_SAMPLES: usize = 12;
/// Samples are timed again, so often at most and for this part of the seconds: the first solve of a size is slow, and machines are busy.
const AGAIN: usize = 3;
const FOR_TIMES: f64 = 0.5;

/// What a sample asks: the surface, and whether to go on.
type Callbacks<'c, 's, 'p> = (&'c mut Option<SurfaceCallback<'s>>, &'c mut Option<ProgressCallback<'p>>);

/// What became of a sample.
enum Taken {
    Sample(Sample),
    /// By a callback.
    Cancelled,
    Unsolved,
}

/// What a small grid has shown.
struct Sample {
    doublings: i32,
    elements: f64,
    /// In the direction with fewer of them.
    across: usize,
    falling: Option<Falling>,
    bytes: f64,
    /// Until the residual was first at most that: seconds since the start of the surface.
    reached: Vec<(f64, f64)>,
    seconds: f64,
    /// Of which the set-up took so many.
    setup: f64,
}

/// Predicts what each of the relative errors `targets` of a quantity costs, from solves on small grids over the rectangle of the
/// scene. Of `accuracy` the limits are read; the rows say which of them is in the way. `surface` as in
/// [`solve_to_accuracy`](super::solve_to_accuracy). Cancelled: by the surface, or by `progress`, which is told of each cycle; the rows then hold what
/// was known.
pub fn cost_of_accuracy(
    scene: &Scene<'_>,
    options: &Options,
    accuracy: &Accuracy,
    (quantity, targets): (Quantity, &[f64]),
    mut surface: Option<SurfaceCallback<'_>>,
    mut progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Vec<Price>)> {
    accuracy.check_limits()?;
    check(scene, options, surface.is_some())?;
    for &target in targets {
        require_target(target)?;
    }
    let least = targets.iter().copied().fold(f64::INFINITY, f64::min);
    let tolerance = tolerance_for(quantity, least).clamp(1e-12, options.tolerance);
    let options = Options { tolerance, estimates: true, ..*options };
    let one = Options { threads: 1, ..options };
    let began = Instant::now();
    let (mut samples, mut doublings): (Vec<Sample>, i32) = (Vec::new(), first(&scene.grid));
    let list = |samples: &[Sample], speed_up: f64| -> Vec<Price> {
        targets.iter().map(|target| price(scene, samples, accuracy, (quantity, *target), speed_up)).collect()
    };
    while samples.len() < MOST_SAMPLES {
        let spare = FOR_TIMES * (SECONDS - began.elapsed().as_secs_f64());
        let sample = match Sample::take(scene, &one, (doublings, spare), quantity, (&mut surface, &mut progress))? {
            Taken::Sample(sample) => sample,
            Taken::Cancelled => return Ok((Outcome::Cancelled, list(&samples, 1.0))),
            Taken::Unsolved => break,
        };
        let next = sample.seconds * NEXT;
        samples.push(sample);
        doublings += 1;
        let had = list(&samples, 1.0).into_iter().filter(|price| price.obstacle.is_none());
        let dearest = had.map(|price| price.seconds).fold(0.0, f64::max);
        let known = samples.last().is_some_and(|last| last.across >= ACROSS || last.elements > UNRESOLVED);
        let over = began.elapsed().as_secs_f64() + next > SECONDS.max(PART * dearest);
        if known && over || scaled(&scene.grid, doublings).is_err() {
            break;
        }
    }
    // How much faster more threads are.
    let mut speed_up = 1.0;
    if let Some(last) = samples.last().filter(|last| options.threads != 1 && last.seconds < SECONDS) {
        let callbacks = (&mut surface, &mut progress);
        match Sample::take(scene, &options, (last.doublings, last.seconds), quantity, callbacks)? {
            Taken::Sample(again) => speed_up = (last.seconds / again.seconds).max(1.0),
            Taken::Cancelled => return Ok((Outcome::Cancelled, list(&samples, 1.0))),
            Taken::Unsolved => {}
        }
    }
    Ok((Outcome::Converged, list(&samples, speed_up)))
}

/// Doublings, or with a sign halvings, from the scene's grid to the first sample.
fn first(grid: &Grid) -> i32 {
    let halves = (0..).take_while(|k| grid.mx.max(grid.my) >> k >= 2 * FIRST && scaled(grid, -(k + 1)).is_ok());
    -(halves.count() as i32)
}

impl Sample {
    /// Solves once, and again for the time as long as there are seconds to spare.
    fn take(
        scene: &Scene<'_>,
        options: &Options,
        (doublings, spare): (i32, f64),
        quantity: Quantity,
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut spent) = (Instant::now(), 0.0);
        let mut taken = Sample::take_once(scene, options, doublings, quantity, (surface, progress))?;
        for _ in 0..AGAIN {
            let Taken::Sample(best) = &mut taken else { break };
            if spent + 2.0 * best.seconds > spare {
                break;
            }
            match Sample::take_once(scene, options, doublings, quantity, (surface, progress))? {
                Taken::Sample(again) if again.seconds < best.seconds => *best = again,
                Taken::Cancelled => return Ok(Taken::Cancelled),
                _ => {}
            }
            spent = began.elapsed().as_secs_f64();
        }
        Ok(taken)
    }

    fn take_once(
        scene: &Scene<'_>,
        options: &Options,
        doublings: i32,
        quantity: Quantity,
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut reached) = (Instant::now(), Vec::new());
        let elements = scaled(&scene.grid, doublings)?.len();
        let mut watch = |told: &Progress| {
            if told.mx * told.my == elements {
                reached.push((told.residual, began.elapsed().as_secs_f64()));
            }
            progress.as_mut().is_some_and(|progress| progress(told))
        };
        let Solved { solver, report, outlook } =
            match on_grid(scene, options, doublings, surface, &mut Some(&mut watch), &|_| false)? {
                Ok(solved) => solved,
                Err((Outcome::Cancelled, ..)) => return Ok(Taken::Cancelled),
                Err(_) => return Ok(Taken::Unsolved),
            };
        let seconds = began.elapsed().as_secs_f64();
        let (x, y) = across(solver.state(), solver.influence().repeats(solver.grid()));
        Ok(Taken::Sample(Sample {
            doublings,
            elements: elements as f64,
            across: x.min(y),
            falling: outlook.falling(quantity),
            bytes: report.bytes as f64,
            reached,
            seconds,
            setup: report.setup_seconds,
        }))
    }

    /// Seconds to a residual: what follows the last iteration is needed by any.
    fn seconds_to(&self, tolerance: f64) -> f64 {
        let end = self.reached.last().map_or(0.0, |last| last.1);
        let at = self.reached.iter().find(|(residual, _)| *residual <= tolerance).map_or(end, |found| found.1);
        self.seconds - (end - at)
    }
}

/// Seconds of one thread on a grid of so many elements, from the sample that promises the least: others were disturbed, or so small
/// that they are mostly overhead. The set-up grows as the last two samples say (that of a period hardly does).
fn seconds_on(samples: &[Sample], elements: f64) -> f64 {
    let seen = match samples {
        [.., before, last] => (last.setup / before.setup).ln() / (last.elements / before.elements).ln(),
        _ => GROWTH,
    };
    let of_setup = if seen.is_finite() { seen.clamp(SETUP_GROWTH, GROWTH) } else { GROWTH };
    let carried = |sample: &Sample| {
        let ratio = elements / sample.elements;
        sample.setup * ratio.powf(of_setup) + (sample.seconds - sample.setup) * ratio.powf(GROWTH)
    };
    samples.iter().filter(|sample| sample.elements <= elements).map(carried).fold(f64::INFINITY, f64::min)
}

/// Doublings from the last sample to the first grid that does, and the seconds of one thread to the tolerance of the samples.
fn predict(scene: &Scene<'_>, samples: &[Sample], target: f64) -> Option<(i32, f64)> {
    let last = samples.last()?;
    let falling = last.falling?;
    let (least, most) = (-(last.across.ilog2() as i32), (MOST_ELEMENTS as f64).log2() as i32);
    let does = |k: &i32| {
        let enough = last.across as f64 * 2f64.powi(*k) >= ENOUGH_ACROSS as f64;
        enough && falling.after(*k) <= target && scaled(&scene.grid, last.doublings + k).is_ok()
    };
    let k = (least..=most).find(does)?;
    Some((k, seconds_on(samples, last.elements * 4f64.powi(k))))
}

/// One row.
fn price(
    scene: &Scene<'_>,
    samples: &[Sample],
    accuracy: &Accuracy,
    (quantity, target): (Quantity, f64),
    speed_up: f64,
) -> Price {
    let tolerance = tolerance_for(quantity, target).max(1e-12);
    let nothing = Price {
        target,
        grid: None,
        tolerance,
        error: -1.0,
        seconds: -1.0,
        seconds_one_thread: -1.0,
        bytes: 0,
        obstacle: Some(Obstacle::Singular),
    };
    if target < ROUND_OFF {
        return Price { obstacle: Some(Obstacle::RoundOff), ..nothing };
    }
    let last = samples.last().filter(|last| last.across >= ACROSS);
    let Some((last, falling)) = last.and_then(|last| Some((last, last.falling?))) else { return nothing };
    let Some((k, seconds)) = predict(scene, samples, target) else {
        return Price { obstacle: Some(Obstacle::Elements), ..nothing };
    };
    let Ok(grid) = scaled(&scene.grid, last.doublings + k) else { return nothing };
    let seconds = seconds * last.seconds_to(tolerance) / last.seconds;
    let bytes = last.bytes * 4f64.powi(k);
    let most = if accuracy.max_elements == 0 { MOST_ELEMENTS } else { accuracy.max_elements };
    let obstacles = [
        (grid.len() as u64 > most, Obstacle::Elements),
        (accuracy.max_bytes > 0 && bytes > accuracy.max_bytes as f64, Obstacle::Memory),
        (accuracy.is_late(seconds / speed_up), Obstacle::Time),
    ];
    let obstacle = obstacles.into_iter().find(|(is_in_the_way, _)| *is_in_the_way).map(|(_, obstacle)| obstacle);
    Price {
        grid: Some(grid),
        error: falling.after(k) + tolerance,
        seconds: seconds / speed_up,
        seconds_one_thread: seconds,
        bytes: bytes as u64,
        obstacle,
        ..nothing
    }
}
