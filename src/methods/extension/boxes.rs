//! The loops of the extension over a few rows, with sums over boxes of elements.
//!
//! The loops are compiled for the vector instructions of this machine, on which no bit depends. They divide each row into chunks and skip chunks far
//! from the boundary of C.

use std::ops::Range;

use super::summand::{Sum, Summand};
use crate::operator::fft::Real;

/// The number of elements of a box in each direction.
pub(super) const BOX: usize = 2 * REACH + 1;
/// The number of elements by which a box extends to each side of its element.
pub(super) const REACH: usize = 4;
/// The number of elements of a row that are processed together, a chunk.
pub(super) const CHUNK: usize = 64;
/// The number of rows that are processed together. Their boxes overlap largely, and common sums are computed once.
pub(super) const ROWS: usize = 4;
/// The number of chunks that are summed together in three stages: sums over columns for all chunks, sums over three neighbouring columns, sums across
/// the box. If the stages of one chunk followed each other directly, each load that overlaps two recent stores would wait until these are in the
/// cache.
const TOGETHER: usize = 2;
/// The number of columns that the boxes of a chunk cover.
const LENGTH: usize = CHUNK + BOX - 1;

/// Counts the elements of C in the box around each element of some rows; 0 for an element of C.
pub(super) struct Count<'a, A, F> {
    /// One value for each element of the grid.
    pub(super) values: &'a [A],
    /// Whether an element with this value is in C.
    pub(super) is_inside: F,
    /// The number of elements of a row.
    pub(super) mx: usize,
    /// The first row.
    pub(super) y: usize,
    /// Output: the counts of these rows.
    pub(super) near: &'a mut [u16],
    /// Output: whether a count in the chunk is positive.
    pub(super) rim: &'a mut [bool],
}

impl<A: Copy, F: Fn(A) -> bool> pulp::NullaryFnOnce for Count<'_, A, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Count { values, is_inside, mx, y, near, rim } = self;
        let (rows, chunks, here) = (near.len() / mx, mx.div_ceil(CHUNK), &values[y * mx..]);
        box_sums(
            (values, mx),
            y..y + rows,
            #[inline(always)]
            |value| u8::from(is_inside(value)),
            #[inline(always)]
            |_, _| true,
            #[inline(always)]
            |row, k, elements, counts| {
                let mut any = 0;
                for ((near, sum), value) in near[elements.clone()].iter_mut().zip(counts).zip(&here[elements]) {
                    *near = if is_inside(*value) { 0 } else { u16::from(*sum) };
                    any |= *near;
                }
                rim[row * chunks + k] = any != 0;
            },
        );
    }
}

/// Computes some rows of E z.
pub(super) struct Extend<'a, T> {
    /// z on the whole grid, zero outside C.
    pub(super) z: &'a [T],
    pub(super) mx: usize,
    pub(super) y: usize,
    /// The counts of [`Count`], from the first row on.
    pub(super) near: &'a [u16],
    /// The chunks with positive counts, from the first row on.
    pub(super) rim: &'a [bool],
    /// The number c.
    pub(super) absent: T,
    /// Output: these rows of E z.
    pub(super) values: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Extend<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Extend { z, mx, y, near, rim, absent, values } = self;
        let (rows, chunks) = (values.len() / mx, mx.div_ceil(CHUNK));
        values.copy_from_slice(&z[y * mx..y * mx + values.len()]);
        box_sums(
            (z, mx),
            y..y + rows,
            Sum,
            #[inline(always)]
            |row, k| rim[row * chunks + k],
            #[inline(always)]
            |_, _, elements, sums| {
                for ((value, near), sum) in values[elements.clone()].iter_mut().zip(&near[elements]).zip(sums) {
                    *value += sum.0 * share(*near, absent);
                }
            },
        );
    }
}

