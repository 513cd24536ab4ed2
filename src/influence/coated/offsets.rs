//! Which offsets of a row are computed, and how.

use crate::grid::Grid;

/// Names its memory in messages.
pub(super) const COATED: &str = "the coefficients of a coating";

/// The first offset in a row that is computed: of square elements the others are those of `(ky, kx)`.
pub(super) fn first_of_half(grid: &Grid, ky: usize) -> usize {
    if grid.dx == grid.dy && grid.my <= grid.mx {
        ky.min(grid.mx)
    } else {
        0
    }
}

/// The first offset in a row whose distance is not below this, or the row's end.
pub(super) fn first_beyond(distance: f64, grid: &Grid, ky: usize) -> usize {
    let y = ky as f64 * grid.dy;
    if y >= distance {
        return 0;
    }
    let x = ((distance - y) * (distance + y)).sqrt();
    ((x / grid.dx).ceil() as usize).min(grid.mx)
}
