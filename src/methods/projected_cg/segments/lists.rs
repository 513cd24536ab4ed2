//! Loops over a block that list elements, in SIMD vectors.

use pulp::{Simd, WithSimd};

use super::arrays::{eights, parts, rest, whole, Arrays, Eight, Segment};
use super::block::{Becomes, Block, Wanted};
use crate::blocks::LANES;
use crate::lanes::{Holds, Lanes};
use crate::operator::fft::Real;

/// Lists elements in contact: the work of [`Block::list`].
pub(super) struct List<'a, T, F, const B: usize> {
    pub(super) block: Block<'a>,
    pub(super) list: &'a mut Vec<u32>,
    pub(super) data: &'a [f64],
    pub(super) arrays: Arrays<'a, T, 0, B>,
    pub(super) wanted: F,
}

impl<T: Real, F: Wanted<B>, const B: usize> WithSimd for List<'_, T, F, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let List { block, list, data, arrays, wanted } = self;
        let ((segments, with_rest), eights) = (whole(block), eights(data));
        let first = |k: usize| block.start + LANES * k;
        for &k in segments {
            let k = k as usize;
            list_segment(simd, (first(k), &eights[k]), arrays.at(k), &wanted, list);
        }
        if with_rest {
            list_segment(simd, (first(eights.len()), &rest(data)), arrays.rest().segment(), &wanted, list);
        }
    }
}

/// Appends the wanted elements in contact of one segment, whose first element is `first`.
#[inline(always)]
fn list_segment<S: Simd, const B: usize>(
    simd: S,
    (first, values): (usize, &Eight<f64>),
    segment: Segment<'_, 0, B>,
    wanted: &impl Wanted<B>,
    list: &mut Vec<u32>,
) {
    for part in 0..parts::<S>() {
        let first = first + part * LANES / parts::<S>();
        let value = Lanes::new(simd, S::as_simd_f64s(values).0[part]);
        let ([], b, inside) = segment.part(simd, part);
        append(simd, first, inside & wanted.of(first, value, b), list);
    }
}

/// Appends the elements of the lanes where `wanted` holds. `first` is the element of the first lane.
#[inline(always)]
fn append<S: Simd>(simd: S, first: usize, wanted: Holds<S>, list: &mut Vec<u32>) {
    if wanted.anywhere() {
        let mut ones = [0.0; LANES];
        let some = wanted.choose(Lanes::splat(simd, 1.0), Lanes::splat(simd, 0.0));
        S::as_mut_simd_f64s(&mut ones).0[0] = some.values();
        list.extend((first as u32..).zip(ones).filter(|(_, one)| *one > 0.0).map(|(i, _)| i));
    }
}

/// Changes all elements, and lists elements outside C: the work of [`Block::change_and_list_outside`].
pub(super) struct Everywhere<'a, T, F, G, const A: usize, const B: usize> {
    pub(super) block: Block<'a>,
    pub(super) data: &'a mut [f64],
    pub(super) list: &'a mut Vec<u32>,
    pub(super) arrays: Arrays<'a, T, A, B>,
    pub(super) change: F,
    pub(super) wanted: G,
}

impl<T: Real, F: Becomes<A, B>, G: Wanted<A>, const A: usize, const B: usize> WithSimd
    for Everywhere<'_, T, F, G, A, B>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Everywhere { block, data, list, arrays, change, wanted } = self;
        let (eights, behind) = pulp::as_arrays_mut::<LANES, f64>(data);
        let end_of_whole = block.start + LANES * eights.len();
        for (k, values) in eights.iter_mut().enumerate() {
            everywhere(simd, (block.start + LANES * k, values), arrays.at(k), (&change, &wanted), list);
        }
        if !behind.is_empty() {
            let mut last = rest(behind);
            everywhere(simd, (end_of_whole, &mut last), arrays.rest().segment(), (&change, &wanted), list);
            // Padding counts as outside C and may be listed: it is removed from the end of the list.
            let end = block.elements().end as u32;
            list.truncate(list.partition_point(|i| *i < end));
            behind.copy_from_slice(&last[..behind.len()]);
        }
    }
}

/// Changes the values of one segment, and appends its wanted elements outside C. `first` is its first element.
#[inline(always)]
fn everywhere<S: Simd, const A: usize, const B: usize>(
    simd: S,
    (first, values): (usize, &mut Eight<f64>),
    segment: Segment<'_, A, B>,
    (change, wanted): (&impl Becomes<A, B>, &impl Wanted<A>),
    list: &mut Vec<u32>,
) {
    for part in 0..parts::<S>() {
        let first = first + part * LANES / parts::<S>();
        let (a, b, _) = segment.part(simd, part);
        let outside = Holds::of_zeros(simd, S::as_simd_u64s(&segment.contact).0[part]);
        let to = &mut S::as_mut_simd_f64s(values).0[part];
        let value = change.of(Lanes::new(simd, *to), a, b);
        *to = value.values();
        append(simd, first, outside & wanted.of(first, value, a), list);
    }
}

#[cfg(test)]
#[path = "../../../../tests/unit/segment_passes.rs"]
mod tests;
