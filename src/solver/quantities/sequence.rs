//! The error of a quantity from its values on finer and finer grids.
//!
//! With elements of size h a value has the error `c h^q`, q = 1 or 2 (Richardson 1911). Let the elements of a grid be doubled k times in both
//! directions, and let d be the change of the value. Then the remaining error is `d/(2^k - 1)` for q = 1, and `d/(4^k - 1)` for q = 2.
//!
//! The last change may be small by chance, because areas change irregularly from grid to grid. The change before the last one also gives an error, at
//! first order. The larger of both errors counts, unless the last two changes indicate second order.

use crate::solver::falling::Falling;

/// A quantity counts as singular (divergent with refinement) if its changes per doubling keep their sign, and each is more than this part of the
/// change before it. The last three changes are compared, or two if there are no more. A logarithm has the ratio 1, an error of first order 1/2.
const SINGULAR_RATIO: f64 = 0.8;
/// The largest ratio of successive changes, one doubling apart, that counts as second order. Exact second order has 1/4; half as much is added
/// because changes are irregular.
const MOST_OF_SECOND_ORDER: f64 = 0.38;
/// Factor on an error of second order, because only three grids indicate this order.
const MARGIN: f64 = 2.0;

/// The ratios of successive changes, one doubling apart, of errors of first and of second order.
const FIRST_ORDER_RATIO: f64 = 0.5;
const SECOND_ORDER_RATIO: f64 = 0.25;

/// Values of one quantity on grids of the same rectangle, coarsest first.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    points: Vec<Point>,
}

/// The value on one grid.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// Doublings of the elements since a common grid; negative: halvings.
    doublings: i32,
    value: f64,
    /// The error of the value due to the residual of the solve.
    residual_error: f64,
}

impl Sequence {
    /// Adds the value on a grid, whose `doublings` since a common grid must exceed those of the grid before. `residual_error` is the error of the
    /// value due to the residual of the solve.
    pub fn add(&mut self, doublings: i32, value: f64, residual_error: f64) {
        self.points.push(Point { doublings, value, residual_error });
    }

    /// The value on the last grid.
    pub fn value(&self) -> Option<f64> {
        self.points.last().map(|point| point.value)
    }

    /// The error of the last value due to the residual of its solve.
    pub fn residual_error(&self) -> Option<f64> {
        self.points.last().map(|point| point.residual_error)
    }

    /// The change from the last grid but one to the last grid, and the doublings between them.
    pub fn last_change(&self) -> Option<(f64, i32)> {
        self.changes().last().map(|change| (change.by, change.doublings))
    }

    /// The number of grids so far.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The error on the last grid. None from one grid, or if the quantity seems to diverge ([`SINGULAR_RATIO`]).
    pub fn error(&self) -> Option<Falling> {
        let last = self.points.last()?;
        let changes = self.changes();
        let (newest, before) = (changes.last()?, changes.iter().rev().nth(1));
        let hidden = last.residual_error;
        let Some(before) = before else {
            return Some(Falling { by_two: newest.error_at(FIRST_ORDER_RATIO), hidden, ..Falling::default() });
        };
        if is_singular(&changes, hidden) {
            return None;
        }
        let predicted = before.error_after(newest);
        let found = newest.error_at(FIRST_ORDER_RATIO);
        if found <= 2.0 * MOST_OF_SECOND_ORDER * predicted {
            // As at first order, the change before the last one gives a lower bound.
            let of_before = before.error_at(SECOND_ORDER_RATIO) * SECOND_ORDER_RATIO.powi(newest.doublings);
            let second = newest.error_at(SECOND_ORDER_RATIO).max(of_before);
            return Some(Falling { by_four: MARGIN * second, hidden, ..Falling::default() });
        }
        Some(Falling { by_two: found.max(predicted), hidden, ..Falling::default() })
    }

    /// [`error`](Sequence::error) of an irregular quantity of first order: a small last change does not indicate second order.
    pub fn error_of_first_order(&self) -> Option<Falling> {
        let error = self.error()?;
        let [.., before, newest] = self.changes()[..] else { return Some(error) };
        let by_two = newest.error_at(FIRST_ORDER_RATIO).max(before.error_after(&newest));
        Some(Falling { by_two, by_four: 0.0, ..error })
    }

    /// The error of a quantity that is known to converge, even if its changes do not decrease yet: the rest of a geometric series of changes. The
    /// ratio of the series, from one doubling to the next, follows from the last two changes. It is clamped between 1/2 and `ratio`. The last change
    /// counts as at least half of the change before it.
    pub fn error_if_slow(&self, ratio: f64) -> Option<Falling> {
        let by_two = match self.changes()[..] {
            [] => return None,
            [only] => only.error_at(FIRST_ORDER_RATIO),
            [.., before, newest] if before.by != 0.0 => {
                let (of_newest, of_before) = (newest.per_doubling().abs(), before.per_doubling().abs());
                // From the middle of one change to that of the next.
                let apart = 0.5 * f64::from(before.doublings + newest.doublings);
                let found = (of_newest / of_before).powf(1.0 / apart).clamp(FIRST_ORDER_RATIO, ratio);
                newest.error_at(found).max(before.error_at(found) * FIRST_ORDER_RATIO.powi(newest.doublings))
            }
            [.., newest] => newest.error_at(ratio),
        };
        Some(Falling { by_two, hidden: self.residual_error()?, ..Falling::default() })
    }

    /// The changes from grid to grid.
    fn changes(&self) -> Vec<Change> {
        let change = |pair: &[Point]| Change {
            by: pair[1].value - pair[0].value,
            doublings: pair[1].doublings - pair[0].doublings,
        };
        self.points.windows(2).map(change).collect()
    }
}

/// The change from one grid to the next.
#[derive(Clone, Copy, Debug)]
struct Change {
    /// The change of the value.
    by: f64,
    /// The doublings between both grids.
    doublings: i32,
}

impl Change {
    /// The error that remains on the finer grid, if errors fall by `ratio` at each doubling.
    fn error_at(&self, ratio: f64) -> f64 {
        self.by.abs() / (ratio.powi(-self.doublings) - 1.0)
    }

    /// The error that remains after the `next` change, as predicted by this one at first order.
    fn error_after(&self, next: &Change) -> f64 {
        self.error_at(FIRST_ORDER_RATIO) * FIRST_ORDER_RATIO.powi(next.doublings)
    }

    /// The change divided by its doublings.
    fn per_doubling(&self) -> f64 {
        self.by / f64::from(self.doublings)
    }
}

/// Whether the quantity seems to diverge with refinement ([`SINGULAR_RATIO`]). Changes below `residual_error` do not indicate this.
fn is_singular(changes: &[Change], residual_error: f64) -> bool {
    let last = &changes[changes.len().saturating_sub(3)..];
    last.windows(2).all(|pair| {
        let (before, now) = (pair[0].per_doubling(), pair[1].per_doubling());
        now.abs() > residual_error && before * now > 0.0 && now.abs() > SINGULAR_RATIO * before.abs()
    })
}

#[cfg(test)]
#[path = "../../../tests/unit/sequence.rs"]
mod tests;
