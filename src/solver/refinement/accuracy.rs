//! The accuracy that a caller asks for, and the cost that is allowed for it.

use super::outlook::Outlook;
use crate::error::{invalid, require, Result};
use crate::grid;
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;

/// Most elements of a grid, unless the caller sets a limit.
pub(super) const MOST_ELEMENTS: u64 = 4096 * 4096;
/// Most elements of any grid.
pub(super) const ALL_ELEMENTS: u64 = grid::MOST_ELEMENTS as u64;
/// Relative errors below this, 450 times the machine epsilon, are round-off and cannot be estimated.
pub(super) const ROUND_OFF: f64 = 1e-13;
/// Least tolerance of a solve.
pub const LEAST_TOLERANCE: f64 = 1e-12;
/// The tolerance of a solve, relative to the target of a sum such as the force. So the residual adds little to the error.
const TOLERANCE_PER_TARGET: f64 = 0.1;
/// The tolerance of a solve, relative to the target of the largest pressure or stress.
const TOLERANCE_PER_PRESSURE: f64 = 0.01;

/// Targets for the relative errors of quantities, and limits on the cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The target of each quantity, at the index of its [number](Quantity::number): the largest relative error. 0: the quantity is not wanted.
    pub targets: [f64; Quantity::ALL.len()],
    /// Most seconds for all grids together; 0: no limit. A solve that runs beyond this limit is stopped.
    pub max_seconds: f64,
    /// Most bytes that the solvers of a grid and of the grid before it may hold together; 0: no limit.
    pub max_bytes: u64,
    /// Most elements of a grid; 0: 4096 x 4096.
    pub max_elements: u64,
}

impl Accuracy {
    /// A target for the force, or for the approach if the force is prescribed. The only limit is the default number of elements.
    pub fn new(target: f64) -> Accuracy {
        let none = Accuracy { targets: [0.0; Quantity::ALL.len()], max_seconds: 0.0, max_bytes: 0, max_elements: 0 };
        none.with(Quantity::Force, target)
    }

    /// The same accuracy with a target for another quantity.
    pub fn with(mut self, quantity: Quantity, target: f64) -> Accuracy {
        self.targets[quantity.number()] = target;
        self
    }

    /// The predicted errors of the wanted quantities, relative to their targets; None for unknown errors.
    pub(super) fn excesses(&self, outlook: &Outlook) -> Vec<Option<Falling>> {
        let excess = |(quantity, target): (Quantity, f64)| outlook.error(quantity).and_then(|error| error.over(target));
        self.wanted().map(excess).collect()
    }

    /// The wanted quantity whose error is largest relative to its target, and this ratio. It is infinite if the error is unknown.
    pub(super) fn farthest(&self, outlook: &Outlook) -> (Quantity, f64) {
        let now = |excess: Option<Falling>| excess.map_or(f64::INFINITY, |excess| excess.now());
        let all = self.wanted().zip(self.excesses(outlook)).map(|((quantity, _), excess)| (quantity, now(excess)));
        all.max_by(|(_, one), (_, other)| one.total_cmp(other)).unwrap_or((Quantity::Force, 0.0))
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

    /// The wanted quantities and their targets.
    pub(super) fn wanted(&self) -> impl Iterator<Item = (Quantity, f64)> + '_ {
        Quantity::ALL.into_iter().zip(self.targets).filter(|(_, target)| *target > 0.0)
    }

    /// The tolerance of the solves: the least one that a target needs, or the caller's tolerance `at_most` if that is less.
    pub(super) fn tolerance(&self, at_most: f64) -> f64 {
        let needed = |(quantity, target): (Quantity, f64)| tolerance_for(quantity, target);
        self.wanted().map(needed).fold(at_most.max(LEAST_TOLERANCE), f64::min)
    }

    /// Whether `elapsed` seconds exceed `max_seconds`.
    pub(super) fn is_late(&self, elapsed: f64) -> bool {
        self.max_seconds > 0.0 && elapsed > self.max_seconds
    }
}

/// Refuses a target that does not lie between 0 and 1. Relative errors of 1 are those of p = 0.
pub(super) fn require_target(target: f64) -> Result<()> {
    require(
        target > 0.0 && target < 1.0,
        "target",
        target,
        "it must lie between 0 and 1: a relative error of 1 is that of p = 0",
    )
}

/// The tolerance at which the residual adds little to an error as large as the target; at least [`LEAST_TOLERANCE`].
pub(super) fn tolerance_for(quantity: Quantity, target: f64) -> f64 {
    let part = if quantity.is_local() { TOLERANCE_PER_PRESSURE } else { TOLERANCE_PER_TARGET };
    (part * target).max(LEAST_TOLERANCE)
}
