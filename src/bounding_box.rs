//! The part of a grid outside of which nothing counts.

use std::ops::Range;

use crate::blocks;
use crate::grid::Grid;
use crate::threads::Threads;

/// Columns and rows.
pub type Part = (Range<usize>, Range<usize>);

/// The columns and the rows outside of which nothing counts: `any` looks at some values of a row together, `counts` at one. None where
/// nothing does.
pub fn bounding_box<A: Sync>(
    values: &[A],
    grid: &Grid,
    threads: &Threads,
    any: impl Fn(&[A]) -> bool + Sync + Send,
    counts: impl Fn(&A) -> bool + Sync + Send,
) -> Option<Part> {
    let mx = grid.mx;
    blocks::fold(
        grid,
        threads,
        None,
        #[inline(always)]
        |block| in_rows(&values[block.clone()], (mx, block.start / mx), &any, &counts),
        joined,
    )
}

/// The box of two.
pub fn joined(a: Option<Part>, b: Option<Part>) -> Option<Part> {
    let join = |a: Range<usize>, b: Range<usize>| a.start.min(b.start)..a.end.max(b.end);
    match (a, b) {
        (Some(a), Some(b)) => Some((join(a.0, b.0), join(a.1, b.1))),
        (a, b) => a.or(b),
    }
}

/// Those of some rows, of `mx` values each, the first of which is `first_row` of the grid.
#[inline(always)]
fn in_rows<A>(
    values: &[A],
    (mx, first_row): (usize, usize),
    any: &impl Fn(&[A]) -> bool,
    counts: &impl Fn(&A) -> bool,
) -> Option<Part> {
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
    Some((start..end, first_row + first..first_row + end_of_rows))
}
