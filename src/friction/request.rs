//! The request to a tangential solve.

use super::plane::Vector;
use crate::effects::{Friction, Previous};

/// The request to a solve.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The pressures of the normal problem, `[my][mx]`.
    pub pressure: &'a [f64],
    /// The friction.
    pub friction: &'a Friction<'a>,
    /// Of the residual.
    pub tolerance: f64,
    /// Iterations on the finest grid at most.
    pub limit: u64,
    /// Unlike bodies: the sideways displacements by the pressures, less those before the step.
    pub sideways: Option<&'a [Vector]>,
    /// Where it starts.
    pub start: Start<'a>,
    /// Whether the caller has cancelled before: then it ends where it starts.
    pub is_cancelled: bool,
    /// Whether errors are to be estimated.
    pub estimates: bool,
}

impl<'a> Request<'a> {
    /// The traction bound of an element: mu p, or less where a layer yields.
    pub fn bound(&self, i: usize) -> f64 {
        self.friction.bound_at(i, self.pressure[i])
    }

    /// From the tractions before the step, for like bodies, in 1000 iterations at most, without estimates.
    pub fn new(pressure: &'a [f64], friction: &'a Friction<'a>, tolerance: f64) -> Request<'a> {
        let (limit, start) = (1000, Start::Before);
        Request { pressure, friction, tolerance, limit, sideways: None, start, is_cancelled: false, estimates: false }
    }
}

/// Where a solve starts.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// From the tractions before the step; from rest on the coarsest grid.
    Before,
    /// The same step once more, with other pressures: from the last result. What was before the step stays.
    Again,
    /// The same with creepages, times the length rolled, in the place of given forces: these are what is found.
    Held(Vector),
    /// From the last result.
    Last,
    /// From tractions of the caller's, in x and y.
    Given([&'a [f64]; 2]),
}

impl Start<'_> {
    /// Whether it may be worth less than the coarser grids.
    pub fn is_guess(&self) -> bool {
        matches!(self, Start::Last | Start::Given(_))
    }

    /// Whether it is the same step once more.
    pub fn is_again(&self) -> bool {
        matches!(self, Start::Again | Start::Held(_))
    }
}

/// The traction of element i before the step; `kept` are those of the last result.
pub(super) fn before(friction: &Friction<'_>, kept: &[Vector], i: usize) -> Vector {
    match friction.previous {
        Previous::None => [0.0; 2],
        Previous::Given([x, y]) => [x[i], y[i]],
        Previous::Kept => kept[i],
    }
}
