//! The periods of products. A is block Toeplitz, so it is a part of a block circulant with periods px and py. In each direction the period must keep
//! all offsets apart that occur:
//!
//! ```text
//!                              offsets           least period
//! any p                        -(m-1) to m-1     2m - 1, or 2m - 2 if the coefficients are even (those at m-1 and -(m-1) are then equal)
//! p within a reach             -reach to reach   2 reach, if the coefficients are even
//! A circulant in a direction   0 to m-1          m: no padding
//! ```

use toeplitz::lengths::{good_length, have_stages, length_for_stages};

use crate::grid::Grid;
use crate::influence::Coefficients;

/// The largest offsets, in x and in y, between elements that carry pressure and elements that are displaced.
pub type Reach = (usize, usize);

/// The reach of pressures anywhere on a grid.
pub(super) fn full_reach(grid: &Grid) -> Reach {
    (grid.mx - 1, grid.my - 1)
}

/// The periods of a product, in x and in y.
pub(super) fn periods(coefficients: &Coefficients, grid: &Grid, reach: Reach) -> (usize, usize) {
    match coefficients.row_tables() {
        // There is a table for each row, so columns are not transformed.
        Some((tables, _)) if tables.is_even_in_x() => (good_length(2 * grid.mx - 2), grid.my),
        Some(_) => (good_length(2 * grid.mx - 1), grid.my),
        None if coefficients.is_even(grid) => even_periods(coefficients, grid, (2 * reach.0, 2 * reach.1)),
        None => {
            let repeats = coefficients.repeats(grid);
            let period = |m: usize, repeats: bool| if repeats { m } else { good_length(2 * m - 1) };
            (period(grid.mx, repeats.0), period(grid.my, repeats.1))
        }
    }
}

/// The periods of at least `least` for products by even coefficients. In a periodic direction of the scene the period is the length of the grid. Rows
/// and columns use the FFT stages of the crate toeplitz, if both periods have stages; otherwise neither does. A machine without SIMD has no such
/// stages, but the same periods.
pub(crate) fn even_periods(coefficients: &Coefficients, grid: &Grid, least: (usize, usize)) -> (usize, usize) {
    let repeats = coefficients.repeats(grid);
    let periods = |length: fn(usize) -> usize| {
        let period = |m: usize, least: usize, repeats: bool| if repeats { m } else { length(least) };
        (period(grid.mx, least.0, repeats.0), period(grid.my, least.1, repeats.1))
    };
    let by_stages = periods(length_for_stages);
    if have_stages(by_stages) {
        by_stages
    } else {
        periods(good_length)
    }
}
