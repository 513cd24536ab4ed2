//! The growth of seconds with the number of elements.
//!
//! A product of n elements takes `n log n` operations, and its arrays exceed one cache after the other.

/// The power of the number of elements with which seconds grow (docs/performance.md).
pub const GROWTH: f64 = 1.1;
/// The largest power that samples may show.
const LARGEST_GROWTH: f64 = 1.2;
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
    /// Seconds of one thread, and the part of the set-up.
    pub seconds: f64,
    pub setup: f64,
    /// Products in work units.
    pub products: f64,
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
        let by = ratio.powf(GROWTH) * if products > 1.0 { products } else { 1.0 };
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

/// The number of products on so many elements, extrapolated beyond the last sample: with friction it may grow by a fifth with a doubling.
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
/// others were disturbed. Pairs count if the first sample has `least` products. The seconds of solves in turns, of
/// unlike bodies, grow more than their products.
fn grown(samples: &[Cost], least: f64) -> f64 {
    let of = |pair: &[Cost]| (pair[1].seconds / pair[0].seconds).ln() / (pair[1].elements / pair[0].elements).ln();
    let seen = samples.windows(2).filter(|pair| pair[0].products >= least).map(of);
    seen.reduce(f64::min).map_or(0.0, |seen| seen.clamp(0.0, LARGEST_GROWTH))
}

#[cfg(test)]
#[path = "../../tests/unit/seconds.rs"]
mod tests;
