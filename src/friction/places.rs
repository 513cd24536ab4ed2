//! The elements of C in one sequence: the fields of an iteration hold these elements only.
//!
//! The sequence is cut into blocks at rows of the grid, so that a pass has the values of its elements and their rows of a field on the
//! grid. Blocks depend on C alone: sums by blocks have the same bits for any number of threads. Blocks are padded with zeros to a whole
//! number of vectors.

use crate::blocks::{BLOCK, BLOCKS, LANES};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::reserve;
use crate::operator::fft::Real;

/// The places of the elements of C on the grid.
#[derive(Default)]
pub struct Places {
    /// Runs of neighbours in a row.
    runs: Vec<Run>,
    blocks: Vec<Block>,
    mx: usize,
    count: usize,
}

/// The part of C in slip from which nearly all of it slips.
const MOSTLY_SLIP: f64 = 0.8;

/// Neighbours in a row: the place of the first on the grid, and their number. 32 bits suffice: 2^32 elements would take 300 GB.
#[derive(Clone, Copy)]
struct Run {
    first: u32,
    length: u32,
}

/// Rows of the grid, with up to [`BLOCK`] elements of C and one row more.
#[derive(Clone, Copy)]
struct Block {
    runs: (usize, usize),
    rows: (usize, usize),
    elements: usize,
}

impl Block {
    /// The number of elements with the padding.
    fn length(&self) -> usize {
        self.elements.next_multiple_of(LANES)
    }
}

/// A block of a pass: the places of its elements.
pub struct Part<'a> {
    runs: &'a [Run],
    /// The first place of the block's rows.
    first: usize,
}

impl Part<'_> {
    /// Calls `work(place on the grid, place in the block, elements)` on each run of elements.
    #[inline(always)]
    fn each_run(&self, mut work: impl FnMut(usize, usize, usize)) {
        let mut at = 0;
        for run in self.runs {
            let length = run.length as usize;
            work(run.first as usize, at, length);
            at += length;
        }
    }

    /// Copies the values of the block's elements from a field on the grid.
    #[inline(always)]
    pub fn gather<T: Real>(&self, field: &[T], to: &mut [f64]) {
        self.each_run(
            #[inline(always)]
            |place, at, length| {
                let to = to[at..at + length].iter_mut();
                to.zip(&field[place..place + length]).for_each(|(to, value)| *to = value.to_double());
            },
        );
    }

    /// Copies the values of the block's elements to its rows of a field on the grid.
    #[inline(always)]
    pub fn scatter<T: Real>(&self, from: &[f64], rows: &mut [T]) {
        self.each_run(
            #[inline(always)]
            |place, at, length| {
                let to = rows[place - self.first..][..length].iter_mut();
                to.zip(&from[at..at + length]).for_each(|(to, value)| *to = T::of(*value));
            },
        );
    }

    /// Calls `work(place on the grid, place in the block)` on each element.
    pub fn each(&self, mut work: impl FnMut(usize, usize)) {
        self.each_run(|place, at, length| (0..length).for_each(|k| work(place + k, at + k)));
    }

    /// The first place of the block's rows on the grid.
    pub fn first(&self) -> usize {
        self.first
    }
}

impl Places {
    /// No elements, with room for all elements of a grid.
    pub fn new(grid: &Grid) -> Result<Places> {
        let what = "the elements of C";
        let mut places = Places { mx: grid.mx, ..Places::default() };
        reserve(&mut places.runs, grid.my * grid.mx.div_ceil(2), what)?;
        reserve(&mut places.blocks, grid.my, what)?;
        Ok(places)
    }

    /// Takes the elements of positive `bound` as C.
    pub fn contact_changed(&mut self, bound: &[f64]) {
        let Places { runs, blocks, mx, count } = self;
        runs.clear();
        blocks.clear();
        let rows = bound.len() / *mx;
        // A block ends with the row that gives it `least` elements: the part 1/BLOCKS of a full grid, but between a quarter of BLOCK and BLOCK.
        let least = (bound.len() / BLOCKS).clamp(BLOCK / 4, BLOCK);
        let mut begun = Block { runs: (0, 0), rows: (0, 0), elements: 0 };
        *count = 0;
        for (iy, row) in bound.chunks_exact(*mx).enumerate() {
            let mut at = iy * *mx;
            for run in row.chunk_by(|g, next| (*g > 0.0) == (*next > 0.0)) {
                if run[0] > 0.0 {
                    runs.push(Run { first: at as u32, length: run.len() as u32 });
                    begun.elements += run.len();
                }
                at += run.len();
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

    /// Whether nearly all of C slips if `slipping` elements do. Newton's method is faster then, and methods that find
    /// creepages and tractions in turns succeed.
    pub fn is_mostly_slip(&self, slipping: usize) -> bool {
        slipping as f64 > MOSTLY_SLIP * self.count as f64
    }

    /// The number of values of a field, with the padding.
    pub fn length(&self) -> usize {
        self.blocks.iter().map(Block::length).sum()
    }

    /// The places of the elements of C on the grid.
    pub fn elements(&self) -> impl Iterator<Item = usize> + '_ {
        self.runs.iter().flat_map(|run| (0..run.length).map(|k| (run.first + k) as usize))
    }

    /// The blocks.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let part = |block: &Block| Part { runs: &self.runs[block.runs.0..block.runs.1], first: block.rows.0 * self.mx };
        self.blocks.iter().map(part)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.runs.capacity() * size_of::<Run>() + self.blocks.capacity() * size_of::<Block>()
    }

    /// Cuts `count` fields on C into blocks, in which the fields follow each other.
    pub fn cut<'a, A>(&'a self, fields: &'a mut [A], count: usize) -> impl Iterator<Item = &'a mut [A]> {
        debug_assert_eq!(fields.len(), count * self.length());
        cut(fields, self.blocks.iter().map(move |block| count * block.length()))
    }

    /// Cuts a field on the grid into the rows of each block.
    pub fn cut_grid<'a, A>(&'a self, field: &'a mut [A]) -> impl Iterator<Item = &'a mut [A]> {
        cut(field, self.blocks.iter().map(|block| (block.rows.1 - block.rows.0) * self.mx))
    }
}

/// Consecutive pieces of the given lengths.
fn cut<'a, A>(mut rest: &'a mut [A], lengths: impl Iterator<Item = usize> + 'a) -> impl Iterator<Item = &'a mut [A]> {
    lengths.map(move |length| {
        let (piece, behind) = std::mem::take(&mut rest).split_at_mut(length);
        rest = behind;
        piece
    })
}

#[cfg(test)]
#[path = "../../tests/unit/places.rs"]
mod tests;
