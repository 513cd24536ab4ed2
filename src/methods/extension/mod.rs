//! The residual, extended beyond the contact area.
//!
//! M is the inverse of a circulant near A on the whole grid, and the residual r is known on C only. For every extension E r of r with
//!
//! ```text
//! (E r, M E r) >= (r, (A on C)^-1 r)
//! ```
//!
//! equality holds for the displacement by the pressures that solve for r on C. Zero outside C is the worst extension. The energy of a step at the
//! boundary grows with the number of elements across a component of C, and C of a rough surface has a long boundary. So E r is a mean of nearby
//! values,
//!
//! ```text
//! E r = r on C,   (sum over B of r)/(n + c) outside,    B: the box of 9 x 9 elements around, n of them in C, c: an eighth of B
//! ```
//!
//! and E^T M E, symmetric and positive definite for any E, replaces M. With a box of 7 or 13 elements at 512 x 512, or half or twice c, the
//! number of iterations differs by one. A compliant layer makes A more diagonal and elements independent: c grows by the square of an
//! element's influence on itself relative to that without a layer. Measured (tolerance 1e-6, iterations on the finest grid, zero outside and
//! with boxes): rough surface by force 512 14 and 8, 1024 16 and 9, by approach 512 20 and 11; ellipse by force 512 6 and 3.
//!
//! The normal problem extends one field, the tangential problem one for each component.

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

/// c, as a part of a box.
const C_PER_BOX: f64 = 0.125;
/// Least elements of a grid for which the extension saves more time than it takes. Processor times of cold calls with it on all grids, relative to
/// those without it (table "cold" of `make bench`, programs in turns): 1.2 where the box around C has some 100 or 400 elements (ellipse 16, 32), 1.0
/// to 1.15 at 2000 to 4000 (ellipse 64, wheel-rail y4_82kN), 0.87 at 15000 (wheel-rail y4_82kN x2), 0.92 and 0.83 at 65000 and 260000 (rough).
const LEAST_ELEMENTS: usize = 8192;
/// Least elements in the shorter direction of a grid with the extension. With it, strips of 9 to 36 rows with two periods end in
/// cycles. Strips of 64 rows and more take half of the iterations.
const LEAST_SIDE: usize = 64;
const WHAT: &str = "the extended residual";

/// E of fields of K components, and the memory for it.
pub struct Extension<T: Real, const K: usize> {
    mx: usize,
    my: usize,
    /// `[K][my][mx]`.
    values: Vec<T>,
    /// Elements of C in each box; 0 where its element is in C.
    near: Vec<u16>,
    /// Whether a chunk has elements with others of C near them.
    rim: Vec<bool>,
    threads: Threads,
}

impl<T: Real, const K: usize> Extension<T, K> {
    /// The extension on `grid`. None if it would not save time.
    pub fn if_worthwhile(grid: &Grid, threads: &Threads) -> Result<Option<Extension<T, K>>> {
        (grid.len() >= LEAST_ELEMENTS && grid.mx.min(grid.my) >= LEAST_SIDE)
            .then(|| Extension::new(grid, threads))
            .transpose()
    }

    /// Memory for a contact area on `grid`. Before use, call [`Extension::wake`] and [`Extension::count`].
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

    /// Counts the elements of C in each box near rows for which `has_changed(elements)`. C are the elements of values with `is_inside`.
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

    /// c, for `compliance`: an element's influence on itself, relative to that without a layer.
    fn absent(&self, compliance: f64) -> T {
        let in_a_box = BOX.min(self.mx) * BOX.min(self.my);
        T::of(C_PER_BOX * in_a_box as f64 * compliance * compliance)
    }

    /// values = E z of component k, for z zero outside C.
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

    /// values = E^T values on C, undefined elsewhere. `shares` is overwritten.
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

    /// `to = E^T M E from` for `from` zero outside C, where `to` is undefined.
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

    /// Frees memory until the next [`Extension::wake`].
    pub fn rest(&mut self) {
        rest(&mut self.values);
    }

    /// Allocates memory before the next use.
    pub fn wake(&mut self) {
        wake(&mut self.values, K * self.mx * self.my, T::nan(), &self.threads);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.near.len() * (K * size_of::<T>() + size_of::<u16>()) + self.rim.len()
    }
}

impl<T: Real> Extension<T, 1> {
    /// z = E^T M E z for z zero outside C, where the result is undefined.
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
