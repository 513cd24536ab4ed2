//! The growth of seconds with the number of elements on this machine.
//!
//! A product of n elements takes `n log n` operations, but its arrays exceed one cache after the other, at sizes that
//! depend on the machine. So products of half-spaces of 32 x 32 to 256 x 256 elements are timed when a process first
//! predicts seconds. Each is timed a few times, and the least time counts. All timings take a few milliseconds on one thread.
//! Threads that predict at the same time measure separately. Between two of these sizes seconds grow with a power of the
//! number of elements, beyond the last with the power between the last two. Bounds on the powers limit the error on a
//! busy machine. No solve depends on these times.

use std::sync::OnceLock;
use std::time::Instant;

use super::{Options, Solver};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use crate::scene::{Bodies, Load, Scene};

/// Elements in a direction of the timed grids.
const SIZES: [usize; 4] = [32, 64, 128, 256];
/// Products on each grid; the first ones are slow.
const PRODUCTS_PER_GRID: usize = 4;
/// The least and the largest power of the number of elements with which seconds of a product grow. The largest one also
/// limits the growth of a solve.
const POWERS: (f64, f64) = (1.0, 1.2);
/// The power without timings (docs/performance.md).
const GROWTH: f64 = 1.08;
/// The least power of the number of elements with which seconds of set-ups grow.
const LEAST_SETUP_GROWTH: f64 = 0.1;
/// Upper bound on the cost ratio of a grid with four times the elements, until samples show it.
pub const NEXT_GRID_RATIO: f64 = 5.0;
/// Largest growth of the number of products with a doubling.
pub const MOST_PRODUCTS_RATIO: f64 = 1.25;
/// A sample counts for seconds if it has at least this part of the products of the last sample.
const LEAST_PRODUCTS: f64 = 0.5;

/// The cost of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    pub elements: f64,
    /// Seconds of set-up and solve on one thread.
    pub seconds: f64,
    /// Seconds of the set-up.
    pub setup: f64,
    /// Products in work units.
    pub products: f64,
}

/// Elements, and the seconds of a product.
type Timed = (f64, f64);

/// The ratio of the times of products on `to` and on `from` elements.
pub fn growth(from: f64, to: f64) -> f64 {
    static MACHINE: OnceLock<Vec<Timed>> = OnceLock::new();
    if MACHINE.get().is_none() {
        // Threads do not wait for one that measures: a child forked meanwhile would wait for ever. The first result counts.
        let timed: Result<Vec<Timed>> = SIZES.into_iter().map(time).collect();
        if let Ok(timed) = timed {
            let _ = MACHINE.set(timed);
        }
    }
    growth_by(MACHINE.get().map_or(&[], Vec::as_slice), from, to)
}

/// Seconds of one thread on a grid of `elements`; 0 without samples. Each sample predicts them. The least prediction
/// counts, because the other samples were disturbed or are mostly overhead. Samples with less than half the products of
/// the last do not count: they hardly resolve the contact. The number of products and the seconds of the set-up grow as
/// between the last two samples. (With a period the set-up hardly grows.) No grid takes longer than a finer one.
pub fn seconds_on(samples: &[Cost], elements: f64) -> f64 {
    let seen = match samples {
        [.., before, last] => (last.setup / before.setup).ln() / (last.elements / before.elements).ln(),
        _ => GROWTH,
    };
    let of_setup = if seen.is_finite() { seen.clamp(LEAST_SETUP_GROWTH, GROWTH) } else { GROWTH };
    let least = samples.last().map_or(0.0, |last| LEAST_PRODUCTS * last.products);
    let of_solve = grown(samples, least);
    let more = more_products(samples, elements);
    let carried = |sample: &Cost| {
        let ratio = elements / sample.elements;
        let products = if ratio > 1.0 { more / sample.products } else { 1.0 };
        let by = growth(sample.elements, elements) * if products > 1.0 { products } else { 1.0 };
        let by = by.max(if ratio > 1.0 { ratio.powf(of_solve) } else { 0.0 });
        sample.setup * ratio.powf(of_setup) + (sample.seconds - sample.setup) * by
    };
    match samples.first() {
        None => 0.0,
        // A grid coarser than all samples: extrapolated from the first.
        Some(first) if first.elements > elements => carried(first),
        _ => {
            let of = |sample: &Cost| if sample.elements <= elements { carried(sample) } else { sample.seconds };
            let sees = |sample: &&Cost| sample.products >= least;
            samples.iter().filter(sees).map(of).fold(f64::INFINITY, f64::min)
        }
    }
}

/// The number of products on `elements`, extrapolated beyond the last sample. With friction it grows, at most by [`MOST_PRODUCTS_RATIO`] with a doubling.
fn more_products(samples: &[Cost], elements: f64) -> f64 {
    match samples {
        [.., before, last] => {
            let doublings = |from: f64, to: f64| 0.5 * (to / from).log2();
            let seen = (last.products / before.products).powf(1.0 / doublings(before.elements, last.elements));
            let each = if seen.is_finite() { seen.clamp(1.0, MOST_PRODUCTS_RATIO) } else { 1.0 };
            last.products * each.powf(doublings(last.elements, elements).max(0.0))
        }
        _ => samples.last().map_or(0.0, |last| last.products),
    }
}

/// The power of the number of elements with which seconds grow: the least power between successive samples, because
/// others were disturbed. Pairs count if the first sample has `least` products. Unlike bodies with friction are solved in
/// turns, whose seconds grow more than their products.
fn grown(samples: &[Cost], least: f64) -> f64 {
    let of = |pair: &[Cost]| (pair[1].seconds / pair[0].seconds).ln() / (pair[1].elements / pair[0].elements).ln();
    let seen = samples.windows(2).filter(|pair| pair[0].products >= least).map(of);
    seen.reduce(f64::min).map_or(0.0, |seen| seen.clamp(0.0, POWERS.1))
}

/// The seconds of a product on m x m elements.
fn time(m: usize) -> Result<Timed> {
    let grid = Grid::new(m, m, 1.0, 1.0)?;
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let mut solver = Solver::new(&scene, &Options { threads: 1, ..Options::default() })?;
    let (mut p, mut u) = (zeros(grid.len(), "pressures")?, zeros(grid.len(), "displacements")?);
    p[grid.len() / 2] = 1.0;
    let mut least = f64::INFINITY;
    for _ in 0..PRODUCTS_PER_GRID {
        let began = Instant::now();
        solver.product(&p, &mut u)?;
        least = least.min(began.elapsed().as_secs_f64());
    }
    Ok((grid.len() as f64, least))
}

fn growth_by(timed: &[Timed], from: f64, to: f64) -> f64 {
    if to < from {
        return 1.0 / growth_by(timed, to, from);
    }
    let last = timed.len().saturating_sub(2);
    let (mut at, mut factor) = (from, 1.0);
    for (k, pair) in timed.windows(2).enumerate() {
        let end = if k == last { to } else { to.min(pair[1].0) };
        if end > at {
            factor *= (end / at).powf(power(pair[0], pair[1]));
            at = end;
        }
    }
    factor * (to / at).powf(GROWTH)
}

fn power(before: Timed, behind: Timed) -> f64 {
    let power = (behind.1 / before.1).ln() / (behind.0 / before.0).ln();
    if power.is_finite() {
        power.clamp(POWERS.0, POWERS.1)
    } else {
        GROWTH
    }
}

#[cfg(test)]
#[path = "../../tests/unit/machine.rs"]
mod tests;
