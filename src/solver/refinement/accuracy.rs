//! The wanted accuracy and its allowed cost.

use super::outlook::Outlook;
use crate::error::{invalid, require, Result};
use crate::grid;
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;

/// Most elements of a grid, unless the caller sets a limit.
pub(super) const MOST_ELEMENTS: u64 = 4096 * 4096;
/// Most elements of any grid.
pub(super) const ALL_ELEMENTS: u64 = grid::MOST_ELEMENTS as u64;
/// Errors below this cannot be estimated: 450 times the machine epsilon.
pub(super) const ROUND_OFF: f64 = 1e-13;
/// Least tolerance of a solve.
pub const LEAST_TOLERANCE: f64 = 1e-12;
/// The tolerance relative to the target of the force, and of the largest pressure, so that the residual adds little to the error.
const TOLERANCE_PER_TARGET: f64 = 0.1;
const TOLERANCE_PER_PRESSURE: f64 = 0.01;

/// The wanted accuracy, and limits of its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Relative errors of the quantities, by their [numbers](Quantity::number); 0: not wanted.
    pub targets: [f64; Quantity::ALL.len()],
    /// Seconds for all grids together; 0: no limit. A solve that takes longer than predicted is stopped.
    pub max_seconds: f64,
    /// Bytes that the solvers of a grid and of the grid before it may hold together; 0: no limit.
    pub max_bytes: u64,
    /// Elements of a grid; 0: 4096 x 4096.
    pub max_elements: u64,
}

impl Accuracy {
    /// A target of the force (of the approach when the force is prescribed); no limits but the number of elements.
    pub fn new(target: f64) -> Accuracy {
        let none = Accuracy { targets: [0.0; Quantity::ALL.len()], max_seconds: 0.0, max_bytes: 0, max_elements: 0 };
        none.with(Quantity::Force, target)
    }

    /// Adds a target of another quantity.
    pub fn with(mut self, quantity: Quantity, target: f64) -> Accuracy {
        self.targets[quantity.number()] = target;
        self
    }

    /// The errors of quantities with targets, relative to their targets.
    pub(super) fn excesses(&self, outlook: &Outlook) -> Vec<Option<Falling>> {
        let of =
            |(quantity, target): (Quantity, f64)| outlook.falling(quantity).and_then(|falling| falling.over(target));
        self.wanted().map(of).collect()
    }

    /// The quantity that is farthest from its target, and its error relative to the target: infinite if it is not known.
    pub(super) fn farthest(&self, outlook: &Outlook) -> (Quantity, f64) {
        let of = |excess: Option<Falling>| excess.map_or(f64::INFINITY, |excess| excess.now());
        let all = self.wanted().zip(self.excesses(outlook)).map(|((quantity, _), excess)| (quantity, of(excess)));
        all.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((Quantity::Force, 0.0))
    }

    /// Refuses targets and limits out of range.
    pub fn check(&self) -> Result<()> {
        for (quantity, target) in Quantity::ALL.into_iter().zip(self.targets) {
            match quantity {
                Quantity::Force if self.targets.iter().all(|target| *target == 0.0) => require_target(target)?,
                _ => {
                    let name = match quantity {
                        Quantity::Force => "target".into(),
                        other => format!("{}_target", other.name()),
                    };
                    let rule = "it must lie between 0 and 1, or be 0 for none";
                    require((0.0..1.0).contains(&target), &name, target, rule)?;
                }
            }
        }
        self.check_limits()
    }

    /// Refuses limits out of range.
    pub(super) fn check_limits(&self) -> Result<()> {
        let seconds = self.max_seconds;
        require(
            seconds >= 0.0 && seconds.is_finite(),
            "max_seconds",
            seconds,
            "it must be positive, or 0 for no limit",
        )?;
        if self.max_elements > ALL_ELEMENTS {
            return invalid(format!(
                "max_elements is {}; a grid has at most {ALL_ELEMENTS} elements",
                self.max_elements
            ));
        }
        Ok(())
    }

    /// The targets.
    pub(super) fn wanted(&self) -> impl Iterator<Item = (Quantity, f64)> + '_ {
        Quantity::ALL.into_iter().zip(self.targets).filter(|(_, target)| *target > 0.0)
    }

    /// The tolerance that the targets need, at most the caller's.
    pub(super) fn tolerance(&self, at_most: f64) -> f64 {
        let of = |(quantity, target): (Quantity, f64)| tolerance_for(quantity, target);
        self.wanted().map(of).fold(at_most.max(LEAST_TOLERANCE), f64::min)
    }

    /// Whether more time than `max_seconds` has passed.
    pub(super) fn is_late(&self, elapsed: f64) -> bool {
        self.max_seconds > 0.0 && elapsed > self.max_seconds
    }
}

/// Refuses a relative error of 1 or more, which p = 0 has.
pub(super) fn require_target(target: f64) -> Result<()> {
    require(
        target > 0.0 && target < 1.0,
        "target",
        target,
        "it must lie between 0 and 1: a relative error of 1 is that of p = 0",
    )
}

/// The tolerance at which the residual adds little to an error of this target; at least [`LEAST_TOLERANCE`].
pub(super) fn tolerance_for(quantity: Quantity, target: f64) -> f64 {
    let part = if quantity.is_local() { TOLERANCE_PER_PRESSURE } else { TOLERANCE_PER_TARGET };
    (part * target).max(LEAST_TOLERANCE)
}
