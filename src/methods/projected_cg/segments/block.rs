//! A block of the grid, and the traits that a formula for its elements implements.

use std::ops::Range;

use pulp::Simd;

use crate::blocks::LANES;
use crate::lanes::{Holds, Lanes};

/// A formula for K sums over C, from A arrays in double precision and B arrays in the precision of the iteration.
pub trait Terms<const A: usize, const B: usize, const K: usize> {
    /// The terms of the elements of one vector.
    fn of<S: Simd>(&self, a: [Lanes<S>; A], b: [Lanes<S>; B]) -> [Lanes<S>; K];
}

/// A formula for a new value of an array, from A arrays in double precision and B arrays in the precision of the iteration.
pub trait Becomes<const A: usize, const B: usize> {
    /// The new values of the elements of one vector. `value` has the present ones.
    fn of<S: Simd>(&self, value: Lanes<S>, a: [Lanes<S>; A], b: [Lanes<S>; B]) -> Lanes<S>;
}

/// A condition for elements that a loop lists, on their value and on the values of N other arrays.
pub trait Wanted<const N: usize> {
    /// A mask of the elements of one vector that are listed. `first` is the element of its first lane.
    fn of<S: Simd>(&self, first: usize, value: Lanes<S>, others: [Lanes<S>; N]) -> Holds<S>;
}

/// A block of the grid, with the numbers of its segments.
#[derive(Clone, Copy)]
pub struct Block<'a> {
    /// The first element of the block.
    pub(super) start: usize,
    /// The contact area in the block.
    pub(super) contact: &'a [bool],
    pub(super) segments: &'a [u32],
}

impl<'a> Block<'a> {
    /// The block of at most `length` elements from `start` on. `contact` is the contact area on the whole grid.
    pub fn new(start: usize, contact: &'a [bool], length: usize, segments: &'a [u32]) -> Block<'a> {
        Block { start, contact: &contact[start..contact.len().min(start + length)], segments }
    }

    /// The elements of the block.
    pub fn elements(self) -> Range<usize> {
        self.start..self.start + self.contact.len()
    }

    /// For each segment: the range of its elements on the grid, and the same range counted from the first element of the block.
    pub fn segments(self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + 'a {
        self.segments.iter().map(move |&k| {
            let local = LANES * k as usize..self.contact.len().min(LANES * (k as usize + 1));
            (self.start + local.start..self.start + local.end, local)
        })
    }
}
