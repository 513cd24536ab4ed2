//! Coefficients of the caller's own: `contact_normal_influence`, `contact_normal_row_tables`.

use super::arguments::{count, required, GivenEffect, Regions};
use super::status::Refusal;
use super::structs::versioned;
use crate::grid::Grid;
use crate::influence::{RowTables, Table};

/// Effect: the caller's own influence coefficients instead of the half-space. Nothing is assumed of them but that a pressure
/// displaces its own element inwards: they need be neither symmetric nor positive.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_influence {
    /// Set by `contact_normal_influence_init`.
    pub struct_size: i64,
    /// The table covers offsets -cx..cx-1; cx >= mx. Default 0: to be set.
    pub cx: i32,
    /// And -cy..cy-1; cy >= my. Default 0: to be set.
    pub cy: i32,
    /// `[2 cy][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, -cy:cy-1)`. `A_IJ = cf(ix - jx, iy - jy)`: the displacement
    /// of element I by a unit pressure on element J (length per pressure). Row -cy and column -cx are never read.
    /// Default NULL: to be set.
    pub coefficients: *const f64,
    /// Every coefficient is multiplied by this, positive; default 1.
    pub scale: f64,
}

versioned! { contact_normal_influence, contact_normal_influence_init, 32, scale: 1.0 }

/// Effect: own coefficients that differ per loaded row, instead of the half-space: conformal contact, an inclination that varies along
/// y. Nothing is assumed of them but that a pressure displaces its own element inwards. Memory and time of a product grow with
/// my * my * mx.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_row_tables {
    /// Set by `contact_normal_row_tables_init`.
    pub struct_size: i64,
    /// The tables cover offsets -cx..cx-1 in x; cx >= mx. Default 0: to be set.
    pub cx: i32,
    /// Number of tables, and rows of each: my. Default 0: to be set.
    pub rows: i32,
    /// `[rows][rows][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, my, my)`. `A_IJ = cf(ix - jx, iy, jy)`: the displacement of
    /// element (ix, iy) by a unit pressure on element (jx, jy). Column -cx is never read. Default
    /// NULL: to be set.
    pub coefficients: *const f64,
    /// Every coefficient is multiplied by this, positive; default 1.
    pub scale: f64,
}

versioned! { contact_normal_row_tables, contact_normal_row_tables_init, 32, scale: 1.0 }

/// Number of values in a table of coefficients.
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

    /// cx, rows, and the number of values that are read.
    fn size(&self, grid: &Grid) -> Result<(usize, usize, usize), Refusal> {
        self.size_on(Some(grid), "row_tables")
    }

    /// cx, rows, and the number of values that are read, with the `name` of the tables in messages. Without a grid all are read.
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
