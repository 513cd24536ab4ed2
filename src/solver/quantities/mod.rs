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

/// A quantity that has an accuracy and a price.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The force, or the approach if the force is prescribed.
    Force,
    /// The largest pressure.
    MaxPressure,
    /// The corrected contact area.
    ContactArea,
    /// The mean of the deformed distance over all elements with a surface.
    MeanGap,
    /// dF/d approach, at fixed contact area.
    Stiffness,
    /// The length of the tangential force.
    TangentialForce,
    /// The length of the creepage, in the directions of prescribed force.
    Creepage,
    /// The moment of the tractions about the spin centre.
    SpinMoment,
    /// The area of stick.
    StickArea,
    /// The largest von Mises stress in both bodies.
    MaxVonMises,
    /// The depth of the largest von Mises stress.
    VonMisesDepth,
    /// The largest shear stress in both bodies.
    MaxShear,
}

impl Quantity {
    /// All quantities, in the order of their numbers in the C ABI.
    pub const ALL: [Quantity; 12] = [
        Quantity::Force,
        Quantity::MaxPressure,
        Quantity::ContactArea,
        Quantity::MeanGap,
        Quantity::Stiffness,
        Quantity::TangentialForce,
        Quantity::Creepage,
        Quantity::SpinMoment,
        Quantity::StickArea,
        Quantity::MaxVonMises,
        Quantity::VonMisesDepth,
        Quantity::MaxShear,
    ];

    /// The number in the C ABI.
    pub fn number(self) -> usize {
        self as usize
    }

    /// The name, the same in C, Fortran and Python.
    pub fn name(self) -> &'static str {
        const NAMES: [&str; 12] = [
            "force",
            "max_pressure",
            "contact_area",
            "mean_gap",
            "stiffness",
            "tangential_force",
            "creepage",
            "spin_moment",
            "stick_area",
            "max_von_mises",
            "von_mises_depth",
            "max_shear",
        ];
        NAMES[self.number()]
    }

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
