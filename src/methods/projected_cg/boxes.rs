//! The passes of the extension over a row of the grid, with sums over boxes of elements.
//!
//! They are compiled for the vectors of this machine; no bit depends on them. They work on chunks of a row, and skip those far from the rim of
//! C.

use std::ops::Range;

use crate::operator::fft::Real;

/// Elements of a box in each direction.
pub(super) const BOX: usize = 2 * REACH + 1;
pub(super) const REACH: usize = 4;
/// Elements of a row that are worked on together, or not at all where they are far from the rim of C.
pub(super) const CHUNK: usize = 64;
/// Chunks whose columns are summed before the first of them is summed across: what was just written in one vector cannot be read in another.
const TOGETHER: usize = 8;
/// Columns of a chunk's boxes.
const LENGTH: usize = CHUNK + BOX - 1;

/// The counts of row y.
pub(super) struct Count<'a> {
    pub(super) contact: &'a [bool],
    pub(super) y: usize,
    pub(super) near: &'a mut [u8],
    pub(super) rim: &'a mut [bool],
}

impl pulp::NullaryFnOnce for Count<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Count { contact, y, near, rim } = self;
        let mx = near.len();
        let here = &contact[y * mx..][..mx];
        box_sums(
            (contact, mx),
            y,
            u8::from,
            #[inline(always)]
            |_| true,
            #[inline(always)]
            |k, elements, counts| {
                let mut any = 0;
                for ((near, count), inside) in near[elements.clone()].iter_mut().zip(counts).zip(&here[elements]) {
                    *near = if *inside { 0 } else { *count };
                    any |= *near;
                }
                rim[k] = any != 0;
            },
        );
    }
}

/// Row y of E z.
pub(super) struct Extend<'a, T> {
    pub(super) z: &'a [T],
    pub(super) y: usize,
    pub(super) near: &'a [u8],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
    pub(super) values: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Extend<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Extend { z, y, near, rim, absent, values } = self;
        let mx = values.len();
        values.copy_from_slice(&z[y * mx..][..mx]);
        box_sums(
            (z, mx),
            y,
            |z| z,
            #[inline(always)]
            |k| rim[k],
            #[inline(always)]
            |_, elements, sums| {
                for ((value, near), sum) in values[elements.clone()].iter_mut().zip(&near[elements]).zip(sums) {
                    *value += share(*near, absent) * *sum;
                }
            },
        );
    }
}

/// What elements outside pass on to each of C that is near them.
pub(super) struct Share<'a, T> {
    pub(super) values: &'a [T],
    pub(super) near: &'a [u8],
    pub(super) rim: &'a [bool],
    pub(super) absent: T,
    pub(super) shares: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Share<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Share { values, near, rim, absent, shares } = self;
        let parts = shares.chunks_mut(CHUNK).zip(values.chunks(CHUNK)).zip(near.chunks(CHUNK));
        for (((shares, values), near), rim) in parts.zip(rim) {
            if *rim {
                for ((z, value), near) in shares.iter_mut().zip(values).zip(near) {
                    *z = share(*near, absent) * *value;
                }
            } else {
                shares.fill(T::zero());
            }
        }
    }
}

/// What elements of C in row y get.
pub(super) struct Collect<'a, T> {
    pub(super) shares: &'a [T],
    pub(super) y: usize,
    pub(super) rim: &'a [bool],
    pub(super) values: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Collect<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Collect { shares, y, rim, values } = self;
        let mx = values.len();
        let chunks = mx.div_ceil(CHUNK);
        let rows = y.saturating_sub(REACH) * chunks..rim.len().min((y + REACH + 1) * chunks);
        box_sums(
            (shares, mx),
            y,
            |share| share,
            #[inline(always)]
            |k| {
                let near = k.saturating_sub(1)..chunks.min(k + 2);
                rim[rows.clone()].chunks_exact(chunks).any(|rim| rim[near.clone()].contains(&true))
            },
            #[inline(always)]
            |_, elements, sums| values[elements].iter_mut().zip(sums).for_each(|(value, sum)| *value += *sum),
        );
    }
}

/// `1/(n + c)`; 0 where n is.
#[inline(always)]
fn share<T: Real>(near: u8, absent: T) -> T {
    let part = T::one() / (T::from_u8(near).unwrap_or_default() + absent);
    if near > 0 {
        part
    } else {
        T::zero()
    }
}

/// Sums over the boxes around the elements of row y of a grid, `mx` of them in a row, for those chunks that are `wanted`; `value` makes them
/// of what the grid holds. Calls `take(chunk, its elements in the row, sums)`; sums beyond the elements have no meaning.
#[inline(always)]
fn box_sums<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    (from, mx): (&[A], usize),
    y: usize,
    value: impl Fn(A) -> B,
    wanted: impl Fn(usize) -> bool,
    mut take: impl FnMut(usize, Range<usize>, &[B; CHUNK]),
) {
    let rows = &from[y.saturating_sub(REACH) * mx..from.len().min((y + REACH + 1) * mx)];
    let (chunks, mut columns, mut which) = (mx.div_ceil(CHUNK), [[B::default(); LENGTH]; TOGETHER], [0; TOGETHER]);
    for first in (0..chunks).step_by(TOGETHER) {
        let mut count = 0;
        for k in first..chunks.min(first + TOGETHER) {
            if wanted(k) {
                columns[count] = column_sums(rows, mx, k * CHUNK, &value);
                which[count] = k;
                count += 1;
            }
        }
        for (&k, columns) in which[..count].iter().zip(&columns) {
            take(k, k * CHUNK..mx.min((k + 1) * CHUNK), &sums_across(columns));
        }
    }
}

/// Sums over the columns of boxes, from [`REACH`] before column `start` on; those beyond the row are zero.
#[inline(always)]
fn column_sums<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    rows: &[A],
    mx: usize,
    start: usize,
    value: impl Fn(A) -> B,
) -> [B; LENGTH] {
    let rows = rows.chunks_exact(mx);
    let mut columns = [B::default(); LENGTH];
    let first = start.saturating_sub(REACH).min(mx.saturating_sub(LENGTH));
    if mx >= LENGTH {
        // A loop of known length.
        for row in rows {
            let row: &[A] = &row[first..][..LENGTH];
            columns.iter_mut().zip(row).for_each(|(sum, from)| *sum = *sum + value(*from));
        }
    } else {
        for row in rows {
            columns.iter_mut().zip(row).for_each(|(sum, from)| *sum = *sum + value(*from));
        }
    }
    // Columns move to their place in the box.
    let (up, down) = ((first + REACH).saturating_sub(start), start.saturating_sub(first + REACH));
    if up + down > 0 {
        let summed = columns;
        columns = [B::default(); LENGTH];
        columns[up..LENGTH - down].copy_from_slice(&summed[down..LENGTH - up]);
    }
    columns
}

/// Sums of [`BOX`] neighbouring columns.
#[inline(always)]
fn sums_across<B: Copy + Default + std::ops::Add<Output = B>>(columns: &[B; LENGTH]) -> [B; CHUNK] {
    let mut sums = [B::default(); CHUNK];
    for (k, sum) in sums.iter_mut().enumerate() {
        let of = |i: usize| columns[k + i];
        *sum = (((of(0) + of(1)) + (of(2) + of(3))) + ((of(4) + of(5)) + (of(6) + of(7)))) + of(8);
    }
    sums
}
