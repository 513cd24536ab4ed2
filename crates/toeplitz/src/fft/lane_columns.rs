//! The y direction of products, a vector of columns at a time, one column in each place.
//!
//! ```text
//! columns <- F^-1 (S . F columns)          of one component: S real, S_k = S_(py-k) to within rounding, one for each column
//! ```
//!
//! Blocks of columns are as [`LaneRows`](crate::fft::lane_rows::LaneRows) write them,
//! `[row][part][column]`. S is kept as `[block of columns][kept row][column]` ([`even_plan`](crate::fft::even_plan)).
//!
//! Of several components S is a matrix, and all are worked on together ([`Factor`](crate::fft::column_pass::Factor)).

use std::ops::Range;
use std::sync::Arc;

use par::Result;

use crate::block::BLOCK;
use crate::fft::column_pass::{Blocks, EvenSymbol, Multiply};
use crate::fft::even_plan::EvenPlan;
use crate::passes::Real;
use crate::real::Complex;

/// Products of columns of one length.
pub(crate) struct LaneColumns<T: Real> {
    plan: Arc<EvenPlan<T>>,
    arch: pulp::Arch,
}

impl<T: Real> LaneColumns<T> {
    /// None where the length has no plan.
    pub fn new(length: usize) -> Result<Option<LaneColumns<T>>> {
        LaneColumns::on(pulp::Arch::new(), length)
    }

    /// With the vectors of these instructions; no bit depends on them.
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

    /// Writes the symbol of a block, of `value(column, bin)` of the columns that there are; zero for the others.
    pub fn write(&self, block: &mut [T], columns: usize, value: impl Fn(usize, usize) -> T) {
        for (row, &bin) in block.chunks_exact_mut(BLOCK).zip(&self.plan.bins) {
            let (there, beyond) = row.split_at_mut(columns.min(BLOCK));
            there.iter_mut().enumerate().for_each(|(column, to)| *to = value(column, bin));
            beyond.fill(T::zero());
        }
    }

    /// Multiplies the columns of a block, `columns` of which mean something and rows `loaded` of which hold values, by its symbol, in memory
    /// for them. `next` is where the next block stands, of as many rows.
    pub fn multiply(
        &self,
        (block, columns): (&mut [Complex<T>], usize),
        next: *const Complex<T>,
        loaded: Range<usize>,
        symbol: &[T],
        memory: &mut [Complex<T>],
    ) {
        assert_eq!(symbol.len(), BLOCK * self.kept_rows());
        let blocks = Blocks { blocks: [block], columns, next: [next], loaded: [loaded] };
        self.multiply_all(blocks, &EvenSymbol(symbol), memory, T::by_even);
    }

    /// The same of K components, by the pass that belongs to the factor.
    pub fn multiply_all<F, const K: usize>(
        &self,
        blocks: Blocks<'_, T, K>,
        factor: &F,
        memory: &mut [Complex<T>],
        pass: impl FnOnce(pulp::Arch, Multiply<'_, T, F, K>),
    ) {
        for (block, loaded) in blocks.blocks.iter().zip(&blocks.loaded) {
            let rows = block.len() / BLOCK;
            assert!(rows <= self.plan.stages.length() && loaded.end <= rows && block.len() % BLOCK == 0);
        }
        pass(self.arch, Multiply { plan: &self.plan, blocks, factor, memory });
    }
}

#[cfg(test)]
#[path = "../../tests/unit/lane_columns.rs"]
mod tests;
