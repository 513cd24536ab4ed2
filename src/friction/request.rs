//! What one tangential solve is asked for.

use super::plane::{add, Vector};
use crate::effects::{Friction, Previous};
use crate::grid::Grid;

/// What one tangential solve is asked for. All values are in the caller's units.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The pressures of the normal problem, `[my][mx]`.
    pub pressure: &'a [f64],
    /// Coefficients, motion and previous tractions.
    pub friction: &'a Friction<'a>,
    /// The tolerance of the residual, and of the missing part of given forces.
    pub tolerance: f64,
    /// The largest number of products on all grids together, counted in products on the finest grid.
    pub limit: u64,
    /// For unlike bodies: the tangential displacements by the pressures, less those before the step.
    pub sideways: Option<&'a [Vector]>,
    /// The tractions with which the iteration starts.
    pub start: Start<'a>,
    /// Whether the caller has cancelled. Then the solve returns its start.
    pub is_cancelled: bool,
    /// Whether errors will be estimated: in steady rolling the next coarser grid is then solved more accurately.
    pub estimates: bool,
    /// The yield limit of each element on an ideal plastic layer; empty without such a layer.
    pub limits: &'a [f64],
    /// A cap on traction bounds, above all tractions that the solution may have (module `glued`).
    pub largest_bound: f64,
}

impl<'a> Request<'a> {
    /// The traction bound of element i: the least of mu p, the cap and the yield limit of an ideal layer. A negative pressure has the bound 0.
    pub fn bound(&self, i: usize) -> f64 {
        let bound = (self.friction.coefficient.at(i) * self.pressure[i].max(0.0)).min(self.largest_bound);
        self.limits.get(i).map_or(bound, |limit| bound.min(*limit))
    }

    /// The rigid slip of element i over a step, including the tangential displacements by pressures.
    pub(super) fn rigid_slip(&self, grid: &Grid, i: usize) -> Vector {
        add(self.friction.rigid_slip_at(grid, i), self.sideways.map_or([0.0; 2], |sideways| sideways[i]))
    }

    /// A request for like bodies that starts from the tractions before the step, with at most 1000 products and no estimates of errors.
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

/// The tractions with which the iteration starts.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// The tractions before the step. If there are none, the solve starts on the coarsest grid with q = 0.
    Before,
    /// The last result, which belongs to the same step with other pressures. The tractions before the step stay as they are.
    Again,
    /// As `Again`, but these creepages, times the length of the step, are given in place of the forces that the friction prescribes. The solve then
    /// finds the forces.
    Held(Vector),
    /// The last result, as a guess for another step.
    Last,
    /// The caller's tractions in x and in y, as a guess.
    Given([&'a [f64]; 2]),
}

impl Start<'_> {
    /// Whether the start is a guess, which may be worse than a start from coarser grids.
    pub fn is_guess(&self) -> bool {
        matches!(self, Start::Last | Start::Given(_))
    }

    /// Whether this solve repeats the last step.
    pub fn is_again(&self) -> bool {
        matches!(self, Start::Again | Start::Held(_))
    }
}

/// The traction of element i before the step. `kept` are the tractions of the step before, which friction that continues starts from.
pub(super) fn before(friction: &Friction<'_>, kept: &[Vector], i: usize) -> Vector {
    match friction.previous {
        Previous::None => [0.0; 2],
        Previous::Given([x, y]) => [x[i], y[i]],
        Previous::Kept => kept[i],
    }
}
