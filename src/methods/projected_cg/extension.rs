//! The residual, extended beyond the contact area.
//!
//! M is the inverse of a circulant near A on the whole grid, and the residual r is known on C only. For every extension E r of r with
//!
//! ```text
//! (E r, M E r) >= (r, (A on C)^-1 r)
//! ```
//!
//! equality holds for the displacement of what would take r away. Zero outside is the worst: a step at the rim has an energy that grows
//! with the number of elements across a piece of C, and a rough surface has much rim. So E r is a mean of what is near,
//!
//! ```text
//! E r = r on C,   (sum over B of r)/(n + c) outside,    B: the box of 9 x 9 elements around, n of them in C, c: an eighth of B
//! ```
//!
//! and E^T M E, symmetric and positive definite for any E, takes the place of M. With a box of 7 or 13, a c of half or twice that, the
//! iterations differ by one. Measured (tolerance 1e-6, iterations on the finest grid, zero outside and now): rough surface by force 512 14
//! and 8, 1024 16 and 9, by approach 512 20 and 11; ellipse by force 512 6 and 3.

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, rest, wake, zeros};
use crate::operator::fft::Real;
use crate::operator::reserve;
use crate::threads::Threads;

/// Elements of a box in each direction.
const BOX: usize = 2 * REACH + 1;
const REACH: usize = 4;
/// c, as a part of a box.
const ABSENT: f64 = 0.125;
/// In the place of a count: an element of C.
const INSIDE: u8 = u8::MAX;

/// E, and the memory for it.
pub(super) struct Extension<T: Real> {
    mx: usize,
    /// c.
    absent: T,
    values: Vec<T>,
    /// Elements of C in each box.
    near: Vec<u8>,
    scratch: Vec<Scratch<T>>,
    threads: Threads,
}

/// Sums of one row, for a thread.
struct Scratch<T> {
    sums: [Vec<T>; 3],
    counts: [Vec<u8>; 3],
}

impl<T: Real> Extension<T> {
    /// Memory for a contact area on `grid`.
    pub fn new(grid: &Grid, threads: &Threads) -> Result<Extension<T>> {
        let what = "the extended residual";
        let (n, length) = (grid.len(), grid.mx + BOX - 1);
        let (mut values, mut near) = (Vec::new(), Vec::new());
        reserve(&mut values, n, what)?;
        reserve(&mut near, n, what)?;
        let scratch = || {
            Ok(Scratch {
                sums: [zeros(length, what)?, zeros(length, what)?, zeros(length, what)?],
                counts: [zeros(length, what)?, zeros(length, what)?, zeros(length, what)?],
            })
        };
        Ok(Extension {
            mx: grid.mx,
            absent: T::of(ABSENT * (BOX.min(grid.mx) * BOX.min(grid.my)) as f64),
            values,
            near,
            scratch: (0..threads.count()).map(|_| scratch()).collect::<Result<_>>()?,
            threads: threads.clone(),
        })
    }

    /// z = E^T M E z; z is zero outside C before, and of no meaning there afterwards.
    pub fn around(&mut self, z: &mut Vec<T>, contact: &[bool], apply: impl FnOnce(&mut [T])) {
        self.extend(z, contact);
        apply(&mut self.values);
        self.collect(z, contact);
        std::mem::swap(z, &mut self.values);
    }

    /// values = E z.
    fn extend(&mut self, z: &[T], contact: &[bool]) {
        let Extension { mx, absent, values, near, scratch, threads } = self;
        let (mx, absent) = (*mx, *absent);
        threads.for_each_row_pair_with((values, mx), (near, mx), scratch, |y, values, near, scratch| {
            let counts = box_sums(contact, (y, mx), &mut scratch.counts, |&inside| u8::from(inside));
            let here = &contact[y * mx..][..mx];
            for ((near, count), inside) in near.iter_mut().zip(counts).zip(here) {
                *near = if *inside { INSIDE } else { *count };
            }
            if !any_near(near) {
                return values.fill(T::zero());
            }
            let sums = box_sums(z, (y, mx), &mut scratch.sums, |z| *z);
            for (((value, z), near), sum) in values.iter_mut().zip(&z[y * mx..]).zip(near).zip(sums) {
                *value = if *near == INSIDE { *z } else { *sum / (count::<T>(*near) + absent) };
            }
        });
    }

