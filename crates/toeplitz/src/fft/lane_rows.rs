//! Transforms of real rows, one row in each SIMD lane. A row x of even length n is transformed as h = n/2 complex numbers z (Cooley, Lewis and Welch
//! 1970). With X the bins of the row:
//!
//! ```text
//! z_j = x_2j + i x_(2j+1),   Z = F z,   w_k = exp(-2 pi i k/n)
//! X_k = (Z_k + Z*_(h-k))/2 - i w_k (Z_k - Z*_(h-k))/2                  k = 0 ..= h, Z_h = Z_0
//! Z_k = X_k + X*_(h-k) + i w*_k (X_k - X*_(h-k))                       backwards; 2 Z, so that the unnormalised inverse gives 2 h z = n z
//! ```
//!
//! Bins are stored in blocks of [`BLOCK`] bins, `[block][row][part][bin]`: in each block the real parts of a row come before its imaginary parts. The
//! transforms of columns, which follow, find each block in contiguous memory. Seen as a matrix with one row for each block, the memory of a group of
//! rows is a group of columns, so threads can write different groups at the same time ([`Block`]). Values are transposed between rows and vectors
//! four columns at a time.

use std::ops::Range;
use std::sync::Arc;

use par::Result;

use crate::block::{blocks_of, Block, BLOCK};
use crate::fft::row_pass::LaneCount;
use crate::fft::row_plan::RowPlan;
use crate::fft::stages::before_a_line;
use crate::passes::Real;
use crate::real::Complex;

/// The transforms of rows of one length, with an instruction set.
pub(crate) struct LaneRows<T: Real> {
    pub(crate) plan: Arc<RowPlan<T>>,
    pub(crate) arch: pulp::Arch,
    /// The number of lanes of a vector of T.
    lanes: usize,
}

impl<T: Real> LaneRows<T> {
    /// Makes the transforms of rows of length n. Returns None if n/2 has no stages, or if the machine has no SIMD vectors.
    pub fn new(n: usize) -> Result<Option<LaneRows<T>>> {
        LaneRows::on(pulp::Arch::new(), n)
    }

    /// [`LaneRows::new`] for a given instruction set. All instruction sets give the same bits.
    pub(crate) fn on(arch: pulp::Arch, n: usize) -> Result<Option<LaneRows<T>>> {
        match arch.dispatch(LaneCount::<f64>(std::marker::PhantomData)) {
            Some(1) => Ok(None),
            _ => LaneRows::of_any(arch, n),
        }
    }

    /// [`LaneRows::on`], also for machines without SIMD vectors, which transform one row at a time.
    pub(crate) fn of_any(arch: pulp::Arch, n: usize) -> Result<Option<LaneRows<T>>> {
        let Some(lanes) = arch.dispatch(LaneCount::<T>(std::marker::PhantomData)) else { return Ok(None) };
        Ok(RowPlan::shared(n)?.map(|plan| LaneRows { plan, arch, lanes }))
    }

    /// The number of complex bins of a row, n/2 + 1.
    pub fn bins(&self) -> usize {
        self.plan.length() + 1
    }

    /// The number of blocks of bins. The last block may have bins beyond n/2, which are undefined.
    pub fn blocks(&self) -> usize {
        self.plan.blocks()
    }

    /// The number of rows that are transformed together.
    pub fn at_a_time(&self) -> usize {
        self.lanes
    }

    /// The number of rows of a block of bins, for a grid of `my` rows. The blocks have rows beyond the grid, because a group of rows that are
    /// transformed together may begin at the last row of the grid.
    pub fn height(&self, my: usize) -> usize {
        my + self.lanes - 1
    }

    /// The number of bins in all blocks, for a grid of `my` rows.
    pub fn bins_of(&self, my: usize) -> usize {
        self.blocks() * self.height(my) * BLOCK
    }

    /// The bins of the rows `rows` of a grid of `my` rows, in groups of rows that are transformed together. The last group may end beyond `rows`.
    pub fn groups<'a>(
        &self,
        my: usize,
        bins: &'a mut [Complex<T>],
        rows: Range<usize>,
    ) -> impl DoubleEndedIterator<Item = Block<'a, T>> + ExactSizeIterator + Send {
        let end = rows.start + rows.len().next_multiple_of(self.lanes);
        blocks_of(bins, self.height(my) * BLOCK, rows.start * BLOCK..end * BLOCK, self.lanes * BLOCK)
    }

    /// The length of the scratch that the transforms in both directions need.
    pub fn scratch_length(&self) -> usize {
        self.plan.length() * self.lanes + before_a_line::<T>()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/lane_rows.rs"]
mod tests;
