//! Counts what a solve does, asks the caller whether to go on, and keeps the ledger.

use std::time::Instant;

use crate::contact::{norm_of_distance, residual_norm, Outline, State};
use crate::grid::Grid;
use crate::solver::estimates::{self, Sample};
use crate::solver::{DiscretisationError, Halving, LedgerRow, Limit, Measures, Report, Stop};

/// What a progress callback is told after each cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Elements in x of the grid that the cycle was on.
    pub mx: usize,
    /// Elements in y.
    pub my: usize,
    /// Cycles on that grid.
    pub cycles: u64,
    /// Elements that changed sides in the last cycle.
    pub active_set_changes: u64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since then.
    pub work_units: f64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// Relative residual over C, as far as it is known.
    pub residual: f64,
}

/// Told the progress after each cycle; says whether to cancel.
pub type ProgressCallback<'a> = &'a mut dyn FnMut(&Progress) -> bool;

/// The counters of one solve.
pub struct Monitor<'a> {
    began: Instant,
    callback: Option<ProgressCallback<'a>>,
    cancelled: bool,
    /// Cycles on the current grid.
    pub cycles: u64,
    /// Work units on all grids.
    pub work_units: f64,
    /// Products on the current grid.
    pub matrix_products: u64,
    /// Elements that changed sides on the current grid.
    pub active_set_changes: u64,
    /// Active-set steps on the current grid.
    pub active_set_steps: u64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// What the finest grid is solved to.
    pub tolerance: f64,
    ledger: Vec<LedgerRow>,
    estimates: bool,
    /// Of the contact area of the last row.
    outline: Outline,
    limit: Limit,
    halving: Halving,
}

impl<'a> Monitor<'a> {
    /// The clock starts. `ledger` lends its memory; `estimates`: whether errors are to be estimated.
    pub fn new(callback: Option<ProgressCallback<'a>>, mut ledger: Vec<LedgerRow>, estimates: bool) -> Monitor<'a> {
        ledger.clear();
        Monitor {
            began: Instant::now(),
            callback,
            cancelled: false,
            cycles: 0,
            work_units: 0.0,
            matrix_products: 0,
            active_set_changes: 0,
            active_set_steps: 0,
            update: 0.0,
            tolerance: 0.0,
            ledger,
            estimates,
            outline: Outline::default(),
            limit: Limit::default(),
            halving: Halving::default(),
        }
    }

    /// A new grid: its own counts start.
    pub fn enter_grid(&mut self) {
        self.cycles = 0;
        self.active_set_changes = 0;
        self.active_set_steps = 0;
        self.update = 0.0;
        self.matrix_products = 0;
    }

    /// Counts products on other grids than the current one: work only.
    pub fn count_work(&mut self, work: f64) {
        self.work_units += work;
    }

    /// Counts products on the current grid: their number and the work of one.
    pub fn count_products(&mut self, products: u64, work: f64) {
        self.work_units += products as f64 * work;
        self.matrix_products += products;
    }

    /// Counts a cycle; false when the caller cancels.
    pub fn cycle_done(&mut self, grid: &Grid, changes: u64, update: f64, residual: f64) -> bool {
        self.cycles += 1;
        self.active_set_changes += changes;
        self.update = update;
        if let Some(callback) = &mut self.callback {
            let progress = Progress {
                mx: grid.mx,
                my: grid.my,
                cycles: self.cycles,
                active_set_changes: changes,
                seconds: self.began.elapsed().as_secs_f64(),
                work_units: self.work_units,
                update,
                residual,
            };
            self.cancelled = callback(&progress);
        }
        !self.cancelled
    }

    /// The ledger so far.
    pub fn ledger(&self) -> &[LedgerRow] {
        &self.ledger
    }

    /// Whether the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled
    }

    /// Writes the ledger row of the current grid.
    pub fn close_grid(&mut self, state: &State) {
        let mut measures = Measures::of(state);
        if self.estimates {
            self.outline = Outline::of(state);
            measures.corrected_area = self.outline.corrected_area(state, measures.contact_count);
        }
        self.ledger.push(LedgerRow {
            mx: state.grid.mx,
            my: state.grid.my,
            cycles: self.cycles,
            seconds: self.began.elapsed().as_secs_f64(),
            work_units: self.work_units,
            measures,
            error: DiscretisationError::default(),
        });
    }

    /// The outline of the contact area of the grid that was closed last, if errors are estimated.
    pub fn outline(&self) -> &Outline {
        &self.outline
    }

    /// The ledger with its errors, once they are known.
    pub fn estimate(&mut self, state: &State, samples: &[Sample]) {
        let solve_seconds = self.began.elapsed().as_secs_f64();
        (self.limit, self.halving) =
            estimates::estimate(&mut self.ledger, state, &self.outline, samples, solve_seconds);
    }

    /// The report of the whole solve, whose last ledger row is the finest grid's, and the ledger.
    pub fn finish(self) -> (Report, Vec<LedgerRow>) {
        let last = self.ledger.last().copied();
        let report = Report {
            cycles: self.cycles,
            active_set_changes: self.active_set_changes,
            active_set_steps: self.active_set_steps,
            update: self.update,
            matrix_products: self.matrix_products,
            work_units: self.work_units,
            measures: last.map(|row| row.measures).unwrap_or_default(),
            error: last.map(|row| row.error).unwrap_or_default(),
            limit: self.limit,
            halving: self.halving,
            tolerance: self.tolerance,
            solve_seconds: self.began.elapsed().as_secs_f64(),
            ..Report::default()
        };
        (report, self.ledger)
    }
}

/// What ends the iteration on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Of the criterion.
    pub tolerance: f64,
    /// Whether the last change of p is judged, or the residual.
    pub by_update: bool,
    /// Whether the contact area is given.
    pub fixed: bool,
    /// Cycles at most.
    pub max_cycles: u64,
}

impl Rule {
    /// Whether the criterion holds for a state whose u is A p.
    pub fn holds(&self, state: &State, update: f64) -> bool {
        if self.by_update {
            let count = state.contact_count() as f64;
            let rms = (state.p.iter().map(|p| p * p).sum::<f64>() / count.max(1.0)).sqrt();
            // not `>` so that a NaN does not pass
            return update <= self.tolerance * rms;
        }
        let residual = residual_norm(state);
        residual.is_finite() && residual <= self.tolerance * norm_of_distance(state)
    }
}

impl Stop {
    /// The stop of a loop that ran out of cycles or was cancelled.
    pub(crate) fn interrupted(monitor: &Monitor<'_>) -> Stop {
        if monitor.is_cancelled() {
            Stop::Cancelled
        } else {
            Stop::IterationLimit
        }
    }
}
