//! The passes of the extension over some rows of cells, with sums over boxes of cells. A cell is S x S elements.
//!
//! They are compiled for the vectors of this machine; no bit depends on them. They work on chunks of a row, and skip those far from the rim of
//! C.

use std::ops::Range;

use super::cells::{for_its_elements, sums_of_cells};
use crate::operator::fft::Real;

/// Cells of a box in each direction.
pub(super) const BOX: usize = 2 * REACH + 1;
pub(super) const REACH: usize = 4;
/// Cells of a row that are worked on together, or not at all where they are far from the rim of C.
pub(super) const CHUNK: usize = 64;
/// Rows that are worked on together: they share much of their boxes.
pub(super) const ROWS: usize = 4;
/// Chunks whose columns are summed, then by threes, before the first of them is summed across: what was just written in one vector cannot be
/// read in another.
const TOGETHER: usize = 2;
/// Columns of a chunk's boxes.
const LENGTH: usize = CHUNK + BOX - 1;

/// The counts of rows of cells from y on, from those of the cells themselves.
pub(super) struct Count<'a, A, F, const S: usize> {
    pub(super) inside: &'a [A],
    /// How many elements of a cell are in C: of a type that has room for those of a box.
    pub(super) count: F,
    pub(super) mx: usize,
    pub(super) y: usize,
    pub(super) near: &'a mut [u16],
    pub(super) rim: &'a mut [bool],
}

impl<A, B, F, const S: usize> pulp::NullaryFnOnce for Count<'_, A, F, S>
where
    A: Copy,
    B: Copy + Default + Into<u16> + std::ops::Add<Output = B>,
    F: Fn(A) -> B,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Count { inside, count, mx, y, near, rim } = self;
        let (rows, chunks, here) = (near.len() / mx, mx.div_ceil(CHUNK), &inside[y * mx..]);
        box_sums(
            (inside, mx),
            y..y + rows,
            &count,
            #[inline(always)]
            |_, _| true,
            #[inline(always)]
            |row, k, cells, counts| {
                let mut any = 0;
                for ((near, sum), inside) in near[cells.clone()].iter_mut().zip(counts).zip(&here[cells]) {
                    *near = if usize::from(count(*inside).into()) == S * S { 0 } else { (*sum).into() };
                    any |= *near;
                }
                rim[row * chunks + k] = any != 0;
            },
        );
    }
}

/// Rows of E z, from row y of cells on.
pub(super) struct Extend<'a, T, const S: usize> {
    /// Of whole cells.
    pub(super) sums: &'a [T],
    /// Elements of a row, and cells.
    pub(super) mx: (usize, usize),
    pub(super) y: usize,
    pub(super) near: &'a [u16],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
    /// z and C of these rows of elements.
    pub(super) z: &'a [T],
    pub(super) contact: &'a [bool],
    pub(super) values: &'a mut [T],
}

impl<T: Real, const S: usize> pulp::NullaryFnOnce for Extend<'_, T, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Extend { sums, mx: (mx, cells), y, near, rim, absent, z, contact, values } = self;
        let (rows, chunks) = (values.len().div_ceil(mx * S), cells.div_ceil(CHUNK));
        values.copy_from_slice(z);
        box_sums(
            (sums, cells),
            y..y + rows,
            |sum| sum,
            #[inline(always)]
            |row, k| rim[row * chunks + k],
            #[inline(always)]
            |row, k, cells, sums| {
                let mut outside = [T::zero(); CHUNK];
                for ((outside, near), sum) in outside.iter_mut().zip(&near[cells]).zip(sums) {
                    *outside = share(*near, absent) * *sum;
                }
                for_its_elements::<_, S>(&outside, (row, k), (values.len(), mx), |elements, outside| {
                    if S == 1 {
                        return values[elements]
                            .iter_mut()
                            .zip(outside)
                            .for_each(|(value, outside)| *value += *outside);
                    }
                    let inside = &contact[elements.clone()];
                    for ((value, inside), outside) in values[elements].iter_mut().zip(inside).zip(outside) {
                        *value = if *inside { *value } else { *outside };
                    }
                });
            },
        );
    }
}

/// What the elements outside C in a row of cells pass on to each of C that is near them.
pub(super) struct Share<'a, T, const S: usize> {
    /// Of this row of cells.
    pub(super) values: &'a [T],
    pub(super) contact: &'a [bool],
    pub(super) mx: usize,
    pub(super) near: &'a [u16],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
    pub(super) shares: &'a mut [T],
}

impl<T: Real, const S: usize> pulp::NullaryFnOnce for Share<'_, T, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Share { values, contact, mx, near, rim, absent, shares } = self;
        for (k, ((shares, near), rim)) in shares.chunks_mut(CHUNK).zip(near.chunks(CHUNK)).zip(rim).enumerate() {
            if !*rim {
                shares.fill(T::zero());
                continue;
            }
            if S == 1 {
                let values = &values[k * CHUNK..][..shares.len()];
                for ((z, value), near) in shares.iter_mut().zip(values).zip(near) {
                    *z = share(*near, absent) * *value;
                }
                continue;
            }
            let outside = |value, inside| if inside { T::zero() } else { value };
            let sums = sums_of_cells::<_, _, S>((values, contact, mx), k, outside);
            for ((z, near), sum) in shares.iter_mut().zip(near).zip(&sums) {
                *z = share(*near, absent) * *sum;
            }
        }
    }
}

/// What elements of C get, from row y of cells on.
pub(super) struct Collect<'a, T, const S: usize> {
    pub(super) shares: &'a [T],
    /// Elements of a row, and cells.
    pub(super) mx: (usize, usize),
    pub(super) y: usize,
    pub(super) rim: &'a [bool],
    pub(super) values: &'a mut [T],
}

