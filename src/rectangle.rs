//! A rectangle of elements: the part of a grid outside of which nothing counts.

use std::ops::Range;

use crate::blocks;
use crate::grid::Grid;
use crate::threads::Threads;

/// A rectangle of elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Columns.
    pub x: Range<usize>,
    /// Rows.
    pub y: Range<usize>,
}

impl Rectangle {
    /// The whole grid.
    pub fn full(grid: &Grid) -> Rectangle {
        Rectangle { x: 0..grid.mx, y: 0..grid.my }
    }

    /// The smallest rectangle with all elements that count. `any`: whether any of some elements of a row counts. None if no element does.
    pub fn around(
        grid: &Grid,
        threads: &Threads,
        any: impl Fn(Range<usize>) -> bool + Sync + Send,
    ) -> Option<Rectangle> {
        let mx = grid.mx;
        blocks::fold(
            grid,
            threads,
            None,
            #[inline(always)]
            |block| in_rows(block.start / mx..block.end / mx, mx, &any),
            Rectangle::joined,
        )
    }

    /// [`Rectangle::around`], by values.
    pub fn around_values<A: Sync>(
        values: &[A],
        grid: &Grid,
        threads: &Threads,
        any: impl Fn(&[A]) -> bool + Sync + Send,
    ) -> Option<Rectangle> {
        Rectangle::around(grid, threads, |elements| any(&values[elements]))
    }

    /// The smallest rectangle that holds both.
    pub fn joined(a: Option<Rectangle>, b: Option<Rectangle>) -> Option<Rectangle> {
        let join = |a: Range<usize>, b: Range<usize>| a.start.min(b.start)..a.end.max(b.end);
        match (a, b) {
            (Some(a), Some(b)) => Some(Rectangle { x: join(a.x, b.x), y: join(a.y, b.y) }),
            (a, b) => a.or(b),
        }
    }

    /// Whether this is the whole grid.
    pub fn is_full(&self, grid: &Grid) -> bool {
        self.x.len() == grid.mx && self.y.len() == grid.my
    }

    /// Number of elements.
    pub fn count(&self) -> usize {
        self.x.len() * self.y.len()
    }

    /// The rectangle as a grid.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { mx: self.x.len(), my: self.y.len(), ..*grid }
    }

    /// The elements of the rectangle's row `iy`, on the whole grid.
    pub fn row(&self, grid: &Grid, iy: usize) -> Range<usize> {
        let start = (self.y.start + iy) * grid.mx;
        start + self.x.start..start + self.x.end
    }

    /// The elements in row `iy` of the whole grid: the index in the rectangle and the column on the grid of each.
    pub fn columns(&self, iy: usize) -> impl Iterator<Item = (usize, usize)> {
        let row = self.y.contains(&iy).then(|| (iy - self.y.start) * self.x.len());
        let columns = self.x.clone();
        row.into_iter().flat_map(move |first| (first..).zip(columns.clone()))
    }

    /// The elements: the index in the rectangle and the index on the whole grid of each.
    pub fn elements<'a>(&'a self, grid: &'a Grid) -> impl Iterator<Item = (usize, usize)> + 'a {
        (0..).zip((0..self.y.len()).flat_map(move |iy| self.row(grid, iy)))
    }

    /// Copies the part of `from`, on the whole grid, to `to`.
    pub fn extract<A: Copy + Send + Sync>(&self, grid: &Grid, from: &[A], to: &mut [A], threads: &Threads) {
        threads.for_a_pass(to.len()).for_each_plain_row(to, self.x.len(), |y, row| {
            row.copy_from_slice(&from[self.row(grid, y)]);
        });
    }

    /// Copies `from`, on the rectangle, to its part of `to`, on the whole grid; `to` becomes `outside` elsewhere.
    pub fn insert<A: Copy + Send + Sync>(&self, grid: &Grid, from: &[A], to: &mut [A], outside: A, threads: &Threads) {
        let Rectangle { x, y: rows } = self;
        threads.for_a_pass(to.len()).for_each_plain_row(to, grid.mx, |y, row| {
            if !rows.contains(&y) {
                return row.fill(outside);
            }
            row[..x.start].fill(outside);
            row[x.clone()].copy_from_slice(&from[(y - rows.start) * x.len()..][..x.len()]);
            row[x.end..].fill(outside);
        });
    }
}

/// The smallest rectangle in some rows of `mx` elements each.
#[inline(always)]
fn in_rows(
    Range { start: mut first, end: mut behind }: Range<usize>,
    mx: usize,
    any: &impl Fn(Range<usize>) -> bool,
) -> Option<Rectangle> {
    let row = |y: usize| y * mx..(y + 1) * mx;
    while first < behind && !any(row(first)) {
        first += 1;
    }
    if first == behind {
        return None;
    }
    while !any(row(behind - 1)) {
        behind -= 1;
    }
    let (mut start, mut end) = (mx, 0);
    for Range { start: of_row, end: next_row } in (first..behind).map(row) {
        // Only elements outside the columns so far are tested.
        if any(of_row..of_row + start) {
            start = first_of(of_row..of_row + start, any) - of_row;
        }
        if any(of_row + end..next_row) {
            end = last_of(of_row + end..next_row, any) + 1 - of_row;
        }
    }
    Some(Rectangle { x: start..end, y: first..behind })
}

/// The first of some elements that counts, by bisection. At least one counts.
#[inline(always)]
fn first_of(Range { mut start, mut end }: Range<usize>, any: &impl Fn(Range<usize>) -> bool) -> usize {
    while end - start > 1 {
        let middle = (start + end) / 2;
        match any(start..middle) {
            true => end = middle,
            false => start = middle,
        }
    }
    start
}

/// The last of some elements that counts, by bisection. At least one counts.
#[inline(always)]
fn last_of(Range { mut start, mut end }: Range<usize>, any: &impl Fn(Range<usize>) -> bool) -> usize {
    while end - start > 1 {
        let middle = (start + end) / 2;
        match any(middle..end) {
            true => start = middle,
            false => end = middle,
        }
    }
    start
}
