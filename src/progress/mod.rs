//! The goal of an iteration loop and its outcome; and what is recorded of a solve: counters, ledger, and calls of the progress callback.

mod criterion;
mod ledger;

use std::time::Instant;

pub use criterion::{Criterion, Goal, Outcome, METHOD_SHARE, UPDATE_RESIDUAL};
pub use ledger::{DiscretisationError, Ledger, LedgerRow, Measures};

use crate::contact::{Outline, State, Survey};
use crate::grid::Grid;

/// What a progress callback is told after each cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Elements in x of the grid of the cycle.
    pub mx: usize,
    /// Elements in y.
    pub my: usize,
    /// Cycles on that grid.
    pub cycles: u64,
    /// Elements that entered or left the contact area in the last cycle.
    pub active_set_changes: u64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since the solve began.
    pub work_units: f64,
    /// rms over C of the last change of p; 0 if it is not measured.
    pub update: f64,
    /// Relative residual, if known: of the normal problem over C, or of the tangential problem during its iterations.
    pub residual: f64,
}

impl Progress {
    /// The progress of work that has no cycles. `cycles` then counts other parts of work: depths of subsurface stresses, or entries of a table.
    pub fn of_part(grid: &Grid, cycles: u64, seconds: f64) -> Progress {
        Progress { mx: grid.mx, my: grid.my, cycles, seconds, ..Progress::default() }
    }
}

/// The caller's function that is called after each cycle. It returns true to cancel the solve.
pub type ProgressCallback<'a> = &'a mut dyn FnMut(&Progress) -> bool;

/// Counters of a solve. [`Monitor::enter_grid`] resets all of them except the work units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    /// Cycles (of multigrid) or iterations (of conjugate gradients or GMRES) on the current grid.
    pub cycles: u64,
    /// Products A p on the current grid.
    pub matrix_products: u64,
    /// Sum over the cycles on the current grid of the elements that entered or left the contact area.
    pub active_set_changes: u64,
    /// Active-set steps on the current grid.
    pub active_set_steps: u64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// Relative residual over C, as of the last cycle.
    pub residual: f64,
    /// Products on all grids, in units of a product on the finest grid.
    pub work_units: f64,
}

/// Counts the work of a solve, calls the progress callback, and writes the ledger.
pub struct Monitor<'a> {
    began: Instant,
    callback: Option<ProgressCallback<'a>>,
    /// Whether the callback has cancelled.
    cancelled: bool,
    /// The counters so far.
    pub count: Counters,
    /// Seconds in which coefficients of coarser grids were set up.
    pub coarse_seconds: f64,
    /// The rows of the grids so far.
    pub ledger: Ledger,
    /// The survey of the final state on the current grid, if it is known; otherwise [`close_grid`](Monitor::close_grid) makes it.
    pub survey: Option<Survey>,
}

impl<'a> Monitor<'a> {
    /// Starts the clock of a solve. The ledger reuses the memory of `rows`. `estimates` tells whether errors will be estimated.
    pub fn new(callback: Option<ProgressCallback<'a>>, mut rows: Vec<LedgerRow>, estimates: bool) -> Monitor<'a> {
        rows.clear();
        let ledger = Ledger { rows, estimates, ..Ledger::default() };
        Monitor {
            began: Instant::now(),
            callback,
            cancelled: false,
            count: Counters::default(),
            coarse_seconds: 0.0,
            ledger,
            survey: None,
        }
    }

    /// A monitor without a callback.
    pub fn silent() -> Monitor<'a> {
        Monitor::new(None, Vec::new(), false)
    }

    /// Seconds since the solve began.
    pub fn seconds(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Begins another grid: resets all counters except the work units.
    pub fn enter_grid(&mut self) {
        self.count = Counters { work_units: self.count.work_units, ..Counters::default() };
    }

    /// Adds work units of products on other grids, which are no products on the current grid.
    pub fn count_work(&mut self, work: f64) {
        self.count.work_units += work;
    }

    /// Counts products on the current grid, each of which takes `work` work units.
    pub fn count_products(&mut self, products: u64, work: f64) {
        self.count.work_units += products as f64 * work;
        self.count.matrix_products += products;
    }

    /// Counts a cycle and calls the callback. Returns false if the callback has cancelled.
    pub fn cycle_done(&mut self, grid: &Grid, changes: u64, update: f64, residual: f64) -> bool {
        self.count.cycles += 1;
        self.count.active_set_changes += changes;
        (self.count.update, self.count.residual) = (update, residual);
        self.tell(grid, changes, update, residual)
    }

    /// Calls the callback unless it has cancelled before. Returns false if it has cancelled.
    fn tell(&mut self, grid: &Grid, changes: u64, update: f64, residual: f64) -> bool {
        if let (Some(callback), false) = (&mut self.callback, self.cancelled) {
            let progress = Progress {
                mx: grid.mx,
                my: grid.my,
                cycles: self.count.cycles,
                active_set_changes: changes,
                seconds: self.began.elapsed().as_secs_f64(),
                work_units: self.count.work_units,
                update,
                residual,
            };
            self.cancelled = callback(&progress);
        }
        !self.cancelled
    }

    /// Calls the callback after an iteration that does not count as a cycle: one of the tangential problem, or on a coarser grid. Returns false if
    /// the callback has cancelled.
    pub fn uncounted_done(&mut self, grid: &Grid, residual: f64) -> bool {
        self.tell(grid, 0, 0.0, residual)
    }

    /// Whether the callback has cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled
    }

    /// The outcome of a loop that ended because the callback cancelled or no cycle is left.
    pub fn interrupted(&self) -> Outcome {
        if self.cancelled {
            Outcome::Cancelled
        } else {
            Outcome::IterationLimit
        }
    }

    /// Ends the current grid: writes its ledger row from `state`, whose u must be A p.
    pub fn close_grid(&mut self, state: &State) {
        let survey = self.survey.take().unwrap_or_else(|| Survey::of(state));
        let mut measures = Measures::of(state, &survey);
        if self.ledger.estimates {
            self.ledger.outline = Outline::of(state);
            measures.corrected_area = self.ledger.outline.corrected_area(state, measures.contact_count);
        }
        self.add_row(&state.grid, measures);
    }

    /// Writes the ledger row of the current grid, with these measures.
    pub fn add_row(&mut self, grid: &Grid, measures: Measures) {
        self.ledger.rows.push(LedgerRow {
            mx: grid.mx,
            my: grid.my,
            cycles: self.count.cycles,
            seconds: self.seconds(),
            work_units: self.count.work_units,
            measures,
            error: DiscretisationError::default(),
        });
    }
}
