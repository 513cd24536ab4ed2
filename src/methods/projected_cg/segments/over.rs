//! The passes over the segments of a block.

use super::arrays::Arrays;
use super::block::{Becomes, Block, Terms, Wanted};
use super::lists::{Everywhere, List};
use super::passes::{Changes, Sum};
use super::Segments;
use crate::operator::fft::Real;

impl Segments {
    /// [`sum`](Segments::sum) of terms; a and b are arrays on the whole grid.
    pub fn sum_of<T: Real, const A: usize, const B: usize, const K: usize>(
        &mut self,
        contact: &[bool],
        a: [&[f64]; A],
        b: [&[T]; B],
        terms: impl Terms<A, B, K> + Copy + Sync + Send,
    ) -> [f64; K] {
        self.sum(
            contact,
            #[inline(always)]
            |block| block.sum(a, b, terms),
        )
    }

    /// Changes an array on C, whose segments are up to date; a and b are arrays on the whole grid.
    pub fn change<D: Real, T: Real, const A: usize, const B: usize>(
        &mut self,
        contact: &[bool],
        data: &mut [D],
        (a, b): ([&[f64]; A], [&[T]; B]),
        change: impl Becomes<A, B> + Copy + Sync + Send,
    ) {
        let [] = self.sum_changing(
            contact,
            data,
            #[inline(always)]
            |block, data| {
                block.change(data, a, b, change);
                []
            },
        );
    }
}

impl Block<'_> {
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

    /// Appends the wanted elements in contact, by the block's part of an array and by arrays b on the whole grid.
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

    /// Changes all of the block's part of an array, then appends the wanted elements outside C, by their new values and by arrays a on the whole
    /// grid. The change also uses arrays b.
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
}
