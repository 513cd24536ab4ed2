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
//! E r = r on C,   (sum over B of r)/(n + c) outside,    B: the box of 9 x 9 cells around, n of its elements in C, c: an eighth of B
//! ```
//!
//! a cell being an element, or S x S elements where the pieces of C are large (module `cells`), and E^T M E, symmetric and positive
//! definite for any E, takes the place of M. With a box of 7 or 13 elements at 512 x 512, or a c of half or twice that, the iterations
//! differ by one. A compliant layer makes A diagonal, where elements know nothing of each other: c grows by the square of an element's
//! influence on itself relative to that without a layer. Measured (tolerance 1e-6, iterations on the finest grid, zero outside and with
//! cells of one element): rough surface by force 512 14 and 8, 1024 16 and 9, by approach 512 20 and 11; ellipse by force 512 6 and 3.
//! With cells of one element, and with those that suit C: rough surface 2048 11 and 9, 4096 12 and 9.

use std::ops::Range;

use super::boxes::{Collect, Count, Extend, Share, BOX, CHUNK, REACH, ROWS};
use super::cells::{suitable_side, CellSums, LARGEST_SIDE};
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
/// Elements of a grid in its shorter direction from which on it is used. Strips of 9 to 36 rows with two periods end in cycles
/// with it; of 64 rows and more they take half of the iterations.
const NARROW: usize = 64;
const WHAT: &str = "the extended residual";

/// E, and the memory for it.
pub(super) struct Extension<T: Real> {
    mx: usize,
    my: usize,
    /// Elements of a cell in each direction.
    side: usize,
    values: Vec<T>,
    /// Elements of C in each box; 0 where its cell is S x S elements of C.
    near: Vec<u16>,
    /// Of cells with more than one element: those in C, and sums over cells.
    inside: Vec<u16>,
    sums: Vec<T>,
    /// Whether a chunk has cells with such elements.
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

/// The same call for the side of the cells there are.
macro_rules! for_side {
    ($side:expr, $self:ident . $call:ident :: <S>($($argument:expr),*)) => {
        match $side {
            1 => $self.$call::<1>($($argument),*),
            2 => $self.$call::<2>($($argument),*),
            4 => $self.$call::<4>($($argument),*),
            8 => $self.$call::<8>($($argument),*),
            _ => $self.$call::<LARGEST_SIDE>($($argument),*),
        }
    };
}

impl<T: Real> Extension<T> {
    /// On `grid`; none on one that is too small.
    pub fn if_worthwhile(grid: &Grid, threads: &Threads) -> Result<Option<Extension<T>>> {
        (grid.len() >= LEAST && grid.mx.min(grid.my) >= NARROW).then(|| Extension::new(grid, threads)).transpose()
    }

    /// Memory for a contact area on `grid`.
    fn new(grid: &Grid, threads: &Threads) -> Result<Extension<T>> {
        let (n, cells) = (grid.len(), grid.mx.div_ceil(2) * grid.my.div_ceil(2));
        let (mut values, mut near, mut inside, mut sums) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        reserve(&mut values, n, WHAT)?;
        reserve(&mut near, n, WHAT)?;
        reserve(&mut inside, cells, WHAT)?;
        reserve(&mut sums, cells, WHAT)?;
        Ok(Extension {
            mx: grid.mx,
            my: grid.my,
            side: 1,
            values,
            near,
            inside,
            sums,
            rim: zeros(grid.my * grid.mx.div_ceil(CHUNK), WHAT)?,
            version: None,
            threads: threads.clone(),
        })
    }

    /// Chooses cells that suit the contact area: after it woke, and whenever C is found anew, before it is used.
    pub fn suit(&mut self, contact: &[bool]) {
        self.take_cells(suitable_side(contact, self.mx));
    }

    fn take_cells(&mut self, side: usize) {
        if side != self.side {
            (self.side, self.version) = (side, None);
        }
        let (cells, rows) = self.cells();
        let (cells, several) = (cells * rows, if side > 1 { cells * rows } else { 0 });
        if self.near.len() != cells || self.inside.len() != several {
            self.version = None;
        }
        wake(&mut self.near, cells, 0, &self.threads);
        wake(&mut self.inside, several, 0, &self.threads);
        wake(&mut self.sums, several, T::nan(), &self.threads);
    }

    /// Cells of a row, and rows of them.
    fn cells(&self) -> (usize, usize) {
        (self.mx.div_ceil(self.side), self.my.div_ceil(self.side))
    }

    /// z = E^T M E z; z is zero outside C before, and of no meaning there afterwards. `compliance`: an element's influence on itself,
    /// relative to that without a layer.
    fn around(&mut self, z: &mut Vec<T>, area: Area<'_>, compliance: f64, apply: impl FnOnce(&mut [T])) {
        let (cells, rows) = self.cells();
        let in_a_box = BOX.min(cells) * BOX.min(rows) * self.side * self.side;
        let absent = T::of(ABSENT * in_a_box as f64 * compliance * compliance);
        for_side!(self.side, self.count::<S>(area));
        for_side!(self.side, self.extend::<S>(z, area.contact, absent));
        apply(&mut self.values);
        for_side!(self.side, self.collect::<S>(z, area.contact, absent));
        std::mem::swap(z, &mut self.values);
    }

