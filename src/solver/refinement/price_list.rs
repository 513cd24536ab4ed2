//! What accuracies cost, before they are paid for: the price list.
//!
//! The scene is solved on small grids, the last of which takes a small part of what the dearest accuracy does. Its errors and seconds
//! are carried on to finer grids: errors by their orders (module `estimates`), seconds by a power of the number of elements.

use std::time::Instant;

use super::next_grid::{tolerance_for, ENOUGH_ACROSS, MOST_ELEMENTS, ROUND_OFF};
use super::outlook::{across, Falling};
use super::{check, on_grid, scaled, Accuracy, Quantity, Solved, SurfaceCallback};
use crate::error::{require, Result};
use crate::grid::Grid;
use crate::scene::Scene;
use crate::solver::{Options, Progress};

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
    /// The coarsest grid that is predicted to do; with an obstacle as far as it is known, else that of the scene.
    pub grid: Grid,
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
const PART: f64 = 0.012;
const SECONDS: f64 = 0.03;
/// The first sample has about so many elements in a direction.
const FIRST: usize = 32;
/// Elements across the contact on a sample that can be carried on.
const ACROSS: usize = 12;
/// Powers of the number of elements with which seconds grow: of that which samples show, what is believed.
const EXPONENTS: (f64, f64) = (1.0, 1.15);
/// What a grid of four times as many elements takes at most, where samples have not shown it.
const NEXT: f64 = 5.0;

/// What a small grid has shown.
struct Sample {
    doublings: i32,
    elements: f64,
    across: usize,
    falling: Option<Falling>,
    bytes: f64,
    /// Until the residual was first at most that: seconds since the start of the surface.
    reached: Vec<(f64, f64)>,
    seconds: f64,
}

/// Predicts what each of the relative errors `targets` of a quantity costs, from solves on small grids over the rectangle of the
/// scene. Of `accuracy` the limits are read; the rows say which of them is in the way. `surface` as in
/// [`solve_to_accuracy`](super::solve_to_accuracy).
pub fn cost_of_accuracy(
    scene: &Scene<'_>,
    options: &Options,
    accuracy: &Accuracy,
    (quantity, targets): (Quantity, &[f64]),
    mut surface: Option<SurfaceCallback<'_>>,
) -> Result<Vec<Price>> {
    accuracy.check()?;
    check(scene, options, surface.is_some())?;
    for &target in targets {
        require(target > 0.0 && target.is_finite(), "target", target, "it must be positive and finite")?;
    }
    let least = targets.iter().copied().fold(f64::INFINITY, f64::min);
    let tolerance = tolerance_for(quantity, least).clamp(1e-12, options.tolerance);
    let options = Options { tolerance, estimates: true, ..*options };
    let one = Options { threads: 1, ..options };
    let began = Instant::now();
    let (mut samples, mut doublings): (Vec<Sample>, i32) = (Vec::new(), first(&scene.grid));
    loop {
        let Some(sample) = Sample::take(scene, &one, doublings, quantity, &mut surface)? else { break };
        samples.push(sample);
        let dearest = targets.iter().filter_map(|target| predict(scene, &samples, *target)).map(|(_, s)| s);
        let budget = SECONDS.max(PART * dearest.fold(0.0, f64::max));
        let next = samples.last().map_or(0.0, |last| last.seconds * NEXT);
        doublings += 1;
        if began.elapsed().as_secs_f64() + next > budget || samples.len() > 12 {
            break;
        }
    }
    // How much faster more threads are.
    let speed_up = match samples.last() {
        Some(last) if options.threads != 1 && began.elapsed().as_secs_f64() + last.seconds < 2.0 * SECONDS => {
            let again = Sample::take(scene, &options, last.doublings, quantity, &mut surface)?;
            again.map_or(1.0, |again| (last.seconds / again.seconds).max(1.0))
        }
        _ => 1.0,
    };
    Ok(targets.iter().map(|target| price(scene, &samples, accuracy, (quantity, *target), speed_up)).collect())
}

/// Doublings, or with a sign halvings, from the scene's grid to the first sample.
fn first(grid: &Grid) -> i32 {
    let halves = (0..).take_while(|k| grid.mx.max(grid.my) >> k >= 2 * FIRST && scaled(grid, -(k + 1)).is_ok());
    -(halves.count() as i32)
}

