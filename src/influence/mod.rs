//! Influence coefficients: the displacement at the centre of element I by a unit pressure on element J.
//!
//! `A_IJ = c(ix - jx, iy - jy)` depends on the offset only: A is block Toeplitz. The coefficients come from the
//! elastic half-space ([`HalfSpace`], even in both offsets) or from a table of the caller's own ([`Table`], of
//! which nothing is assumed). What else a scene names has its own file: [`Periodic`],
//! [`Layered`], [`Patches`]; and [`RowTables`], of which A is Toeplitz in x only: their [`Influence::at`] is a mean over rows.

mod half_space;
mod layered;
mod patches;
mod periodic;
mod row_tables;
mod special;
mod table;

pub use half_space::HalfSpace;
pub use layered::Layered;
pub use patches::Patches;
pub use periodic::Periodic;
pub use row_tables::RowTables;
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
    /// The caller's own, one table per loaded row.
    RowTables(RowTables),
    /// The half-space's, of a scene that repeats itself.
    Periodic(Periodic),
    /// Any of them, with a compliant layer.
    Layered(Layered),
    /// Those of bodies or a table, scaled between patches.
    Patches(Patches),
}

impl Influence {
    /// The coefficient at offset `(kx, ky)`.
    pub fn at(&self, kx: i64, ky: i64) -> f64 {
        match self {
            Influence::HalfSpace(half_space) => half_space.at(kx, ky),
            Influence::Table(table) => table.at(kx, ky),
            Influence::RowTables(tables) => tables.mean(kx, ky),
            Influence::Periodic(periodic) => periodic.at(kx, ky),
            Influence::Patches(patches) => patches.base().at(kx, ky),
            Influence::Layered(layered) => {
                layered.base().at(kx, ky) + if (kx, ky) == (0, 0) { layered.least() } else { 0.0 }
            }
        }
    }

    /// The coefficients times `factor`, a power of two: no digit changes.
    pub fn times(&self, factor: f64) -> Result<Influence> {
        Ok(match self {
            Influence::HalfSpace(half_space) => Influence::HalfSpace(half_space.times(factor)),
            Influence::Table(table) => Influence::Table(table.times(factor)?),
            Influence::RowTables(tables) => Influence::RowTables(tables.times(factor)?),
            Influence::Periodic(periodic) => Influence::Periodic(periodic.times(factor)),
            Influence::Layered(layered) => Influence::Layered(layered.times(factor)?),
            Influence::Patches(patches) => Influence::Patches(patches.times(factor)?),
        })
    }