impl<T: Real, const S: usize> pulp::NullaryFnOnce for Collect<'_, T, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Collect { shares, mx: (mx, cells), y, rim, values } = self;
        let (count, chunks) = (values.len().div_ceil(mx * S), cells.div_ceil(CHUNK));
        // Of all rows together: nothing is collected from chunks that have nothing to give.
        let rows = y.saturating_sub(REACH) * chunks..rim.len().min((y + count + REACH) * chunks);
        box_sums(
            (shares, cells),
            y..y + count,
            |share| share,
            #[inline(always)]
            |_, k| {
                let near = k.saturating_sub(1)..chunks.min(k + 2);
                rim[rows.clone()].chunks_exact(chunks).any(|rim| rim[near.clone()].contains(&true))
            },
            #[inline(always)]
            |row, k, _, sums| {
                for_its_elements::<_, S>(sums, (row, k), (values.len(), mx), |elements, sums| {
                    values[elements].iter_mut().zip(sums).for_each(|(value, sum)| *value += *sum);
                });
            },
        );
    }
}

/// `1/(n + c)`; 0 where n is.
#[inline(always)]
fn share<T: Real>(near: u16, absent: T) -> T {
    let part = T::one() / (T::from_u16(near).unwrap_or_default() + absent);
    if near > 0 {
        part
    } else {
        T::zero()
    }
}

/// Sums over the boxes around the cells of some rows of a grid, up to [`ROWS`], `mx` cells in each, for those chunks that are
/// `wanted(row, chunk)`; `value` makes them of what the grid holds. Calls `take(row, chunk, its cells among those of the rows, sums)`, rows
/// counted from the first; sums beyond the cells have no meaning.
#[inline(always)]
fn box_sums<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    (from, mx): (&[A], usize),
    rows: Range<usize>,
    value: impl Fn(A) -> B,
    wanted: impl Fn(usize, usize) -> bool,
    mut take: impl FnMut(usize, usize, Range<usize>, &[B; CHUNK]),
) {
    let (chunks, count) = (mx.div_ceil(CHUNK), rows.len());
    let nothing = [[[B::default(); LENGTH]; ROWS]; TOGETHER];
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
                let cells = row * mx + k * CHUNK..row * mx + mx.min((k + 1) * CHUNK);
                take(row, k, cells, &sums_across(&threes[row]));
            }
        }
    }
}

/// Sums over the columns of boxes, from [`REACH`] before column `start` on, for each of some rows; those beyond the row are zero.
#[inline(always)]
fn column_sums<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    (from, mx): (&[A], usize),
    rows: Range<usize>,
    start: usize,
    value: impl Fn(A) -> B,
) -> [[B; LENGTH]; ROWS] {
    let my = from.len() / mx;
    let mut columns = [[B::default(); LENGTH]; ROWS];
    let first = start.saturating_sub(REACH).min(mx.saturating_sub(LENGTH));
    if mx >= LENGTH && rows.len() == ROWS && rows.start >= REACH && rows.end + REACH <= my {
        let row = |k: usize| &from[(rows.start - REACH + k) * mx + first..][..LENGTH];
        columns = sums_of_four(std::array::from_fn(row), value);
    } else {
        for (y, columns) in rows.zip(&mut columns) {
            let rows = &from[y.saturating_sub(REACH) * mx..my.min(y + REACH + 1) * mx];
            for row in rows.chunks_exact(mx) {
                let row = &row[first..mx.min(first + LENGTH)];
                columns.iter_mut().zip(row).for_each(|(sum, from)| *sum = *sum + value(*from));
            }
        }
    }
    // Columns move to their place in the box.
    let (up, down) = ((first + REACH).saturating_sub(start), start.saturating_sub(first + REACH));
    if up + down > 0 {
        for columns in &mut columns {
            let summed = *columns;
            *columns = [B::default(); LENGTH];
            columns[up..LENGTH - down].copy_from_slice(&summed[down..LENGTH - up]);
        }
    }
    columns
}

/// Sums of nine rows each, from the first of these, the second, .. on: what all four have is summed once.
#[inline(always)]
fn sums_of_four<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    rows: [&[A]; ROWS - 1 + BOX],
    value: impl Fn(A) -> B,
) -> [[B; LENGTH]; ROWS] {
    let (rows, mut sums) = (rows.map(|row| &row[..LENGTH]), [[B::default(); LENGTH]; ROWS]);
    for i in 0..LENGTH {
        let of = |k: usize| value(rows[k][i]);
        let all = ((of(3) + of(4)) + (of(5) + of(6))) + (of(7) + of(8));
        let (before, behind) = (of(1) + of(2), of(9) + of(10));
        sums[0][i] = all + (of(0) + before);
        sums[1][i] = all + (before + of(9));
        sums[2][i] = all + (of(2) + behind);
        sums[3][i] = all + (behind + of(11));
    }
    sums
}

/// Sums of three neighbouring columns; the last two have no meaning.
#[inline(always)]
fn sums_of_three<B: Copy + Default + std::ops::Add<Output = B>>(columns: &[B; LENGTH]) -> [B; LENGTH] {
    let mut sums = *columns;
    for (k, sum) in sums[..LENGTH - 2].iter_mut().enumerate() {
        *sum = (columns[k] + columns[k + 1]) + columns[k + 2];
    }
    sums
}

/// Sums of [`BOX`] neighbouring columns, of those of three.
#[inline(always)]
fn sums_across<B: Copy + Default + std::ops::Add<Output = B>>(threes: &[B; LENGTH]) -> [B; CHUNK] {
    let mut sums = [B::default(); CHUNK];
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = (threes[k] + threes[k + 3]) + threes[k + 6];
    }
    sums
}
