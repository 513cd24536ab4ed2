//! The ledger: one row for each grid of a solve, with its results, estimated errors and costs.

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
    /// Elements in contact in the first or last row or column of the grid: the contact may continue beyond the grid.
    pub edge_count: usize,
    /// The area of the elements in contact.
    pub contact_area: f64,
    /// The contact area with a correction for the counting of whole elements along its outline. Negative if errors are not estimated.
    pub corrected_area: f64,
}

impl Measures {
    /// The measures of a state with this survey. The corrected area is -1.
    pub fn of(state: &State, survey: &Survey) -> Measures {
        let (_, largest_pressure) = survey.range;
        Measures {
            certificate: survey.certificate(),
            approach: state.approach,
            force: survey.pressures * state.grid.element_area(),
            max_pressure: largest_pressure.max(0.0),
            contact_count: survey.contact_count,
            edge_count: state.edge_count(),
            contact_area: survey.contact_count as f64 * state.grid.element_area(),
            corrected_area: -1.0,
        }
    }

    /// Whether there is neither contact nor attraction.
    pub fn is_apart(&self) -> bool {
        self.contact_count == 0 && self.force == 0.0
    }

    /// The result that the load does not prescribe: the force if the approach is prescribed, else the approach.
    pub fn found(&self, load: Load) -> f64 {
        match load {
            Load::Approach(_) => self.force,
            Load::Force(_) => self.approach,
        }
    }
}

/// Estimated discretisation errors (module `estimates`). None: unknown. Either no estimates were requested; or the error has its bit in `untrusted`,
/// because the grid does not resolve the contact or the peak is singular.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiscretisationError {
    /// The absolute error of the force, or of the approach if the force is prescribed.
    pub force: Option<f64>,
    /// The absolute error of the largest pressure.
    pub max_pressure: Option<f64>,
    /// The absolute error of the contact area, which counts elements.
    pub contact_area: Option<f64>,
    /// The absolute error of the corrected contact area.
    pub corrected_area: Option<f64>,
    /// The relative error of the pressures: rms of their errors over the rms of p.
    pub pressure: Option<f64>,
    /// The errors that cannot be estimated, one bit each: [`DiscretisationError::FORCE`] and the following.
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

/// One row of the ledger: the measures on one grid, and the cost from the beginning of the solve to the end of this grid.
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
    /// The result on this grid.
    pub measures: Measures,
    /// The estimated errors of this result.
    pub error: DiscretisationError,
}

/// The ledger of a solve so far.
#[derive(Default)]
pub struct Ledger {
    /// The rows, coarsest grid first.
    pub rows: Vec<LedgerRow>,
    /// Whether errors will be estimated. Then rows have a corrected area.
    pub estimates: bool,
    /// The outline of the contact area of the last row, if errors are estimated.
    pub outline: Outline,
}
