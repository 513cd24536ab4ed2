//! The choice of the next grid within the limits.

use std::fmt;

use super::accuracy::{Accuracy, ALL_ELEMENTS, MOST_ELEMENTS, ROUND_OFF};
use super::outlook::across;
use super::solved::Solved;
use crate::grid::Grid;
use crate::progress::Outcome;
use crate::scene::{refines, Scene};
use crate::solver::falling::Falling;
use crate::solver::seconds::GROWTH;

/// The results of the last grid.
#[derive(Clone, Debug)]
pub(super) struct Past {
    pub grid: Grid,
    /// The directions in which a finer grid has more elements.
    pub refines: (bool, bool),
    /// Elements across the contact area.
    pub across: (usize, usize),
    /// Elements across that suffice for all targets.
    pub enough: usize,
    /// The errors over their targets, where known.
    pub excesses: Vec<Option<Falling>>,
    /// Whether there are enough grids for these errors to be valid.
    pub is_believed: bool,
    /// Whether errors are predicted over several doublings: not if one follows from several grids, which hardly determine its order.
    pub leaps: bool,
    /// Bytes held by the grid's solver.
    pub bytes: u64,
    /// Seconds of this grid: undeformed distance, set-up and solve.
    pub seconds: f64,
    /// The power of the number of elements with which the seconds grow.
    pub exponent: f64,
    /// Seconds since the first grid was begun.
    pub elapsed: f64,
}

/// The next grid, or the end.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Next {
    /// Double the elements of the directions that a scene [`refines`] this many times.
    Refine(u32),
    /// The limit that forbids the next grid.
    Limit(String),
}

/// Elements in the longer direction below which a grid may lack an estimate.
const SMALL_GRID: usize = 32;
/// The search ends after this many larger grids without an estimate, or this many grids in succession without contact.
pub const MOST_WITHOUT: usize = 3;
/// Most doublings of a prediction. Over more, errors are uncertain, and a grid in between costs only 1/64 of the last.
const MOST_DOUBLINGS: u32 = 3;
/// Least and largest power of the number of elements with which seconds grow.
const EXPONENTS: (f64, f64) = (0.9, 1.25);
/// A grid is tried if its predicted time is at most this many times the time left. Its unfinished result may be better than the last one.
const WORTH_A_TRY: f64 = 1.2;

impl Past {
    /// `entered`, `now`: seconds from the start of the first grid to the start and to the end of this one.
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
            leaps: accuracy.wanted().all(|(quantity, _)| quantity.has_estimate()),
            bytes: solved.report.bytes,
            seconds,
            exponent: exponent.clamp(EXPONENTS.0, EXPONENTS.1),
            elapsed: now,
        }
    }

    /// Whether there are enough elements across the contact.
    pub fn is_resolved(&self) -> bool {
        self.across.0.min(self.across.1) >= self.enough
    }

    /// Whether an estimate is missing on a grid that should have one.
    pub fn lacks_estimate(&self) -> bool {
        self.grid.mx.max(self.grid.my) >= SMALL_GRID && self.worst().is_none()
    }

    /// The largest error over its target, if all are known.
    pub fn worst(&self) -> Option<f64> {
        self.after(0)
    }

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
    /// The outcome and its reason, if the refinement ends here.
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

    /// Doublings required by the estimates and by the elements across the contact; one without estimates.
    fn doublings(&self, past: &Past) -> u32 {
        let across = past.across.0.min(past.across.1);
        if across == 0 || !past.leaps || past.worst().is_none() {
            return 1;
        }
        let enough = |k: u32| across.saturating_mul(1 << k) >= past.enough;
        let met = |k: u32| enough(k) && past.after(k).is_none_or(|worst| worst <= 1.0);
        (1..MOST_DOUBLINGS).find(|k| met(*k)).unwrap_or(MOST_DOUBLINGS)
    }

    /// The limit that these doublings would break, if any.
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
        let in_the_way = |limit: String| Some(format!("{limit} is in the way of {mx} x {my} elements{why}"));
        let most = if self.max_elements == 0 { MOST_ELEMENTS } else { self.max_elements };
        // mx and my are below 2^34.
        if mx.saturating_mul(my) > most.min(ALL_ELEMENTS) {
            return in_the_way(format!("max_elements, {most},"));
        }
        let ratio = mx as f64 * my as f64 / past.grid.len() as f64;
        let bytes = past.bytes as f64 * (1.0 + ratio);
        if self.max_bytes > 0 && bytes > self.max_bytes as f64 {
            return in_the_way(format!("max_bytes, {} of the {bytes:.0} predicted,", self.max_bytes));
        }
        let seconds = past.elapsed + past.seconds * ratio.powf(past.exponent);
        let left = if doublings == 1 { WORTH_A_TRY } else { 1.0 };
        if self.is_late(seconds / left) {
            return in_the_way(format!("max_seconds, {} of the {seconds:.3} predicted,", self.max_seconds));
        }
        None
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/next_grid.rs"]
mod tests;
