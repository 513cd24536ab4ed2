//! The offsets in a row at which coefficients are computed, and those with the base of the substrate.

use crate::grid::Grid;

/// The name of the memory of coefficients in messages.
pub(super) const COATED: &str = "the coefficients of a coating";

/// The first offset in x at which row ky is computed. For square elements `c(kx, ky) = c(ky, kx)`, so that kx >= ky suffices.
pub(super) fn first_of_half(grid: &Grid, ky: usize) -> usize {
    if grid.dx == grid.dy && grid.my <= grid.mx {
        ky.min(grid.mx)
    } else {
        0
    }
}

/// The first offset in x of row ky at which the base is the substrate of a layer of thickness t: the first at a distance of at least t. If an
/// element is longer than t, the substrate is the base at all offsets, also for the loaded element. For a layer on a rigid body only the
/// compression of the layer then remains, without a difference of large numbers.
pub(super) fn first_of_substrate(t: f64, grid: &Grid, ky: usize) -> usize {
    if t <= grid.dx.max(grid.dy) {
        0
    } else {
        first_beyond(t, grid, ky)
    }
}

/// The first offset in x of row ky at a distance of at least `distance`; the end of the row if there is none.
pub(super) fn first_beyond(distance: f64, grid: &Grid, ky: usize) -> usize {
    let y = ky as f64 * grid.dy;
    if y >= distance {
        return 0;
    }
    let x = ((distance - y) * (distance + y)).sqrt();
    ((x / grid.dx).ceil() as usize).min(grid.mx)
}
