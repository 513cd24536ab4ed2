//! The elements of C in one sequence, row by row: the fields of an iteration hold the values of these elements only.
//!
//! The sequence is cut into blocks between rows of the grid, so that a pass over a block has the values of its elements and, of a field on the grid,
//! the rows with these elements. The cuts depend on C alone, so that sums over blocks have the same bits for any number of threads. Each block is
//! padded with zeros to a whole number of SIMD vectors.

use crate::blocks::{BLOCK, BLOCKS, LANES};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::reserve;
use crate::operator::fft::Real;

/// The elements of C: their indices on the grid, and the blocks of their sequence.
#[derive(Default)]
pub struct Places {
    /// The elements, as runs of neighbours in a row.
    runs: Vec<Run>,
    blocks: Vec<Block>,
    /// The number of elements in a row of the grid.
    mx: usize,
    /// The number of elements of C.
    count: usize,
}

/// Nearly all of C slips if more than this part of its elements slips.
const MOSTLY_SLIP: f64 = 0.8;

/// Neighbours in a row: the index of the first on the grid, and their number. 32 bits suffice, because a problem of 2^32 elements would take 300 GB.
#[derive(Clone, Copy)]
struct Run {
    first: u32,
    length: u32,
}

/// Consecutive rows of the grid. Without its last row a block has fewer than [`BLOCK`] elements of C.
#[derive(Clone, Copy)]
struct Block {
    /// The first run of the block, and the one after its last.
    runs: (usize, usize),
    /// The first row of the block, and the one after its last.
    rows: (usize, usize),
    /// The number of elements of C in the block.
    elements: usize,
}

impl Block {
    /// The number of values of a field in the block, including the padding.
    fn length(&self) -> usize {
        self.elements.next_multiple_of(LANES)
    }
}

/// The elements of one block, for a pass.
pub struct Part<'a> {
    runs: &'a [Run],
    /// The index on the grid of the first element of the block's rows.
    first: usize,
}

impl Part<'_> {
    /// Calls `work(index on the grid, index in the block, number)` on each run, with the indices of its first element and its number of elements.
    #[inline(always)]
    fn each_run(&self, mut work: impl FnMut(usize, usize, usize)) {
        let mut in_block = 0;
        for run in self.runs {
            let length = run.length as usize;
            work(run.first as usize, in_block, length);
            in_block += length;
        }
    }

    /// Copies the values of the block's elements from a field on the grid to the block.
    #[inline(always)]
    pub fn gather<T: Real>(&self, field: &[T], to: &mut [f64]) {
        self.each_run(
            #[inline(always)]
            |on_grid, in_block, length| {
                let to = to[in_block..in_block + length].iter_mut();
                to.zip(&field[on_grid..on_grid + length]).for_each(|(to, value)| *to = value.to_double());
            },
        );
    }

    /// Copies the values of the block's elements from the block to its rows of a field on the grid.
    #[inline(always)]
    pub fn scatter<T: Real>(&self, from: &[f64], rows: &mut [T]) {
        self.each_run(
            #[inline(always)]
            |on_grid, in_block, length| {
                let to = rows[on_grid - self.first..][..length].iter_mut();
                to.zip(&from[in_block..in_block + length]).for_each(|(to, value)| *to = T::of(*value));
            },
        );
    }

    /// Calls `work(index on the grid, index in the block)` on each element.
    pub fn each(&self, mut work: impl FnMut(usize, usize)) {
        self.each_run(|on_grid, in_block, length| (0..length).for_each(|k| work(on_grid + k, in_block + k)));
    }

    /// The index on the grid of the first element of the block's rows.
    pub fn first(&self) -> usize {
        self.first
    }
}

impl Places {
    /// An empty C, with memory for all elements of a grid.
    pub fn new(grid: &Grid) -> Result<Places> {
        let what = "the elements of C";
        let mut places = Places { mx: grid.mx, ..Places::default() };
        reserve(&mut places.runs, grid.my * grid.mx.div_ceil(2), what)?;
        reserve(&mut places.blocks, grid.my, what)?;
        Ok(places)
    }

    /// Sets C to the elements of positive `bound`.
    pub fn contact_changed(&mut self, bound: &[f64]) {
        let Places { runs, blocks, mx, count } = self;
        runs.clear();
        blocks.clear();
        let rows = bound.len() / *mx;
        // A block ends with the row at which it has `least` elements. If all elements are in C, there are about BLOCKS blocks.
        let least = (bound.len() / BLOCKS).clamp(BLOCK / 4, BLOCK);
        let mut begun = Block { runs: (0, 0), rows: (0, 0), elements: 0 };
        *count = 0;
        for (iy, row) in bound.chunks_exact(*mx).enumerate() {
            let mut index = iy * *mx;
            for run in row.chunk_by(|g, next| (*g > 0.0) == (*next > 0.0)) {
                if run[0] > 0.0 {
                    runs.push(Run { first: index as u32, length: run.len() as u32 });
                    begun.elements += run.len();
                }
                index += run.len();
            }
            (begun.runs.1, begun.rows.1) = (runs.len(), iy + 1);
            if begun.elements >= least || iy + 1 == rows {
                *count += begun.elements;
                blocks.push(begun);
                begun = Block { runs: (runs.len(), runs.len()), rows: (iy + 1, iy + 1), elements: 0 };
            }
        }
    }

    /// The number of elements of C.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether nearly all of C slips if `slipping` elements slip. Then Newton's method is faster than the conjugate gradients, and methods that find
    /// creepages and tractions in turns succeed.
    pub fn is_mostly_slip(&self, slipping: usize) -> bool {
        slipping as f64 > MOSTLY_SLIP * self.count as f64
    }

    /// The number of values of a field on C, including the padding.
    pub fn length(&self) -> usize {
        self.blocks.iter().map(Block::length).sum()
    }

    /// The indices of the elements of C on the grid.
    pub fn elements(&self) -> impl Iterator<Item = usize> + '_ {
        self.runs.iter().flat_map(|run| (0..run.length).map(|k| (run.first + k) as usize))
    }

    /// The blocks, with their elements.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let part = |block: &Block| Part { runs: &self.runs[block.runs.0..block.runs.1], first: block.rows.0 * self.mx };
        self.blocks.iter().map(part)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.runs.capacity() * size_of::<Run>() + self.blocks.capacity() * size_of::<Block>()
    }

    /// Cuts the memory of `count` fields on C into one slice for each block, `[block][field][element]`.
    pub fn cut<'a, A>(&'a self, fields: &'a mut [A], count: usize) -> impl Iterator<Item = &'a mut [A]> {
        debug_assert_eq!(fields.len(), count * self.length());
        cut(fields, self.blocks.iter().map(move |block| count * block.length()))
    }

    /// Cuts a field on the grid into one slice for each block, which holds the block's rows.
    pub fn cut_grid<'a, A>(&'a self, field: &'a mut [A]) -> impl Iterator<Item = &'a mut [A]> {
        cut(field, self.blocks.iter().map(|block| (block.rows.1 - block.rows.0) * self.mx))
    }
}

/// Cuts a slice into consecutive pieces of the given lengths.
fn cut<'a, A>(mut rest: &'a mut [A], lengths: impl Iterator<Item = usize> + 'a) -> impl Iterator<Item = &'a mut [A]> {
    lengths.map(move |length| {
        let (piece, after) = std::mem::take(&mut rest).split_at_mut(length);
        rest = after;
        piece
    })
}

#[cfg(test)]
#[path = "../../tests/unit/places.rs"]
mod tests;
