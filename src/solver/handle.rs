//! What a handle (a [`Solver`]) tells about its last result and its set-up, and the replacement of the caller's influence coefficients.

use std::sync::Arc;

use super::tangential::Tangent;
use super::{LedgerRow, Options, Solver};
use crate::contact::{Freshness, State};
use crate::effects::{self, Effect, Layout, Visco};
use crate::error::{invalid, Result};
use crate::friction;
use crate::grid::Grid;
use crate::influence::{Coefficients, Table};

impl Solver {
    /// The result: pressures, displacements, contact area and approach.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The grid of the set-up.
    pub fn grid(&self) -> &Grid {
        &self.problem.grid
    }

    /// Tractions, slip and stick area of the last result; none if its scene had no friction.
    pub fn friction(&self) -> Option<&friction::Solution> {
        self.friction.as_deref().filter(|_| self.has_result).and_then(Tangent::solution)
    }

    /// Whether the last result has no estimates: pressures are at their limit, or bodies attract.
    pub(crate) fn lacks_estimates(&self) -> bool {
        self.state.has_limited() || self.split.is_some()
    }

    /// Whether the solver holds a result.
    pub fn has_solved(&self) -> bool {
        self.has_result
    }

    /// The history of visco-elastic bodies as a list of numbers. None before the first step.
    pub(crate) fn history(&self) -> Option<Vec<f64>> {
        self.beside.histories[effects::place(Visco::NAME)?].numbers()
    }

    /// Sets the history of visco-elastic bodies to the `numbers` of another solver's [history](Self::history).
    pub(crate) fn take_history(&mut self, numbers: &[f64]) -> Result<()> {
        match effects::place(Visco::NAME) {
            Some(k) => self.beside.histories[k].take(numbers, &self.problem.grid),
            None => Ok(()),
        }
    }

    /// The ledger of the last solve: one row for each grid, coarsest first.
    pub fn ledger(&self) -> &[LedgerRow] {
        &self.ledger
    }

    /// The influence coefficients in use.
    pub fn influence(&self) -> &Coefficients {
        &self.problem.coefficients
    }

    /// Replaces the caller's table of influence coefficients for all later solves. Memory and FFT plans of the operator are reused. The last result
    /// does not change. If an operator cannot be set up with the table, the solver has none until another table is set.
    pub fn set_influence(&mut self, table: Table) -> Result<()> {
        if self.set_up.own_coefficients.is_none_or(|(_, layout)| layout != Layout::Offsets) {
            return invalid("influence is given, but this solver was set up without".into());
        }
        Effect::check(&table, &self.problem.grid)?;
        let coefficients = self.problem.coefficients.clone().with_kernel(Arc::new(table.clone()));
        self.set_up.largest_influence = coefficients.largest(&self.problem.grid);
        // All other owners of the operator are dropped first, so that its memory can be reused.
        self.set_up.lacks_table = true;
        self.methods.forget_operator();
        self.adhesion = None;
        self.workers.clear();
        self.state.u_is = Freshness::Stale;
        self.problem.renew(coefficients)?;
        self.methods.renew(&self.problem)?;
        self.set_up.named.replace(&table);
        self.set_up.lacks_table = false;
        Ok(())
    }

    /// The number of threads requested at set-up; 0 means all cores.
    pub fn threads(&self) -> usize {
        self.set_up.options.threads
    }

    /// The options at set-up.
    pub(crate) fn set_up_options(&self) -> &Options {
        &self.set_up.options
    }

    /// The caller's influence coefficients and the name of their effect, if there are any. The layout is that of a scene on this grid: all offsets
    /// `-mx..mx` in x, and in y either all offsets (a table) or all pairs of rows (row tables).
    pub(crate) fn own_tables(&self) -> Option<(&'static str, Vec<f64>)> {
        let kernel = self.influence().kernel();
        let (mx, my) = (self.grid().mx as i64, self.grid().my as i64);
        let of_row = move |jy: i64, iy: i64| {
            // No pair of elements has the offset -mx; the layout has a column for it.
            (-mx..mx).map(move |kx| if kx == -mx { 0.0 } else { kernel.between((0, jy), (kx, iy)) })
        };
        let (name, layout) = self.set_up.own_coefficients?;
        let values = match layout {
            Layout::Offsets => (-my..my).flat_map(|ky| of_row(0, ky)).collect(),
            Layout::Rows => (0..my).flat_map(|jy| (0..my).flat_map(move |iy| of_row(jy, iy))).collect(),
        };
        Some((name, values))
    }

    /// Bytes of operators, workspace and results.
    pub fn bytes(&self) -> usize {
        // The coefficients of the finest grid are shared with the workers and count once.
        let unshared = |worker: &Solver| worker.bytes() - worker.influence().bytes();
        let workers: usize = self.workers.iter().flatten().map(unshared).sum();
        let limits = (self.limits.len() + self.remembered.len()) * size_of::<f64>();
        let friction = self.friction.as_deref().into_iter().chain(&self.crew).map(Tangent::bytes).sum::<usize>();
        let tables = self.own_tables.as_ref().map_or(0, |tables| tables.bytes());
        let split = self.split.as_ref().map_or(0, |split| split.bytes());
        let adhesion = self.adhesion.as_ref().map_or(0, |adhesion| adhesion.bytes()) + split;
        let beside = self.beside.bytes() + friction + adhesion + tables;
        self.problem.bytes() + self.methods.bytes() + self.state.bytes() + limits + workers + beside
    }
}
