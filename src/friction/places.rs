//! The elements of C one after the other: fields of an iteration hold these only.
//!
//! They are cut into blocks at rows of the grid, so that a pass has both the values of its elements and their rows of a field on the grid. Blocks depend on C
//! alone: sums by blocks have the same bits for any number of threads.

use std::ops::Range;

use super::vectors::BLOCK;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::reserve;

/// Where the elements of C are.
#[derive(Default)]
pub struct Places {
    /// Of each element of C its place on the grid. Grids of more elements than 32 bits count would take 300 GB.
    elements: Vec<u32>,
    blocks: Vec<Block>,
    mx: usize,
}

/// A grid has so many blocks, where they are not too small then.
const BLOCKS: usize = 64;

/// Some rows of the grid, with up to [`BLOCK`] elements of C or a row more.
#[derive(Clone, Copy)]
struct Block {
    places: (usize, usize),
    rows: (usize, usize),
}

/// A block of a pass: its elements, and where they are.
pub struct Part<'a> {
    /// The first element.
    pub start: usize,
    elements: &'a [u32],
    /// The first place of its rows.
    first: usize,
}

impl<'a> Part<'a> {
    /// Places on the grid, in the order of the elements.
    pub fn on_grid(&self) -> impl Iterator<Item = usize> + 'a {
        self.elements.iter().map(|&i| i as usize)
    }

    /// The same within the rows of the block.
    pub fn in_rows(&self) -> impl Iterator<Item = usize> + 'a {
        let first = self.first;
        self.on_grid().map(move |i| i - first)
    }
}

impl Places {
    /// With room for all elements of a grid.
    pub fn new(grid: &Grid) -> Result<Places> {
        let what = "the elements of C";
        let mut places = Places { mx: grid.mx, ..Places::default() };
        reserve(&mut places.elements, grid.len(), what)?;
        reserve(&mut places.blocks, grid.my, what)?;
        Ok(places)
    }

    /// C has changed: where `bound` is positive.
    pub fn contact_changed(&mut self, bound: &[f64]) {
        let Places { elements, blocks, mx } = self;
        elements.clear();
        blocks.clear();
        let rows = bound.len() / *mx;
        let least = (bound.len() / BLOCKS).clamp(BLOCK / 4, BLOCK);
        let mut begun = Block { places: (0, 0), rows: (0, 0) };
        for (iy, row) in bound.chunks_exact(*mx).enumerate() {
            let inside = row.iter().enumerate().filter(|(_, g)| **g > 0.0);
            elements.extend(inside.map(|(ix, _)| (iy * *mx + ix) as u32));
            (begun.places.1, begun.rows.1) = (elements.len(), iy + 1);
            if begun.places.1 - begun.places.0 >= least || iy + 1 == rows {
                blocks.push(begun);
                begun = Block { places: (elements.len(), elements.len()), rows: (iy + 1, iy + 1) };
            }
        }
    }

    /// Elements of C.
    pub fn count(&self) -> usize {
        self.elements.len()
    }

    /// Their places on the grid.
    pub fn elements(&self) -> impl Iterator<Item = usize> + '_ {
        self.elements.iter().map(|&i| i as usize)
    }

    /// The blocks.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        self.blocks.iter().map(|block| {
            let elements = &self.elements[block.range()];
            Part { start: block.places.0, elements, first: block.rows.0 * self.mx }
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.elements.capacity() * size_of::<u32>() + self.blocks.capacity() * size_of::<Block>()
    }

    /// A field on C by blocks.
    pub fn cut<'a, A>(&'a self, field: &'a mut [A]) -> impl Iterator<Item = &'a mut [A]> {
        debug_assert_eq!(field.len(), self.count());
        cut(field, self.blocks.iter().map(|block| block.range().len()))
    }

    /// A field on the grid by blocks.
    pub fn cut_grid<'a, A>(&'a self, field: &'a mut [A]) -> impl Iterator<Item = &'a mut [A]> {
        cut(field, self.blocks.iter().map(|block| (block.rows.1 - block.rows.0) * self.mx))
    }
}

impl Block {
    fn range(&self) -> Range<usize> {
        self.places.0..self.places.1
    }
}

/// Consecutive pieces of so many values.
fn cut<'a, A>(mut rest: &'a mut [A], lengths: impl Iterator<Item = usize> + 'a) -> impl Iterator<Item = &'a mut [A]> {
    lengths.map(move |length| {
        let (piece, behind) = std::mem::take(&mut rest).split_at_mut(length);
        rest = behind;
        piece
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every element of C stands in one block, in order, and its block has its row of the grid.
    #[test]
    fn blocks_have_all_elements_and_all_rows() {
        for (mx, my, inside) in [(70, 50, 3), (1, 9, 2), (3000, 2, 1), (5, 4, 1000)] {
            let bound: Vec<f64> = (0..mx * my).map(|i| if i % inside == 1 % inside { 1.0 } else { 0.0 }).collect();
            let mut places = Places::new(&Grid::new(mx, my, 1.0, 1.0).unwrap()).unwrap();
            // What C was before is forgotten.
            places.contact_changed(&vec![1.0; mx * my]);
            places.contact_changed(&bound);
            let expected: Vec<usize> = (0..mx * my).filter(|&i| bound[i] > 0.0).collect();
            assert!(places.elements().eq(expected.iter().copied()));
            assert_eq!(places.count(), expected.len());
            let (mut on_grid, mut on_c) = (vec![0; mx * my], vec![0; expected.len()]);
            let blocks = places.parts().zip(places.cut(&mut on_c)).zip(places.cut_grid(&mut on_grid));
            for ((part, on_c), on_grid) in blocks {
                assert!(part.on_grid().eq(expected[part.start..part.start + on_c.len()].iter().copied()));
                part.in_rows().for_each(|place| on_grid[place] += 1);
                on_c.iter_mut().for_each(|count| *count += 1);
            }
            assert!(on_c.iter().all(|count| *count == 1));
            assert!(on_grid.iter().zip(&bound).all(|(count, g)| f64::from(*count) == *g));
            assert_eq!(places.cut_grid(&mut on_grid).map(|rows| rows.len()).sum::<usize>(), mx * my);
        }
    }
}