    /// Fills `out[k]` with the coefficient at offset `(kx + k, ky)`, `kx >= 0` when the coefficients are even.
    pub fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        match self {
            Influence::HalfSpace(half_space) => half_space.fill_row(kx, ky, out),
            Influence::Table(table) => table.fill_row(kx, ky, out),
            Influence::RowTables(tables) => {
                out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = tables.mean(kx, ky));
            }
            Influence::Periodic(periodic) => {
                out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = periodic.at(kx, ky));
            }
            Influence::Patches(patches) => patches.base().fill_row(kx, ky, out),
            Influence::Layered(layered) => {
                layered.base().fill_row(kx, ky, out);
                if ky == 0 && kx <= 0 && -kx < out.len() as i64 {
                    out[-kx as usize] += layered.least();
                }
            }
        }
    }

    /// Fills `out[k]` with the mean of the coefficients at offsets `(+-k, +-ky)`: what is even of them, for preconditioners. A
    /// table that ends before is carried on with its outermost coefficient; what has no inverse gets one.
    pub fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        match self {
            Influence::HalfSpace(half_space) => half_space.fill_row(0, ky, out),
            Influence::Table(table) => {
                for (kx, value) in (0..).zip(out) {
                    let four = [(kx, ky), (-kx, ky), (kx, -ky), (-kx, -ky)];
                    *value = 0.25 * four.into_iter().map(|(x, y)| table.at(x, y)).sum::<f64>();
                }
            }
            Influence::RowTables(tables) => tables.fill_even_mean(ky, out),
            Influence::Periodic(periodic) => {
                let constant = periodic.constant_for_inverse();
                out.iter_mut().zip(0..).for_each(|(value, kx)| *value = periodic.at(kx, ky) + constant);
            }
            Influence::Patches(patches) => patches.base().fill_even_row(ky, out),
            Influence::Layered(layered) => {
                match layered.base() {
                    // With a layer it has an inverse.
                    Influence::Periodic(_) => layered.base().fill_row(0, ky, out),
                    base => base.fill_even_row(ky, out),
                }
                if ky == 0 {
                    out[0] += layered.typical();
                }
            }
        }
    }

    /// The largest coefficient within `grid`, whatever its sign.
    pub fn largest(&self, grid: &Grid) -> f64 {
        match self {
            Influence::HalfSpace(half_space) => half_space.at(0, 0),
            Influence::Table(table) => table.largest(grid),
            Influence::RowTables(tables) => tables.largest(),
            Influence::Periodic(periodic) => periodic.at(0, 0),
            Influence::Layered(layered) => layered.base().largest(grid) + layered.most(),
            Influence::Patches(patches) => patches.base().largest(grid),
        }
    }

    /// Whether `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` for all offsets within `grid`.
    pub fn is_even(&self, grid: &Grid) -> bool {
        match self {
            Influence::HalfSpace(_) | Influence::Periodic(_) => true,
            Influence::Table(table) => table.is_even(grid),
            Influence::RowTables(_) => false,
            Influence::Layered(layered) => layered.base().is_even(grid),
            Influence::Patches(patches) => patches.base().is_even(grid),
        }
    }

    /// Whether A is symmetric on `grid`, `c(kx, ky) = c(-kx, -ky)`, to within round-off of the table.
    pub fn is_symmetric(&self, grid: &Grid) -> bool {
        match self {
            Influence::HalfSpace(_) | Influence::Periodic(_) => true,
            Influence::Table(table) => table.is_symmetric(grid),
            Influence::RowTables(tables) => tables.is_symmetric(),
            Influence::Layered(layered) => layered.base().is_symmetric(grid),
            Influence::Patches(patches) => patches.base().is_symmetric(grid),
        }
    }

    /// In which directions the coefficients repeat themselves after a length of `grid`: A is then circulant in them, not only Toeplitz.
    pub fn repeats(&self, grid: &Grid) -> (bool, bool) {
        match self {
            Influence::Periodic(periodic) => periodic.repeats(grid),
            Influence::Layered(layered) => layered.base().repeats(grid),
            Influence::Patches(patches) => patches.base().repeats(grid),
            _ => (false, false),
        }
    }

    /// What A has on the diagonal beyond the coefficient at offset (0, 0), per element; none where A is block Toeplitz.
    pub fn diagonal(&self) -> Option<&[f64]> {
        match self {
            Influence::Layered(layered) => layered.more(),
            _ => None,
        }
    }

    /// Patches between which the coefficients are scaled.
    pub fn patches(&self) -> Option<&Patches> {
        match self {
            Influence::Patches(patches) => Some(patches),
            Influence::Layered(layered) => layered.base().patches(),
            _ => None,
        }
    }

    /// The caller's own table.
    pub fn table(&self) -> Option<&Table> {
        match self {
            Influence::Table(table) => Some(table),
            Influence::Patches(patches) => patches.base().table(),
            Influence::Layered(layered) => layered.base().table(),
            _ => None,
        }
    }

    /// The same coefficients from another table.
    pub fn with_table(&self, table: Table) -> Influence {
        match self {
            Influence::Patches(patches) => Influence::Patches(patches.on(patches.base().with_table(table))),
            Influence::Layered(layered) => Influence::Layered(layered.on(layered.base().with_table(table))),
            _ => Influence::Table(table),
        }
    }

    /// Tables of loaded rows, and what a layer adds to all of them at offset (0, 0).
    pub fn row_tables(&self) -> Option<(&RowTables, f64)> {
        match self {
            Influence::RowTables(tables) => Some((tables, 0.0)),
            Influence::Patches(patches) => patches.base().row_tables(),
            Influence::Layered(layered) => layered.base().row_tables().map(|(tables, _)| (tables, layered.least())),
            _ => None,
        }
    }

    /// Whether A is more than coefficients of offsets: then a part of the grid has an operator of its own, wherever it is.
    pub fn depends_on_place(&self) -> bool {
        self.diagonal().is_some() || self.patches().is_some() || self.row_tables().is_some()
    }

    /// Whether a uniform pressure on the whole grid displaces nothing, so that A has no inverse.
    pub fn is_mean_free(&self) -> bool {
        matches!(self, Influence::Periodic(periodic) if periodic.is_mean_free())
    }

    /// The coefficients on a grid coarsened from `fine` to `coarse`: for the half-space computed anew for the larger
    /// element (the paper's direct coarse-grid operator), for tables summed from the fine coefficients.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Influence> {
        Ok(match self {
            Influence::HalfSpace(half_space) => Influence::HalfSpace(half_space.for_element(coarse.dx, coarse.dy)),
            Influence::Table(table) => Influence::Table(table.coarsen(fine, coarse)?),
            Influence::RowTables(tables) => Influence::RowTables(tables.coarsen(coarse)?),
            Influence::Periodic(periodic) => Influence::Periodic(periodic.coarsen(coarse)),
            Influence::Layered(layered) => Influence::Layered(layered.coarsen(fine, coarse)?),
            Influence::Patches(patches) => Influence::Patches(patches.coarsen(fine, coarse)?),
        })
    }

    /// Bytes of coefficients held: none for the half-space.
    pub fn bytes(&self) -> usize {
        match self {
            Influence::HalfSpace(_) => 0,
            Influence::Table(table) => table.bytes(),
            Influence::RowTables(tables) => tables.bytes(),
            Influence::Periodic(periodic) => periodic.bytes(),
            Influence::Layered(layered) => layered.base().bytes() + layered.more().map_or(0, size_of_val),
            Influence::Patches(patches) => patches.base().bytes() + patches.bytes(),
        }
    }
}
