//! The interface of all sources of influence coefficients.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;

/// A source of influence coefficients by offset. Default methods are those of an even kernel.
pub trait Kernel: Any + Debug + Send + Sync {
    /// The coefficient at offset `(kx, ky)`.
    fn at(&self, kx: i64, ky: i64) -> f64;

    /// The coefficient of a pressure on element `(jx, jy)` and the displacement of element `(ix, iy)`.
    fn between(&self, (jx, jy): (i64, i64), (ix, iy): (i64, i64)) -> f64 {
        self.at(ix - jx, iy - jy)
    }

    /// Fills `out[k]` with the coefficient at offset `(kx + k, ky)`, `kx >= 0` when the coefficients are even.
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    /// Fills `out[k]` with the symmetric part at `(kx + k, ky)`, within the table: the mean of the coefficients there and at `(-kx - k, -ky)`.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.fill_row(kx, ky, out);
    }

    /// Fills `out[k]` with the even part at `(k, ky)`, the mean of the coefficients at `(+-k, +-ky)`, for preconditioners. Beyond the end of
    /// a table its outermost coefficient is used.
    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        self.fill_row(0, ky, out);
    }

    /// The largest coefficient within `grid`, whatever its sign.
    fn largest(&self, _grid: &Grid) -> f64 {
        self.at(0, 0)
    }

    /// Whether `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` for all offsets within `grid`.
    fn is_even(&self, _grid: &Grid) -> bool {
        true
    }

    /// Whether A is symmetric on `grid`, `c(kx, ky) = c(-kx, -ky)`, to within round-off of the table.
    fn is_symmetric(&self, _grid: &Grid) -> bool {
        true
    }

    /// The directions in which the coefficients repeat after a length of `grid`: A is circulant in them.
    fn repeats(&self, _grid: &Grid) -> (bool, bool) {
        (false, false)
    }

    /// A constant part of all coefficients. Without it the mean displacement is 0. Its displacement is proportional to the mean pressure: it
    /// changes the approach of a prescribed force, but not its pressures.
    fn constant(&self) -> f64 {
        0.0
    }

    /// The kernel without its constant; none if the constant is 0.
    fn without_constant(&self) -> Option<Arc<dyn Kernel>> {
        None
    }

    /// Whether a uniform pressure on the whole grid displaces nothing.
    fn is_mean_free(&self) -> bool {
        false
    }

    /// A constant for all coefficients that gives a uniform pressure this response if it displaces nothing; 0 otherwise.
    fn constant_for(&self, _response: f64) -> f64 {
        0.0
    }

    /// A constant for all coefficients that makes A invertible if a uniform pressure displaces nothing; 0 otherwise.
    fn constant_for_inverse(&self) -> f64 {
        0.0
    }

    /// The response to a pressure wave `(kx, ky)` of amplitude 1, constant on elements, for preconditioners of kernels whose coefficients,
    /// wrapped to a period, are not positive. None: the wrapped coefficients serve.
    fn wave(&self, _grid: &Grid, _kx: f64, _ky: f64) -> Option<f64> {
        None
    }

    /// The kernel on a grid coarsened from `fine` to `coarse`: computed anew for the larger element from the bodies (the paper's direct
    /// coarse-grid operator), summed from the fine coefficients of a table.
    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>>;

    /// Bytes of coefficients held.
    fn bytes(&self) -> usize {
        0
    }
}
