//! The half-space that is the base of a radial function.

/// w at rho = 2. Panels below it have the layer as base, the others the substrate.
pub(super) const SMOOTH: f64 = 8.0;

/// The half-space that is the base of a radial function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// b = 1: the half-space of the layer's material.
    Layer,
    /// b = B(0): the half-space of the substrate.
    Substrate,
}

impl Base {
    /// The base of the panel at `w = 4 + rho^2`.
    pub(super) fn at(w: f64) -> Base {
        if w < SMOOTH {
            Base::Layer
        } else {
            Base::Substrate
        }
    }

    /// The number of times `(1 - B0)/rho` that has to be added to F of this base to give F of the `other` base.
    pub(super) fn to(self, other: Base) -> f64 {
        match (self, other) {
            (Base::Layer, Base::Substrate) => 1.0,
            (Base::Substrate, Base::Layer) => -1.0,
            _ => 0.0,
        }
    }
}
