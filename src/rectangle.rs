//! A rectangle of elements of a grid, usually the bounding box of the elements with some property (the marked elements).

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

    /// The smallest rectangle that contains all marked elements; None without any. `any(elements)` tells whether a range of elements within one row
    /// contains a marked one.
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
            |block| around_in_rows(block.start / mx..block.end / mx, mx, &any),
            Rectangle::joined,
        )
    }

    /// [`Rectangle::around`], where `any` gets the values of the elements instead of their indices.
    pub fn around_values<A: Sync>(
        values: &[A],
        grid: &Grid,
        threads: &Threads,
        any: impl Fn(&[A]) -> bool + Sync + Send,
    ) -> Option<Rectangle> {
        Rectangle::around(grid, threads, |elements| any(&values[elements]))
    }

    /// The smallest rectangle that contains both rectangles; None contains no element.
    pub fn joined(a: Option<Rectangle>, b: Option<Rectangle>) -> Option<Rectangle> {
        let join = |a: Range<usize>, b: Range<usize>| a.start.min(b.start)..a.end.max(b.end);
        match (a, b) {
            (Some(a), Some(b)) => Some(Rectangle { x: join(a.x, b.x), y: join(a.y, b.y) }),
            (a, b) => a.or(b),
        }
    }

    /// Whether the rectangle is the whole grid.
    pub fn is_full(&self, grid: &Grid) -> bool {
        self.x.len() == grid.mx && self.y.len() == grid.my
    }

    /// The number of elements of the rectangle.
    pub fn count(&self) -> usize {
        self.x.len() * self.y.len()
    }

    /// A grid with the elements of the rectangle.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { mx: self.x.len(), my: self.y.len(), ..*grid }
    }

    /// The indices on the whole grid of the elements in the rectangle's row number `own_row`, counted from its first row.
    pub fn row(&self, grid: &Grid, own_row: usize) -> Range<usize> {
        let start = (self.y.start + own_row) * grid.mx;
        start + self.x.start..start + self.x.end
    }

    /// For each element of the rectangle in row `iy` of the grid: its index in the rectangle, and its column on the grid.
    pub fn columns(&self, iy: usize) -> impl Iterator<Item = (usize, usize)> {
        let first = self.y.contains(&iy).then(|| (iy - self.y.start) * self.x.len());
        let columns = self.x.clone();
        first.into_iter().flat_map(move |first| (first..).zip(columns.clone()))
    }

    /// For each element of the rectangle: its index in the rectangle, and its index on the grid.
    pub fn elements<'a>(&'a self, grid: &'a Grid) -> impl Iterator<Item = (usize, usize)> + 'a {
        (0..).zip((0..self.y.len()).flat_map(move |own_row| self.row(grid, own_row)))
    }

    /// Copies the values in the rectangle from `from`, on the whole grid, to `to`, on the rectangle.
    pub fn extract<A: Copy + Send + Sync>(&self, grid: &Grid, from: &[A], to: &mut [A], threads: &Threads) {
        threads.for_a_pass(to.len()).for_each_plain_row(to, self.x.len(), |y, row| {
            row.copy_from_slice(&from[self.row(grid, y)]);
        });
    }

    /// Copies `from`, on the rectangle, to the rectangle in `to`, on the whole grid. `to` becomes `outside` elsewhere.
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

/// [`Rectangle::around`] for the marked elements in some rows of `mx` elements each.
#[inline(always)]
fn around_in_rows(
    Range { start: mut first_row, end: mut end_row }: Range<usize>,
    mx: usize,
    any: &impl Fn(Range<usize>) -> bool,
) -> Option<Rectangle> {
    let row = |y: usize| y * mx..(y + 1) * mx;
    while first_row < end_row && !any(row(first_row)) {
        first_row += 1;
    }
    if first_row == end_row {
        return None;
    }
    while !any(row(end_row - 1)) {
        end_row -= 1;
    }
    let (mut start, mut end) = (mx, 0);
    for Range { start: row_start, end: row_end } in (first_row..end_row).map(row) {
        // Elements in the columns found so far cannot widen the rectangle and are not tested.
        if any(row_start..row_start + start) {
            start = first_marked(row_start..row_start + start, any) - row_start;
        }
        if any(row_start + end..row_end) {
            end = last_marked(row_start + end..row_end, any) + 1 - row_start;
        }
    }
    Some(Rectangle { x: start..end, y: first_row..end_row })
}

/// The first marked element of a range that has one, by bisection.
#[inline(always)]
fn first_marked(Range { mut start, mut end }: Range<usize>, any: &impl Fn(Range<usize>) -> bool) -> usize {
    while end - start > 1 {
        let middle = (start + end) / 2;
        match any(start..middle) {
            true => end = middle,
            false => start = middle,
        }
    }
    start
}

/// The last marked element of a range that has one, by bisection.
#[inline(always)]
fn last_marked(Range { mut start, mut end }: Range<usize>, any: &impl Fn(Range<usize>) -> bool) -> usize {
    while end - start > 1 {
        let middle = (start + end) / 2;
        match any(middle..end) {
            true => start = middle,
            false => end = middle,
        }
    }
    start
}
