//! The interface of all sources of influence coefficients.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;

/// A source of influence coefficients, which depend on the offset between two elements. The default methods are those of a kernel that is even in
/// both directions.
pub trait Kernel: Any + Debug + Send + Sync {
    /// The coefficient at offset `(kx, ky)`.
    fn at(&self, kx: i64, ky: i64) -> f64;

    /// The displacement of element `(ix, iy)` by a unit pressure on element `(jx, jy)`.
    fn between(&self, (jx, jy): (i64, i64), (ix, iy): (i64, i64)) -> f64 {
        self.at(ix - jx, iy - jy)
    }

    /// Fills `out[k]` with the coefficient at offset `(kx + k, ky)`. If the kernel is even, `kx >= 0`.
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    /// Fills `out[k]` with the symmetric part of A at offset `(kx + k, ky)`: the mean of the coefficients at this offset and at `(-kx - k, -ky)`.
    /// All offsets must lie within the table.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.fill_row(kx, ky, out);
    }

    /// Fills `out[k]` with the even part at offset `(k, ky)`: the mean of the four coefficients at `(+-k, +-ky)`. Preconditioners use it. Beyond
    /// the end of a table its outermost coefficient is used.
    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        self.fill_row(0, ky, out);
    }

    /// The largest absolute value of a coefficient at the offsets of `grid`.
    fn largest(&self, _grid: &Grid) -> f64 {
        self.at(0, 0)
    }

    /// Whether `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` for all offsets of `grid`.
    fn is_even(&self, _grid: &Grid) -> bool {
        true
    }

    /// Whether A is symmetric on `grid`, `c(kx, ky) = c(-kx, -ky)`, up to the round-off of a table.
    fn is_symmetric(&self, _grid: &Grid) -> bool {
        true
    }

    /// Whether the coefficients repeat with the length of `grid`, in x and in y. In such a direction A is circulant.
    fn repeats(&self, _grid: &Grid) -> (bool, bool) {
        (false, false)
    }

    /// A constant that all coefficients contain. The coefficients without it displace the mean plane by 0. The constant displaces all elements
    /// alike, in proportion to the mean pressure. So it changes the approach that belongs to a prescribed force, but not the pressures.
    fn constant(&self) -> f64 {
        0.0
    }

    /// The kernel without its [constant](Kernel::constant). `None` if the constant is 0.
    fn without_constant(&self) -> Option<Arc<dyn Kernel>> {
        None
    }

    /// Whether a uniform pressure on the whole grid displaces nothing. Then A has no inverse.
    fn is_mean_free(&self) -> bool {
        false
    }

    /// The constant that, added to all coefficients, adds `response` to the displacement by a uniform pressure of 1. Without two periods it is 0,
    /// because no constant does this.
    fn constant_for(&self, _response: f64) -> f64 {
        0.0
    }

    /// The constant that a preconditioner adds to all coefficients, so that a uniform pressure has at least about the response of the longest
    /// wave. 0 without two periods.
    fn constant_for_inverse(&self) -> f64 {
        0.0
    }

    /// The displacement by a pressure wave of amplitude 1 with the wave numbers `(kx, ky)`, whose pressure is constant on each element.
    /// Preconditioners use it for kernels whose coefficients, wrapped to a period, have a transform that is not positive. `None`: the transform
    /// of the wrapped coefficients is used.
    fn wave(&self, _grid: &Grid, _kx: f64, _ky: f64) -> Option<f64> {
        None
    }

    /// The kernel on a grid that is coarsened from `fine` to `coarse`. Coefficients of bodies are computed for the larger element (the paper's
    /// direct coarse-grid operator). Coefficients of a table are sums of the fine ones.
    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>>;

    /// Bytes of the stored coefficients.
    fn bytes(&self) -> usize {
        0
    }
}
