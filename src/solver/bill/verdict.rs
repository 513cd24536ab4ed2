//! One row of the bill: the change of a quantity, the error of the change, and the verdict.

use super::omission::Omission;
use crate::solver::quantities::{Lack, Quantity, Sequence, SUM_RATIO};

/// The relative change of an area, or of a peak that elements do not resolve, is at most this times the largest relative change of smooth quantities
/// (force, approach, gap). The area of a Hertz contact changes in proportion to the approach, that of other smooth surfaces up to twice as much.
pub const MOST_MOVED: f64 = 3.0;
/// The same factor for stick areas. Their relative change is that of the force times 1/(1 - F/(mu N)); the factor is that of .999 of full slip.
pub const STICK_MOVED: f64 = 1e3;

/// Bound on the relative error of single pressures, over the residual (docs/accuracy.md: their tolerance is a hundredth of the target).
const ERROR_PER_RESIDUAL: f64 = 100.0;

/// The verdict of a row; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The change is too near to the target, or its error is unknown. Finer grids, which take more time, may decide.
    NotDecided,
    /// The change plus its error is at most the target: the effect may be left out.
    Negligible,
    /// The change less its error exceeds the target: the effect is needed.
    Needed,
}

/// One row of a bill: the change of a quantity if one effect is left out, or two, and what this saves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillRow {
    /// What is left out.
    pub omission: Omission,
    /// What else is left out at the same time, in rows of pairs.
    pub other: Option<Omission>,
    /// The quantity that changes.
    pub quantity: Quantity,
    /// The value in the scene as it is, on the last small grid; None if there is none.
    pub value: Option<f64>,
    /// The value with the omission less the value of the scene as it is; None if unknown.
    pub change: Option<f64>,
    /// The error of the change; None if unknown.
    pub error: Option<f64>,
    /// Why value, change or error is unknown; None if all are known.
    pub lack: Option<Lack>,
    /// Whether the omission is negligible for this quantity.
    pub verdict: Verdict,
    /// Predicted seconds on the scene's own grid with one thread: of the scene as it is, and with the omission.
    pub seconds: [f64; 2],
    /// Predicted bytes on the scene's own grid: of the scene as it is, and with the omission.
    pub bytes: [f64; 2],
}

/// What the small grids have measured for one row of a bill.
pub struct Measured<'a> {
    pub quantity: Quantity,
    /// The value of the scene as it is, on the last grid.
    pub value: Result<f64, Lack>,
    /// The value with the omission, on the last grid.
    pub without: Result<f64, Lack>,
    /// The change by the omission, grid by grid.
    pub change: &'a Sequence,
    /// Whether the last grid is the scene's own. The change on that grid is the exact one.
    pub on_own_grid: bool,
    /// Whether the elements of the last grid resolve the peaks of the pressure.
    pub has_peaks: bool,
    /// The largest relative change, on the last grid, of quantities other than pressures, stresses, areas and the stiffness.
    pub moved: f64,
}

impl Measured<'_> {
    /// The error of the change, as an estimate of the change on the scene's grid. Elements that do not resolve a peak show its change only roughly:
    /// the peak changes as other quantities do. A pressure limit may be reached by such peaks alone, so its omission has no error then.
    fn error(&self, left_out: &[Omission]) -> Option<f64> {
        // A sum converges, and so does its change.
        let slow = if self.quantity.is_local() { None } else { self.change.error_if_slow(SUM_RATIO) };
        let error = self.change.error().or(slow).map(|error| error.now());
        match self.quantity {
            // On the scene's own grid only the residual has an error. It counts if the sequence has none.
            _ if self.on_own_grid => {
                error.or(self.change.residual_error().map(|residual_error| ERROR_PER_RESIDUAL * residual_error))
            }
            Quantity::MaxPressure if !self.has_peaks => {
                let error = error?.max(MOST_MOVED * self.moved * self.value.ok()?.abs());
                (error.is_finite() && !left_out.contains(&Omission::PressureLimit)).then_some(error)
            }
            _ => error,
        }
    }

    /// Makes the row of the bill. `seconds` and `bytes` are those of [`BillRow`].
    pub fn row(&self, left_out: &[Omission], target: f64, seconds: [f64; 2], bytes: [f64; 2]) -> BillRow {
        let (change, error) = match (self.value, self.without) {
            (Ok(_), Ok(_)) => (self.change.value(), self.error(left_out)),
            // Without both values on the last grid, the last change is one of a coarser grid.
            _ => (None, None),
        };
        let verdict = match (self.value, change, error) {
            (Ok(value), Some(change), Some(error)) => decide(value, change, error, target),
            _ => Verdict::NotDecided,
        };
        let lack = match (self.value, self.without, error) {
            (Err(lack), ..) | (_, Err(lack), _) => Some(lack),
            (.., Some(_)) => None,
            _ if self.change.len() < 2 => Some(Lack::OneGrid),
            _ => Some(Lack::Unsettled),
        };
        BillRow {
            omission: left_out[0],
            other: left_out.get(1).copied(),
            quantity: self.quantity,
            value: self.value.ok(),
            change,
            error,
            lack,
            verdict,
            seconds,
            bytes,
        }
    }
}

/// The verdict on a change with this error, for a target relative to the value.
fn decide(value: f64, change: f64, error: f64, target: f64) -> Verdict {
    let allowed = target * value.abs();
    if change.abs() + error <= allowed {
        Verdict::Negligible
    } else if change.abs() - error > allowed {
        Verdict::Needed
    } else {
        Verdict::NotDecided
    }
}

/// The value of a quantity in a scene with omissions: tangential force and moment are 0 if friction is left out, not unknown.
pub fn without(quantity: Quantity, left_out: &[Omission], value: Result<f64, Lack>) -> Result<f64, Lack> {
    let has_no_friction = left_out.contains(&Omission::Friction);
    match (quantity, value) {
        (Quantity::TangentialForce | Quantity::SpinMoment, Err(Lack::NoFriction)) if has_no_friction => Ok(0.0),
        (_, value) => value,
    }
}
