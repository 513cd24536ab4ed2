//! The options of a bill of effects.

/// The options of a bill of effects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillOptions {
    /// The wanted accuracy: a change that is smaller than this part of the quantity is negligible.
    pub target: f64,
    /// Most seconds for the bill. 0: about 5 % of the seconds of the scene, and at least 0.07 s. In this case both are estimated from counts of
    /// products, so that the choice of the grids does not depend on a clock.
    pub max_seconds: f64,
    /// Whether the bill also has rows for pairs: the changes if two effects are left out together.
    pub pairs: bool,
}

impl BillOptions {
    /// Options with pairs and the default time.
    pub fn new(target: f64) -> BillOptions {
        BillOptions { target, max_seconds: 0.0, pairs: true }
    }
}
