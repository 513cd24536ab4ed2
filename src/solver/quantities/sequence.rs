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
const SECOND_ORDER_RATIO: f64 = 0.38;
/// Factor on an error of second order, because only three grids indicate this order.
const MARGIN: f64 = 2.0;

/// The ratio of successive changes, one doubling apart, of an error of first order.
const FIRST_ORDER_RATIO: f64 = 0.5;

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
            return Some(Falling { by_two: newest.error_at_first_order(), hidden, ..Falling::default() });
        };
        if is_singular(&changes, hidden) {
            return None;
        }
        let predicted = before.error_after(newest);
        let found = newest.error_at_first_order();
        if found <= 2.0 * SECOND_ORDER_RATIO * predicted {
            // As at first order, the change before the last one gives a lower bound.
            let of_before = before.error_at_second_order() * 0.25_f64.powi(newest.doublings);
            let second = newest.error_at_second_order().max(of_before);
            return Some(Falling { by_four: MARGIN * second, hidden, ..Falling::default() });
        }
        Some(Falling { by_two: found.max(predicted), hidden, ..Falling::default() })
    }

    /// [`error`](Sequence::error) of an irregular quantity of first order: a small last change does not indicate second order.
    pub fn error_of_first_order(&self) -> Option<Falling> {
        let error = self.error()?;
        let [.., before, newest] = self.changes()[..] else { return Some(error) };
        let by_two = newest.error_at_first_order().max(before.error_after(&newest));
        Some(Falling { by_two, by_four: 0.0, ..error })
    }

    /// The error of a quantity that is known to converge, even if its changes do not decrease yet: the rest of a geometric series of changes. The
    /// last change counts as at least half of the change before it. Changes are taken per doubling, and their ratio is clamped between 1/2 and
    /// `ratio`. If the last grids are one doubling apart, this is the ratio of the series; if they are farther apart, it is an approximation.
    pub fn error_if_slow(&self, ratio: f64) -> Option<Falling> {
        let per_doubling: Vec<f64> = self.changes().iter().map(|change| change.per_doubling().abs()).collect();
        let (last, ratio_found) = match per_doubling[..] {
            [] => return None,
            [only] => (only, FIRST_ORDER_RATIO),
            [.., before, newest] if before > 0.0 => {
                (newest.max(FIRST_ORDER_RATIO * before), (newest / before).clamp(FIRST_ORDER_RATIO, ratio))
            }
            [.., newest] => (newest, ratio),
        };
        let hidden = self.residual_error()?;
        Some(Falling { by_two: last * ratio_found / (1.0 - ratio_found), hidden, ..Falling::default() })
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
    /// The error that remains on the finer grid, if it is of first order.
    fn error_at_first_order(&self) -> f64 {
        self.by.abs() / (2f64.powi(self.doublings) - 1.0)
    }

    /// The error that remains on the finer grid, if it is of second order.
    fn error_at_second_order(&self) -> f64 {
        self.by.abs() / (4f64.powi(self.doublings) - 1.0)
    }

    /// The error that remains after the `next` change, as predicted by this one at first order.
    fn error_after(&self, next: &Change) -> f64 {
        self.error_at_first_order() * FIRST_ORDER_RATIO.powi(next.doublings)
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
