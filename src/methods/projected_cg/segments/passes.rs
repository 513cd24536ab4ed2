//! Loops over the segments of a block in SIMD vectors: sums, and changes of an array on C. No bit depends on the length of the vectors: each sum has
//! eight parts, one for each position in a segment.

use pulp::{Simd, WithSimd};

use super::arrays::{convert, parts, rest, whole, Arrays, Eight, Segment};
use super::block::{Becomes, Block, Terms};
use crate::blocks::LANES;
use crate::lanes::Lanes;
use crate::operator::fft::Real;
use crate::sums::Value;

/// Computes sums over the elements in contact: the work of [`Block::sum`].
pub(super) struct Sum<'a, T, F, const A: usize, const B: usize, const K: usize> {
    pub(super) block: Block<'a>,
    pub(super) arrays: Arrays<'a, T, A, B>,
    pub(super) terms: F,
}

impl<T: Real, F: Terms<A, B, K>, const A: usize, const B: usize, const K: usize> WithSimd for Sum<'_, T, F, A, B, K> {
    type Output = [f64; K];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; K] {
        let Sum { block, arrays, terms } = &self;
        let (segments, with_rest) = whole(*block);
        let mut sums = [[0.0; LANES]; K];
        for &k in segments {
            add(simd, arrays.at(k as usize), terms, &mut sums);
        }
        if with_rest {
            add(simd, arrays.rest().segment(), terms, &mut sums);
        }
        sums.map(|lanes| lanes.iter().sum())
    }
}

/// Adds the terms of one segment to the sums.
#[inline(always)]
fn add<S: Simd, const A: usize, const B: usize, const K: usize>(
    simd: S,
    segment: Segment<'_, A, B>,
    terms: &impl Terms<A, B, K>,
    sums: &mut [Eight<f64>; K],
) {
    for part in 0..parts::<S>() {
        let (a, b, inside) = segment.part(simd, part);
        for (sums, term) in sums.iter_mut().zip(terms.of(a, b)) {
            let sum = &mut S::as_mut_simd_f64s(sums).0[part];
            *sum = (Lanes::new(simd, *sum) + inside.choose(term, Lanes::splat(simd, 0.0))).values();
        }
    }
}

/// Changes values on the elements in contact: the work of [`Block::change`].
pub(super) struct Changes<'a, D, T, F, const A: usize, const B: usize> {
    pub(super) block: Block<'a>,
    pub(super) data: &'a mut [D],
    pub(super) arrays: Arrays<'a, T, A, B>,
    pub(super) change: F,
}

impl<D: Real, T: Real, F: Becomes<A, B>, const A: usize, const B: usize> WithSimd for Changes<'_, D, T, F, A, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Changes { block, data, arrays, change } = self;
        let (segments, with_rest) = whole(block);
        let (eights, behind) = pulp::as_arrays_mut::<LANES, D>(data);
        for &k in segments {
            change_segment(simd, &mut eights[k as usize], arrays.at(k as usize), &change);
        }
        if with_rest {
            let mut last = rest(behind);
            change_segment(simd, &mut last, arrays.rest().segment(), &change);
            behind.copy_from_slice(&last[..behind.len()]);
        }
    }
}

/// Changes the values of one segment on its elements in contact.
#[inline(always)]
fn change_segment<D: Real, S: Simd, const A: usize, const B: usize>(
    simd: S,
    values: &mut Eight<D>,
    segment: Segment<'_, A, B>,
    change: &impl Becomes<A, B>,
) {
    let mut doubles = [0.0; LANES];
    convert(values, &mut doubles, Value::to_double);
    for part in 0..parts::<S>() {
        let (a, b, inside) = segment.part(simd, part);
        let value = &mut S::as_mut_simd_f64s(&mut doubles).0[part];
        let before = Lanes::new(simd, *value);
        *value = inside.choose(change.of(before, a, b), before).values();
    }
    convert(&doubles, values, D::of);
}
