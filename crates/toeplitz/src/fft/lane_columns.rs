//! The y direction of products, a vector of columns at a time, one column in each lane.
//!
//! ```text
//! columns <- F^-1 (S . F columns)          one component: S real, S_k = S_(py-k) to round-off, one S for each column
//! ```
//!
//! Blocks of columns are as [`LaneRows`](crate::fft::lane_rows::LaneRows) write them,
//! `[row][part][column]`. S is stored as `[block of columns][kept row][column]` ([`even_plan`](crate::fft::even_plan)).
//!
//! With several components S is a matrix, and all components are done together ([`Factor`](crate::fft::column_pass::Factor)).

use std::sync::Arc;

use par::Result;

use crate::block::BLOCK;
use crate::fft::even_plan::EvenPlan;
use crate::passes::Real;

/// Products of columns of one length.
pub(crate) struct LaneColumns<T: Real> {
    pub(crate) plan: Arc<EvenPlan<T>>,
    pub(crate) arch: pulp::Arch,
}

impl<T: Real> LaneColumns<T> {
    /// Products of columns of this length; None if there is no plan for it.
    pub fn new(length: usize) -> Result<Option<LaneColumns<T>>> {
        LaneColumns::on(pulp::Arch::new(), length)
    }

    /// [`LaneColumns::new`] for an instruction set. Results have the same bits with any of them.
    fn on(arch: pulp::Arch, length: usize) -> Result<Option<LaneColumns<T>>> {
        Ok(EvenPlan::shared(length)?.map(|plan| LaneColumns { plan, arch }))
    }

    /// The length.
    pub fn length(&self) -> usize {
        self.plan.stages.length()
    }

    /// Kept rows of the symbol of a block.
    pub fn kept_rows(&self) -> usize {
        self.plan.bins.len()
    }

    /// Writes the symbol `value(column, bin)` of a block; zero for missing columns.
    pub fn write(&self, block: &mut [T], columns: usize, value: impl Fn(usize, usize) -> T) {
        for (row, &bin) in block.chunks_exact_mut(BLOCK).zip(&self.plan.bins) {
            let (there, beyond) = row.split_at_mut(columns.min(BLOCK));
            there.iter_mut().enumerate().for_each(|(column, to)| *to = value(column, bin));
            beyond.fill(T::zero());
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/lane_columns.rs"]
mod tests;
