//! One row of the price list, computed from samples.

use super::accuracy::{tolerance_for, MOST_ELEMENTS, ROUND_OFF};
use super::sample::Sample;
use super::Accuracy;
use crate::grid::{doubling, Grid};
use crate::scene::{refines, scaled, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;
use crate::solver::seconds::{seconds_on, Cost, MOST_PRODUCTS_RATIO};

/// The initial residual of a grid over that of the next coarser grid. A grid starts from the result of the coarser grid. The initial residual comes
/// from the error of this result at the boundary of contact.
const FIRST_RESIDUAL_RATIO: f64 = 0.35;
/// The usual growth of tangential products with a doubling, measured on six surfaces (docs/notes/2026-11-accuracy.md).
const PRODUCTS_GROWTH: f64 = 1.1;
/// The fewest elements across the contact of a sample that can be extrapolated.
pub(super) const FEWEST_ACROSS: usize = 12;

/// The reason why an accuracy cannot be reached; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// No sufficient grid is known: the quantity is singular, contact is on few elements, nothing touches although the quantity is not 0 then, or no
    /// grid was solved.
    Singular = 1,
    /// The target is below round-off.
    RoundOff,
    /// It takes more elements than `max_elements`.
    Elements,
    /// It takes more memory than `max_bytes`.
    Memory,
    /// It takes longer than `max_seconds`.
    Time,
    /// Bodies relax, and the error of the step length alone exceeds the target.
    Step,
}

/// Products counted on a grid to a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counted {
    pub grid: Grid,
    pub tolerance: f64,
    pub products: f64,
}

impl Counted {
    pub fn is_of(&self, grid: &Grid, tolerance: f64) -> bool {
        self.grid == *grid && self.tolerance == tolerance
    }
}

/// The price of one accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// The target of the relative error.
    pub target: f64,
    /// The coarsest sufficient grid by prediction, if it is known.
    pub grid: Option<Grid>,
    /// The largest sufficient tolerance.
    pub tolerance: f64,
    /// The larger of the predicted relative error of the grid and the tolerance, if it is known.
    pub error: Option<f64>,
    /// Seconds of set-up and solve with the threads of the options, if they are known.
    pub seconds: Option<f64>,
    /// Seconds with one thread, if they are known.
    pub seconds_one_thread: Option<f64>,
    /// Products that the solve takes, in products on its grid; 0: not known.
    pub work_units: f64,
    /// Bytes held by the solver; 0: not known.
    pub bytes: u64,
    /// Why the accuracy cannot be reached. None if it can.
    pub obstacle: Option<Obstacle>,
    /// The relative error of the step length on any grid, in addition to `error`. 0 if no body relaxes.
    pub time_error: f64,
}

/// Predicts the doublings from the last sample to the first sufficient grid, and the seconds of one thread to the tolerance of the samples. For an
/// exact value the grid is that of the scene.
pub(super) fn predict(
    scene: &Scene<'_>,
    samples: &[Sample],
    (quantity, target): (Quantity, f64),
) -> Option<(i32, f64)> {
    let last = samples.last()?;
    let costs: Vec<Cost> = samples.iter().map(|sample| sample.cost).collect();
    let each = doubling(refines(scene));
    let seconds = |k: i32| seconds_on(&costs, last.cost.elements * each.powi(k));
    if last.is_exact() {
        return Some((-last.doublings, seconds(-last.doublings)));
    }
    let falling = last.falling()?;
    let (least, most) = (-(last.across.ilog2() as i32), (MOST_ELEMENTS as f64).log2() as i32);
    let does = |k: &i32| {
        let enough = last.across as f64 * 2f64.powi(*k) >= quantity.enough_across() as f64;
        enough && error_after(samples, falling, *k) <= target && scaled(scene, last.doublings + k).is_ok()
    };
    let k = (least..=most).find(does)?;
    Some((k, seconds(k)))
}

/// The relative error `k` doublings after the last sample. A coarser sample has at least its difference from the last one.
fn error_after(samples: &[Sample], falling: Falling, k: i32) -> f64 {
    let Some(last) = samples.last() else { return f64::INFINITY };
    let coarser = samples.iter().find(|sample| k < 0 && sample.doublings == last.doublings + k);
    let apart = coarser.and_then(|sample| Some(((sample.value()? - last.value()?) / last.value()?).abs()));
    falling.after(k).max(apart.map_or(0.0, |apart| apart + falling.now()))
}

