//! Quantities of a result: their values on one grid, and their errors.
//!
//! Force, largest pressure and contact area have error estimates from one grid (module `estimates`). The errors of all other quantities follow from
//! their values on a sequence of grids, each with twice the elements of the one before in both directions ([`Course`]).

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
    /// A quantity of a result for which a caller can ask accuracy and cost.
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
        /// The absolute value of the tangential force.
        TangentialForce: "tangential_force",
        /// The absolute value of the creepage, over the directions in which the force is prescribed.
        Creepage: "creepage",
        /// The moment of the tractions about the spin centre.
        SpinMoment: "spin_moment",
        /// The area of the elements that stick.
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
    /// Whether the error of the quantity is estimated from one grid.
    pub fn has_estimate(self) -> bool {
        matches!(self, Quantity::Force | Quantity::MaxPressure | Quantity::ContactArea)
    }

    /// Whether the quantity is an area, which counts whole elements.
    pub fn is_area(self) -> bool {
        matches!(self, Quantity::ContactArea | Quantity::StickArea)
    }

    /// The least number of elements across the contact, in the direction with fewer of them, for a valid estimate.
    ///
    /// The numbers were measured on balls, ellipses, cones, pairs of balls, tori, superellipsoids, blunt rollers and punches at any position between
    /// the elements: with so many elements, at most 5 % of the estimates are below the error, and none is below a third of the error
    /// (docs/notes/2026-11-accuracy.md). Areas need more elements, because they change by whole rows of them. If an error follows from several grids,
    /// the coarsest of these has a quarter of the elements.
    pub fn enough_across(self) -> usize {
        match self {
            Quantity::Force => 6,
            Quantity::MaxPressure => 12,
            area if area.is_area() => 32,
            _ => 10,
        }
    }

    /// Whether the quantity is one of the tangential problem.
    pub fn is_tangential(self) -> bool {
        use Quantity::{Creepage, SpinMoment, StickArea, TangentialForce};
        matches!(self, TangentialForce | Creepage | SpinMoment | StickArea)
    }

    /// Whether the quantity is a largest stress, or the depth of one.
    pub fn is_stress(self) -> bool {
        matches!(self, Quantity::MaxVonMises | Quantity::VonMisesDepth | Quantity::MaxShear)
    }

    /// Whether the quantity depends on single pressures, not on sums of them.
    pub fn is_local(self) -> bool {
        self == Quantity::MaxPressure || self.is_stress()
    }
}
