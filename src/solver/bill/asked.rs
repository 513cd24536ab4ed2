//! The options of a bill.

/// The options of a bill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillOptions {
    /// The accuracy asked for: changes that are smaller, relative to the quantity, are negligible.
    pub target: f64,
    /// Seconds at most; 0: about 5 % of what the scene takes, or a tenth of a second, by what is counted: no clock chooses the grids.
    pub max_seconds: f64,
    /// Whether pairs are left out, too.
    pub pairs: bool,
}

impl BillOptions {
    /// With pairs, in the time that it takes by default.
    pub fn new(target: f64) -> BillOptions {
        BillOptions { target, max_seconds: 0.0, pairs: true }
    }
}
