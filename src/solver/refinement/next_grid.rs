//! The choice of the next grid in a search for an accuracy, within the limits on the cost.

use std::fmt;

use super::accuracy::{Accuracy, ALL_ELEMENTS, MOST_ELEMENTS, ROUND_OFF};
use super::outlook::across;
use super::solved::Solved;
use crate::grid::Grid;
use crate::progress::Outcome;
use crate::scene::{refines, Scene};
use crate::solver::falling::Falling;
use crate::solver::seconds::GROWTH;

/// What the choice of the next grid needs to know of the last grid.
#[derive(Clone, Debug)]
pub(super) struct Past {
    pub grid: Grid,
    /// The directions in which a finer grid has more elements.
    pub refines: (bool, bool),
    /// Elements across the contact area.
    pub across: (usize, usize),
    /// Elements across that suffice for all targets.
    pub enough: usize,
    /// The errors of the wanted quantities relative to their targets; None for unknown errors.
    pub excesses: Vec<Option<Falling>>,
    /// Whether there are enough grids for these errors to be valid.
    pub is_believed: bool,
    /// Whether errors may be predicted over several doublings. They may if all have estimates from one grid: several grids hardly determine the order
    /// of an error.
    pub predicts_far: bool,
    /// Bytes held by the grid's solver.
    pub bytes: u64,
    /// Seconds of this grid: undeformed distance, set-up and solve.
    pub seconds: f64,
    /// The exponent of the number of elements in the predicted seconds.
    pub exponent: f64,
    /// Seconds from the start of the first grid to the end of this one.
    pub elapsed: f64,
}

/// How the search goes on.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Next {
    /// On a grid whose elements are doubled this many times, in the directions that the scene [`refines`].
    Refine(u32),
    /// Not at all: the limit, in words, that forbids the next grid.
    Limit(String),
}

/// A grid with fewer elements in its longer direction may lack an estimate.
const SMALL_GRID: usize = 32;
/// The search ends after this many larger grids without an estimate, or after this many grids in succession without contact.
pub const MOST_WITHOUT: usize = 3;
/// Most doublings from one grid to the next. Predictions over more are uncertain, and a grid in between costs only 1/64 of the next one.
const MOST_DOUBLINGS: u32 = 3;
/// Bounds on the exponent of the number of elements in the predicted seconds.
const EXPONENTS: (f64, f64) = (0.9, 1.25);
/// A grid is tried even if its predicted time exceeds `max_seconds` by up to this factor, because its unfinished result may be better than the last
/// one.
const WORTH_A_TRY: f64 = 1.2;

impl Past {
    /// Collects the results of a grid. `entered` and `now` are the seconds from the start of the first grid to the start and to the end of this one;
    /// `before` is the grid before it.
    pub fn of(
        (solved, is_believed): (&Solved, bool),
        (accuracy, scene): (&Accuracy, &Scene<'_>),
        (entered, now): (f64, f64),
        before: Option<&Past>,
    ) -> Past {
        let (problem, seconds) = (&solved.solver.problem, now - entered);
        let seen = before.map(|before| {
            let ratio = problem.grid.len() as f64 / before.grid.len() as f64;
            (seconds / before.seconds).ln() / ratio.ln()
        });
        let repeats = problem.coefficients.repeats(&problem.grid);
        let exponent = seen.filter(|seen| seen.is_finite()).unwrap_or(GROWTH);
        Past {
            grid: problem.grid,
            refines: refines(scene),
            across: across(solved.solver.state(), repeats, &scene.grid),
            enough: accuracy.wanted().map(|(quantity, _)| quantity.enough_across()).max().unwrap_or(1),
            excesses: accuracy.excesses(&solved.outlook),
            is_believed,
            predicts_far: accuracy.wanted().all(|(quantity, _)| quantity.has_estimate()),
            bytes: solved.report.bytes,
            seconds,
            exponent: exponent.clamp(EXPONENTS.0, EXPONENTS.1),
            elapsed: now,
        }
    }

    /// Whether there are enough elements across the contact for all targets.
    pub fn is_resolved(&self) -> bool {
        self.across.0.min(self.across.1) >= self.enough
    }

    /// Whether an error is unknown on a grid that is large enough to have estimates.
    pub fn lacks_estimate(&self) -> bool {
        self.grid.mx.max(self.grid.my) >= SMALL_GRID && self.worst().is_none()
    }

    /// The largest error relative to its target. None if an error is unknown.
    pub fn worst(&self) -> Option<f64> {
        self.after(0)
    }

    /// [`worst`](Past::worst) as predicted for the grid after `doublings`.
    fn after(&self, doublings: u32) -> Option<f64> {
        self.excesses.iter().try_fold(0.0, |worst: f64, one| one.map(|one| worst.max(one.after(doublings as i32))))
    }
}

impl fmt::Display for Past {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, y) = self.across;
        match self.worst() {
            Some(worst) => {
                write!(f, "the estimated error is {worst:.2} times the target, {x} x {y} elements across the contact")
            }
            None => write!(f, "no estimate, {x} x {y} elements across the contact"),
        }
    }
}

