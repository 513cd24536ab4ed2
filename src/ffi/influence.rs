//! The caller's influence coefficients: `contact_normal_influence`, `contact_normal_row_tables`.

use super::arguments::{count, required, GivenEffect, Regions};
use super::status::Refusal;
use super::structs::versioned;
use crate::grid::Grid;
use crate::influence::{RowTables, Table};

/// Effect: influence coefficients of your own instead of the half-space's. They need be neither symmetric nor positive. But a pressure must displace
/// its own element inwards, and must not displace another element by more (in the mean of both directions between two elements).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_influence {
    /// Set by `contact_normal_influence_init`.
    pub struct_size: i64,
    /// The table covers the offsets -cx to cx - 1 in x; cx >= mx. Default 0: to be set.
    pub cx: i32,
    /// The table covers the offsets -cy to cy - 1 in y; cy >= my. Default 0: to be set.
    pub cy: i32,
    /// The table, `[2 cy][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, -cy:cy-1)`. `A_IJ = cf(ix - jx, iy - jy)` is the displacement
    /// of element I by a unit pressure on element J (length per pressure). Row -cy and column -cx are never read.
    /// Default NULL: to be set.
    pub coefficients: *const f64,
    /// A positive factor on every coefficient; default 1.
    pub scale: f64,
}

versioned! { contact_normal_influence, contact_normal_influence_init, 32, scale: 1.0 }

/// Effect: influence coefficients of your own that differ from loaded row to loaded row, instead of the half-space's: for conformal contact, or an
/// inclination that varies along y. They need be neither symmetric nor positive. But a pressure must displace its own element inwards, and no
/// coefficient (in the mean of both directions between two elements) may exceed the largest one of an element on itself. Memory and time of a product
/// grow with my * my * mx.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_row_tables {
    /// Set by `contact_normal_row_tables_init`.
    pub struct_size: i64,
    /// The tables cover the offsets -cx to cx - 1 in x; cx >= mx. Default 0: to be set.
    pub cx: i32,
    /// The number of tables, and of the rows of each table: my. Default 0: to be set.
    pub rows: i32,
    /// The tables, `[rows][rows][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, my, my)`. `A_IJ = cf(ix - jx, iy, jy)` is the displacement
    /// of element (ix, iy) by a unit pressure on element (jx, jy). Column -cx is never read. Default
    /// NULL: to be set.
    pub coefficients: *const f64,
    /// A positive factor on every coefficient; default 1.
    pub scale: f64,
}

versioned! { contact_normal_row_tables, contact_normal_row_tables_init, 32, scale: 1.0 }

/// The number of values in a table over the offsets -cx to cx - 1 and -cy to cy - 1.
pub(super) fn table_size(cx: usize, cy: usize) -> Result<usize, Refusal> {
    let size = cx.checked_mul(cy).and_then(|n| n.checked_mul(4)).filter(|n| *n <= isize::MAX as usize / 8);
    size.ok_or_else(|| Refusal::invalid(format!("cx * cy is {cx} * {cy}; no influence table is that large")))
}

impl contact_normal_influence {
    /// Copies the part of the caller's table that the grid needs.
    pub(super) unsafe fn translate(&self, grid: &Grid) -> Result<Table, Refusal> {
        let (cx, cy, size) = self.size("influence")?;
        // SAFETY: NULL or 2 cy by 2 cx values, by the conventions of the ABI.
        let values = unsafe { required("influence->coefficients", self.coefficients, size)? };
        Ok(Table::scaled(cx, cy, values, self.scale, grid)?)
    }

    /// cx, cy, and the number of values; `name` is what messages call the table.
    pub(super) fn size(&self, name: &str) -> Result<(usize, usize, usize), Refusal> {
        let (cx, cy) = (count(&format!("{name}->cx"), self.cx)?, count(&format!("{name}->cy"), self.cy)?);
        Ok((cx, cy, table_size(cx, cy)?))
    }
}

impl GivenEffect for contact_normal_influence {
    fn add_to(&self, regions: &mut Regions, _grid: &Grid) -> Result<(), Refusal> {
        regions.input("influence->coefficients", self.coefficients, self.size("influence")?.2)
    }
}

impl contact_normal_row_tables {
    /// Copies the part of the caller's tables that the grid needs.
    pub(super) unsafe fn translate(&self, grid: &Grid) -> Result<RowTables, Refusal> {
        let (cx, rows, size) = self.size(grid)?;
        // SAFETY: NULL or rows by rows by 2 cx values, by the conventions of the ABI.
        let values = unsafe { required("row_tables->coefficients", self.coefficients, size)? };
        Ok(RowTables::scaled(cx, rows, values, self.scale, grid)?)
    }

    /// cx, the number of rows, and the number of values that are read.
    fn size(&self, grid: &Grid) -> Result<(usize, usize, usize), Refusal> {
        self.size_on(Some(grid), "row_tables")
    }

    /// cx, the number of rows, and the number of values that are read: all if `grid` is None. Messages call the tables `name`.
    pub(super) fn size_on(&self, grid: Option<&Grid>, name: &str) -> Result<(usize, usize, usize), Refusal> {
        let (cx, rows) = (count(&format!("{name}->cx"), self.cx)?, count(&format!("{name}->rows"), self.rows)?);
        // A table for another grid is refused, so that its coefficients are not read.
        let rows_read = if grid.is_none_or(|grid| rows == grid.my && cx >= grid.mx) { rows } else { 0 };
        let size = rows_read.checked_mul(rows_read).and_then(|n| n.checked_mul(2)).and_then(|n| n.checked_mul(cx));
        let size = size.filter(|n| *n <= isize::MAX as usize / 8).ok_or_else(|| {
            Refusal::invalid(format!("rows * rows * 2 cx is {rows} * {rows} * 2 * {cx}; no row tables are that large"))
        })?;
        Ok((cx, rows, size))
    }
}

impl GivenEffect for contact_normal_row_tables {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        regions.input("row_tables->coefficients", self.coefficients, self.size(grid)?.2)
    }
}
