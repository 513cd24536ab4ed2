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
//! iterations differ by one. A compliant layer makes A diagonal, where elements know nothing of each other: c grows by the square of an
//! element's influence on itself relative to that without a layer. Measured (tolerance 1e-6, iterations on the finest grid, zero
//! outside and now): rough surface by force 512 14 and 8, 1024 16 and 9, by approach 512 20 and 11; ellipse by force 512 6 and 3.

use super::boxes::{Collect, Count, Extend, Share, BOX, CHUNK, REACH, ROWS};
use super::segments::Segments;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, rest, wake, zeros};
use crate::operator::fft::Real;
use crate::operator::reserve;
use crate::threads::Threads;

/// c, as a part of a box.
const ABSENT: f64 = 0.125;
/// Elements of a grid from which on the extension saves more than it takes. Processor times of cold calls with it on all grids, by those
/// without (table "cold" of `make bench`, programs in turns): 1.2 where the box around C has some 100 or 400 elements (ellipse 16, 32), 1.0 to 1.15
/// at 2000 to 4000 (ellipse 64, wheel-rail y4_82kN), 0.87 at 15000 (wheel-rail y4_82kN x2), 0.92 and 0.83 at 65000 and 260000 (rough).
const LEAST: usize = 8192;
const WHAT: &str = "the extended residual";

/// E, and the memory for it.
pub(super) struct Extension<T: Real> {
    mx: usize,
    /// c, without a layer.
    absent: f64,
    values: Vec<T>,
    /// Elements of C in each box; 0 in C.
    near: Vec<u8>,
    /// Whether a chunk has elements outside whose box has elements of C.
    rim: Vec<bool>,
    /// The version of C of which they are.
    version: Option<u64>,
    threads: Threads,
}

/// The contact area that an extension is for.
#[derive(Clone, Copy)]
pub(super) struct Area<'a> {
    pub(super) contact: &'a [bool],
    /// What knows when parts of it changed.
    pub(super) segments: &'a Segments,
}

impl<T: Real> Extension<T> {
    /// On `grid`; none on one that is too small.
    pub fn if_worthwhile(grid: &Grid, threads: &Threads) -> Result<Option<Extension<T>>> {
        (grid.len() >= LEAST).then(|| Extension::new(grid, threads)).transpose()
    }

    /// Memory for a contact area on `grid`.
    fn new(grid: &Grid, threads: &Threads) -> Result<Extension<T>> {
        let n = grid.len();
        let (mut values, mut near) = (Vec::new(), Vec::new());
        reserve(&mut values, n, WHAT)?;
        reserve(&mut near, n, WHAT)?;
        Ok(Extension {
            mx: grid.mx,
            absent: ABSENT * (BOX.min(grid.mx) * BOX.min(grid.my)) as f64,
            values,
            near,
            rim: zeros(grid.my * grid.mx.div_ceil(CHUNK), WHAT)?,
            version: None,
            threads: threads.clone(),
        })
    }

    /// z = E^T M E z; z is zero outside C before, and of no meaning there afterwards. `compliance`: an element's influence on itself,
    /// relative to that without a layer.
    fn around(&mut self, z: &mut Vec<T>, area: Area<'_>, compliance: f64, apply: impl FnOnce(&mut [T])) {
        let absent = T::of(self.absent * compliance * compliance);
        self.count(area);
        self.extend(z, absent);
        apply(&mut self.values);
        self.collect(z, absent);
        std::mem::swap(z, &mut self.values);
    }

    /// The elements of C in the boxes of rows near which C has changed.
    fn count(&mut self, Area { contact, segments }: Area<'_>) {
        let before = self.version.replace(segments.version());
        if before == self.version {
            return;
        }
        let (mx, my) = (self.mx, self.near.len() / self.mx);
        let (near, rim) = ((&mut self.near[..], ROWS * mx), (&mut self.rim[..], ROWS * mx.div_ceil(CHUNK)));
        self.threads.for_each_row_pair(near, rim, |k, near, rim| {
            let y = ROWS * k;
            let rows = y.saturating_sub(REACH) * mx..my.min(y + ROWS + REACH) * mx;
            if before.is_none_or(|before| segments.changed_since(before, rows)) {
                pulp::Arch::new().dispatch(Count { contact, mx, y, near, rim });
            }
        });
    }

    /// values = E z.
    fn extend(&mut self, z: &[T], absent: T) {
        let Extension { mx, values, near, rim, threads, .. } = self;
        let (mx, chunks) = (*mx, mx.div_ceil(CHUNK));
        threads.for_each_plain_row(values, ROWS * mx, |k, values| {
            let y = ROWS * k;
            let (near, rim) = (&near[y * mx..], &rim[y * chunks..]);
            pulp::Arch::new().dispatch(Extend { z, mx, y, near, rim, absent, values });
        });
    }

    /// values = E^T values on C; z is what it needs of the others.
    fn collect(&mut self, z: &mut [T], absent: T) {
        let Extension { mx, values, near, rim, threads, .. } = self;
        let (mx, chunks) = (*mx, mx.div_ceil(CHUNK));
        threads.for_each_plain_row(z, mx, |y, shares| {
            let (near, rim) = (&near[y * mx..][..mx], &rim[y * chunks..][..chunks]);
            pulp::Arch::new().dispatch(Share { values: &values[y * mx..], near, rim, absent, shares });
        });
        threads.for_each_plain_row(values, ROWS * mx, |k, values| {
            pulp::Arch::new().dispatch(Collect { shares: z, mx, y: ROWS * k, rim, values });
        });
    }

    /// It is not needed for a while.
    pub fn rest(&mut self) {
        rest(&mut self.values);
        rest(&mut self.near);
    }

    /// Before it is used, at first or again, on a grid of n elements.
    pub fn wake(&mut self, n: usize) {
        if self.near.len() < n {
            self.version = None;
        }
        wake(&mut self.values, n, T::zero(), &self.threads);
        wake(&mut self.near, n, 0, &self.threads);
    }

    /// Bytes held, for n elements.
    pub fn bytes(&self, n: usize) -> usize {
        n * (size_of::<T>() + 1) + self.rim.len()
    }
}

/// z = E^T M E z; z = M z where there is no extension.
pub(super) fn extended<T: Real>(
    extension: &mut Option<Extension<T>>,
    z: &mut Vec<T>,
    (area, compliance): (Area<'_>, f64),
    apply: impl FnOnce(&mut [T]),
) {
    match extension {
        Some(extension) => extension.around(z, area, compliance, apply),
        None => apply(z),
    }
}

impl<T: Real> Drop for Extension<T> {
    fn drop(&mut self) {
        keep([&mut self.values]);
        keep([&mut self.near]);
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/extension.rs"]
mod tests;