/// The first half of E^T, for one row: each element outside C divides its value by n + c. [`Collect`] adds this share to each element of C in the
/// box.
pub(super) struct Share<'a, T> {
    /// The values of this row.
    pub(super) values: &'a [T],
    /// The counts of [`Count`] in this row, and the chunks with positive counts.
    pub(super) near: &'a [u16],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
    /// Output: the shares, 0 for elements of C.
    pub(super) shares: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Share<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Share { values, near, rim, absent, shares } = self;
        let chunks = shares.chunks_mut(CHUNK).zip(near.chunks(CHUNK)).zip(values.chunks(CHUNK));
        for (((shares, near), values), rim) in chunks.zip(rim) {
            if !*rim {
                shares.fill(T::zero());
                continue;
            }
            for ((to, value), near) in shares.iter_mut().zip(values).zip(near) {
                *to = *value * share(*near, absent);
            }
        }
    }
}

/// The second half of E^T, for some rows: adds to each element the shares in the box around it. The result is right for elements of C.
pub(super) struct Collect<'a, T> {
    /// The shares on the whole grid.
    pub(super) shares: &'a [T],
    pub(super) mx: usize,
    pub(super) y: usize,
    /// The chunks of the whole grid with positive counts: only these have shares.
    pub(super) rim: &'a [bool],
    /// The values of these rows, to which the shares are added.
    pub(super) values: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Collect<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Collect { shares, mx, y, rim, values } = self;
        let (count, chunks) = (values.len() / mx, mx.div_ceil(CHUNK));
        // A chunk is skipped if neither it nor its neighbours have shares in any row of the boxes.
        let rows = y.saturating_sub(REACH) * chunks..rim.len().min((y + count + REACH) * chunks);
        box_sums(
            (shares, mx),
            y..y + count,
            Sum,
            #[inline(always)]
            |_, k| {
                let near = k.saturating_sub(1)..chunks.min(k + 2);
                rim[rows.clone()].chunks_exact(chunks).any(|rim| rim[near.clone()].contains(&true))
            },
            #[inline(always)]
            |_, _, elements, sums| {
                values[elements].iter_mut().zip(sums).for_each(|(value, sum)| *value += sum.0);
            },
        );
    }
}

/// `1/(n + c)`, or 0 if n = `near` is 0.
#[inline(always)]
fn share<T: Real>(near: u16, absent: T) -> T {
    let part = T::one() / (T::from_u16(near).unwrap_or_default() + absent);
    if near > 0 {
        part
    } else {
        T::zero()
    }
}

/// Computes the sums over the boxes around the elements of at most [`ROWS`] rows of a grid, which has `mx` elements in each row.
///
/// - `value` maps a value of the grid to its term in the sums.
/// - `wanted(row, chunk)` tells whether the sums of a chunk are needed. Rows are counted from the first of `rows`.
/// - `take(row, chunk, elements, sums)` receives the sums of a chunk. `elements` are those of the chunk, counted from the first element of `rows`. If
///   the chunk has fewer than [`CHUNK`] elements, the last sums are not valid.
#[inline(always)]
fn box_sums<A: Copy, B: Summand>(
    (from, mx): (&[A], usize),
    rows: Range<usize>,
    value: impl Fn(A) -> B,
    wanted: impl Fn(usize, usize) -> bool,
    mut take: impl FnMut(usize, usize, Range<usize>, &[B; CHUNK]),
) {
    let (chunks, count) = (mx.div_ceil(CHUNK), rows.len());
    let nothing = [[[B::zero(); LENGTH]; ROWS]; TOGETHER];
    let (mut columns, mut threes, mut which) = (nothing, nothing, [0; TOGETHER]);
    for first in (0..chunks).step_by(TOGETHER) {
        let mut some = 0;
        for k in first..chunks.min(first + TOGETHER) {
            if (0..count).any(|row| wanted(row, k)) {
                columns[some] = column_sums((from, mx), rows.clone(), k * CHUNK, &value);
                which[some] = k;
                some += 1;
            }
        }
        for (columns, threes) in columns[..some].iter().zip(&mut threes) {
            columns[..count].iter().zip(threes).for_each(|(columns, threes)| *threes = sums_of_three(columns));
        }
        for (&k, threes) in which[..some].iter().zip(&threes) {
            for row in (0..count).filter(|row| wanted(*row, k)) {
                let elements = row * mx + k * CHUNK..row * mx + mx.min((k + 1) * CHUNK);
                take(row, k, elements, &sums_across(&threes[row]));
            }
        }
    }
}

