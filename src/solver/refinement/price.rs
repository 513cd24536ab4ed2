//! One row of the price list, from samples.

use super::next_grid::{tolerance_for, MOST_ELEMENTS, ROUND_OFF};
use super::sample::Sample;
use super::Accuracy;
use crate::grid::Grid;
use crate::scene::{scaled, Scene};
use crate::solver::machine::growth;
use crate::solver::quantities::Quantity;

/// The least and the largest power of the number of elements with which seconds of set-ups grow.
const SETUP_GROWTH: (f64, f64) = (0.4, 1.08);
/// The largest power of the number of elements with which seconds of a solve grow.
const GROWTH: f64 = 1.2;
/// Samples with less than this part of the products of the last do not count for seconds.
const SEES: f64 = 0.5;
/// Residuals with which a grid begins fall so much with a doubling: it starts from the grid before, whose error is of this order at the rim.
const BEGINS: f64 = 0.35;
/// Elements across the contact on a sample that can be carried on.
pub(super) const ACROSS: usize = 12;

/// The reason why an accuracy cannot be had.
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
    /// Bodies relax, and the length of the step alone leaves more than the error that is wanted.
    Step,
}

/// The price of one accuracy.
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
    /// Products that the solve takes, in products on its grid; 0: not known.
    pub work_units: f64,
    /// Bytes held by the solver; 0: not known.
    pub bytes: u64,
    /// Why it cannot be had; none where it can.
    pub obstacle: Option<Obstacle>,
    /// Of bodies that relax: the relative error that the length of the step leaves on any grid, beside `error`; 0: none relaxes.
    pub time_error: f64,
}

/// Seconds of one thread on a grid of so many elements, from the sample that promises the least: others were disturbed, or so small
/// that they are mostly overhead. Samples with half the products of the last and fewer hardly see the contact. The set-up grows as the last two
/// samples say (that of a period hardly does). No grid takes longer than a finer one.
pub(super) fn seconds_on(samples: &[Sample], elements: f64) -> f64 {
    let seen = match samples {
        [.., before, last] => (last.setup / before.setup).ln() / (last.elements / before.elements).ln(),
        _ => SETUP_GROWTH.1,
    };
    let of_setup = if seen.is_finite() { seen.clamp(SETUP_GROWTH.0, SETUP_GROWTH.1) } else { SETUP_GROWTH.1 };
    let least = samples.last().map_or(0.0, |last| SEES * last.products);
    let of_solve = grown(samples, least);
    let carried = |sample: &Sample| {
        let ratio = elements / sample.elements;
        let by = growth(sample.elements, elements).max(if ratio > 1.0 { ratio.powf(of_solve) } else { 0.0 });
        sample.setup * ratio.powf(of_setup) + (sample.seconds - sample.setup) * by
    };
    match samples.first() {
        // A grid coarser than all samples: the first of them, carried down.
        Some(first) if first.elements > elements => carried(first),
        _ => {
            let of = |sample: &Sample| if sample.elements <= elements { carried(sample) } else { sample.seconds };
            let sees = |sample: &&Sample| sample.products >= least;
            samples.iter().filter(sees).map(of).fold(f64::INFINITY, f64::min)
        }
    }
}

/// The power of the number of elements with which the samples themselves grow, where each has `least` products: solves in turns, of unlike bodies, take more than
/// their products. The least one from sample to sample, for others were disturbed.
fn grown(samples: &[Sample], least: f64) -> f64 {
    let of = |pair: &[Sample]| (pair[1].seconds / pair[0].seconds).ln() / (pair[1].elements / pair[0].elements).ln();
    let seen = samples.windows(2).filter(|pair| pair[0].products >= least).map(of);
    seen.reduce(f64::min).map_or(0.0, |seen| seen.clamp(0.0, GROWTH))
}

/// Doublings from the last sample to the first grid that does, and the seconds of one thread to the tolerance of the samples.
pub(super) fn predict(
    scene: &Scene<'_>,
    samples: &[Sample],
    (quantity, target): (Quantity, f64),
) -> Option<(i32, f64)> {
    let last = samples.last()?;
    let falling = last.falling()?;
    let (least, most) = (-(last.across.ilog2() as i32), (MOST_ELEMENTS as f64).log2() as i32);
    let does = |k: &i32| {
        let enough = last.across as f64 * 2f64.powi(*k) >= quantity.enough_across() as f64;
        enough && falling.after(*k) <= target && scaled(&scene.grid, last.doublings + k).is_ok()
    };
    let k = (least..=most).find(does)?;
    Some((k, seconds_on(samples, last.elements * 4f64.powi(k))))
}

/// Of the seconds of a solve the part that a tolerance takes on a grid of so many doublings, and its products: those of the finest sample that is
/// not finer. On finer grids than that the iteration begins nearer to the end.
fn to(samples: &[Sample], doublings: i32, tolerance: f64) -> (f64, f64) {
    let Some(sample) = samples.iter().rev().find(|sample| sample.doublings <= doublings).or(samples.first()) else {
        return (1.0, 0.0);
    };
    let (seconds, products) = sample.to(tolerance / BEGINS.powi((doublings - sample.doublings).max(0)));
    (seconds / sample.seconds, products)
}

/// One row.
pub(super) fn price(
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
        work_units: 0.0,
        bytes: 0,
        obstacle: Some(Obstacle::Singular),
        time_error: samples.last().map_or(0.0, |last| last.time_error),
    };
    if target < ROUND_OFF {
        return Price { obstacle: Some(Obstacle::RoundOff), ..nothing };
    }
    let last = samples.last().filter(|last| last.across >= ACROSS);
    let Some((last, falling)) = last.and_then(|last| Some((last, last.falling()?))) else { return nothing };
    let Some((k, seconds)) = predict(scene, samples, (quantity, target)) else {
        return Price { obstacle: Some(Obstacle::Elements), ..nothing };
    };
    let Ok(grid) = scaled(&scene.grid, last.doublings + k) else { return nothing };
    let (part, work_units) = to(samples, last.doublings + k, tolerance);
    let seconds = seconds * part;
    let bytes = last.bytes * 4f64.powi(k);
    let most = if accuracy.max_elements == 0 { MOST_ELEMENTS } else { accuracy.max_elements };
    let obstacles = [
        (grid.len() as u64 > most, Obstacle::Elements),
        (accuracy.max_bytes > 0 && bytes > accuracy.max_bytes as f64, Obstacle::Memory),
        (accuracy.is_late(seconds / speed_up), Obstacle::Time),
        (last.time_error > target, Obstacle::Step),
    ];
    let obstacle = obstacles.into_iter().find(|(is_in_the_way, _)| *is_in_the_way).map(|(_, obstacle)| obstacle);
    Price {
        grid: Some(grid),
        error: falling.after(k) + tolerance,
        seconds: seconds / speed_up,
        seconds_one_thread: seconds,
        work_units,
        bytes: bytes as u64,
        obstacle,
        ..nothing
    }
}
