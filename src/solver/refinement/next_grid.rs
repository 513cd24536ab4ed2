//! Which grid comes next, and whether the limits allow it.

use crate::error::{invalid, require, Result};
use crate::grid::Grid;
use crate::solver::estimates::SECONDS_EXPONENT;

/// The accuracy that is asked for, and what it may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Relative error of the force, or of the approach when the force is prescribed.
    pub target: f64,
    /// Seconds for all grids together; 0: no limit. A solve that takes longer than predicted is stopped.
    pub max_seconds: f64,
    /// Bytes that the solver of a grid may hold, with that of the grid before it; 0: no limit.
    pub max_bytes: u64,
    /// Elements of a grid; 0: 4096 x 4096.
    pub max_elements: u64,
}

impl Accuracy {
    /// A target, no limits but the number of elements.
    pub fn new(target: f64) -> Accuracy {
        Accuracy { target, max_seconds: 0.0, max_bytes: 0, max_elements: 0 }
    }
}

/// What the last grid has shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Past {
    pub grid: Grid,
    /// Estimated relative error, if known.
    pub relative: Option<f64>,
    /// By what the error falls with a doubling, if known: 4 where it is of second order in the element size.
    pub falls_by: Option<f64>,
    /// Bytes held by its solver.
    pub bytes: u64,
    /// Seconds that it took: undeformed distance, set-up and solve.
    pub seconds: f64,
    /// Seconds since the first grid was begun.
    pub elapsed: f64,
}

/// What to do next.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Next {
    /// Double the elements of both directions, so many times.
    Refine(u32),
    /// A limit is in the way: which.
    Limit(String),
}

/// Without a limit of the caller's.
const MOST_ELEMENTS: u64 = 4096 * 4096;
/// Elements that a grid can have at all.
const ALL_ELEMENTS: u64 = i32::MAX as u64;
/// Predictions over more doublings are not worth much, and a grid in between costs 1/64 of the last.
const MOST_DOUBLINGS: u32 = 3;
/// By what errors of the force fall with a doubling on smooth bodies, and the least that is believed: order 1/2.
const FALLS_BY: (f64, f64) = (4.0, std::f64::consts::SQRT_2);
/// The target may be missed by a quarter of a doubling: a grid too few costs a quarter more, one too many four times as much.
const SLACK: f64 = 0.25;

impl Accuracy {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<()> {
        let (target, seconds) = (self.target, self.max_seconds);
        require(target > 0.0 && target.is_finite(), "target", target, "it must be positive and finite")?;
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

    /// Whether the time is over.
    pub(super) fn is_late(&self, elapsed: f64) -> bool {
        self.max_seconds > 0.0 && elapsed > self.max_seconds
    }

    /// The next grid: the one that is predicted to meet the target, or as many doublings towards it as the limits allow.
    pub(super) fn next(&self, past: &Past) -> Next {
        let mut doublings = self.doublings(past);
        loop {
            match self.limit(past, doublings) {
                None => return Next::Refine(doublings),
                Some(_) if doublings > 1 => doublings -= 1,
                Some(limit) => return Next::Limit(limit),
            }
        }
    }

    /// Doublings that the estimate asks for; one if there is none.
    fn doublings(&self, past: &Past) -> u32 {
        let falls_by = past.falls_by.unwrap_or(FALLS_BY.0).clamp(FALLS_BY.1, FALLS_BY.0);
        let wanted = past.relative.map_or(1.0, |relative| (relative / self.target).log(falls_by) - SLACK);
        // `as` saturates, and takes a NaN for 0.
        (wanted.ceil() as u32).clamp(1, MOST_DOUBLINGS)
    }

    /// The limit that so many doublings would break, if any.
    fn limit(&self, past: &Past, doublings: u32) -> Option<String> {
        let (mx, my) = ((past.grid.mx as u64) << doublings, (past.grid.my as u64) << doublings);
        let in_the_way = |limit: String| Some(format!("{limit} is in the way of {mx} x {my} elements"));
        let most = if self.max_elements == 0 { MOST_ELEMENTS } else { self.max_elements };
        // mx and my are below 2^34.
        if mx.saturating_mul(my) > most.min(ALL_ELEMENTS) {
            return in_the_way(format!("max_elements, {most},"));
        }
        let ratio = 4f64.powi(doublings as i32);
        let bytes = past.bytes as f64 * (1.0 + ratio);
        if self.max_bytes > 0 && bytes > self.max_bytes as f64 {
            return in_the_way(format!("max_bytes, {} of the {bytes:.0} predicted,", self.max_bytes));
        }
        let seconds = past.elapsed + past.seconds * ratio.powf(SECONDS_EXPONENT);
        if self.is_late(seconds) {
            return in_the_way(format!("max_seconds, {} of the {seconds:.3} predicted,", self.max_seconds));
        }
        None
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/next_grid.rs"]
mod tests;
