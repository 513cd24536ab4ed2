//! The passes of the extension over a row of the grid, with sums over boxes of elements.
//!
//! They are compiled for the vectors of this machine; no bit depends on them. They work on chunks of a row, and skip those far from the rim of
//! C.

use crate::operator::fft::Real;

/// Elements of a box in each direction.
pub(super) const BOX: usize = 2 * REACH + 1;
pub(super) const REACH: usize = 4;
/// Elements of a row that are worked on together, or not at all where they are far from the rim of C.
pub(super) const CHUNK: usize = 64;

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
        let here = contact[y * mx..][..mx].chunks(CHUNK);
        for (k, ((near, rim), inside)) in near.chunks_mut(CHUNK).zip(rim).zip(here).enumerate() {
            let counts = box_sums(contact, (y, mx), k * CHUNK, u8::from);
            let mut any = 0;
            for ((near, count), inside) in near.iter_mut().zip(&counts).zip(inside) {
                *near = if *inside { 0 } else { *count };
                any |= *near;
            }
            *rim = any != 0;
        }
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
        for (k, ((values, near), rim)) in values.chunks_mut(CHUNK).zip(near.chunks(CHUNK)).zip(rim).enumerate() {
            if *rim {
                let sums = box_sums(z, (y, mx), k * CHUNK, |z| z);
                for ((value, near), sum) in values.iter_mut().zip(near).zip(&sums) {
                    *value += share(*near, absent) * *sum;
                }
            }
        }
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
        for (k, values) in values.chunks_mut(CHUNK).enumerate() {
            let near = k.saturating_sub(1)..chunks.min(k + 2);
            if rim[rows.clone()].chunks_exact(chunks).any(|rim| rim[near.clone()].contains(&true)) {
                let sums = box_sums(shares, (y, mx), k * CHUNK, |share| share);
                values.iter_mut().zip(&sums).for_each(|(value, sum)| *value += *sum);
            }
        }
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

/// Sums over the boxes around the elements of row y, `mx` of them in a row, from column `start` on; `value` makes them of what the grid
/// holds. They are right as far as the row goes.
#[inline(always)]
fn box_sums<A: Copy, B: Copy + Default + std::ops::Add<Output = B>>(
    from: &[A],
    (y, mx): (usize, usize),
    start: usize,
    value: impl Fn(A) -> B,
) -> [B; CHUNK] {
    const LENGTH: usize = CHUNK + BOX - 1;
    let rows = from[y.saturating_sub(REACH) * mx..from.len().min((y + REACH + 1) * mx)].chunks_exact(mx);
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
    // Columns move to their place in the box; those beyond the row are zero.
    let (up, down) = ((first + REACH).saturating_sub(start), start.saturating_sub(first + REACH));
    if up + down > 0 {
        let summed = columns;
        columns = [B::default(); LENGTH];
        columns[up..LENGTH - down].copy_from_slice(&summed[down..LENGTH - up]);
    }
    let mut sums = [B::default(); CHUNK];
    for (k, sum) in sums.iter_mut().enumerate() {
        let of = |i: usize| columns[k + i];
        *sum = (((of(0) + of(1)) + (of(2) + of(3))) + ((of(4) + of(5)) + (of(6) + of(7)))) + of(8);
    }
    sums
}
