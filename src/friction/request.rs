//! The request of a tangential solve.

use super::plane::{add, Vector};
use crate::effects::{Friction, Previous};
use crate::grid::Grid;

/// The request of a tangential solve.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The pressures of the normal problem, `[my][mx]`.
    pub pressure: &'a [f64],
    /// The friction.
    pub friction: &'a Friction<'a>,
    /// The tolerance of the residual.
    pub tolerance: f64,
    /// The limit on iterations on the finest grid.
    pub limit: u64,
    /// Unlike bodies: the sideways displacements by the pressures, less those before the step.
    pub sideways: Option<&'a [Vector]>,
    /// The start.
    pub start: Start<'a>,
    /// Whether the caller has cancelled: then the solve ends at its start.
    pub is_cancelled: bool,
    /// Whether errors are estimated.
    pub estimates: bool,
    /// The yield limits of an ideal layer; empty without one.
    pub limits: &'a [f64],
    /// The cap on traction bounds: no traction reaches a larger one.
    pub largest_bound: f64,
}

impl<'a> Request<'a> {
    /// The traction bound of an element: mu p, or less where an ideal layer yields.
    pub fn bound(&self, i: usize) -> f64 {
        let bound = (self.friction.coefficient.at(i) * self.pressure[i].max(0.0)).min(self.largest_bound);
        self.limits.get(i).map_or(bound, |limit| bound.min(*limit))
    }

    /// The rigid slip of element i over a step, with the sideways displacements by pressures.
    pub(super) fn rigid_slip(&self, grid: &Grid, i: usize) -> Vector {
        add(self.friction.rigid_slip_at(grid, i), self.sideways.map_or([0.0; 2], |sideways| sideways[i]))
    }

    /// A request from the tractions before the step, for like bodies, with at most 1000 iterations and no estimates.
    pub fn new(pressure: &'a [f64], friction: &'a Friction<'a>, tolerance: f64) -> Request<'a> {
        Request {
            pressure,
            friction,
            tolerance,
            limit: 1000,
            sideways: None,
            start: Start::Before,
            is_cancelled: false,
            estimates: false,
            limits: &[],
            largest_bound: f64::INFINITY,
        }
    }
}

/// The start of a solve.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// From the tractions before the step; from rest on the coarsest grid.
    Before,
    /// From the last result: the same step once more with other pressures. The state before the step is kept.
    Again,
    /// As `Again`, but with given creepages, times the length rolled, in place of the forces that the friction
    /// prescribes. The solve finds the forces.
    Held(Vector),
    /// From the last result.
    Last,
    /// From the caller's tractions, in x and y.
    Given([&'a [f64]; 2]),
}

impl Start<'_> {
    /// Whether the start may be worse than one from coarser grids.
    pub fn is_guess(&self) -> bool {
        matches!(self, Start::Last | Start::Given(_))
    }

    /// Whether the step is solved once more.
    pub fn is_again(&self) -> bool {
        matches!(self, Start::Again | Start::Held(_))
    }
}

/// The traction of element i before the step; `kept`: tractions of the last result.
pub(super) fn before(friction: &Friction<'_>, kept: &[Vector], i: usize) -> Vector {
    match friction.previous {
        Previous::None => [0.0; 2],
        Previous::Given([x, y]) => [x[i], y[i]],
        Previous::Kept => kept[i],
    }
}
