//! The transforms in x of a product: of the rows with pressures to bins, and of the bins back to all rows.

use std::ops::Range;

use crate::block::{room_of_column, BLOCK};
use crate::fft::lane_rows::LaneRows;
use crate::fft::row_pass::{Forward, Inverse};
use crate::fft::row_transform::RowTransform;
use crate::fft::stages::{before_a_line, from_a_line};
use crate::passes::Real;
use crate::real::Complex;
use par::threads::Threads;
use par::Result;

use crate::workspace::{Memory, Piece, Room};

/// The transforms of the rows of a grid, padded with zeros to the period in x.
pub struct Rows<T: Real> {
    /// The number of elements in x.
    pub mx: usize,
    /// The number of elements in y.
    pub my: usize,
    /// The transforms of rows without lanes.
    pub transform: RowTransform<T>,
    /// The threads of the transforms.
    pub threads: Threads,
}

impl<T: Real> Rows<T> {
    /// Makes the plans for rows of a period.
    pub fn new((mx, my): (usize, usize), period: usize, threads: &Threads) -> Result<Rows<T>> {
        Ok(Rows { mx, my, transform: RowTransform::new(period)?, threads: threads.clone() })
    }

    /// The sizes of the memory of products without lanes. `scratch` is the number of scratch values that columns need.
    pub fn room(&self, period_in_y: usize, scratch: usize) -> Room {
        self.room_with(None, period_in_y, scratch)
    }

    /// The sizes of the memory of products that may use the transforms `lanes`, if there are any.
    pub(crate) fn room_with(&self, lanes: Option<&LaneRows<T>>, period_in_y: usize, scratch: usize) -> Room {
        Room {
            bins: self.bins(lanes),
            row: self.at_a_time(lanes).max(self.transform.at_a_time()) * self.mx,
            columns: BLOCK * room_of_column(period_in_y) + before_a_line::<T>(),
            scratch: self.scratch_length(lanes).max(scratch),
            pieces: self.threads.count(),
        }
    }

    /// The number of rows that are transformed together.
    fn at_a_time(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(self.transform.at_a_time(), LaneRows::at_a_time)
    }

    /// The bins in lanes, as blocks of columns, and the buffers of the threads. The bins begin at the start of a cache line.
    pub(crate) fn blocks_of_bins<'a>(
        &self,
        lanes: &LaneRows<T>,
        memory: &'a mut Memory<T>,
    ) -> (&'a mut [Complex<T>], &'a mut [Piece<T>]) {
        let bins = from_a_line(&mut memory.bins);
        (&mut bins[..lanes.bins_of(self.my)], &mut memory.pieces)
    }

    /// The number of bins of all rows: that with lanes, if there are any, or that without, whichever is larger.
    fn bins(&self, lanes: Option<&LaneRows<T>>) -> usize {
        let in_lanes = lanes.map_or(0, |lanes| lanes.bins_of(self.my) + before_a_line::<T>());
        in_lanes.max(self.my * self.transform.bins())
    }

    /// The length of the transforms' scratch, with lanes or without, whichever is larger.
    fn scratch_length(&self, lanes: Option<&LaneRows<T>>) -> usize {
        lanes.map_or(0, LaneRows::scratch_length).max(self.transform.scratch_length())
    }

    /// Transforms the rows of p that have values, in lanes if there are any. Returns the range of these rows.
    pub(crate) fn forward(&self, p: &[T], memory: &mut Memory<T>, lanes: Option<&LaneRows<T>>) -> Range<usize> {
        let (loaded, together, mx) = (rows_with_pressure(p, self.mx), self.at_a_time(lanes), self.mx);
        if let Some(lanes) = lanes {
            let rows = p[loaded.start * mx..loaded.end * mx].chunks(together * mx);
            let (bins, pieces) = self.blocks_of_bins(lanes, memory);
            let bins = lanes.groups(self.my, bins, loaded.clone());
            self.threads.share(rows.zip(bins), pieces, |(rows, mut bins), piece| {
                let (bins, scratch) = (&mut bins, &mut piece.scratch[..]);
                T::rows_forward(lanes.arch, Forward { plan: &lanes.plan, rows, width: mx, bins, scratch });
            });
        } else {
            let nb = self.transform.bins();
            let bins = &mut memory.bins[loaded.start * nb..loaded.end * nb];
            self.threads.for_each_row(bins, together * nb, &mut memory.pieces, |i, bins, piece| {
                let rows = &p[(loaded.start + i * together) * mx..][..bins.len() / nb * mx];
                self.transform.forward_together(rows, mx, bins, &mut piece.scratch);
            });
        }
        loaded
    }

    /// Transforms all rows back to u, in lanes if there are any.
    pub(crate) fn back(&self, u: &mut [T], memory: &mut Memory<T>, lanes: Option<&LaneRows<T>>) {
        self.each_back(u, memory, lanes, |_, u, piece, inverse| inverse(u, &mut piece.scratch));
    }

    /// Transforms all rows back, and calls `write(first element, values of u, transformed values)` for each group of rows.
    pub(crate) fn back_with(
        &self,
        u: &mut [T],
        memory: &mut Memory<T>,
        lanes: Option<&LaneRows<T>>,
        write: impl Fn(usize, &mut [T], &[T]) + Sync + Send,
    ) {
        let together = self.at_a_time(lanes);
        self.each_back(u, memory, lanes, |i, u, piece, inverse| {
            let rows = &mut piece.row[..u.len()];
            inverse(rows, &mut piece.scratch);
            write(i * together * self.mx, u, rows);
        });
    }

    /// Calls `work(i, values of u, piece, inverse)` for each group i of rows that are transformed together. `inverse(rows, scratch)` transforms the
    /// bins of this group back to `rows`.
    fn each_back(
        &self,
        u: &mut [T],
        memory: &mut Memory<T>,
        lanes: Option<&LaneRows<T>>,
        work: impl Fn(usize, &mut [T], &mut Piece<T>, &mut dyn FnMut(&mut [T], &mut [Complex<T>])) + Sync + Send,
    ) {
        let (mx, together) = (self.mx, self.at_a_time(lanes));
        if let Some(lanes) = lanes {
            let u = u.chunks_mut(together * mx).enumerate();
            let (bins, pieces) = self.blocks_of_bins(lanes, memory);
            let bins = lanes.groups(self.my, bins, 0..self.my);
            return self.threads.share(u.zip(bins), pieces, |((i, u), bins), piece| {
                work(i, u, piece, &mut |rows, scratch| {
                    T::rows_inverse(lanes.arch, Inverse { plan: &lanes.plan, bins: &bins, rows, width: mx, scratch });
                });
            });
        }
        let nb = self.transform.bins();
        let bins = (&mut memory.bins[..self.my * nb], together * nb);
        self.threads.for_each_row_pair_with((u, together * mx), bins, &mut memory.pieces, |i, u, bins, piece| {
            work(i, u, piece, &mut |rows, scratch| self.transform.inverse_together(bins, rows, mx, scratch));
        });
    }
}

/// The smallest range of rows outside of which `p` is zero.
fn rows_with_pressure<T: Real>(p: &[T], mx: usize) -> Range<usize> {
    // The whole row is read, without an early end: the compiler vectorises this loop.
    let loaded = |row: &[T]| row.iter().fold(false, |any, &value| any | (value != T::zero()));
    let Some(first) = p.chunks_exact(mx).position(loaded) else { return 0..0 };
    let last = p.chunks_exact(mx).rposition(loaded).unwrap_or(first);
    first..last + 1
}
