//! The periods of products.
//!
//! ```text
//! A is block Toeplitz: a part of a block circulant of period px * py, which must keep the offsets apart that occur
//! any p                        -(m-1)..m-1:     2m - 1, or 2m - 2 when the coefficients are even (m-1 and -(m-1) are then alike)
//! p within a [`Reach`]         -reach..reach:   2 reach, when the coefficients are even
//! A circulant in a direction   m: nothing is padded
//! ```

use super::fft::good_length;
use crate::grid::Grid;
use crate::influence::Coefficients;

/// The largest offsets, in x and y, between elements that carry pressure and elements that are displaced.
pub type Reach = (usize, usize);

/// That of pressures anywhere on a grid.
pub(super) fn full_reach(grid: &Grid) -> Reach {
    (grid.mx - 1, grid.my - 1)
}

/// The periods of a product.
pub(super) fn periods(coefficients: &Coefficients, grid: &Grid, reach: Reach) -> (usize, usize) {
    let (even, repeats) = (coefficients.is_even(grid), coefficients.repeats(grid));
    let period = |m: usize, reach: usize, repeats: bool| match (repeats, even) {
        (true, _) => m,
        (_, true) => good_length(2 * reach),
        (_, false) => good_length(2 * m - 1),
    };
    match coefficients.row_tables() {
        // Columns are not transformed.
        Some((tables, _)) if tables.is_even_in_x() => (good_length(2 * grid.mx - 2), grid.my),
        Some(_) => (good_length(2 * grid.mx - 1), grid.my),
        None => (period(grid.mx, reach.0, repeats.0), period(grid.my, reach.1, repeats.1)),
    }
}
