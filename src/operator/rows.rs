//! The transforms in x of a product: of those rows only that hold pressures, and back.

use std::ops::Range;

use super::fft::{Complex, Real};
use super::row_transform::RowTransform;
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
    /// `[my][px/2 + 1]`: the rows, transformed in x.
    pub bins: Vec<Complex<T>>,
    pub pieces: Vec<Piece<T>>,
}

impl<T: Real> Rows<T> {
    pub fn new(mx: usize, my: usize, period: usize, threads: &Threads) -> Rows<T> {
        Rows { mx, my, transform: RowTransform::new(period), threads: threads.clone() }
    }

    /// Transforms the rows that hold pressures; returns which.
    pub fn forward(&self, p: &[T], product: &mut Product<T>) -> Range<usize> {
        let loaded = rows_with_pressure(p, self.mx);
        let nb = self.transform.bins();
        let bins = &mut product.bins[loaded.start * nb..loaded.end * nb];
        let first = loaded.start;
        self.threads.for_each_row(bins, nb, &mut product.pieces, |i, row_bins, piece| {
            let row = &p[(first + i) * self.mx..(first + i + 1) * self.mx];
            self.transform.forward(row, row_bins, &mut piece.scratch);
        });
        loaded
    }

    /// Transforms all rows back to u.
    pub fn back(&self, u: &mut [T], product: &mut Product<T>) {
        self.back_by(u, product, |_, u, row_bins, piece| self.transform.inverse(row_bins, u, &mut piece.scratch));
    }

    /// Transforms all rows back; `write(iy, row of u, values)` takes each of them.
    pub fn back_with(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        write: impl Fn(usize, &mut [T], &[T]) + Sync + Send,
    ) {
        self.back_by(u, product, |iy, u, row_bins, piece| {
            let row = &mut piece.row[..self.mx];
            self.transform.inverse(row_bins, row, &mut piece.scratch);
            write(iy, u, row);
        });
    }

    fn back_by(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        work: impl Fn(usize, &mut [T], &mut [Complex<T>], &mut Piece<T>) + Sync + Send,
    ) {
        let Product { bins, pieces } = product;
        let nb = self.transform.bins();
        self.threads.for_each_row_pair_with((u, self.mx), (&mut bins[..self.my * nb], nb), pieces, work);
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
