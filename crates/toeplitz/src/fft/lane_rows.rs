//! Transforms of real rows, one row in each SIMD lane: an even length n by a complex transform of h = n/2 values.
//!
//! ```text
//! z_j = x_2j + i x_(2j+1),   Z = F z,   w_k = exp(-2 pi i k/n)        (Cooley, Lewis and Welch 1970)
//! X_k = (Z_k + Z*_(h-k))/2 - i w_k (Z_k - Z*_(h-k))/2                  k = 0 .. h, Z_h = Z_0
//! Z_k = X_k + X*_(h-k) + i w*_k (X_k - X*_(h-k))                       backwards, unnormalised: 2 h times z
//! ```
//!
//! Bins are stored in blocks of [`BLOCK`], `[block][row][part][bin]`, the real parts of a row before its imaginary ones. So the column
//! transforms, which follow, find a block in one piece, and a group of rows is a group of columns of the matrix whose rows are blocks. Values
//! are transposed to vectors and back four columns at a time.

use std::ops::Range;
use std::sync::Arc;

use par::Result;

use crate::block::{blocks_of, Block, BLOCK};
use crate::fft::row_pass::LaneCount;
use crate::fft::row_plan::RowPlan;
use crate::fft::stages::before_a_line;
use crate::passes::Real;
use crate::real::Complex;

/// Transforms of rows of one length.
pub(crate) struct LaneRows<T: Real> {
    pub(crate) plan: Arc<RowPlan<T>>,
    pub(crate) arch: pulp::Arch,
    lanes: usize,
}

impl<T: Real> LaneRows<T> {
    /// None if the length has no plan, or the machine no vectors.
    pub fn new(n: usize) -> Result<Option<LaneRows<T>>> {
        LaneRows::on(pulp::Arch::new(), n)
    }

    /// [`LaneRows::new`] for an instruction set. Results have the same bits with any of them.
    pub(crate) fn on(arch: pulp::Arch, n: usize) -> Result<Option<LaneRows<T>>> {
        match arch.dispatch(LaneCount::<f64>(std::marker::PhantomData)) {
            Some(1) => Ok(None),
            _ => LaneRows::of_any(arch, n),
        }
    }

    /// [`LaneRows::on`] that serves machines without vectors as well, one row at a time.
    pub(crate) fn of_any(arch: pulp::Arch, n: usize) -> Result<Option<LaneRows<T>>> {
        let Some(lanes) = arch.dispatch(LaneCount::<T>(std::marker::PhantomData)) else { return Ok(None) };
        Ok(RowPlan::shared(n)?.map(|plan| LaneRows { plan, arch, lanes }))
    }

    /// Number of complex bins.
    pub fn bins(&self) -> usize {
        self.plan.length() + 1
    }

    /// Number of blocks of bins; bins beyond n/2 are undefined.
    pub fn blocks(&self) -> usize {
        self.plan.blocks()
    }

    /// Rows that are transformed together.
    pub fn at_a_time(&self) -> usize {
        self.lanes
    }

    /// Rows of a block of bins of a grid of `my` rows: a group of rows transformed together may begin at the last row, and is always whole.
    pub fn height(&self, my: usize) -> usize {
        my + self.lanes - 1
    }

    /// Number of bins in the blocks of a grid of `my` rows.
    pub fn bins_of(&self, my: usize) -> usize {
        self.blocks() * self.height(my) * BLOCK
    }

    /// These rows of the blocks of a grid of `my` rows, in groups that are transformed together: the last group may end beyond `rows`.
    pub fn groups<'a>(
        &self,
        my: usize,
        bins: &'a mut [Complex<T>],
        rows: Range<usize>,
    ) -> impl DoubleEndedIterator<Item = Block<'a, T>> + ExactSizeIterator + Send {
        let end = rows.start + rows.len().next_multiple_of(self.lanes);
        blocks_of(bins, self.height(my) * BLOCK, rows.start * BLOCK..end * BLOCK, self.lanes * BLOCK)
    }

    /// Length of the scratch of both directions.
    pub fn scratch_length(&self) -> usize {
        self.plan.length() * self.lanes + before_a_line::<T>()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/lane_rows.rs"]
mod tests;
