//! The loops over all blocks, and those over one block, by formulas for an element. `a` and `b` are arrays on the whole grid.

use super::arrays::Arrays;
use super::block::{Becomes, Block, Terms, Wanted};
use super::lists::{Everywhere, List};
use super::passes::{Changes, Sum};
use super::Segments;
use crate::operator::fft::Real;

impl Segments {
    /// The K sums over C of `terms`. The segments of `contact` must be up to date.
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

    /// Changes an array on C. The segments of `contact` must be up to date.
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
    /// The K sums of `terms` over the elements of the block in contact.
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

    /// Changes `data`, the block's part of an array, on the elements in contact.
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

    /// Appends the wanted elements in contact to `list`. `data` is the block's part of an array, whose values decide together with the arrays b.
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

    /// Changes all of `data`, the block's part of an array, by the arrays a and b. Appends the wanted elements outside C to `list`: their new values
    /// decide together with the arrays a.
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
