//! The range of offsets to compute in a row.

use crate::grid::Grid;

/// The name of this memory in messages.
pub(super) const COATED: &str = "the coefficients of a coating";

/// The first offset in x to compute in row ky. For square elements c(kx, ky) = c(ky, kx), so that earlier ones are known.
pub(super) fn first_of_half(grid: &Grid, ky: usize) -> usize {
    if grid.dx == grid.dy && grid.my <= grid.mx {
        ky.min(grid.mx)
    } else {
        0
    }
}

/// The first offset in x of row ky whose base is the substrate of a layer of thickness t: at distances from t on. On elements longer than t all
/// offsets have this base, also that of the loaded element. For a layer on a rigid body only its compression times t remains, without a difference of
/// large numbers.
pub(super) fn first_of_substrate(t: f64, grid: &Grid, ky: usize) -> usize {
    if t <= grid.dx.max(grid.dy) {
        0
    } else {
        first_beyond(t, grid, ky)
    }
}

/// The first offset in x of row ky whose distance is at least `distance`; the end of the row if there is none.
pub(super) fn first_beyond(distance: f64, grid: &Grid, ky: usize) -> usize {
    let y = ky as f64 * grid.dy;
    if y >= distance {
        return 0;
    }
    let x = ((distance - y) * (distance + y)).sqrt();
    ((x / grid.dx).ceil() as usize).min(grid.mx)
}
