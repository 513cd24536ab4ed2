//! Influence coefficients: the displacement at the centre of element I by a unit pressure on element J.
//!
//! `A_IJ = c(ix - jx, iy - jy)` depends on the offset only: A is block Toeplitz. The coefficients come from the
//! elastic half-space ([`HalfSpace`], even in both offsets) or from a table of the caller's own ([`Table`], of
//! which nothing is assumed).

mod half_space;
mod table;

pub use half_space::HalfSpace;
pub use table::Table;

use crate::error::Result;
use crate::grid::Grid;

/// Where the coefficients of one grid come from.
#[derive(Clone, Debug)]
pub enum Influence {
    /// Love's closed form for the elastic half-space.
    HalfSpace(HalfSpace),
    /// The caller's own coefficients.
    Table(Table),
}

impl Influence {
    /// The coefficient at offset `(kx, ky)`.
    pub fn at(&self, kx: i64, ky: i64) -> f64 {
        match self {
            Influence::HalfSpace(half_space) => half_space.at(kx, ky),
            Influence::Table(table) => table.at(kx, ky),
        }
    }

    /// The coefficients times `factor`, a power of two: no digit changes.
    pub fn times(&self, factor: f64) -> Result<Influence> {
        Ok(match self {
            Influence::HalfSpace(half_space) => Influence::HalfSpace(half_space.times(factor)),
            Influence::Table(table) => Influence::Table(table.times(factor)?),
        })
    }

    /// Fills `out[k]` with the coefficient at offset `(kx + k, ky)`, `kx >= 0` when the coefficients are even.
    pub fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        match self {
            Influence::HalfSpace(half_space) => half_space.fill_row(kx, ky, out),
            Influence::Table(table) => table.fill_row(kx, ky, out),
        }
    }

    /// Fills `out[k]` with the mean of the coefficients at offsets `(+-k, +-ky)`: what is even of them, for preconditioners. A
    /// table that ends before is carried on with its outermost coefficient.
    pub fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        match self {
            Influence::HalfSpace(half_space) => half_space.fill_row(0, ky, out),
            Influence::Table(table) => {
                for (kx, value) in (0..).zip(out) {
                    let four = [(kx, ky), (-kx, ky), (kx, -ky), (-kx, -ky)];
                    *value = 0.25 * four.into_iter().map(|(x, y)| table.at(x, y)).sum::<f64>();
                }
            }
        }
    }

    /// The largest coefficient within `grid`, whatever its sign.
    pub fn largest(&self, grid: &Grid) -> f64 {
        match self {
            Influence::HalfSpace(half_space) => half_space.at(0, 0),
            Influence::Table(table) => table.largest(grid),
        }
    }

    /// Whether `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` for all offsets within `grid`.
    pub fn is_even(&self, grid: &Grid) -> bool {
        match self {
            Influence::HalfSpace(_) => true,
            Influence::Table(table) => table.is_even(grid),
        }
    }

    /// Whether A is symmetric on `grid`, `c(kx, ky) = c(-kx, -ky)`, to within round-off of the table.
    pub fn is_symmetric(&self, grid: &Grid) -> bool {
        match self {
            Influence::HalfSpace(_) => true,
            Influence::Table(table) => table.is_symmetric(grid),
        }
    }

    /// The coefficients on a grid coarsened from `fine` to `coarse`: for the half-space computed anew for the larger
    /// element (the paper's direct coarse-grid operator), for a table summed from the fine coefficients.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Influence> {
        Ok(match self {
            Influence::HalfSpace(half_space) => Influence::HalfSpace(half_space.for_element(coarse.dx, coarse.dy)),
            Influence::Table(table) => Influence::Table(table.coarsen(fine, coarse)?),
        })
    }
}
