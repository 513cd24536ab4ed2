//! The options of a bill.

/// The options of a bill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillOptions {
    /// The wanted accuracy: smaller changes, relative to the quantity, are negligible.
    pub target: f64,
    /// Most seconds. 0: about 5 % of the scene's time, and at least 0.07 s; both are estimated by counts of products, so that no clock chooses the
    /// grids.
    pub max_seconds: f64,
    /// Whether the bill also has the changes without each two effects.
    pub pairs: bool,
}

impl BillOptions {
    /// Options with pairs, in the default time.
    pub fn new(target: f64) -> BillOptions {
        BillOptions { target, max_seconds: 0.0, pairs: true }
    }
}
