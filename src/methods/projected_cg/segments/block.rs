//! A block of the grid, and the traits of formulas for its elements.

use std::ops::Range;

use pulp::Simd;

use crate::blocks::LANES;
use crate::lanes::{Holds, Lanes};

/// K sums of a pass over A arrays in double precision and B arrays of the iteration's precision.
pub trait Terms<const A: usize, const B: usize, const K: usize> {
    fn of<S: Simd>(&self, a: [Lanes<S>; A], b: [Lanes<S>; B]) -> [Lanes<S>; K];
}

/// A new value per element, from A arrays in double precision and B arrays of the iteration's precision.
pub trait Becomes<const A: usize, const B: usize> {
    fn of<S: Simd>(&self, value: Lanes<S>, a: [Lanes<S>; A], b: [Lanes<S>; B]) -> Lanes<S>;
}

/// The elements that a pass lists, by their values and those of N other arrays.
pub trait Wanted<const N: usize> {
    /// `first`: the element of the first value.
    fn of<S: Simd>(&self, first: usize, value: Lanes<S>, others: [Lanes<S>; N]) -> Holds<S>;
}

/// A block of the grid.
#[derive(Clone, Copy)]
pub struct Block<'a> {
    pub(super) start: usize,
    pub(super) contact: &'a [bool],
    pub(super) segments: &'a [u32],
}

impl<'a> Block<'a> {
    /// A block of up to `length` elements of the grid, from `start` on.
    pub fn new(start: usize, contact: &'a [bool], length: usize, segments: &'a [u32]) -> Block<'a> {
        Block { start, contact: &contact[start..contact.len().min(start + length)], segments }
    }

    /// The elements of the block.
    pub fn elements(self) -> Range<usize> {
        self.start..self.start + self.contact.len()
    }

    /// Elements of each segment: among those of the grid, and among those of the block.
    pub fn segments(self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + 'a {
        self.segments.iter().map(move |&k| {
            let local = LANES * k as usize..self.contact.len().min(LANES * (k as usize + 1));
            (self.start + local.start..self.start + local.end, local)
        })
    }
}
