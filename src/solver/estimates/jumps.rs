//! Finds jumps of a quantity whose values at the centres of elements are known.
//!
//! A jump lies somewhere between two centres, so its position is uncertain by half an element. Along a straight line of jumps all these errors have
//! one sign; along other lines most of them cancel. A jump J between the middle two of four centres has the third difference `-2 J`. Three conditions
//! identify a jump:
//!
//! - the third difference exceeds those around it by a factor of [`JUMP_RATIO`],
//! - the second differences beside it have opposite signs,
//! - the jump continues in a neighbouring line.
//!
//! Smooth curves have no jumps. On a rough surface whose shortest waves have 3 to 16 elements, at most one interval in 1e4 counts as a jump, a small
//! one.

use std::ops::Range;

use crate::direction::Direction;
use crate::grid::Grid;
use crate::rectangle::Rectangle;

/// If a sample of the lines suffices, from this many to twice as many are searched.
const LINES: usize = 32;
/// The least ratio of a jump's third difference to those around it.
const JUMP_RATIO: f64 = 8.0;
/// A jump continues in the next line if the ratio of the third differences in both lines lies between this and its inverse.
const CONTINUATION_RATIO: f64 = 0.5;
/// Uncertainty of the position of a jump along a straight line, in elements.
const STRAIGHT_JUMP: f64 = 0.5;
/// Uncertainty of the position of other jumps, in elements.
const STEPPED_JUMP: f64 = 0.15;

/// A row or a column.
#[derive(Clone, Copy)]
pub(super) struct Line {
    /// The number of the row or column.
    pub(super) number: usize,
    /// The direction along the line.
    pub(super) along: Direction,
    /// The direction from this line to the next.
    pub(super) across: Direction,
}

/// A jump between two neighbours of a line.
#[derive(Clone, Copy, Debug)]
pub struct Jump {
    /// The elements before and after the jump.
    pub between: (usize, usize),
    /// The value after the jump less the value before it.
    pub height: f64,
    /// The uncertainty of the position, in elements.
    pub uncertain: f64,
    /// The number of lines for which this one was sampled.
    pub lines: f64,
}

/// Calls `visit` for each jump between two neighbours i, j with `is_wanted(i, j)`, at least one of which lies in `part` of the grid. If there are
/// many lines and not `all`, only a sample of them is searched.
pub fn each_jump(
    (grid, part): (&Grid, &Rectangle),
    repeats: (bool, bool),
    (value, all): (impl Fn(usize) -> f64, bool),
    is_wanted: impl Fn(usize, usize) -> bool,
    mut visit: impl FnMut(Jump),
) {
    let [x, y] = Direction::both(grid, repeats);
    for (along, across, numbers, positions) in [(x, y, &part.y, &part.x), (y, x, &part.x, &part.y)] {
        // A third difference needs four different centres.
        if along.m < 4 {
            continue;
        }
        let stride = if all { 1 } else { (numbers.len() / LINES).max(1) };
        let searched = (numbers.start + stride / 2..numbers.end).step_by(stride);
        let lines = numbers.len() as f64 / searched.len() as f64;
        // Intervals are named by the position before them. The one before the first element is searched as well; in a whole period it is the last
        // one.
        let first = if along.is_periodic && positions.len() == along.m { 0 } else { -1 };
        let positions = positions.start as isize + first..positions.end as isize;
        for number in searched {
            Line { number, along, across }.jumps((positions.clone(), lines), &value, &is_wanted, &mut visit);
        }
    }
}

/// The sum over the jumps J in all lines of `|J|` times the uncertainty of its position, in elements, times `weight(i, j)` of the two elements.
pub fn at_jumps(
    part: (&Grid, &Rectangle),
    repeats: (bool, bool),
    value: impl Fn(usize) -> f64,
    weight: impl Fn(usize, usize) -> f64,
) -> f64 {
    let mut sum = 0.0;
    let add = |Jump { between: (i, j), height, uncertain, .. }: Jump| sum += weight(i, j) * height.abs() * uncertain;
    each_jump(part, repeats, (value, true), |i, j| weight(i, j) > 0.0, add);
    sum
}

impl Line {
    /// The element at a position of the line; None beyond an end without a period.
    fn element(&self, position: isize) -> Option<usize> {
        self.along.offset(position).map(|offset| self.number * self.across.step + offset)
    }

    /// Calls `visit` for each jump between a position of the range and the next position.
    fn jumps(
        &self,
        (positions, lines): (Range<isize>, f64),
        value: &impl Fn(usize) -> f64,
        is_wanted: &impl Fn(usize, usize) -> bool,
        visit: &mut impl FnMut(Jump),
    ) {
        // Second differences at the positions before and after an interval.
        let mut before = self.second(positions.start, value);
        for position in positions {
            let after = self.second(position + 1, value);
            // Nearly all intervals fail this first test.
            if before > 0.0 && after < 0.0 || before < 0.0 && after > 0.0 {
                if let (Some(i), Some(j)) = (self.element(position), self.element(position + 1)) {
                    let uncertain = if is_wanted(i, j) { self.uncertain(position, after - before, value) } else { 0.0 };
                    if uncertain > 0.0 {
                        visit(Jump { between: (i, j), height: 0.5 * (before - after), uncertain, lines });
                    }
                }
            }
            before = after;
        }
    }

    /// The uncertainty, in elements, of the jump between `position` and the next one, where the third difference is `found`. 0 if there is no jump.
    fn uncertain(&self, position: isize, found: f64, value: &impl Fn(usize) -> f64) -> f64 {
        let second = |k: isize| self.second(position + k, value);
        let change = |from: isize, to: isize| {
            let change = (second(to) - second(from)).abs();
            change.is_finite().then_some(change)
        };
        // Second differences of short waves have opposite signs as well, but those farther away change as much.
        let around = [change(-2, -1), change(2, 3), change(-1, 2)].into_iter().flatten().reduce(f64::max);
        // Without third differences around it, a jump cannot be distinguished from a bend.
        if !around.is_some_and(|around| found.abs() > JUMP_RATIO * around) {
            return 0.0;
        }
        let beside = [-1, 1].map(|next| self.across.number(self.number as isize + next));
        let beside: Vec<Line> = beside.into_iter().flatten().map(|number| Line { number, ..*self }).collect();
        // Whether the jump continues in a neighbouring line, shifted by one of `shifts` positions.
        let continues = |line: &Line, mut shifts: Range<isize>| {
            let third = |k: isize| line.second(position + k + 1, value) - line.second(position + k, value);
            shifts.any(|k| (CONTINUATION_RATIO..=1.0 / CONTINUATION_RATIO).contains(&(third(k) / found)))
        };
        if !beside.is_empty() && !beside.iter().any(|line| continues(line, -1..2)) {
            return 0.0;
        }
        match beside.iter().all(|line| continues(line, 0..1)) {
            true => STRAIGHT_JUMP,
            false => STEPPED_JUMP,
        }
    }

    /// The second difference at a position; NaN beside an end of the surface.
    #[inline]
    pub(super) fn second(&self, position: isize, value: &impl Fn(usize) -> f64) -> f64 {
        let second = if position >= 1 && position + 1 < self.along.m as isize {
            let Direction { step, .. } = self.along;
            let i = self.number * self.across.step + position as usize * step;
            value(i - step) + value(i + step) - 2.0 * value(i)
        } else {
            let [before, here, after] = [position - 1, position, position + 1]
                .map(|position| self.element(position).map_or(f64::INFINITY, value));
            before + after - 2.0 * here
        };
        if second.is_finite() {
            second
        } else {
            f64::NAN
        }
    }
}