    /// The elements of C in the boxes of rows near which C has changed.
    fn count<const S: usize>(&mut self, Area { contact, segments }: Area<'_>) {
        let before = self.version.replace(segments.version());
        if before == self.version {
            return;
        }
        let ((cells, height), mx) = (self.cells(), self.mx);
        let has_changed = |rows: Range<usize>| {
            let elements = rows.start * S * mx..contact.len().min(rows.end * S * mx);
            before.is_none_or(|before| segments.changed_since(before, elements))
        };
        if S > 1 {
            self.threads.for_each_plain_row(&mut self.inside, cells, |y, sums| {
                if has_changed(y..y + 1) {
                    let contact = rows_of::<_, S>(contact, mx, y..y + 1);
                    let value = |inside, _| u16::from(inside);
                    pulp::Arch::new().dispatch(CellSums::<_, _, _, S> { elements: contact, contact, mx, value, sums });
                }
            });
        }
        let (near, rim) = ((&mut self.near[..], ROWS * cells), (&mut self.rim[..], ROWS * cells.div_ceil(CHUNK)));
        let inside = &self.inside[..];
        self.threads.for_each_row_pair(near, rim, |k, near, rim| {
            let y = ROWS * k;
            if !has_changed(y.saturating_sub(REACH)..height.min(y + ROWS + REACH)) {
                return;
            }
            let arch = pulp::Arch::new();
            if S > 1 {
                arch.dispatch(Count::<_, _, S> { inside, count: |count| count, mx: cells, y, near, rim });
            } else {
                arch.dispatch(Count::<_, _, S> { inside: contact, count: u8::from, mx, y, near, rim });
            }
        });
    }

    /// values = E z.
    fn extend<const S: usize>(&mut self, z: &[T], contact: &[bool], absent: T) {
        let (cells, _) = self.cells();
        let Extension { mx, values, near, sums, rim, threads, .. } = self;
        if S > 1 {
            threads.for_each_plain_row(sums, cells, |y, sums| {
                let (z, contact) = (rows_of::<_, S>(z, *mx, y..y + 1), rows_of::<_, S>(contact, *mx, y..y + 1));
                pulp::Arch::new().dispatch(CellSums::<_, _, _, S> {
                    elements: z,
                    contact,
                    mx: *mx,
                    value: |z, _| z,
                    sums,
                });
            });
        }
        let (mx, chunks) = (*mx, cells.div_ceil(CHUNK));
        let sums = if S > 1 { &sums[..] } else { z };
        threads.for_each_plain_row(values, ROWS * S * mx, |k, values| {
            let y = ROWS * k;
            let (near, rim) = (&near[y * cells..], &rim[y * chunks..]);
            let here = y * S * mx..y * S * mx + values.len();
            let (z, contact) = (&z[here.clone()], &contact[here]);
            pulp::Arch::new().dispatch(Extend::<_, S> {
                sums,
                mx: (mx, cells),
                y,
                near,
                rim,
                absent,
                z,
                contact,
                values,
            });
        });
    }

    /// values = E^T values on C. What it needs of the others goes to z, or to the sums of larger cells.
    fn collect<const S: usize>(&mut self, z: &mut [T], contact: &[bool], absent: T) {
        let (cells, rows) = self.cells();
        let (mx, chunks) = (self.mx, cells.div_ceil(CHUNK));
        let Extension { values, near, sums, rim, threads, .. } = self;
        let shares = if S > 1 { &mut sums[..] } else { z };
        threads.for_each_plain_row(shares, cells, |y, shares| {
            let (near, rim) = (&near[y * cells..][..cells], &rim[y * chunks..][..chunks]);
            let (values, contact) = (rows_of::<_, S>(values, mx, y..y + 1), rows_of::<_, S>(contact, mx, y..y + 1));
            pulp::Arch::new().dispatch(Share::<_, S> { values, contact, mx, near, rim, absent, shares });
        });
        let (shares, rim) = (&*shares, &rim[..rows * chunks]);
        threads.for_each_plain_row(values, ROWS * S * mx, |k, values| {
            pulp::Arch::new().dispatch(Collect::<_, S> { shares, mx: (mx, cells), y: ROWS * k, rim, values });
        });
    }

    /// It is not needed for a while.
    pub fn rest(&mut self) {
        rest(&mut self.values);
        rest(&mut self.near);
        rest(&mut self.inside);
        rest(&mut self.sums);
    }

    /// Before it is used, at first or again, on a grid of n elements. Cells are to be chosen then.
    pub fn wake(&mut self, n: usize) {
        wake(&mut self.values, n, T::zero(), &self.threads);
    }

    /// Bytes held, for n elements.
    pub fn bytes(&self, n: usize) -> usize {
        n * (size_of::<T>() + size_of::<u16>()) + n / 4 * (size_of::<T>() + size_of::<u16>()) + self.rim.len()
    }
}

/// The elements of some rows of cells.
fn rows_of<A, const S: usize>(elements: &[A], mx: usize, rows: Range<usize>) -> &[A] {
    &elements[rows.start * S * mx..elements.len().min(rows.end * S * mx)]
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
        keep([&mut self.values, &mut self.sums]);
        keep([&mut self.near, &mut self.inside]);
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/extension.rs"]
mod tests;
