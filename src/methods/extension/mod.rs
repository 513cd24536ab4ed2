//! The preconditioner M for the equations on C, with residuals that are extended beyond the contact area.
//!
//! M is the inverse of a circulant near A on the whole grid, but the residual r is known on C only. If M is `A^-1`, every extension E r of r has
//!
//! ```text
//! (E r, M E r) >= (r, (A on C)^-1 r)
//! ```
//!
//! Equality holds if E r is the displacement by the pressures that solve for r on C. Such an E r continues beyond C without a step. An extension by
//! zero has a step at the boundary of C. The energy of the step grows with the number of elements across a component of C, and the contact area of a
//! rough surface has a long boundary. Therefore E r outside C is a mean of nearby values of r:
//!
//! ```text
//! E r = r                            on C
//! E r = (sum of r over B)/(n + c)    outside;  B: the box of 9 x 9 elements around the element;  n: the elements of B in C;  c: an eighth of B
//! ```
//!
//! E^T M E, which is symmetric and positive definite with M, replaces M. With boxes of 7 or 13 elements at 512 x 512, or half or twice c, the number
//! of iterations differs by one. A compliant layer increases the diagonal of A, and so neighbours depend less on each other. Then c is multiplied by
//! the square of the ratio of an element's influence on itself with the layer to that without.
//!
//! Iterations on the finest grid for a tolerance of 1e-6 (measured):
//!
//! | problem | extension by zero | by boxes |
//! |---|---:|---:|
//! | rough surface, 512 x 512, given force | 14 | 8 |
//! | rough surface, 1024 x 1024, given force | 16 | 9 |
//! | rough surface, 512 x 512, given approach | 20 | 11 |
//! | ellipse, 512 x 512, given force | 6 | 3 |
//!
//! The normal problem extends one field, the tangential problem one for each component of the tractions.

mod boxes;
mod summand;

use std::array::from_fn;
use std::ops::Range;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, reserve, rest, wake, zeros};
use crate::operator::fft::Real;
use crate::threads::Threads;
use boxes::{Collect, Count, Extend, Share, BOX, CHUNK, REACH, ROWS};

/// The number c, relative to the elements of a box.
const C_PER_BOX: f64 = 0.125;
/// The extension is used on grids of at least this many elements, where it saves more time than it takes. Processor times of first calls with the
/// extension on all grids, relative to those without (table "cold" of `make bench`):
///
/// | elements in the rectangle around C | problem | time |
/// |---|---|---:|
/// | 100, 400 | ellipse 16, 32 | 1.2 |
/// | 2000 to 4000 | ellipse 64, wheel-rail y4_82kN | 1.0 to 1.15 |
/// | 15000 | wheel-rail y4_82kN x2 | 0.87 |
/// | 65000, 260000 | rough | 0.92, 0.83 |
const LEAST_ELEMENTS: usize = 8192;
/// The extension is used on grids with at least this many elements in the shorter direction. On strips of 9 to 36 rows with two periods the iteration
/// with the extension ends in endless cycles. Strips of 64 rows and more take half of the iterations.
const LEAST_SIDE: usize = 64;
/// The name of the memory in messages.
const WHAT: &str = "the extended residual";

/// The extension E for fields of K components on one grid and for one contact area.
pub struct Extension<T: Real, const K: usize> {
    mx: usize,
    my: usize,
    /// The extended field E r, `[K][my][mx]`.
    values: Vec<T>,
    /// For each element outside C: the number n of elements of C in the box around it. For each element of C: 0.
    near: Vec<u16>,
    /// For each chunk of a row: whether `near` is positive anywhere in it, so that the chunk lies at the boundary of C.
    rim: Vec<bool>,
    threads: Threads,
}

impl<T: Real, const K: usize> Extension<T, K> {
    /// Creates the extension on `grid`; None if it would not save time there.
    pub fn if_worthwhile(grid: &Grid, threads: &Threads) -> Result<Option<Extension<T, K>>> {
        (grid.len() >= LEAST_ELEMENTS && grid.mx.min(grid.my) >= LEAST_SIDE)
            .then(|| Extension::new(grid, threads))
            .transpose()
    }

    /// Allocates the extension on `grid`. Before use, call [`Extension::wake`] and [`Extension::count`].
    fn new(grid: &Grid, threads: &Threads) -> Result<Extension<T, K>> {
        let mut values = Vec::new();
        reserve(&mut values, K * grid.len(), WHAT)?;
        Ok(Extension {
            mx: grid.mx,
            my: grid.my,
            values,
            near: zeros(grid.len(), WHAT)?,
            rim: zeros(grid.my * grid.mx.div_ceil(CHUNK), WHAT)?,
            threads: threads.clone(),
        })
    }

