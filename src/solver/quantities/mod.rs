//! Quantities of a result: their values on one grid, and their errors from several.
//!
//! Forces, pressures and areas have estimates from one grid (module `estimates`). All other quantities are compared on grids of twice and
//! four times the elements ([`Course`]).

mod course;
mod deepest;
mod on_grids;
mod sequence;
mod values;

pub use course::{Course, Value, SUM_RATIO};
pub use on_grids::{quantities, OnGrid, QuantityRow};
pub use sequence::Sequence;
pub use values::{values, Lack};

use crate::solver::numbered::numbered;

numbered! {
    /// A quantity that has an accuracy and a price.
    Quantity {
        /// The force, or the approach if the force is prescribed.
        Force: "force",
        /// The largest pressure.
        MaxPressure: "max_pressure",
        /// The corrected contact area.
        ContactArea: "contact_area",
        /// The mean of the deformed distance over all elements with a surface.
        MeanGap: "mean_gap",
        /// dF/d approach, at fixed contact area.
        Stiffness: "stiffness",
        /// The length of the tangential force.
        TangentialForce: "tangential_force",
        /// The length of the creepage, in the directions of prescribed force.
        Creepage: "creepage",
        /// The moment of the tractions about the spin centre.
        SpinMoment: "spin_moment",
        /// The area of stick.
        StickArea: "stick_area",
        /// The largest von Mises stress in both bodies.
        MaxVonMises: "max_von_mises",
        /// The depth of the largest von Mises stress.
        VonMisesDepth: "von_mises_depth",
        /// The largest shear stress in both bodies.
        MaxShear: "max_shear",
    }
}

impl Quantity {
    /// Whether its error is estimated from one grid.
    pub fn has_estimate(self) -> bool {
        matches!(self, Quantity::Force | Quantity::MaxPressure | Quantity::ContactArea)
    }

    /// Whether it is a sum of whole elements.
    pub fn is_area(self) -> bool {
        matches!(self, Quantity::ContactArea | Quantity::StickArea)
    }

    /// The least elements across the contact, in the direction with fewer, for a valid estimate. Measured on balls, ellipses, cones, two
    /// balls, tori, superellipsoids, blunt rollers and punches anywhere between the elements: with these, at most 5 % of the estimates are
    /// below the error, and none is below a third of it (docs/notes/2026-11-accuracy.md). Areas jump by whole rows of elements. If an error
    /// follows from several grids, the coarsest has a quarter of these elements.
    pub fn enough_across(self) -> usize {
        match self {
            Quantity::Force => 6,
            Quantity::MaxPressure => 12,
            area if area.is_area() => 32,
            _ => 10,
        }
    }

    /// Whether it is a quantity of the tangential problem.
    pub fn is_tangential(self) -> bool {
        use Quantity::{Creepage, SpinMoment, StickArea, TangentialForce};
        matches!(self, TangentialForce | Creepage | SpinMoment | StickArea)
    }

    /// Whether it is a largest stress, or its depth.
    pub fn is_stress(self) -> bool {
        matches!(self, Quantity::MaxVonMises | Quantity::VonMisesDepth | Quantity::MaxShear)
    }

    /// Whether it follows from single pressures, not from sums of them.
    pub fn is_local(self) -> bool {
        self == Quantity::MaxPressure || self.is_stress()
    }
}
