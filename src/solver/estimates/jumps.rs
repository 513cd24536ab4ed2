//! Jumps of a quantity known at the centres of elements.
//!
//! A jump lies somewhere between two centres, so half an element is uncertain. Along a straight line all errors have one sign, else most
//! cancel. A jump J between the middle two of four centres has the third difference `-2 J`. Three conditions identify it: the third
//! difference exceeds those around, the second differences beside it have opposite signs, and the jump continues in the next line. Smooth
//! curves have none. (On a rough surface whose shortest waves have 3 to 16 elements, at most one place in 1e4 counts as a jump, a small one.)

use std::ops::Range;

use crate::direction::Direction;
use crate::grid::Grid;
use crate::rectangle::Rectangle;

/// Least number of lines that are searched.
const LINES: usize = 32;
/// Ratio of a jump's third difference to those around it.
const JUMP_RATIO: f64 = 8.0;
/// A jump continues in the next line if the ratio of both third differences lies between this and its inverse.
const CONTINUATION_RATIO: f64 = 0.5;
/// Uncertainty of a jump in elements, along a straight line and otherwise.
const STRAIGHT_JUMP: f64 = 0.5;
const STEPPED_JUMP: f64 = 0.15;

/// A row or a column.
#[derive(Clone, Copy)]
pub(super) struct Line {
    /// The number of the line.
    pub(super) number: usize,
    /// The direction along it, and that to the next line.
    pub(super) along: Direction,
    pub(super) across: Direction,
}

/// A jump between two neighbours of a line.
#[derive(Clone, Copy, Debug)]
pub struct Jump {
    /// The elements before and behind the jump.
    pub between: (usize, usize),
    /// The quantity behind the jump, less that before it.
    pub height: f64,
    /// The part of an element that is uncertain.
    pub uncertain: f64,
    /// Lines represented by this one.
    pub lines: f64,
}

/// Visits the jumps between wanted neighbours, of which one lies in `part` of the grid. Searches a sample of many lines, unless `all`.
pub fn each_jump(
    (grid, part): (&Grid, &Rectangle),
    repeats: (bool, bool),
    (value, all): (impl Fn(usize) -> f64, bool),
    is_wanted: impl Fn(usize, usize) -> bool,
    mut visit: impl FnMut(Jump),
) {
    let [x, y] = Direction::both(grid, repeats);
    for (along, across, numbers, places) in [(x, y, &part.y, &part.x), (y, x, &part.x, &part.y)] {
        // A jump needs four different centres.
        if along.m < 4 {
            continue;
        }
        let stride = if all { 1 } else { (numbers.len() / LINES).max(1) };
        let looked_at = (numbers.start + stride / 2..numbers.end).step_by(stride);
        let lines = numbers.len() as f64 / looked_at.len() as f64;
        // With a whole period, the jump at its seam comes last.
        let first = if along.repeats && places.len() == along.m { 0 } else { -1 };
        let places = places.start as isize + first..places.end as isize;
        for number in looked_at {
            Line { number, along, across }.jumps((places.clone(), lines), &value, &is_wanted, &mut visit);
        }
    }
}

/// Sum over the jumps J, in all lines, of `|J|` times the part of an element that is uncertain times `weight(i, j)` of the two elements.
pub fn at_jumps(
    part: (&Grid, &Rectangle),
    repeats: (bool, bool),
    value: impl Fn(usize) -> f64,
    weight: impl Fn(usize, usize) -> f64,
) -> f64 {
    let mut sum = 0.0;
    let add = |jump: Jump| sum += weight(jump.between.0, jump.between.1) * jump.height.abs() * jump.uncertain;
    each_jump(part, repeats, (value, true), |i, j| weight(i, j) > 0.0, add);
    sum
}

impl Line {
    /// The element at `place`, none beyond the ends.
    fn at(&self, place: isize) -> Option<usize> {
        self.along.at(place).map(|at| self.number * self.across.step + at)
    }

    fn jumps(
        &self,
        (places, lines): (Range<isize>, f64),
        value: &impl Fn(usize) -> f64,
        is_wanted: &impl Fn(usize, usize) -> bool,
        visit: &mut impl FnMut(Jump),
    ) {
        let mut before = self.second(places.start, value);
        for place in places {
            let behind = self.second(place + 1, value);
            // Nearly all places end here.
            if before > 0.0 && behind < 0.0 || before < 0.0 && behind > 0.0 {
                if let (Some(i), Some(j)) = (self.at(place), self.at(place + 1)) {
                    let uncertain = if is_wanted(i, j) { self.uncertain(place, behind - before, value) } else { 0.0 };
                    if uncertain > 0.0 {
                        visit(Jump { between: (i, j), height: 0.5 * (before - behind), uncertain, lines });
                    }
                }
            }
            before = behind;
        }
    }

    /// The part of an element by which a jump behind `place` may be off, whose third difference is `found`; 0 if there is no jump.
    fn uncertain(&self, place: isize, found: f64, value: &impl Fn(usize) -> f64) -> f64 {
        let second = |k: isize| self.second(place + k, value);
        let change = |from: isize, to: isize| {
            let change = (second(to) - second(from)).abs();
            change.is_finite().then_some(change)
        };
        // Second differences of short waves have opposite signs as well, but change as much farther off.
        let around = [change(-2, -1), change(2, 3), change(-1, 2)].into_iter().flatten().reduce(f64::max);
        // Without values around, a jump cannot be distinguished from a bend.
        if !around.is_some_and(|around| found.abs() > JUMP_RATIO * around) {
            return 0.0;
        }
        let beside = [-1, 1].map(|next| self.across.place(self.number as isize + next));
        let beside: Vec<Line> = beside.into_iter().flatten().map(|number| Line { number, ..*self }).collect();
        let goes_on = |line: &Line, mut places: Range<isize>| {
            let third = |k: isize| line.second(place + k + 1, value) - line.second(place + k, value);
            places.any(|k| (CONTINUATION_RATIO..=1.0 / CONTINUATION_RATIO).contains(&(third(k) / found)))
        };
        if !beside.is_empty() && !beside.iter().any(|line| goes_on(line, -1..2)) {
            return 0.0;
        }
        match beside.iter().all(|line| goes_on(line, 0..1)) {
            true => STRAIGHT_JUMP,
            false => STEPPED_JUMP,
        }
    }

    /// The second difference at a place; NaN where the surface ends.
    #[inline]
    pub(super) fn second(&self, place: isize, value: &impl Fn(usize) -> f64) -> f64 {
        let second = if place >= 1 && place + 1 < self.along.m as isize {
            let Direction { step, .. } = self.along;
            let at = self.number * self.across.step + place as usize * step;
            value(at - step) + value(at + step) - 2.0 * value(at)
        } else {
            let [before, here, behind] =
                [place - 1, place, place + 1].map(|place| self.at(place).map_or(f64::INFINITY, value));
            before + behind - 2.0 * here
        };
        if second.is_finite() {
            second
        } else {
            f64::NAN
        }
    }
}
