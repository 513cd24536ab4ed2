//! Effects: the caller's influence coefficients of pressures, in one table for all elements (`influence`) or one table per loaded row (`row_tables`).
//!
//! A handle keeps the tables, so later scenes may leave them out.

use std::sync::Arc;

use super::effect::{Effect, Value};
use super::properties::{Layout, Properties, Stresses, HALF_SPACE_ALONE};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::{Kernel, RowTables, Table};
use crate::scene::Plain;

/// Why a solve on several grids is refused.
const ONE_GRID: &str = "own coefficients are those of one grid, and an accuracy needs several";

impl Effect for Table {
    fn name(&self) -> &'static str {
        "influence"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["period", "row_tables"],
            without_multigrid: None,
            with_given_area: true,
            one_grid: Some(ONE_GRID),
            own_coefficients: Some(Layout::Offsets),
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let (mx, my) = (self.cx, self.cy);
        if mx < grid.mx || my < grid.my {
            let Grid { mx: columns, my: rows, .. } = grid;
            return invalid(format!("influence is a table of {mx} x {my} elements; the grid has {columns} x {rows}"));
        }
        self.check_largest()
    }

    fn kernel(&self, _: &Plain<'_>, _: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(Some(Arc::new(self.clone())))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("influence->coefficients", Value::Shared(&self.values));
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Unknown(HALF_SPACE_ALONE)
    }
}

impl Effect for RowTables {
    fn name(&self) -> &'static str {
        "row_tables"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["period"],
            without_multigrid: Some(self.name()),
            with_given_area: true,
            one_grid: Some(ONE_GRID),
            own_coefficients: Some(Layout::Rows),
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let (mx, my) = (self.mx, self.my);
        if (mx, my) != (grid.mx, grid.my) {
            let Grid { mx: columns, my: rows, .. } = grid;
            return invalid(format!("row_tables are those of {mx} x {my} elements; the grid has {columns} x {rows}"));
        }
        self.check_largest()
    }

    fn kernel(&self, _: &Plain<'_>, _: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(Some(Arc::new(self.clone())))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("row_tables->coefficients", Value::Shared(&self.values));
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Unknown(HALF_SPACE_ALONE)
    }
}