    /// values = E^T values on C; z is what it needs of the others.
    fn collect(&mut self, z: &mut [T], contact: &[bool]) {
        let Extension { mx, absent, values, near, scratch, threads } = self;
        let (mx, absent) = (*mx, *absent);
        threads.for_each_plain_row(z, mx, |y, z| {
            let near = &near[y * mx..][..mx];
            if !any_near(near) {
                return z.fill(T::zero());
            }
            for ((z, value), near) in z.iter_mut().zip(&values[y * mx..]).zip(near) {
                *z = if *near == INSIDE { T::zero() } else { *value / (count::<T>(*near) + absent) };
            }
        });
        threads.for_each_row(values, mx, scratch, |y, values, scratch| {
            let contact = &contact[y * mx..][..mx];
            if !contact.contains(&true) {
                return;
            }
            let sums = box_sums(z, (y, mx), &mut scratch.sums, |z| *z);
            for ((value, sum), inside) in values.iter_mut().zip(sums).zip(contact) {
                *value = if *inside { *value + *sum } else { *value };
            }
        });
    }

    /// It is not needed for a while.
    pub fn rest(&mut self) {
        rest(&mut self.values);
        rest(&mut self.near);
    }

    /// Before it is used, at first or again, on a grid of n elements.
    pub fn wake(&mut self, n: usize) {
        wake(&mut self.values, n, T::zero());
        wake(&mut self.near, n, 0);
    }

    /// Bytes held, for n elements.
    pub fn bytes(&self, n: usize) -> usize {
        n * (size_of::<T>() + 1)
    }
}

impl<T: Real> Drop for Extension<T> {
    fn drop(&mut self) {
        keep([&mut self.values]);
        keep([&mut self.near]);
    }
}

/// Whether elements of C are in any of the boxes.
#[inline(always)]
fn any_near(near: &[u8]) -> bool {
    near.iter().fold(0, |any, near| any | near) != 0
}

#[inline(always)]
fn count<T: Real>(near: u8) -> T {
    T::from_u8(near).unwrap_or_default()
}

/// Sums over the boxes around the elements of row y, `mx` of them in a row; `value` makes them of what the grid holds.
/// Inlined where it is compiled for the vectors of the machine.
#[inline(always)]
fn box_sums<'a, A, B: Copy + Default + std::ops::Add<Output = B>>(
    from: &[A],
    (y, mx): (usize, usize),
    [column, sums, more]: &'a mut [Vec<B>; 3],
    value: impl Fn(&A) -> B,
) -> &'a [B] {
    let rows = y.saturating_sub(REACH) * mx..from.len().min((y + REACH + 1) * mx);
    let inner = &mut column[REACH..][..mx];
    inner.fill(B::default());
    for row in from[rows].chunks_exact(mx) {
        inner.iter_mut().zip(row).for_each(|(sum, from)| *sum = *sum + value(from));
    }
    // Of 2, 4, 8 neighbours, and the ninth.
    let n = mx + BOX - 1;
    pairs(&mut sums[..n - 1], &column[..n - 1], &column[1..n]);
    pairs(&mut more[..n - 3], &sums[..n - 3], &sums[2..n - 1]);
    pairs(&mut sums[..n - 7], &more[..n - 7], &more[4..n - 3]);
    pairs(&mut more[..mx], &sums[..mx], &column[BOX - 1..n]);
    &more[..mx]
}

/// The sums of two rows.
#[inline(always)]
fn pairs<B: Copy + std::ops::Add<Output = B>>(sums: &mut [B], first: &[B], second: &[B]) {
    sums.iter_mut().zip(first).zip(second).for_each(|((sum, a), b)| *sum = *a + *b);
}

#[cfg(test)]
#[path = "../../../tests/unit/extension.rs"]
mod tests;
