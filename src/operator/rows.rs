//! The transforms in x of a product: of those rows only that hold pressures, and back.

use std::ops::Range;

use super::fft::{Complex, Real};
use super::lane_rows::LaneRows;
use super::row_transform::RowTransform;
use super::stages::{before_a_line, from_a_line};
use crate::threads::Threads;

/// Rows of the grid, padded to the period in x.
pub(super) struct Rows<T: Real> {
    pub mx: usize,
    pub my: usize,
    pub transform: RowTransform<T>,
    pub threads: Threads,
}

/// Scratch of one piece of the work.
pub(super) struct Piece<T: Real> {
    pub row: Vec<T>,
    pub columns: Vec<Complex<T>>,
    pub scratch: Vec<Complex<T>>,
}

/// Memory of one product.
pub(super) struct Product<T: Real> {
    /// `[my][px/2 + 1]`: the rows, transformed in x. In the places of vectors, as [`LaneRows`] have them.
    pub bins: Vec<Complex<T>>,
    pub pieces: Vec<Piece<T>>,
}

impl<T: Real> Product<T> {
    /// The bins from a line of the cache on, and the pieces.
    pub fn at_a_line(&mut self) -> (&mut [Complex<T>], &mut [Piece<T>]) {
        (from_a_line(&mut self.bins), &mut self.pieces)
    }
}

impl<T: Real> Rows<T> {
    pub fn new(mx: usize, my: usize, period: usize, threads: &Threads) -> Rows<T> {
        Rows { mx, my, transform: RowTransform::new(period), threads: threads.clone() }
    }

    /// Rows that are transformed together.
    pub fn at_a_time(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(self.transform.at_a_time(), LaneRows::at_a_time)
    }

    /// Bins of all rows, with these transforms or without. In vectors there are always all rows that are transformed together.
    pub fn room(&self, lanes: Option<&LaneRows<T>>) -> usize {
        let in_vectors = |lanes: &LaneRows<T>| (self.my + lanes.at_a_time() - 1) * lanes.room() + before_a_line::<T>();
        lanes.map_or(0, in_vectors).max(self.my * self.transform.bins())
    }

    /// Scratch that transforms need, with these or without.
    pub fn scratch_length(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(0, LaneRows::scratch_length).max(self.transform.scratch_length())
    }

    /// Transforms the rows that hold pressures; returns which.
    pub fn forward(&self, p: &[T], product: &mut Product<T>, lanes: Option<&LaneRows<T>>) -> Range<usize> {
        let (loaded, together) = (rows_with_pressure(p, self.mx), self.at_a_time(lanes));
        let (bins, pieces) = match lanes {
            Some(_) => product.at_a_line(),
            None => (&mut product.bins[..], &mut product.pieces[..]),
        };
        let p = &p[loaded.start * self.mx..loaded.end * self.mx];
        let rows = |i: usize| &p[i * together * self.mx..p.len().min((i + 1) * together * self.mx)];
        if let Some(lanes) = lanes {
            let nb = lanes.room();
            let bins = &mut bins[loaded.start * nb..][..loaded.len().next_multiple_of(together) * nb];
            self.threads.for_each_row(bins, together * nb, pieces, |i, bins, piece| {
                lanes.forward(rows(i), self.mx, bins, &mut piece.scratch);
            });
        } else {
            let nb = self.transform.bins();
            let bins = &mut bins[loaded.start * nb..loaded.end * nb];
            self.threads.for_each_row(bins, together * nb, pieces, |i, bins, piece| {
                self.transform.forward_together(rows(i), self.mx, bins, &mut piece.scratch);
            });
        }
        loaded
    }

    /// Transforms all rows back to u.
    pub fn back(&self, u: &mut [T], product: &mut Product<T>, lanes: Option<&LaneRows<T>>) {
        self.back_by(u, product, lanes, |_, u, bins, piece| self.inverse(lanes, bins, u, &mut piece.scratch));
    }

    /// Transforms all rows back; `write(first element, values of u, values)` takes some of them.
    pub fn back_with(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        lanes: Option<&LaneRows<T>>,
        write: impl Fn(usize, &mut [T], &[T]) + Sync + Send,
    ) {
        let together = self.at_a_time(lanes);
        self.back_by(u, product, lanes, |i, u, bins, piece| {
            let rows = &mut piece.row[..u.len()];
            self.inverse(lanes, bins, rows, &mut piece.scratch);
            write(i * together * self.mx, u, rows);
        });
    }

    fn inverse(
        &self,
        lanes: Option<&LaneRows<T>>,
        bins: &mut [Complex<T>],
        rows: &mut [T],
        scratch: &mut [Complex<T>],
    ) {
        match lanes {
            Some(lanes) => lanes.inverse(bins, rows, self.mx, scratch),
            None => self.transform.inverse_together(bins, rows, self.mx, scratch),
        }
    }

    fn back_by(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        lanes: Option<&LaneRows<T>>,
        work: impl Fn(usize, &mut [T], &mut [Complex<T>], &mut Piece<T>) + Sync + Send,
    ) {
        let together = self.at_a_time(lanes);
        let (bins, pieces, nb, rows) = match lanes {
            Some(lanes) => {
                let (bins, pieces) = product.at_a_line();
                (bins, pieces, lanes.room(), self.my.next_multiple_of(together))
            }
            None => (&mut product.bins[..], &mut product.pieces[..], self.transform.bins(), self.my),
        };
        let bins = &mut bins[..rows * nb];
        self.threads.for_each_row_pair_with((u, together * self.mx), (bins, together * nb), pieces, work);
    }
}

/// The run of rows outside of which `p` is zero.
fn rows_with_pressure<T: Real>(p: &[T], mx: usize) -> Range<usize> {
    // All of a row, which the compiler can vectorise.
    let loaded = |row: &[T]| row.iter().fold(false, |any, &value| any | (value != T::zero()));
    let Some(first) = p.chunks_exact(mx).position(loaded) else { return 0..0 };
    let last = p.chunks_exact(mx).rposition(loaded).unwrap_or(first);
    first..last + 1
}
