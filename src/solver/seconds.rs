//! Predictions of the seconds of a solve on a grid, from those on other grids (samples).
//!
//! Seconds grow more than the number n of elements: a product takes `n log n` operations, and its arrays exceed one level of the cache after the
//! other.

/// The usual exponent of n in the seconds of a solve (docs/performance.md).
pub const GROWTH: f64 = 1.1;
/// The largest exponent that is taken from samples.
const LARGEST_GROWTH: f64 = 1.2;
/// The least exponent of n in the seconds of a set-up.
const LEAST_SETUP_GROWTH: f64 = 0.1;
/// The seconds of a grid with four times the elements, over those of this grid: an upper bound while no sample shows them.
pub const NEXT_GRID_RATIO: f64 = 5.0;
/// The largest growth of the number of products with a doubling of the elements in both directions.
pub const MOST_PRODUCTS_RATIO: f64 = 1.25;
/// A sample is used to predict seconds if it has at least this part of the products of the last sample.
const LEAST_PRODUCTS: f64 = 0.5;

/// The cost of a solve on one grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The number of elements of the grid.
    pub elements: f64,
    /// Seconds of set-up and solve with one thread.
    pub seconds: f64,
    /// Seconds of the set-up, which `seconds` contain.
    pub setup: f64,
    /// Products in work units.
    pub products: f64,
}

/// Predicts the seconds of one thread on a grid of `elements`, from samples in the order of their elements; 0 without samples.
///
/// Each sample gives a prediction. The least one is taken, because the other samples were disturbed by other programs or consist mostly of
/// overhead. Samples with less than half the products of the last one are left out: they hardly resolve the contact. The number of products and the
/// seconds of the set-up are extrapolated from the last two samples. (With a period the set-up hardly grows.) A grid is predicted to take at most
/// the seconds of a finer sample.
pub fn seconds_on(samples: &[Cost], elements: f64) -> f64 {
    let seen = match samples {
        [.., before, last] => (last.setup / before.setup).ln() / (last.elements / before.elements).ln(),
        _ => GROWTH,
    };
    let of_setup = if seen.is_finite() { seen.clamp(LEAST_SETUP_GROWTH, GROWTH) } else { GROWTH };
    let least = samples.last().map_or(0.0, |last| LEAST_PRODUCTS * last.products);
    let of_solve = seen_growth(samples, least);
    let more = more_products(samples, elements);
    let extrapolated = |sample: &Cost| {
        let ratio = elements / sample.elements;
        let products = if ratio > 1.0 { more / sample.products } else { 1.0 };
        let by = ratio.powf(GROWTH) * if products > 1.0 { products } else { 1.0 };
        let by = by.max(if ratio > 1.0 { ratio.powf(of_solve) } else { 0.0 });
        sample.setup * ratio.powf(of_setup) + (sample.seconds - sample.setup) * by
    };
    match samples.first() {
        None => 0.0,
        // The grid is coarser than all samples.
        Some(first) if first.elements > elements => extrapolated(first),
        _ => {
            let predicted =
                |sample: &Cost| if sample.elements <= elements { extrapolated(sample) } else { sample.seconds };
            let resolves = |sample: &&Cost| sample.products >= least;
            samples.iter().filter(resolves).map(predicted).fold(f64::INFINITY, f64::min)
        }
    }
}

/// Predicts the number of products on a grid of `elements` from the last two samples; at most as many elements as the last sample have its products.
/// With friction the number may grow by a fifth with each doubling.
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

/// The exponent of n in the seconds of successive samples. The least one of all pairs is taken, because others were disturbed. Pairs whose first
/// sample has fewer than `least` products are left out. This exponent serves solves of unlike bodies, whose seconds grow more than their products:
/// both problems are solved in turns.
fn seen_growth(samples: &[Cost], least: f64) -> f64 {
    let exponent =
        |pair: &[Cost]| (pair[1].seconds / pair[0].seconds).ln() / (pair[1].elements / pair[0].elements).ln();
    let seen = samples.windows(2).filter(|pair| pair[0].products >= least).map(exponent);
    seen.reduce(f64::min).map_or(0.0, |seen| seen.clamp(0.0, LARGEST_GROWTH))
}

#[cfg(test)]
#[path = "../../tests/unit/seconds.rs"]
mod tests;
