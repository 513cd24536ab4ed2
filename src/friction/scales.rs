//! Units of the iterations: powers of two, so that no bit changes. Element sizes, coefficients and traction bounds are of order 1 in them,
//! whatever the caller's units: squares and single precision stay within range.

use super::plane::Vector;
use super::unit::unit_of;
use super::Tangential;
use crate::grid::Grid;

/// The largest unit of displacements; the smallest is its inverse, so that inverses are finite.
const LARGEST_UNIT: f64 = 1e290;

/// The units of one grid and one step.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    length: f64,
    /// The unit of displacements by tractions of 1.
    compliance: f64,
    traction: f64,
}

impl Scales {
    /// The units of a grid, and the coefficients in these units.
    pub fn of(grid: &Grid, tangential: &Tangential) -> (Scales, Tangential) {
        let length = unit_of(grid.dx);
        let (scaled, compliance) = tangential.in_units_of(length);
        (Scales { length, compliance, traction: 1.0 }, scaled)
    }

    /// Fits the unit of tractions to a step, whose tractions are at most `largest`.
    pub fn fit(&mut self, largest: f64) {
        let traction = unit_of(largest);
        let displacement = (traction * self.compliance).clamp(1.0 / LARGEST_UNIT, LARGEST_UNIT);
        self.traction = unit_of(displacement / self.compliance);
    }

    /// A grid in the units of the iterations.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { dx: self.length(grid.dx), dy: self.length(grid.dy), ..*grid }
    }

    /// A grid in the caller's units.
    pub fn own_grid(&self, grid: &Grid) -> Grid {
        Grid { dx: self.length * grid.dx, dy: self.length * grid.dy, ..*grid }
    }

    /// A length of the grid in the units of the iterations.
    pub fn length(&self, length: f64) -> f64 {
        length / self.length
    }

    /// A displacement by a traction of 1 in the units of the iterations.
    pub fn compliance(&self, compliance: f64) -> f64 {
        compliance / self.compliance
    }

    /// A traction in the units of the iterations.
    pub fn traction(&self, traction: f64) -> f64 {
        traction / self.traction
    }

    /// A displacement or a slip in the units of the iterations.
    pub fn displacement(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u / self.compliance / self.traction)
    }

    /// A change of displacement per change of tractions in the units of the iterations, for tractions that stay in the caller's units.
    pub fn change(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u / self.compliance)
    }

    /// A traction in the caller's units.
    pub fn own_traction(&self, traction: Vector) -> Vector {
        traction.map(|q| self.traction * q)
    }

    /// A displacement in the caller's units.
    pub fn own_displacement(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u * self.traction * self.compliance)
    }

    /// A force in the caller's units.
    pub fn own_force(&self, force: Vector) -> Vector {
        force.map(|force| force * self.traction * self.length * self.length)
    }

    /// A displacement per length in the caller's units.
    pub fn own_creepage(&self, creepage: Vector) -> Vector {
        self.own_displacement(creepage).map(|creepage| creepage / self.length)
    }
}
