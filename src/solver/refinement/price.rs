//! One row of the price list: the predicted cost of one accuracy, from solves on small grids (samples).

use super::accuracy::{tolerance_for, MOST_ELEMENTS, ROUND_OFF};
use super::sample::Sample;
use super::Accuracy;
use crate::grid::{doubling, Grid};
use crate::scene::{refines, scaled, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;
use crate::solver::seconds::{seconds_on, Cost, MOST_PRODUCTS_RATIO};

/// The initial residual of a grid over that of the next coarser grid. Each grid starts from the result of the coarser one, whose error at the
/// boundary of contact is the initial residual.
const FIRST_RESIDUAL_RATIO: f64 = 0.35;
/// The usual growth of tangential products with a doubling, measured on six surfaces (docs/notes/2026-11-accuracy.md).
const PRODUCTS_GROWTH: f64 = 1.1;
/// Least number of elements across the contact from which a sample can be extrapolated.
pub(super) const FEWEST_ACROSS: usize = 12;

/// The reason why an accuracy cannot be reached; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// No sufficient grid is known: the quantity is singular, contact is on few elements, there is no contact although the quantity is not 0 without
    /// it, or no grid was solved.
    Singular = 1,
    /// The target is below round-off.
    RoundOff,
    /// The accuracy takes more elements than `max_elements`.
    Elements,
    /// The accuracy takes more memory than `max_bytes`.
    Memory,
    /// The accuracy takes longer than `max_seconds`.
    Time,
    /// Bodies relax, and the error from the length of the time step alone exceeds the target.
    Step,
}

/// The products of a solve on a grid to a tolerance, counted and not predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counted {
    pub grid: Grid,
    pub tolerance: f64,
    pub products: f64,
}

impl Counted {
    /// Whether the count is that of this grid and tolerance.
    pub fn is_of(&self, grid: &Grid, tolerance: f64) -> bool {
        self.grid == *grid && self.tolerance == tolerance
    }
}

/// The price of one accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// The accuracy: the largest relative error.
    pub target: f64,
    /// The coarsest grid that is predicted to suffice; None if unknown.
    pub grid: Option<Grid>,
    /// The largest tolerance that suffices.
    pub tolerance: f64,
    /// The predicted relative error on this grid, or the tolerance if that is larger; None if unknown.
    pub error: Option<f64>,
    /// Predicted seconds of set-up and solve with the threads of the options; None if unknown.
    pub seconds: Option<f64>,
    /// Predicted seconds of set-up and solve with one thread; None if unknown.
    pub seconds_one_thread: Option<f64>,
    /// Predicted products of the solve, in work units; 0 if unknown.
    pub work_units: f64,
    /// Predicted bytes held by the solver; 0 if unknown.
    pub bytes: u64,
    /// Why the accuracy cannot be reached; None if it can.
    pub obstacle: Option<Obstacle>,
    /// The relative error from the length of the time step, which is the same on all grids and adds to `error`. 0 if no body relaxes.
    pub time_error: f64,
}

/// Predicts the number of doublings from the last sample to the coarsest grid that suffices for the target, and the seconds of one thread for a solve
/// on that grid to the tolerance of the samples. If the value of the last sample is exact, the grid is that of the scene. None if no grid suffices.
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
    let error = last.error()?;
    let (least, most) = (-(last.across.ilog2() as i32), (MOST_ELEMENTS as f64).log2() as i32);
    let suffices = |k: &i32| {
        let enough = last.across as f64 * 2f64.powi(*k) >= quantity.enough_across() as f64;
        enough && error_after(samples, error, *k) <= target && scaled(scene, last.doublings + k).is_ok()
    };
    let k = (least..=most).find(suffices)?;
    Some((k, seconds(k)))
}

/// The relative error `k` doublings after the last sample, whose error is `error`. If there is a coarser sample on that grid (k < 0), its error is at
/// least its difference from the last sample plus the error of the latter.
fn error_after(samples: &[Sample], error: Falling, k: i32) -> f64 {
    let Some(last) = samples.last() else { return f64::INFINITY };
    let coarser = samples.iter().find(|sample| k < 0 && sample.doublings == last.doublings + k);
    let difference = coarser.and_then(|sample| Some(((sample.value()? - last.value()?) / last.value()?).abs()));
    error.after(k).max(difference.map_or(0.0, |difference| difference + error.now()))
}

/// The cost of a solve to a tolerance on the grid after `doublings`: its seconds over those of a solve to the tolerance of the samples, and its
/// products. Both come from the finest sample that is not finer than this grid.
///
/// On a finer grid the iteration starts closer to the solution. So the work to `tolerance` there is that of the sample to a larger residual, the
/// `equivalent` tolerance.
fn cost_to(samples: &[Sample], doublings: i32, tolerance: f64) -> (f64, f64) {
    let index = samples.iter().rposition(|sample| sample.doublings <= doublings).unwrap_or(0);
    let Some(sample) = samples.get(index) else { return (1.0, 0.0) };
    let finer = (doublings - sample.doublings).max(0);
    let equivalent = tolerance / FIRST_RESIDUAL_RATIO.powi(finer);
    if let Some((part, tangential)) = sample.with_friction(tolerance) {
        let of_before = index.checked_sub(1).and_then(|before| samples[before].with_friction(tolerance));
        // The growth between two samples is irregular. The prediction is its geometric mean with the usual growth.
        let seen = match of_before {
            Some((_, before)) if before > 0.0 => tangential / before,
            _ => PRODUCTS_GROWTH,
        };
        let growth = (seen * PRODUCTS_GROWTH).sqrt().clamp(1.0, MOST_PRODUCTS_RATIO);
        return (part, sample.normal_products(tolerance, equivalent) + tangential * growth.powi(finer));
    }
    let (seconds, products) = sample.cost_to(tolerance, equivalent);
    (seconds / sample.cost.seconds, products)
}

/// Makes one row of the price list. `counted` are products that need no prediction; `speed_up` is the ratio of the seconds of one thread to those of
/// the threads of the options.
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
    let error_of = |last: &Sample| if last.is_exact() { Some(Falling::default()) } else { last.error() };
    let Some((last, error)) = last.and_then(|last| Some((last, error_of(last)?))) else { return nothing };
    let Some((k, seconds)) = predict(scene, samples, (quantity, target)) else {
        return Price { obstacle: Some(Obstacle::Elements), ..nothing };
    };
    let Ok(grid) = scaled(scene, last.doublings + k) else { return nothing };
    let (part, work_units) = cost_to(samples, last.doublings + k, tolerance);
    let work_units = counted.iter().find(|one| one.is_of(&grid, tolerance)).map_or(work_units, |one| one.products);
    let seconds = seconds * part;
    let each = doubling(refines(scene));
    let sample = samples.iter().rfind(|sample| sample.doublings <= last.doublings + k).unwrap_or(&samples[0]);
    let bytes = sample.bytes * each.powi((last.doublings + k - sample.doublings).max(0));
    // A search also holds the solver of the grid before, which has at most half the elements in each direction, unless it ends on its first grid.
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
        error: Some(if last.is_exact() { 0.0 } else { error_after(samples, error, k).max(tolerance) }),
        seconds: Some(seconds / speed_up),
        seconds_one_thread: Some(seconds),
        work_units,
        bytes: bytes as u64,
        obstacle,
        ..nothing
    }
}