impl Sample {
    /// None where nothing is solved.
    fn take(
        scene: &Scene<'_>,
        options: &Options,
        doublings: i32,
        quantity: Quantity,
        surface: &mut Option<SurfaceCallback<'_>>,
    ) -> Result<Option<Sample>> {
        let began = Instant::now();
        let mut reached: Vec<(f64, f64)> = Vec::new();
        let elements = scaled(&scene.grid, doublings)?.len();
        let mut watch = |told: &Progress| {
            if told.mx * told.my == elements {
                reached.push((told.residual, began.elapsed().as_secs_f64()));
            }
            false
        };
        let solved = on_grid(scene, options, doublings, surface, &mut Some(&mut watch), &|_| false)?;
        let seconds = began.elapsed().as_secs_f64();
        let Ok(Solved { solver, report, outlook }) = solved else { return Ok(None) };
        let repeats = solver.influence().repeats(solver.grid());
        let (x, y) = across(solver.state(), repeats);
        Ok(Some(Sample {
            doublings,
            elements: elements as f64,
            across: x.min(y),
            falling: outlook.falling(quantity),
            bytes: report.bytes as f64,
            reached,
            seconds,
        }))
    }

    /// Seconds to a residual: what follows the last iteration is needed by any.
    fn seconds_to(&self, tolerance: f64) -> f64 {
        let end = self.reached.last().map_or(0.0, |last| last.1);
        let at = self.reached.iter().find(|(residual, _)| *residual <= tolerance).map_or(end, |found| found.1);
        self.seconds - (end - at)
    }
}

/// The power of the number of elements with which seconds grow.
fn growth(samples: &[Sample]) -> f64 {
    let [.., before, last] = samples else { return EXPONENTS.1 };
    let seen = (last.seconds / before.seconds).ln() / (last.elements / before.elements).ln();
    if seen.is_finite() {
        seen.clamp(EXPONENTS.0, EXPONENTS.1)
    } else {
        EXPONENTS.1
    }
}

/// Doublings from the last sample to the first grid that does, and the seconds of one thread to the tolerance of the samples.
fn predict(scene: &Scene<'_>, samples: &[Sample], target: f64) -> Option<(i32, f64)> {
    let last = samples.last()?;
    let falling = last.falling?;
    let most = (MOST_ELEMENTS as f64).log2() as i32;
    let least = -(last.across.ilog2() as i32);
    let does = |k: &i32| {
        let enough = last.across as f64 * 2f64.powi(*k) >= ENOUGH_ACROSS as f64;
        enough && falling.after(*k) <= target && scaled(&scene.grid, last.doublings + k).is_ok()
    };
    let k = (least..=most).find(does)?;
    let ratio = 4f64.powi(k);
    let sample = samples.iter().find(|sample| sample.doublings == last.doublings + k);
    let seconds = sample.map_or(last.seconds * ratio.powf(growth(samples)), |sample| sample.seconds);
    Some((k, seconds))
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
        grid: scene.grid,
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
    let Some(last) = samples.last().filter(|last| last.across >= ACROSS.min(ENOUGH_ACROSS)) else { return nothing };
    let Some(falling) = last.falling else { return nothing };
    let Some((k, seconds)) = predict(scene, samples, target) else {
        return Price { obstacle: Some(Obstacle::Elements), ..nothing };
    };
    let Ok(grid) = scaled(&scene.grid, last.doublings + k) else { return nothing };
    let seconds = seconds * last.seconds_to(tolerance) / last.seconds;
    let bytes = last.bytes * 4f64.powi(k);
    let most = if accuracy.max_elements == 0 { MOST_ELEMENTS } else { accuracy.max_elements };
    let obstacle = if grid.len() as u64 > most {
        Some(Obstacle::Elements)
    } else if accuracy.max_bytes > 0 && bytes > accuracy.max_bytes as f64 {
        Some(Obstacle::Memory)
    } else if accuracy.is_late(seconds / speed_up) {
        Some(Obstacle::Time)
    } else {
        None
    };
    Price {
        grid,
        error: falling.after(k) + tolerance,
        seconds: seconds / speed_up,
        seconds_one_thread: seconds,
        bytes: bytes as u64,
        obstacle,
        ..nothing
    }
}