    /// Sets the contact area: counts the elements of C in the box around each element. An element is in C if `is_inside` of its value is true. The
    /// counts of a group of rows are kept if `has_changed` is false for the range of all elements in their boxes.
    pub fn count<A: Copy + Sync>(
        &mut self,
        values: &[A],
        is_inside: impl Fn(A) -> bool + Sync + Send + Copy,
        has_changed: impl Fn(Range<usize>) -> bool + Sync + Send,
    ) {
        let (mx, my) = (self.mx, self.my);
        let (near, rim) = ((&mut self.near[..], ROWS * mx), (&mut self.rim[..], ROWS * mx.div_ceil(CHUNK)));
        self.threads.for_each_row_pair(near, rim, |k, near, rim| {
            let y = ROWS * k;
            if has_changed(y.saturating_sub(REACH) * mx..my.min(y + ROWS + REACH) * mx) {
                pulp::Arch::new().dispatch(Count { values, is_inside, mx, y, near, rim });
            }
        });
    }

    /// The number c. `compliance` is an element's influence on itself with the layer, relative to that without.
    fn absent(&self, compliance: f64) -> T {
        let in_a_box = BOX.min(self.mx) * BOX.min(self.my);
        T::of(C_PER_BOX * in_a_box as f64 * compliance * compliance)
    }

    /// Sets component k of `values` to E z. z is zero outside C.
    fn extend(&mut self, k: usize, z: &[T], compliance: f64) {
        let absent = self.absent(compliance);
        let Extension { mx, my, values, near, rim, threads, .. } = self;
        let (mx, elements, chunks) = (*mx, *mx * *my, mx.div_ceil(CHUNK));
        threads.for_each_plain_row(&mut values[k * elements..][..elements], ROWS * mx, |k, values| {
            let y = ROWS * k;
            let (near, rim) = (&near[y * mx..], &rim[y * chunks..]);
            pulp::Arch::new().dispatch(Extend { z, mx, y, near, rim, absent, values });
        });
    }

    /// Replaces `values` by E^T values on C; elsewhere the result is undefined. `shares` is overwritten.
    fn collect(&self, values: &mut [T], shares: &mut [T], compliance: f64) {
        let (mx, chunks, absent) = (self.mx, self.mx.div_ceil(CHUNK), self.absent(compliance));
        let Extension { near, rim, threads, .. } = self;
        let from = &*values;
        threads.for_each_plain_row(shares, mx, |y, shares| {
            let (near, rim) = (&near[y * mx..][..mx], &rim[y * chunks..][..chunks]);
            pulp::Arch::new().dispatch(Share { values: &from[y * mx..][..mx], near, rim, absent, shares });
        });
        let (shares, rim) = (&*shares, &rim[..]);
        threads.for_each_plain_row(values, ROWS * mx, |k, values| {
            pulp::Arch::new().dispatch(Collect { shares, mx, y: ROWS * k, rim, values });
        });
    }

    /// Sets `to = E^T M E from` on C; elsewhere `to` is undefined. `from` is zero outside C. `apply` applies M: it gets E from, and the memory for M
    /// E from.
    pub fn between(
        &mut self,
        from: [&[T]; K],
        mut to: [&mut [T]; K],
        compliance: f64,
        apply: impl FnOnce([&[T]; K], [&mut [T]; K]),
    ) {
        from.into_iter().enumerate().for_each(|(k, from)| self.extend(k, from, compliance));
        let (mut values, elements) = (std::mem::take(&mut self.values), self.mx * self.my);
        let mut planes = values.chunks_exact(elements);
        apply(from_fn(|_| planes.next().unwrap_or_default()), to.each_mut().map(|to| &mut **to));
        for (to, values) in to.into_iter().zip(values.chunks_exact_mut(elements)) {
            self.collect(to, values, compliance);
        }
        self.values = values;
    }

    /// Releases the memory of the extended field until the next [`Extension::wake`].
    pub fn rest(&mut self) {
        rest(&mut self.values);
    }

    /// Makes the memory of the extended field usable after [`Extension::rest`].
    pub fn wake(&mut self) {
        wake(&mut self.values, K * self.mx * self.my, T::nan(), &self.threads);
    }

    /// Bytes of the extended field and of the counts.
    pub fn bytes(&self) -> usize {
        self.near.len() * (K * size_of::<T>() + size_of::<u16>()) + self.rim.len()
    }
}

impl<T: Real> Extension<T, 1> {
    /// Replaces z by E^T M E z on C; elsewhere the result is undefined. z is zero outside C. `apply` applies M in place.
    pub fn around(&mut self, z: &mut Vec<T>, compliance: f64, apply: impl FnOnce(&mut [T])) {
        self.extend(0, z, compliance);
        let mut values = std::mem::take(&mut self.values);
        apply(&mut values);
        self.collect(&mut values, z, compliance);
        self.values = std::mem::replace(z, values);
    }
}

impl<T: Real, const K: usize> Drop for Extension<T, K> {
    fn drop(&mut self) {
        keep([&mut self.values]);
        keep([&mut self.near]);
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/extension.rs"]
mod tests;
