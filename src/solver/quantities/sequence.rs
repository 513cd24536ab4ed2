//! The error of a quantity from its values on grids of more and more elements.
//!
//! With elements of size h a value is off by `c h^q`, q being 1 or 2 (Richardson). Between two grids, k doublings apart, it changes by `d`, so
//! that `d/(2^k - 1)` is left where q = 1, and `d/(4^k - 1)` where q = 2. Areas jump from grid to grid: so no error is less than that of
//! first order that the grid before has promised, unless both say that the order is the second.

use crate::solver::falling::Falling;

/// Changes that fall by less than this with a doubling, thrice or as often as is known, do not come to an end: the quantity is singular.
/// A logarithm changes by the same each time, a change of first order by a half.
const SINGULAR: f64 = 0.8;
/// Of the error of first order, what one of second order leaves at most: a quarter, and half of that for what is irregular.
const SECOND_ORDER: f64 = 0.38;
/// An error of second order is taken so many times, since its order is known from three grids only.
const MARGIN: f64 = 2.0;

/// Changes of first order fall by this; slower ones are not taken to fall by more.
const LEAST: f64 = 0.5;

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
    /// Adds a grid with so many doublings, more than the one before. `hidden`: what the residual may hide of the value.
    pub fn add(&mut self, doublings: i32, value: f64, hidden: f64) {
        self.points.push(Point { doublings, value, hidden });
    }

    /// The value on the last grid.
    pub fn value(&self) -> Option<f64> {
        self.points.last().map(|point| point.value)
    }

    /// What the residual may hide of the value on the last grid.
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

    /// The error on the last grid; none from one grid alone, or where the changes do not fall.
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
        let promised = before.promises(newest);
        let found = newest.first_order();
        if found <= 2.0 * SECOND_ORDER * promised {
            let second = newest.second_order().max(before.second_order() * 0.25_f64.powi(newest.doublings));
            return Some(Falling { by_four: MARGIN * second, hidden, ..Falling::default() });
        }
        Some(Falling { by_two: found.max(promised), hidden, ..Falling::default() })
    }

    /// The same of what is of first order and irregular: a small change is no second order.
    pub fn of_first_order(&self) -> Option<Falling> {
        let falling = self.falling()?;
        let [.., before, newest] = self.changes()[..] else { return Some(falling) };
        let by_two = newest.first_order().max(before.promises(&newest));
        Some(Falling { by_two, by_four: 0.0, ..falling })
    }

    /// The error of what converges for certain, whether its changes fall yet or not: the rest of a row of changes that fall as the last two do, by
    /// `ratio` at least with a doubling, and by a half at most.
    pub fn slow(&self, ratio: f64) -> Option<Falling> {
        let (last, falls) = match self.changes().iter().map(|change| change.of_one().abs()).collect::<Vec<f64>>()[..] {
            [] => return None,
            [only] => (only, LEAST),
            [.., before, newest] if before > 0.0 => (newest.max(LEAST * before), (newest / before).clamp(LEAST, ratio)),
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

/// From one grid to the next.
#[derive(Clone, Copy, Debug)]
struct Change {
    by: f64,
    doublings: i32,
}

impl Change {
    /// The remaining error where errors are of first order.
    fn first_order(&self) -> f64 {
        self.by.abs() / (2f64.powi(self.doublings) - 1.0)
    }

    /// The same of second order.
    fn second_order(&self) -> f64 {
        self.by.abs() / (4f64.powi(self.doublings) - 1.0)
    }

    /// The error of first order on the grid behind another change, as this one says.
    fn promises(&self, next: &Change) -> f64 {
        self.first_order() * 0.5_f64.powi(next.doublings)
    }

    /// The change of a doubling.
    fn of_one(&self) -> f64 {
        self.by / f64::from(self.doublings)
    }
}

/// Whether the last three changes, or the two that there are, have one sign and do not fall. What the residual hides is no change.
fn is_singular(changes: &[Change], hidden: f64) -> bool {
    let last = &changes[changes.len().saturating_sub(3)..];
    last.windows(2).all(|pair| {
        let (before, now) = (pair[0].of_one(), pair[1].of_one());
        now.abs() > hidden && before * now > 0.0 && now.abs() > SINGULAR * before.abs()
    })
}

#[cfg(test)]
#[path = "../../../tests/unit/sequence.rs"]
mod tests;
