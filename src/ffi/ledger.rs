//! `contact_normal_ledger_row`: the results on each grid.

use super::structs::{versioned, Versioned};
use crate::solver::LedgerRow;

/// `untrusted`: the error of the force (or the approach) cannot be estimated: contact is on single elements.
pub const CONTACT_NORMAL_UNTRUSTED_FORCE: i32 = 1;
/// `untrusted`: that of the largest pressure (singular at an edge, or on a surface that the grid does not resolve).
pub const CONTACT_NORMAL_UNTRUSTED_MAX_PRESSURE: i32 = 2;
/// `untrusted`: that of the pressures.
pub const CONTACT_NORMAL_UNTRUSTED_PRESSURE: i32 = 4;

/// One row of the ledger: the results on one grid, and their cost so far. Estimated errors are absolute; negative: not
/// known, and if the bit is set in `untrusted`, not to be known from these grids.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_ledger_row {
    /// Set by `contact_normal_ledger_row_init`, which the first row of an array needs, and by the solve.
    pub struct_size: i64,
    /// Elements in x of the grid.
    pub mx: i32,
    /// Elements in y.
    pub my: i32,
    /// Cycles on it.
    pub cycles: i64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since then: products, each weighted by its elements over those of the finest grid.
    pub work_units: f64,
    /// Relative residual over C.
    pub residual: f64,
    /// Approach.
    pub approach: f64,
    /// Force.
    pub force: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// Contact area: that of the elements in contact.
    pub contact_area: f64,
    /// Contact area, corrected for the elements along its outline.
    pub corrected_area: f64,
    /// Estimated error of the force (of the approach, when the force is prescribed).
    pub error_force: f64,
    /// Of the largest pressure.
    pub error_max_pressure: f64,
    /// Of the contact area.
    pub error_contact_area: f64,
    /// Of the corrected area.
    pub error_corrected_area: f64,
    /// Of the pressures: rms of the error over that of p.
    pub error_pressure: f64,
    /// Elements in contact.
    pub contact_count: i64,
    /// CONTACT_NORMAL_UNTRUSTED_... bits.
    pub untrusted: i32,
    /// Always 0.
    pub reserved: i32,
}

versioned! { contact_normal_ledger_row, contact_normal_ledger_row_init, 144 }

/// An error or seconds as C has them: negative where they are not known.
pub(super) fn known(value: Option<f64>) -> f64 {
    value.unwrap_or(-1.0)
}

/// Copies members of the same name, converted as C has them.
macro_rules! copy {
    ($from:expr => $to:ident: $($member:ident),+) => { $($to.$member = $from.$member as _;)+ };
}
pub(super) use copy;

/// Sets the results that rows of the ledger and reports have in common.
macro_rules! set_measures {
    ($to:ident, $measures:expr) => {
        copy!($measures.certificate => $to: residual);
        copy!($measures => $to: approach, force, max_pressure, contact_area, corrected_area, contact_count);
    };
}
pub(super) use set_measures;

/// Sets the errors that rows of the ledger and reports have in common.
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
