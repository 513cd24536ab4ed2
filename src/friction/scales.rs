//! The units of the iterations. In these units element sizes, coefficients and traction bounds are of order 1, so that squares and numbers of single
//! precision stay in range, whatever the caller's units are. Units are powers of two, so that a change of units is exact.

use super::plane::Vector;
use super::unit::unit_of;
use super::Tangential;
use crate::grid::Grid;

/// The largest unit of displacements. The smallest one is 1/LARGEST_UNIT, so that the inverse of a unit is finite.
const LARGEST_UNIT: f64 = 1e290;

/// The units of one grid and one step, in the caller's units.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// The unit of lengths on the grid.
    length: f64,
    /// The unit of the ratio of displacements to tractions. The unit of displacements is this times the unit of tractions.
    compliance: f64,
    /// The unit of tractions.
    traction: f64,
}

impl Scales {
    /// Chooses the units for a grid. Returns them, and the coefficients in these units.
    pub fn of(grid: &Grid, tangential: &Tangential) -> (Scales, Tangential) {
        let length = unit_of(grid.dx);
        let (scaled, compliance) = tangential.in_units_of(length);
        (Scales { length, compliance, traction: 1.0 }, scaled)
    }

    /// Chooses the unit of tractions for a step whose traction bounds are at most `largest`.
    pub fn fit(&mut self, largest: f64) {
        let traction = unit_of(largest);
        let displacement = (traction * self.compliance).clamp(1.0 / LARGEST_UNIT, LARGEST_UNIT);
        self.traction = unit_of(displacement / self.compliance);
    }

    /// Converts a grid to the units of the iterations.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { dx: self.length(grid.dx), dy: self.length(grid.dy), ..*grid }
    }

    /// Converts a grid to the caller's units.
    pub fn callers_grid(&self, grid: &Grid) -> Grid {
        Grid { dx: self.length * grid.dx, dy: self.length * grid.dy, ..*grid }
    }

    /// Converts a length on the grid to the units of the iterations.
    pub fn length(&self, length: f64) -> f64 {
        length / self.length
    }

    /// Converts a compliance, a displacement per traction, to the units of the iterations.
    pub fn compliance(&self, compliance: f64) -> f64 {
        compliance / self.compliance
    }

    /// Converts a traction to the units of the iterations.
    pub fn traction(&self, traction: f64) -> f64 {
        traction / self.traction
    }

    /// Converts a displacement or a slip to the units of the iterations.
    pub fn displacement(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u / self.compliance / self.traction)
    }

    /// Converts a change of displacement for a linear solve whose tractions stay in the caller's units.
    pub fn change(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u / self.compliance)
    }

    /// Converts a traction to the caller's units.
    pub fn callers_traction(&self, traction: Vector) -> Vector {
        traction.map(|q| self.traction * q)
    }

    /// Converts a displacement to the caller's units.
    pub fn callers_displacement(&self, displacement: Vector) -> Vector {
        displacement.map(|u| u * self.traction * self.compliance)
    }

    /// Converts a force to the caller's units.
    pub fn callers_force(&self, force: Vector) -> Vector {
        force.map(|force| force * self.traction * self.length * self.length)
    }

    /// Converts a creepage, a displacement per length on the grid, to the caller's units.
    pub fn callers_creepage(&self, creepage: Vector) -> Vector {
        self.callers_displacement(creepage).map(|creepage| creepage / self.length)
    }
}
