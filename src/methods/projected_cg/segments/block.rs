//! Passes over the segments of a block, and what a formula is to say of each element.

use std::ops::Range;

use pulp::Simd;

use super::arrays::{Arrays, EIGHT};
use super::lists::{Everywhere, List};
use super::passes::{Changes, Sum};
use super::vector::{Holds, Vector};
use crate::operator::fft::Real;

/// What a pass sums, in K sums, of A arrays in double precision and B of the iteration's.
pub trait Terms<const A: usize, const B: usize, const K: usize> {
    fn of<S: Simd>(&self, a: [Vector<S>; A], b: [Vector<S>; B]) -> [Vector<S>; K];
}

/// What a value becomes, beside A arrays in double precision and B of the iteration's.
pub trait Becomes<const A: usize, const B: usize> {
    fn of<S: Simd>(&self, value: Vector<S>, a: [Vector<S>; A], b: [Vector<S>; B]) -> Vector<S>;
}

/// Which elements a pass lists, by their values and those of N other arrays.
pub trait Wanted<const N: usize> {
    /// `first`: the element of the first value.
    fn of<S: Simd>(&self, first: usize, value: Vector<S>, others: [Vector<S>; N]) -> Holds<S>;
}

/// A block of the grid.
#[derive(Clone, Copy)]
pub struct Block<'a> {
    pub(super) start: usize,
    pub(super) contact: &'a [bool],
    pub(super) segments: &'a [u32],
}

impl<'a> Block<'a> {
    /// Of up to so many elements of the grid, from `start` on.
    pub fn new(start: usize, contact: &'a [bool], length: usize, segments: &'a [u32]) -> Block<'a> {
        Block { start, contact: &contact[start..contact.len().min(start + length)], segments }
    }

    /// Sums over the elements of the block in contact; a and b are arrays on the whole grid.
    #[inline(always)]
    pub fn sum<T: Real, const A: usize, const B: usize, const K: usize>(
        self,
        a: [&[f64]; A],
        b: [&[T]; B],
        terms: impl Terms<A, B, K>,
    ) -> [f64; K] {
        let arrays = Arrays::of(self, a, b);
        pulp::Arch::new().dispatch(Sum { block: self, arrays, terms })
    }

    /// Changes the block's part of an array on C; a and b are arrays on the whole grid.
    #[inline(always)]
    pub fn change<D: Real, T: Real, const A: usize, const B: usize>(
        self,
        data: &mut [D],
        a: [&[f64]; A],
        b: [&[T]; B],
        change: impl Becomes<A, B>,
    ) {
        let arrays = Arrays::of(self, a, b);
        pulp::Arch::new().dispatch(Changes { block: self, data, arrays, change });
    }

    /// Appends those elements in contact that are wanted, by the block's part of an array and by arrays b on the whole grid.
    #[inline(always)]
    pub fn list<T: Real, const B: usize>(
        self,
        list: &mut Vec<u32>,
        data: &[f64],
        b: [&[T]; B],
        wanted: impl Wanted<B>,
    ) {
        let arrays = Arrays::of(self, [], b);
        pulp::Arch::new().dispatch(List { block: self, list, data, arrays, wanted });
    }

    /// Changes all of the block's part of an array, and then appends those elements outside C that are wanted, by what they have become and by
    /// arrays a on the whole grid; b are more of those.
    #[inline(always)]
    pub fn change_and_list_outside<T: Real, const A: usize, const B: usize>(
        self,
        data: &mut [f64],
        list: &mut Vec<u32>,
        a: [&[f64]; A],
        b: [&[T]; B],
        change: impl Becomes<A, B>,
        wanted: impl Wanted<A>,
    ) {
        let arrays = Arrays::of(self, a, b);
        pulp::Arch::new().dispatch(Everywhere { block: self, data, list, arrays, change, wanted });
    }

    /// The elements of the block.
    pub fn elements(self) -> Range<usize> {
        self.start..self.start + self.contact.len()
    }

    /// Elements of each segment: among those of the grid, and among those of the block.
    pub fn segments(self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + 'a {
        self.segments.iter().map(move |&k| {
            let local = EIGHT * k as usize..self.contact.len().min(EIGHT * (k as usize + 1));
            (self.start + local.start..self.start + local.end, local)
        })
    }
}
