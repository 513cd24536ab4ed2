//! The passes of the extension over some rows, with sums over boxes of elements.
//!
//! They are compiled for the vector instructions of this machine, on which no bit depends. They work on chunks of a row and skip chunks far from the
//! boundary of C.

use std::ops::Range;

use super::summand::{Sum, Summand};
use crate::operator::fft::Real;

/// Elements of a box in each direction.
pub(super) const BOX: usize = 2 * REACH + 1;
pub(super) const REACH: usize = 4;
/// Elements of a row that are processed together. A chunk far from the boundary of C is skipped.
pub(super) const CHUNK: usize = 64;
/// Rows that are processed together. Their boxes overlap largely.
pub(super) const ROWS: usize = 4;
/// Chunks that are summed together: first the columns of all, then threes of these, then across. If each chunk were
/// summed at once, loads that overlap two recent stores would stall until these are in the cache.
const TOGETHER: usize = 2;
/// Columns of a chunk's boxes.
const LENGTH: usize = CHUNK + BOX - 1;

/// The elements of C in the boxes of rows from y on; 0 where an element is in C.
pub(super) struct Count<'a, A, F> {
    pub(super) values: &'a [A],
    /// Whether an element of this value is in C.
    pub(super) is_inside: F,
    pub(super) mx: usize,
    pub(super) y: usize,
    pub(super) near: &'a mut [u16],
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

/// Rows of E z, from row y on.
pub(super) struct Extend<'a, T> {
    pub(super) z: &'a [T],
    pub(super) mx: usize,
    pub(super) y: usize,
    pub(super) near: &'a [u16],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
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

/// The shares that elements outside C in a row give to nearby elements of C.
pub(super) struct Share<'a, T> {
    /// The values of this row.
    pub(super) values: &'a [T],
    pub(super) near: &'a [u16],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
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

/// The sums for elements of C, from row y on.
pub(super) struct Collect<'a, T> {
    pub(super) shares: &'a [T],
    pub(super) mx: usize,
    pub(super) y: usize,
    pub(super) rim: &'a [bool],
    pub(super) values: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Collect<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Collect { shares, mx, y, rim, values } = self;
        let (count, chunks) = (values.len() / mx, mx.div_ceil(CHUNK));
        // Chunks without shares in any of these rows are skipped.
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

/// `1/(n + c)`; 0 if n is 0.
#[inline(always)]
fn share<T: Real>(near: u16, absent: T) -> T {
    let part = T::one() / (T::from_u16(near).unwrap_or_default() + absent);
    if near > 0 {
        part
    } else {
        T::zero()
    }
}

/// Sums over the boxes around the elements of some rows of a grid, up to [`ROWS`], `mx` elements in each, for those chunks that are
/// `wanted(row, chunk)`; `value` maps a value of the grid to its summand. Calls `take(row, chunk, its elements among those of the rows, sums)`,
/// rows counted from the first. Sums beyond the elements are not valid.
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

/// Sums over the columns of boxes, from [`REACH`] before column `start` on, for each of some rows; those beyond the row are zero.
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
    // Shifts the columns to their position in the box.
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

/// Four sums of nine rows, which start at the first, second, third and fourth row. The rows that all four share are summed once.
#[inline(always)]
fn sums_of_four<A: Copy, B: Summand>(rows: [&[A]; ROWS - 1 + BOX], value: impl Fn(A) -> B) -> [[B; LENGTH]; ROWS] {
    let (rows, mut sums) = (rows.map(|row| &row[..LENGTH]), [[B::zero(); LENGTH]; ROWS]);
    for i in 0..LENGTH {
        let of = |k: usize| value(rows[k][i]);
        let all = of(3).plus(of(4)).plus(of(5).plus(of(6))).plus(of(7).plus(of(8)));
        let (before, behind) = (of(1).plus(of(2)), of(9).plus(of(10)));
        sums[0][i] = all.plus(of(0).plus(before));
        sums[1][i] = all.plus(before.plus(of(9)));
        sums[2][i] = all.plus(of(2).plus(behind));
        sums[3][i] = all.plus(behind.plus(of(11)));
    }
    sums
}

/// Sums of three neighbouring columns. The last two values are not valid.
#[inline(always)]
fn sums_of_three<B: Summand>(columns: &[B; LENGTH]) -> [B; LENGTH] {
    let mut sums = *columns;
    for (k, sum) in sums[..LENGTH - 2].iter_mut().enumerate() {
        *sum = columns[k].plus(columns[k + 1]).plus(columns[k + 2]);
    }
    sums
}

/// Sums of [`BOX`] neighbouring columns, from the sums of three.
#[inline(always)]
fn sums_across<B: Summand>(threes: &[B; LENGTH]) -> [B; CHUNK] {
    let mut sums = [B::zero(); CHUNK];
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = threes[k].plus(threes[k + 3]).plus(threes[k + 6]);
    }
    sums
}
