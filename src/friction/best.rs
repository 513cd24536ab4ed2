//! The best tractions of an iteration, which are the result if it does not converge.

use super::certificate::Certificate;
use super::forces::Forces;
use super::plane::Vector;
use super::problem::{Problem, State};
use crate::error::Result;
use crate::methods::fields::{self, Fields};

/// A residual from displacements that are not fresh is uncertain by this: the round-off of single precision.
const STALE_UNCERTAINTY: f64 = f32::EPSILON as f64;

/// The tractions and creepages with the least error so far.
pub struct Best {
    /// Empty if there are none yet.
    q: Vec<Vector>,
    offset: Vector,
    /// Their error: the largest of the residual, the excess of |q| over its bounds and the missing force, each relative to its scale.
    worst: f64,
}

impl Best {
    /// A place for tractions, without any yet.
    pub fn none() -> Best {
        Best { q: Vec::new(), offset: [0.0; 2], worst: f64::INFINITY }
    }

    /// Copies the state's tractions if their error `worst` is the least so far. If their displacements are not fresh, the error counts as
    /// [`STALE_UNCERTAINTY`] at least.
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

    /// After an iteration that did not converge: projects the last tractions and the best ones onto the discs, computes their errors by fresh
    /// products, and sets the state to the better ones.
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

    /// Sets the tractions and creepages to the best ones. The displacements then have to be computed. Returns false if there are no best tractions.
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

    /// Gives the memory back to `fields`.
    pub fn give(self, fields: &mut Fields) {
        if !self.q.is_empty() {
            fields.give(self.q);
        }
    }
}

/// Projects q onto the discs, and returns its error: the larger of the residual and the missing force, by a fresh product.
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
