//! One row of the bill: a change, its error, and the verdict.

use super::omission::Omission;
use crate::solver::quantities::{Lack, Quantity, Sequence, SUM_RATIO};

/// Bound on the relative change of an area, or of a peak that elements do not resolve, over the largest of the other quantities. The area
/// of a Hertz contact changes as the approach does, that of other smooth surfaces up to twice as much.
pub const MOST_MOVED: f64 = 3.0;
/// The same for stick areas, which change by 1/(1 - F/(mu N)) times the force: at .999 of full slip.
pub const STICK_MOVED: f64 = 1e3;

/// Bound on the relative error of single pressures over the residual (docs/accuracy.md: a hundredth of the target for these).
const ERROR_PER_RESIDUAL: f64 = 100.0;

/// The verdict of a row; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The change is too near to the target, or its error is unknown: finer grids, that is more time, decide.
    NotDecided,
    /// The quantity changes by less than the target, its error included.
    Negligible,
    /// The quantity changes by more than the target, its error subtracted.
    Needed,
}

/// The change of a quantity by leaving out one thing, or two, and the savings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BillRow {
    /// The omission.
    pub omission: Omission,
    /// A second omission beside it.
    pub other: Option<Omission>,
    /// The quantity that changes.
    pub quantity: Quantity,
    /// The value of the scene as it is, on the last small grid, if it has one.
    pub value: Option<f64>,
    /// The change by leaving out.
    pub change: Option<f64>,
    /// The error of the change; none: unknown.
    pub error: Option<f64>,
    /// Why value, change or error is unknown.
    pub lack: Option<Lack>,
    /// Negligible, needed, or not decided.
    pub verdict: Verdict,
    /// Predicted seconds of the scene on its own grid with one thread, as it is and with the omission.
    pub seconds: [f64; 2],
    /// Predicted bytes, likewise.
    pub bytes: [f64; 2],
}

/// A quantity with and without the omissions.
pub struct Measured<'a> {
    pub quantity: Quantity,
    pub value: Result<f64, Lack>,
    pub without: Result<f64, Lack>,
    pub change: &'a Sequence,
    /// Whether the last grid is that of the scene, on which the change is then exact.
    pub on_own_grid: bool,
    /// Whether peaks of the pressure are known on the last grid.
    pub has_peaks: bool,
    /// The largest relative change on the last grid of quantities other than pressures and areas.
    pub moved: f64,
}

impl Measured<'_> {
    /// The error of the change on the scene's grid. An unresolved peak changes as the other quantities do, except by a limit that only peaks reach.
    fn error(&self, left_out: &[Omission]) -> Option<f64> {
        // A change of a sum converges, as the sum does.
        let slow = if self.quantity.is_local() { None } else { self.change.slow(SUM_RATIO) };
        let falling = self.change.falling().or(slow).map(|falling| falling.now());
        match self.quantity {
            // The change on the scene's grid counts, whatever the ones before.
            _ if self.on_own_grid => falling.or(self.change.hidden().map(|hidden| ERROR_PER_RESIDUAL * hidden)),
            Quantity::MaxPressure if !self.has_peaks => {
                let error = falling?.max(MOST_MOVED * self.moved * self.value.ok()?.abs());
                (error.is_finite() && !left_out.contains(&Omission::PressureLimit)).then_some(error)
            }
            _ => falling,
        }
    }

    /// The row of the bill.
    pub fn row(&self, left_out: &[Omission], target: f64, seconds: [f64; 2], bytes: [f64; 2]) -> BillRow {
        let (change, error) = match (self.value, self.without) {
            (Ok(_), Ok(_)) => (self.change.value(), self.error(left_out)),
            // The last change is that of a coarser grid.
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

/// The value of a quantity with omissions: without friction tangential forces are 0.
pub fn without(quantity: Quantity, left_out: &[Omission], value: Result<f64, Lack>) -> Result<f64, Lack> {
    let has_no_friction = left_out.contains(&Omission::Friction);
    match (quantity, value) {
        (Quantity::TangentialForce | Quantity::SpinMoment, Err(Lack::NoFriction)) if has_no_friction => Ok(0.0),
        (_, value) => value,
    }
}
