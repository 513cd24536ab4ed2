//! The y direction of products with SIMD lanes: each lane of a vector holds one column.
//!
//! ```text
//! columns <- F^-1 (S . F columns)
//! ```
//!
//! Each column has its S. For one component with an even symbol, S is real and `S_k = S_(py-k)`. It is stored as `[block of columns][kept
//! row][column]` ([`even_plan`](crate::fft::even_plan)). With two components S is a matrix, and both components are multiplied together
//! ([`Factor`](crate::fft::column_pass::Factor)).
//!
//! A block of columns is `[row][part][column]`, as [`LaneRows`](crate::fft::lane_rows::LaneRows) write it.

use std::sync::Arc;

use par::Result;

use crate::block::BLOCK;
use crate::fft::even_plan::EvenPlan;
use crate::passes::Real;

/// The transforms of columns of one length, with an instruction set.
pub(crate) struct LaneColumns<T: Real> {
    pub(crate) plan: Arc<EvenPlan<T>>,
    pub(crate) arch: pulp::Arch,
}

impl<T: Real> LaneColumns<T> {
    /// Makes the transforms of columns of this length. Returns None if the length has no stages.
    pub fn new(length: usize) -> Result<Option<LaneColumns<T>>> {
        LaneColumns::on(pulp::Arch::new(), length)
    }

    /// [`LaneColumns::new`] for a given instruction set. All instruction sets give the same bits.
    fn on(arch: pulp::Arch, length: usize) -> Result<Option<LaneColumns<T>>> {
        Ok(EvenPlan::shared(length)?.map(|plan| LaneColumns { plan, arch }))
    }

    /// The length of a column.
    pub fn length(&self) -> usize {
        self.plan.stages.length()
    }

    /// The number of bins in y that an even symbol stores.
    pub fn kept_rows(&self) -> usize {
        self.plan.bins.len()
    }

    /// Writes the even symbol `value(column, bin)` of one block. Only the first `columns` columns are defined; the others are set to zero.
    pub fn write(&self, block: &mut [T], columns: usize, value: impl Fn(usize, usize) -> T) {
        for (row, &bin) in block.chunks_exact_mut(BLOCK).zip(&self.plan.bins) {
            let (defined, undefined) = row.split_at_mut(columns.min(BLOCK));
            defined.iter_mut().enumerate().for_each(|(column, to)| *to = value(column, bin));
            undefined.fill(T::zero());
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/lane_columns.rs"]
mod tests;
