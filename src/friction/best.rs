//! The best tractions that an iteration saw: they are what it returns where it does not converge.

use super::certificate::Certificate;
use super::forces::Forces;
use super::plane::Vector;
use super::problem::{Problem, State};
use crate::error::Result;
use crate::methods::fields::{self, Fields};

/// Of a residual with displacements that are not fresh, the part that they hide: round-off of single precision.
const HIDDEN: f64 = f32::EPSILON as f64;

/// Tractions, the creepages found with them, and how far they are from the conditions.
pub struct Best {
    q: Vec<Vector>,
    offset: Vector,
    /// The largest of the residual, the excess over the bounds and what is missing of the forces.
    worst: f64,
}

impl Best {
    /// None yet.
    pub fn none() -> Best {
        Best { q: Vec::new(), offset: [0.0; 2], worst: f64::INFINITY }
    }

    /// Keeps these if they are better, as far as displacements that may be of products in single precision tell.
    pub fn see(&mut self, problem: &Problem, state: &State, worst: f64, fields: &mut Fields) -> Result<()> {
        let worst = if state.is_exact { worst } else { worst.max(HIDDEN) };
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

    /// Where an iteration did not converge: makes the last tractions feasible, with a fresh product, and puts the best in their place if
    /// those are better then.
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

    /// Goes on from the best, if there is one.
    pub fn take_up(&mut self, problem: &mut Problem, state: &mut State) {
        if self.q.len() == state.q.len() {
            fields::map(&problem.threads().clone(), &mut state.q, |i, _| self.q[i]);
            problem.offset = self.offset;
            problem.refresh(state);
        }
    }

    fn swap(&mut self, problem: &mut Problem, state: &mut State) {
        std::mem::swap(&mut self.q, &mut state.q);
        std::mem::swap(&mut self.offset, &mut problem.offset);
    }

    /// Gives its field back.
    pub fn give(self, fields: &mut Fields) {
        if !self.q.is_empty() {
            fields.give(self.q);
        }
    }
}

/// How far feasible tractions are from the conditions.
fn measured(problem: &mut Problem, state: &mut State, forces: Forces) -> f64 {
    problem.refresh(state);
    let missing = if forces.any() { forces.missing(problem, &state.q) } else { 0.0 };
    let residual = Certificate::of(problem, state).residual;
    if missing.is_nan() || residual.is_nan() {
        f64::INFINITY
    } else {
        residual.max(missing)
    }
}
