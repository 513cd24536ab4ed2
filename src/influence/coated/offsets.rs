//! The offsets of a row to be computed.

use crate::grid::Grid;

/// The name of this memory in messages.
pub(super) const COATED: &str = "the coefficients of a coating";

/// The first offset computed in a row: for square elements, earlier ones equal those of `(ky, kx)`.
pub(super) fn first_of_half(grid: &Grid, ky: usize) -> usize {
    if grid.dx == grid.dy && grid.my <= grid.mx {
        ky.min(grid.mx)
    } else {
        0
    }
}

/// The first offset in a row at this distance or more, or the row's end.
pub(super) fn first_beyond(distance: f64, grid: &Grid, ky: usize) -> usize {
    let y = ky as f64 * grid.dy;
    if y >= distance {
        return 0;
    }
    let x = ((distance - y) * (distance + y)).sqrt();
    ((x / grid.dx).ceil() as usize).min(grid.mx)
}