/// The cost of a tolerance on the grid after `doublings`: its seconds over those of a solve to the samples' tolerance, and its products. Both come
/// from the finest sample that is not finer than this grid. On a finer grid the iteration starts closer to the solution.
fn to(samples: &[Sample], doublings: i32, tolerance: f64) -> (f64, f64) {
    let at = samples.iter().rposition(|sample| sample.doublings <= doublings).unwrap_or(0);
    let Some(sample) = samples.get(at) else { return (1.0, 0.0) };
    let finer = (doublings - sample.doublings).max(0);
    let begins = tolerance / FIRST_RESIDUAL_RATIO.powi(finer);
    if let Some((part, tangential)) = sample.between(tolerance) {
        let before = at.checked_sub(1).and_then(|before| samples[before].between(tolerance));
        // The growth between two samples is irregular. The prediction is its geometric mean with the usual growth.
        let seen = before.filter(|before| before.1 > 0.0).map_or(PRODUCTS_GROWTH, |before| tangential / before.1);
        let grows = (seen * PRODUCTS_GROWTH).sqrt().clamp(1.0, MOST_PRODUCTS_RATIO);
        return (part, sample.normal(tolerance, begins) + tangential * grows.powi(finer));
    }
    let (seconds, products) = sample.to(tolerance, begins);
    (seconds / sample.cost.seconds, products)
}

/// One row of the price list.
pub(super) fn price(
    scene: &Scene<'_>,
    (samples, counted): (&[Sample], &[Counted]),
    accuracy: &Accuracy,
    (quantity, target): (Quantity, f64),
    speed_up: f64,
) -> Price {
    let tolerance = tolerance_for(quantity, target);
    let nothing = Price {
        target,
        grid: None,
        tolerance,
        error: None,
        seconds: None,
        seconds_one_thread: None,
        work_units: 0.0,
        bytes: 0,
        obstacle: Some(Obstacle::Singular),
        time_error: samples.last().map_or(0.0, |last| last.time_error),
    };
    if target < ROUND_OFF {
        return Price { obstacle: Some(Obstacle::RoundOff), ..nothing };
    }
    let last = samples.last().filter(|last| last.across >= FEWEST_ACROSS || last.is_exact());
    let error_of = |last: &Sample| if last.is_exact() { Some(Falling::default()) } else { last.falling() };
    let Some((last, falling)) = last.and_then(|last| Some((last, error_of(last)?))) else { return nothing };
    let Some((k, seconds)) = predict(scene, samples, (quantity, target)) else {
        return Price { obstacle: Some(Obstacle::Elements), ..nothing };
    };
    let Ok(grid) = scaled(scene, last.doublings + k) else { return nothing };
    let (part, work_units) = to(samples, last.doublings + k, tolerance);
    let work_units = counted.iter().find(|one| one.is_of(&grid, tolerance)).map_or(work_units, |one| one.products);
    let seconds = seconds * part;
    let each = doubling(refines(scene));
    let sample = samples.iter().rfind(|sample| sample.doublings <= last.doublings + k).unwrap_or(&samples[0]);
    let bytes = sample.bytes * each.powi((last.doublings + k - sample.doublings).max(0));
    // A search holds the solver of the grid before, of half the elements a side or less, unless it ends on its first grid.
    let before = if last.doublings + k > 0 { bytes / each } else { 0.0 };
    let most = if accuracy.max_elements == 0 { MOST_ELEMENTS } else { accuracy.max_elements };
    let obstacles = [
        (grid.len() as u64 > most, Obstacle::Elements),
        (accuracy.max_bytes > 0 && bytes + before > accuracy.max_bytes as f64, Obstacle::Memory),
        (accuracy.is_late(seconds / speed_up), Obstacle::Time),
        (last.time_error > target, Obstacle::Step),
    ];
    let obstacle = obstacles.into_iter().find(|(is_in_the_way, _)| *is_in_the_way).map(|(_, obstacle)| obstacle);
    Price {
        grid: Some(grid),
        error: Some(if last.is_exact() { 0.0 } else { error_after(samples, falling, k).max(tolerance) }),
        seconds: Some(seconds / speed_up),
        seconds_one_thread: Some(seconds),
        work_units,
        bytes: bytes as u64,
        obstacle,
        ..nothing
    }
}
