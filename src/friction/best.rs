//! The best tractions of an iteration, returned if it does not converge.

use super::certificate::Certificate;
use super::forces::Forces;
use super::plane::Vector;
use super::problem::{Problem, State};
use crate::error::Result;
use crate::methods::fields::{self, Fields};

/// Relative uncertainty of a residual from displacements that are not fresh: round-off of single precision.
const STALE_UNCERTAINTY: f64 = f32::EPSILON as f64;

/// Tractions, their creepages, and their largest measure.
pub struct Best {
    q: Vec<Vector>,
    offset: Vector,
    /// The largest of the residual, the excess over the bounds and the missing force.
    worst: f64,
}

impl Best {
    /// No tractions yet.
    pub fn none() -> Best {
        Best { q: Vec::new(), offset: [0.0; 2], worst: f64::INFINITY }
    }

    /// Keeps the state's tractions if they are better. Their measure counts as [`STALE_UNCERTAINTY`] or more if the
    /// displacements are not fresh.
    pub fn see(&mut self, problem: &Problem, state: &State, worst: f64, fields: &mut Fields) -> Result<()> {
        let worst = if state.is_exact { worst } else { worst.max(STALE_UNCERTAINTY) };
        if !(worst < self.worst) {
            return Ok(());
        }
        if self.q.len() != state.q.len() {
            self.q = fields.take(state.q.len())?;
        }
        fields::fill(problem.threads(), &mut self.q, |i| state.q[i]);
        (self.offset, self.worst) = (problem.offset, worst);
        Ok(())
    }

    /// After an iteration without convergence: makes the last tractions feasible, with a fresh product, and replaces them by the best if those are
    /// better.
    pub fn restore(&mut self, problem: &mut Problem, state: &mut State, forces: Forces) {
        let last = measured(problem, state, forces);
        if self.q.len() != state.q.len() {
            return;
        }
        self.swap(problem, state);
        if !(measured(problem, state, forces) <= last) {
            self.swap(problem, state);
            problem.refresh(state);
        }
    }

    /// Restores the best tractions without their displacements. Returns whether there are any.
    pub fn take_up(&self, problem: &mut Problem, state: &mut State) -> bool {
        if self.q.len() != state.q.len() {
            return false;
        }
        fields::fill(problem.threads(), &mut state.q, |i| self.q[i]);
        problem.offset = self.offset;
        true
    }

    fn swap(&mut self, problem: &mut Problem, state: &mut State) {
        std::mem::swap(&mut self.q, &mut state.q);
        std::mem::swap(&mut self.offset, &mut problem.offset);
    }

    /// Returns the field.
    pub fn give(self, fields: &mut Fields) {
        if !self.q.is_empty() {
            fields.give(self.q);
        }
    }
}

/// The largest measure of feasible tractions.
fn measured(problem: &mut Problem, state: &mut State, forces: Forces) -> f64 {
    problem.refresh(state);
    let missing = forces.missing(problem, &state.q);
    let residual = Certificate::of(problem, state).residual;
    if missing.is_nan() || residual.is_nan() {
        f64::INFINITY
    } else {
        residual.max(missing)
    }
}
