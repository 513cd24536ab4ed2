//! The transforms in x of a product: of those rows only that hold pressures, and back.

use std::ops::Range;

use super::columns::{blocks_of, Block, BLOCK};
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

/// What one thread works with.
pub(super) struct Piece<T: Real> {
    /// The block of columns that was worked on last.
    pub block: usize,
    pub row: Vec<T>,
    pub columns: Vec<Complex<T>>,
    pub scratch: Vec<Complex<T>>,
}

/// Memory of one product.
pub(super) struct Product<T: Real> {
    /// `[my][px/2 + 1]`: the rows, transformed in x. In the places of vectors, blocks as [`LaneRows`] have them.
    pub bins: Vec<Complex<T>>,
    pub pieces: Vec<Piece<T>>,
}

impl<T: Real> Rows<T> {
    pub fn new(mx: usize, my: usize, period: usize, threads: &Threads) -> Rows<T> {
        Rows { mx, my, transform: RowTransform::new(period), threads: threads.clone() }
    }

    /// Rows that are transformed together.
    pub fn at_a_time(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(self.transform.at_a_time(), LaneRows::at_a_time)
    }

    /// Rows that a block of bins has room for in the places of vectors: a group of rows that are transformed together may begin at the last row of
    /// the grid, and is always whole.
    pub fn height(&self, lanes: &LaneRows<T>) -> usize {
        self.my + lanes.at_a_time() - 1
    }

    /// The blocks of bins in the places of vectors, from a line of the cache on, and the pieces.
    pub fn blocks_of_bins<'a>(
        &self,
        lanes: &LaneRows<T>,
        product: &'a mut Product<T>,
    ) -> (&'a mut [Complex<T>], &'a mut [Piece<T>]) {
        let bins = from_a_line(&mut product.bins);
        (&mut bins[..lanes.blocks() * self.height(lanes) * BLOCK], &mut product.pieces)
    }

    /// Bins of all rows, with these transforms or without.
    pub fn room(&self, lanes: Option<&LaneRows<T>>) -> usize {
        let in_vectors = |lanes: &LaneRows<T>| lanes.blocks() * self.height(lanes) * BLOCK + before_a_line::<T>();
        lanes.map_or(0, in_vectors).max(self.my * self.transform.bins())
    }

    /// Scratch that transforms need, with these or without.
    pub fn scratch_length(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(0, LaneRows::scratch_length).max(self.transform.scratch_length())
    }

    /// Transforms the rows that hold pressures; returns which.
    pub fn forward(&self, p: &[T], product: &mut Product<T>, lanes: Option<&LaneRows<T>>) -> Range<usize> {
        let (loaded, together, mx) = (rows_with_pressure(p, self.mx), self.at_a_time(lanes), self.mx);
        if let Some(lanes) = lanes {
            let rows = p[loaded.start * mx..loaded.end * mx].chunks(together * mx);
            let (bins, pieces) = self.blocks_of_bins(lanes, product);
            let bins = self.some_rows(lanes, bins, loaded.clone());
            self.threads.share(rows.zip(bins), pieces, |(rows, mut bins), piece| {
                lanes.forward(rows, mx, &mut bins, &mut piece.scratch);
            });
        } else {
            let nb = self.transform.bins();
            let bins = &mut product.bins[loaded.start * nb..loaded.end * nb];
            self.threads.for_each_row(bins, together * nb, &mut product.pieces, |i, bins, piece| {
                let rows = &p[(loaded.start + i * together) * mx..][..bins.len() / nb * mx];
                self.transform.forward_together(rows, mx, bins, &mut piece.scratch);
            });
        }
        loaded
    }

    /// Those rows of blocks, as many at a time as are transformed together: the last of them may lie beyond `rows`.
    fn some_rows<'a>(
        &self,
        lanes: &LaneRows<T>,
        bins: &'a mut [Complex<T>],
        rows: Range<usize>,
    ) -> impl DoubleEndedIterator<Item = Block<'a, T>> + ExactSizeIterator + Send {
        let together = lanes.at_a_time();
        let end = rows.start + rows.len().next_multiple_of(together);
        blocks_of(bins, self.height(lanes) * BLOCK, rows.start * BLOCK..end * BLOCK, together * BLOCK)
    }

    /// Transforms all rows back to u.
    pub fn back(&self, u: &mut [T], product: &mut Product<T>, lanes: Option<&LaneRows<T>>) {
        self.back_by(u, product, lanes, |_, u, piece, inverse| inverse(u, &mut piece.scratch));
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
        self.back_by(u, product, lanes, |i, u, piece, inverse| {
            let rows = &mut piece.row[..u.len()];
            inverse(rows, &mut piece.scratch);
            write(i * together * self.mx, u, rows);
        });
    }

    /// `work(i, values of u, piece, inverse)` for all rows that are transformed together; `inverse(rows, scratch)` transforms them.
    fn back_by(
        &self,
        u: &mut [T],
        product: &mut Product<T>,
        lanes: Option<&LaneRows<T>>,
        work: impl Fn(usize, &mut [T], &mut Piece<T>, &mut dyn FnMut(&mut [T], &mut [Complex<T>])) + Sync + Send,
    ) {
        let (mx, together) = (self.mx, self.at_a_time(lanes));
        if let Some(lanes) = lanes {
            let u = u.chunks_mut(together * mx).enumerate();
            let (bins, pieces) = self.blocks_of_bins(lanes, product);
            let bins = self.some_rows(lanes, bins, 0..self.my);
            return self.threads.share(u.zip(bins), pieces, |((i, u), bins), piece| {
                work(i, u, piece, &mut |rows, scratch| lanes.inverse(&bins, rows, mx, scratch));
            });
        }
        let nb = self.transform.bins();
        let bins = (&mut product.bins[..self.my * nb], together * nb);
        self.threads.for_each_row_pair_with((u, together * mx), bins, &mut product.pieces, |i, u, bins, piece| {
            work(i, u, piece, &mut |rows, scratch| self.transform.inverse_together(bins, rows, mx, scratch));
        });
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
