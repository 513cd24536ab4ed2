//! The ledger: results and costs of a solve, one row per grid.

use crate::contact::{Certificate, Outline, State, Survey};
use crate::scene::Load;

/// The measures of the result on one grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// How well the contact conditions hold.
    pub certificate: Certificate,
    /// The approach.
    pub approach: f64,
    /// `sum of p dx dy`.
    pub force: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// Elements in contact.
    pub contact_count: usize,
    /// Elements in contact on the first or last row or column of the grid.
    pub edge_count: usize,
    /// The area of the elements in contact.
    pub contact_area: f64,
    /// The contact area corrected for the elements along the outline; negative when errors are not estimated.
    pub corrected_area: f64,
}

impl Measures {
    /// The measures of a surveyed state, without the corrected area.
    pub fn of(state: &State, survey: &Survey) -> Measures {
        Measures {
            certificate: survey.certificate(),
            approach: state.approach,
            force: survey.pressures * state.grid.element_area(),
            max_pressure: survey.range.1.max(0.0),
            contact_count: survey.contact_count,
            edge_count: state.edge_count(),
            contact_area: survey.contact_count as f64 * state.grid.element_area(),
            corrected_area: -1.0,
        }
    }

    /// Whether no element touches, and none attracts.
    pub fn is_apart(&self) -> bool {
        self.contact_count == 0 && self.force == 0.0
    }

    /// The force if the approach is prescribed, else the approach.
    pub fn found(&self, load: Load) -> f64 {
        match load {
            Load::Approach(_) => self.force,
            Load::Force(_) => self.approach,
        }
    }
}

/// Estimated errors (module `estimates`). None: unknown, because no estimates were requested, or, with its bit in
/// `untrusted`, as the grid does not resolve the contact, or the peak is singular.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiscretisationError {
    /// The error of the force (of the approach, when the force is prescribed).
    pub force: Option<f64>,
    /// The error of the largest pressure.
    pub max_pressure: Option<f64>,
    /// The error of the contact area by counting elements.
    pub contact_area: Option<f64>,
    /// The error of the corrected contact area.
    pub corrected_area: Option<f64>,
    /// The error of the pressures: rms of the error over rms of p.
    pub pressure: Option<f64>,
    /// Bits: see [`DiscretisationError::FORCE`] and the following.
    pub untrusted: u32,
}

impl DiscretisationError {
    /// Bit of `untrusted`: the error of the force or the approach.
    pub const FORCE: u32 = 1;
    /// Bit of `untrusted`: the error of the largest pressure.
    pub const MAX_PRESSURE: u32 = 2;
    /// Bit of `untrusted`: the error of the pressures.
    pub const PRESSURE: u32 = 4;
}

/// One row of the ledger: the measures of one grid, and the cost up to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgerRow {
    /// Elements in x.
    pub mx: usize,
    /// Elements in y.
    pub my: usize,
    /// Cycles on this grid.
    pub cycles: u64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since the solve began: products, each weighted by its elements over those of the finest grid.
    pub work_units: f64,
    /// The measures of the grid.
    pub measures: Measures,
    /// The estimated errors.
    pub error: DiscretisationError,
}

/// The rows so far.
#[derive(Default)]
pub struct Ledger {
    /// Coarsest grid first.
    pub rows: Vec<LedgerRow>,
    /// Whether errors are estimated: then rows have a corrected area.
    pub estimates: bool,
    /// The outline of the contact area of the last row, if errors are estimated.
    pub outline: Outline,
}