impl Accuracy {
    /// The outcome of the search and its reason, if the search ends here. `without_contact` is the number of last grids without contact,
    /// `without_estimate` the number of grids that [lack an estimate](Past::lacks_estimate).
    pub(super) fn end(
        &self,
        past: &Past,
        without_contact: usize,
        without_estimate: usize,
    ) -> Option<(Outcome, String)> {
        let least = self.wanted().map(|(_, target)| target).fold(f64::INFINITY, f64::min);
        if least < ROUND_OFF {
            return Some((Outcome::Stagnated, format!("target is {least:e}, below round-off")));
        }
        if past.is_resolved() && past.is_believed && past.worst().is_some_and(|worst| worst <= 1.0) {
            return Some((Outcome::Converged, "the target is met".into()));
        }
        if without_contact == MOST_WITHOUT {
            return Some((Outcome::Converged, "there is no contact on three grids".into()));
        }
        (without_estimate == MOST_WITHOUT)
            .then(|| (Outcome::Stagnated, "no estimate of the error can be trusted".into()))
    }

    /// The next grid: the one predicted to meet the target, or as many doublings towards it as the limits allow.
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

    /// The least number of doublings after which the errors are predicted to meet the targets with enough elements across the contact; at most
    /// [`MOST_DOUBLINGS`]. 1 if errors are unknown or not predicted so far.
    fn doublings(&self, past: &Past) -> u32 {
        let across = past.across.0.min(past.across.1);
        if across == 0 || !past.predicts_far || past.worst().is_none() {
            return 1;
        }
        let enough = |k: u32| across.saturating_mul(1 << k) >= past.enough;
        let met = |k: u32| enough(k) && past.after(k).is_none_or(|worst| worst <= 1.0);
        (1..MOST_DOUBLINGS).find(|k| met(*k)).unwrap_or(MOST_DOUBLINGS)
    }

    /// A sentence on the limit that so many doublings would break; None if they break none.
    fn limit(&self, past: &Past, doublings: u32) -> Option<String> {
        let times = |m: usize, refines: bool| if refines { (m as u64) << doublings } else { m as u64 };
        let (mx, my) = (times(past.grid.mx, past.refines.0), times(past.grid.my, past.refines.1));
        let why = match past.is_resolved() {
            true => String::new(),
            false => format!(
                "; {} elements across the contact are less than {}",
                past.across.0.min(past.across.1),
                past.enough
            ),
        };
        let forbids = |limit: String| Some(format!("{limit} is in the way of {mx} x {my} elements{why}"));
        let most = if self.max_elements == 0 { MOST_ELEMENTS } else { self.max_elements };
        // mx and my are below 2^34, so `as u64` and the shift lose no bits; their product may overflow.
        if mx.saturating_mul(my) > most.min(ALL_ELEMENTS) {
            return forbids(format!("max_elements, {most},"));
        }
        let ratio = mx as f64 * my as f64 / past.grid.len() as f64;
        let bytes = past.bytes as f64 * (1.0 + ratio);
        if self.max_bytes > 0 && bytes > self.max_bytes as f64 {
            return forbids(format!("max_bytes, {} of the {bytes:.0} predicted,", self.max_bytes));
        }
        let seconds = past.elapsed + past.seconds * ratio.powf(past.exponent);
        let tolerated = if doublings == 1 { WORTH_A_TRY } else { 1.0 };
        if self.is_late(seconds / tolerated) {
            return forbids(format!("max_seconds, {} of the {seconds:.3} predicted,", self.max_seconds));
        }
        None
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/next_grid.rs"]
mod tests;
