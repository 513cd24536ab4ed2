//! `contact_normal_ledger_row`: the results of a solve on one of its grids.

use super::structs::{versioned, Versioned};
use crate::solver::LedgerRow;

/// `untrusted`: the error of the force (or of the approach) cannot be estimated, because contact is on single elements.
pub const CONTACT_NORMAL_UNTRUSTED_FORCE: i32 = 1;
/// `untrusted`: the error of the largest pressure cannot be estimated (pressures are singular at an edge, or the grid does not resolve the surface).
pub const CONTACT_NORMAL_UNTRUSTED_MAX_PRESSURE: i32 = 2;
/// `untrusted`: the error of the pressures cannot be estimated.
pub const CONTACT_NORMAL_UNTRUSTED_PRESSURE: i32 = 4;

/// One row of the ledger: the results on one grid, and the cost so far. Estimated errors are absolute. A negative error is not known; if its bit is
/// set in `untrusted`, it cannot be estimated from the grids of this solve.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_ledger_row {
    /// Set by `contact_normal_ledger_row_init`, which the first row of an array needs, and by the solve.
    pub struct_size: i64,
    /// Elements in x of the grid.
    pub mx: i32,
    /// Elements in y of the grid.
    pub my: i32,
    /// Cycles on the grid.
    pub cycles: i64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since the solve began: products u = A p, each weighted by the ratio of its elements to those of the finest grid.
    pub work_units: f64,
    /// Relative residual over C.
    pub residual: f64,
    /// Approach.
    pub approach: f64,
    /// Force.
    pub force: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// Contact area: the area of the elements in contact.
    pub contact_area: f64,
    /// Contact area, corrected for the elements along its outline.
    pub corrected_area: f64,
    /// Estimated error of the force, or of the approach if the force is prescribed.
    pub error_force: f64,
    /// Estimated error of the largest pressure.
    pub error_max_pressure: f64,
    /// Estimated error of the contact area.
    pub error_contact_area: f64,
    /// Estimated error of the corrected area.
    pub error_corrected_area: f64,
    /// Estimated error of the pressures: the rms of the error divided by the rms of p.
    pub error_pressure: f64,
    /// Elements in contact.
    pub contact_count: i64,
    /// CONTACT_NORMAL_UNTRUSTED_... bits.
    pub untrusted: i32,
    /// Always 0.
    pub reserved: i32,
}

versioned! { contact_normal_ledger_row, contact_normal_ledger_row_init, 144 }

/// A value in a struct of C: negative if it is not known.
pub(super) fn known(value: Option<f64>) -> f64 {
    value.unwrap_or(-1.0)
}

/// Copies members of the same name, converted to the types of C.
macro_rules! copy {
    ($from:expr => $to:ident: $($member:ident),+) => { $($to.$member = $from.$member as _;)+ };
}
pub(super) use copy;

/// Sets the results that both rows of the ledger and reports have.
macro_rules! set_measures {
    ($to:ident, $measures:expr) => {
        copy!($measures.certificate => $to: residual);
        copy!($measures => $to: approach, force, max_pressure, contact_area, corrected_area, contact_count);
    };
}
pub(super) use set_measures;

/// Sets the errors that both rows of the ledger and reports have.
macro_rules! set_errors {
    ($to:ident, $error:expr) => {
        copy!($error => $to: untrusted);
        ($to.error_force, $to.error_max_pressure) = (known($error.force), known($error.max_pressure));
        ($to.error_contact_area, $to.error_corrected_area) =
            (known($error.contact_area), known($error.corrected_area));
        $to.error_pressure = known($error.pressure);
    };
}
pub(super) use set_errors;

impl From<&LedgerRow> for contact_normal_ledger_row {
    fn from(row: &LedgerRow) -> Self {
        let mut to = Self::defaults();
        copy!(row => to: mx, my, cycles, seconds, work_units);
        set_measures!(to, row.measures);
        set_errors!(to, row.error);
        to
    }
}
