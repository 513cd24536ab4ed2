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
        let (nb, together) = (self.transform.bins(), self.transform.at_a_time());
        let bins = &mut product.bins[loaded.start * nb..loaded.end * nb];
        let first = loaded.start;
        self.threads.for_each_row(bins, together * nb, &mut product.pieces, |i, bins, piece| {
            let rows = &p[(first + i * together) * self.mx..][..bins.len() / nb * self.mx];
            self.transform.forward_together(rows, self.mx, bins, &mut piece.scratch);
        });
        loaded
    }

    /// Transforms all rows back to u.
    pub fn back(&self, u: &mut [T], product: &mut Product<T>) {
        self.back_by(u, product, |_, u, bins, piece| {
            self.transform.inverse_together(bins, u, self.mx, &mut piece.scratch);
        });
    }

    /// Transforms all rows back; `write(first element, values of u, values)` takes some of them.
    pub fn back_with(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        write: impl Fn(usize, &mut [T], &[T]) + Sync + Send,
    ) {
        let together = self.transform.at_a_time();
        self.back_by(u, product, |i, u, bins, piece| {
            let rows = &mut piece.row[..u.len()];
            self.transform.inverse_together(bins, rows, self.mx, &mut piece.scratch);
            write(i * together * self.mx, u, rows);
        });
    }

    fn back_by(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        work: impl Fn(usize, &mut [T], &mut [Complex<T>], &mut Piece<T>) + Sync + Send,
    ) {
        let Product { bins, pieces } = product;
        let (nb, together) = (self.transform.bins(), self.transform.at_a_time());
        let bins = &mut bins[..self.my * nb];
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