/// For each of some rows: the sums over the columns of the boxes, from the column `start` - [`REACH`] on. Sums of columns outside of the grid are
/// zero.
#[inline(always)]
fn column_sums<A: Copy, B: Summand>(
    (from, mx): (&[A], usize),
    rows: Range<usize>,
    start: usize,
    value: impl Fn(A) -> B,
) -> [[B; LENGTH]; ROWS] {
    let my = from.len() / mx;
    let mut columns = [[B::zero(); LENGTH]; ROWS];
    let first = start.saturating_sub(REACH).min(mx.saturating_sub(LENGTH));
    if mx >= LENGTH && rows.len() == ROWS && rows.start >= REACH && rows.end + REACH <= my {
        let row = |k: usize| &from[(rows.start - REACH + k) * mx + first..][..LENGTH];
        columns = sums_of_four(std::array::from_fn(row), value);
    } else {
        for (y, columns) in rows.zip(&mut columns) {
            let rows = &from[y.saturating_sub(REACH) * mx..my.min(y + REACH + 1) * mx];
            for row in rows.chunks_exact(mx) {
                let row = &row[first..mx.min(first + LENGTH)];
                columns.iter_mut().zip(row).for_each(|(sum, from)| *sum = sum.plus(value(*from)));
            }
        }
    }
    // `columns` begins at the column `first` of the grid. It is shifted so that it begins at `start - REACH`.
    let (up, down) = ((first + REACH).saturating_sub(start), start.saturating_sub(first + REACH));
    if up + down > 0 {
        for columns in &mut columns {
            let summed = *columns;
            *columns = [B::zero(); LENGTH];
            columns[up..LENGTH - down].copy_from_slice(&summed[down..LENGTH - up]);
        }
    }
    columns
}

/// Four sums over nine consecutive rows, which start at the first, second, third and fourth row. The six rows that all four sums share are added
/// once.
#[inline(always)]
fn sums_of_four<A: Copy, B: Summand>(rows: [&[A]; ROWS - 1 + BOX], value: impl Fn(A) -> B) -> [[B; LENGTH]; ROWS] {
    let (rows, mut sums) = (rows.map(|row| &row[..LENGTH]), [[B::zero(); LENGTH]; ROWS]);
    for i in 0..LENGTH {
        let of = |k: usize| value(rows[k][i]);
        let shared = of(3).plus(of(4)).plus(of(5).plus(of(6))).plus(of(7).plus(of(8)));
        let (before, after) = (of(1).plus(of(2)), of(9).plus(of(10)));
        sums[0][i] = shared.plus(of(0).plus(before));
        sums[1][i] = shared.plus(before.plus(of(9)));
        sums[2][i] = shared.plus(of(2).plus(after));
        sums[3][i] = shared.plus(after.plus(of(11)));
    }
    sums
}

/// Sums over three neighbouring columns, from each column on. The last two values are not valid.
#[inline(always)]
fn sums_of_three<B: Summand>(columns: &[B; LENGTH]) -> [B; LENGTH] {
    let mut sums = *columns;
    for (k, sum) in sums[..LENGTH - 2].iter_mut().enumerate() {
        *sum = columns[k].plus(columns[k + 1]).plus(columns[k + 2]);
    }
    sums
}

/// Sums over [`BOX`] = 9 neighbouring columns, each from three sums over three columns.
#[inline(always)]
fn sums_across<B: Summand>(threes: &[B; LENGTH]) -> [B; CHUNK] {
    let mut sums = [B::zero(); CHUNK];
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = threes[k].plus(threes[k + 3]).plus(threes[k + 6]);
    }
    sums
}
