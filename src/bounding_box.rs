//! The part of a grid outside of which nothing counts.

use std::ops::Range;

use crate::blocks;
use crate::grid::Grid;
use crate::threads::Threads;

/// Columns and rows.
#[derive(Clone, Copy)]
struct Corners {
    x: (usize, usize),
    y: (usize, usize),
}

/// The columns and the rows outside of which nothing counts: `any` looks at some values of a row together, `counts` at one. None where
/// nothing does.
pub fn bounding_box<A: Sync>(
    values: &[A],
    grid: &Grid,
    threads: &Threads,
    any: impl Fn(&[A]) -> bool + Sync + Send,
    counts: impl Fn(&A) -> bool + Sync + Send,
) -> Option<(Range<usize>, Range<usize>)> {
    let mx = grid.mx;
    let found = blocks::fold(
        grid,
        threads,
        None,
        #[inline(always)]
        |block| in_rows(&values[block.clone()], (mx, block.start / mx), &any, &counts),
        |a: Option<Corners>, b| match (a, b) {
            (Some(a), Some(b)) => Some(a.joined(&b)),
            (a, b) => a.or(b),
        },
    )?;
    Some((found.x.0..found.x.1, found.y.0..found.y.1))
}

impl Corners {
    fn joined(&self, other: &Corners) -> Corners {
        let join = |a: (usize, usize), b: (usize, usize)| (a.0.min(b.0), a.1.max(b.1));
        Corners { x: join(self.x, other.x), y: join(self.y, other.y) }
    }
}

/// Those of some rows, of `mx` values each, the first of which is `first_row` of the grid.
#[inline(always)]
fn in_rows<A>(
    values: &[A],
    (mx, first_row): (usize, usize),
    any: &impl Fn(&[A]) -> bool,
    counts: &impl Fn(&A) -> bool,
) -> Option<Corners> {
    let row = |y: usize| &values[y * mx..(y + 1) * mx];
    let (mut first, mut end_of_rows) = (0, values.len() / mx);
    while first < end_of_rows && !any(row(first)) {
        first += 1;
    }
    if first == end_of_rows {
        return None;
    }
    while !any(row(end_of_rows - 1)) {
        end_of_rows -= 1;
    }
    let (mut start, mut end) = (mx, 0);
    for row in (first..end_of_rows).map(row) {
        // Only what lies outside the columns so far is looked at.
        if any(&row[..start]) {
            start = row.iter().position(counts).unwrap_or(start);
        }
        if any(&row[end..]) {
            end = row.iter().rposition(counts).map_or(end, |last| last + 1);
        }
    }
    Some(Corners { x: (start, end), y: (first_row + first, first_row + end_of_rows) })
}
