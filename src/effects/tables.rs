//! Effects: own coefficients, one table for all elements (`influence`) or one per loaded row (`row_tables`).
//!
//! A solve on a handle need not name them again: its own serve.

use std::sync::Arc;

use super::effect::{Effect, Value};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::{Kernel, RowTables, Table};
use crate::scene::Plain;

impl Effect for Table {
    fn name(&self) -> &'static str {
        "influence"
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let (mx, my) = (self.cx, self.cy);
        if mx < grid.mx || my < grid.my {
            let Grid { mx: columns, my: rows, .. } = grid;
            return invalid(format!("influence is a table of {mx} x {my} elements; the grid has {columns} x {rows}"));
        }
        Ok(())
    }

    fn excludes(&self) -> &'static [&'static str] {
        &["period", "row_tables"]
    }

    fn replaces_bodies(&self) -> bool {
        true
    }

    fn kernel(&self, _: &Plain<'_>, _: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(Some(Arc::new(self.clone())))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("influence->coefficients", Value::Shared(&self.values));
    }
}

impl Effect for RowTables {
    fn name(&self) -> &'static str {
        "row_tables"
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let (mx, my) = (self.mx, self.my);
        if (mx, my) != (grid.mx, grid.my) {
            let Grid { mx: columns, my: rows, .. } = grid;
            return invalid(format!("row_tables are those of {mx} x {my} elements; the grid has {columns} x {rows}"));
        }
        Ok(())
    }

    fn excludes(&self) -> &'static [&'static str] {
        &["period"]
    }

    fn replaces_bodies(&self) -> bool {
        true
    }

    fn without_multigrid(&self) -> Option<&'static str> {
        Some(self.name())
    }

    fn kernel(&self, _: &Plain<'_>, _: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(Some(Arc::new(self.clone())))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("row_tables->coefficients", Value::Shared(&self.values));
    }
}
