//! The interface of all sources of influence coefficients.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;

/// Where the coefficients of offsets come from. What is not said is that of an even kernel.
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

    /// Fills `out[k]` with the mean of the coefficients at offsets `(kx + k, ky)` and `(-kx - k, -ky)`, within the table: what is symmetric of
    /// them.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.fill_row(kx, ky, out);
    }

    /// Fills `out[k]` with the mean of the coefficients at offsets `(+-k, +-ky)`: what is even of them, for preconditioners. A
    /// table that ends before is carried on with its outermost coefficient.
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

    /// In which directions the coefficients repeat themselves after a length of `grid`: A is then circulant in them.
    fn repeats(&self, _grid: &Grid) -> (bool, bool) {
        (false, false)
    }

    /// The part that all coefficients have in common beyond those of bodies whose mean displacement is zero. It displaces by the mean pressure, so it
    /// changes the approach of a prescribed force, and not its pressures.
    fn constant(&self) -> f64 {
        0.0
    }

    /// The same kernel without it; none where it is 0.
    fn without_constant(&self) -> Option<Arc<dyn Kernel>> {
        None
    }

    /// Whether a uniform pressure on the whole grid displaces nothing.
    fn is_mean_free(&self) -> bool {
        false
    }

    /// Added to all coefficients, this gives a uniform pressure the response asked for where it has none; 0 where it has.
    fn constant_for(&self, _response: f64) -> f64 {
        0.0
    }

    /// Added to all coefficients, this gives A an inverse where a uniform pressure displaces nothing; 0 where A has one.
    fn constant_for_inverse(&self) -> f64 {
        0.0
    }

    /// For preconditioners, where coefficients wrapped to a period would not be positive: what a pressure wave `(kx, ky)` of
    /// amplitude 1, constant on elements, displaces. None: the coefficients do.
    fn wave(&self, _grid: &Grid, _kx: f64, _ky: f64) -> Option<f64> {
        None
    }

    /// The kernel of a grid coarsened from `fine` to `coarse`: of bodies computed anew for the larger element (the paper's direct
    /// coarse-grid operator), of tables summed from the fine coefficients.
    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>>;

    /// Bytes of coefficients held.
    fn bytes(&self) -> usize {
        0
    }
}
