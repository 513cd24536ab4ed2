//! The error of a quantity from its values on finer and finer grids.
//!
//! With elements of size h a value has the error `c h^q`, q = 1 or 2 (Richardson). With the change d between two grids,
//! k doublings apart, the remaining error is `d/(2^k - 1)` for q = 1, and `d/(4^k - 1)` for q = 2. Areas change
//! irregularly from grid to grid. So the error is not less than the prediction of the grid before at first order,
//! unless the last two changes indicate second order.

use crate::solver::falling::Falling;

/// A quantity is singular if the ratios of its last three changes (of two, if there are no more), each per doubling,
/// are above this. A logarithm has the ratio 1, first order 1/2.
const SINGULAR_RATIO: f64 = 0.8;
/// Largest ratio of successive changes at a doubling for second order: a quarter, and half of that for irregularity.
const SECOND_ORDER_RATIO: f64 = 0.38;
/// Factor on an error of second order, because only three grids indicate this order.
const MARGIN: f64 = 2.0;

/// Ratio of successive changes at a doubling for first order.
const FIRST_ORDER_RATIO: f64 = 0.5;

/// Values of one quantity on grids of the same rectangle, coarsest first.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    points: Vec<Point>,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    doublings: i32,
    value: f64,
    hidden: f64,
}

impl Sequence {
    /// Adds a grid; its `doublings` exceed those of the grid before. `hidden`: the error of the value due to the
    /// residual.
    pub fn add(&mut self, doublings: i32, value: f64, hidden: f64) {
        self.points.push(Point { doublings, value, hidden });
    }

    /// The value on the last grid.
    pub fn value(&self) -> Option<f64> {
        self.points.last().map(|point| point.value)
    }

    /// The error of the last value due to the residual.
    pub fn hidden(&self) -> Option<f64> {
        self.points.last().map(|point| point.hidden)
    }

    /// The last change, and its doublings.
    pub fn last_change(&self) -> Option<(f64, i32)> {
        self.changes().last().map(|change| (change.by, change.doublings))
    }

    /// Grids so far.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The error on the last grid; none from one grid, or if the changes do not fall.
    pub fn falling(&self) -> Option<Falling> {
        let last = self.points.last()?;
        let changes = self.changes();
        let (newest, before) = (changes.last()?, changes.iter().rev().nth(1));
        let hidden = last.hidden;
        let Some(before) = before else {
            return Some(Falling { by_two: newest.first_order(), hidden, ..Falling::default() });
        };
        if is_singular(&changes, hidden) {
            return None;
        }
        let predicted = before.predicts(newest);
        let found = newest.first_order();
        if found <= 2.0 * SECOND_ORDER_RATIO * predicted {
            let second = newest.second_order().max(before.second_order() * 0.25_f64.powi(newest.doublings));
            return Some(Falling { by_four: MARGIN * second, hidden, ..Falling::default() });
        }
        Some(Falling { by_two: found.max(predicted), hidden, ..Falling::default() })
    }

    /// The error of an irregular quantity of first order, for which a small change does not indicate second order.
    pub fn of_first_order(&self) -> Option<Falling> {
        let falling = self.falling()?;
        let [.., before, newest] = self.changes()[..] else { return Some(falling) };
        let by_two = newest.first_order().max(before.predicts(&newest));
        Some(Falling { by_two, by_four: 0.0, ..falling })
    }

    /// The error of a quantity that is known to converge, even if its changes do not fall yet: the rest of a geometric
    /// series with the ratio of the last two changes, clamped between 1/2 and `ratio` at a doubling.
    pub fn slow(&self, ratio: f64) -> Option<Falling> {
        let (last, falls) = match self.changes().iter().map(|change| change.of_one().abs()).collect::<Vec<f64>>()[..] {
            [] => return None,
            [only] => (only, FIRST_ORDER_RATIO),
            [.., before, newest] if before > 0.0 => {
                (newest.max(FIRST_ORDER_RATIO * before), (newest / before).clamp(FIRST_ORDER_RATIO, ratio))
            }
            [.., newest] => (newest, ratio),
        };
        Some(Falling { by_two: last * falls / (1.0 - falls), hidden: self.hidden()?, ..Falling::default() })
    }

    fn changes(&self) -> Vec<Change> {
        let of = |pair: &[Point]| Change {
            by: pair[1].value - pair[0].value,
            doublings: pair[1].doublings - pair[0].doublings,
        };
        self.points.windows(2).map(of).collect()
    }
}

/// The change from one grid to the next.
#[derive(Clone, Copy, Debug)]
struct Change {
    by: f64,
    doublings: i32,
}

impl Change {
    /// The remaining error at first order.
    fn first_order(&self) -> f64 {
        self.by.abs() / (2f64.powi(self.doublings) - 1.0)
    }

    /// The remaining error at second order.
    fn second_order(&self) -> f64 {
        self.by.abs() / (4f64.powi(self.doublings) - 1.0)
    }

    /// The error of first order after the `next` change, predicted by this one.
    fn predicts(&self, next: &Change) -> f64 {
        self.first_order() * 0.5_f64.powi(next.doublings)
    }

    /// The change per doubling.
    fn of_one(&self) -> f64 {
        self.by / f64::from(self.doublings)
    }
}

/// Whether the last three changes, or two if there are no more, have one sign and do not fall. Changes below `hidden`
/// do not indicate a singularity.
fn is_singular(changes: &[Change], hidden: f64) -> bool {
    let last = &changes[changes.len().saturating_sub(3)..];
    last.windows(2).all(|pair| {
        let (before, now) = (pair[0].of_one(), pair[1].of_one());
        now.abs() > hidden && before * now > 0.0 && now.abs() > SINGULAR_RATIO * before.abs()
    })
}

#[cfg(test)]
#[path = "../../../tests/unit/sequence.rs"]
mod tests;
