//! The arrays of a loop, segment by segment: loads of eight values as SIMD vectors of any length.

use std::array::from_fn;

use pulp::Simd;

use super::block::Block;
use crate::blocks::LANES;
use crate::lanes::{Holds, Lanes};
use crate::operator::fft::Real;
use crate::sums::Value;

/// The eight values of one segment.
pub(super) type Eight<A> = [A; LANES];

/// The values of a block as groups of eight, without the rest behind them.
#[inline(always)]
pub(super) fn eights<A>(values: &[A]) -> &[Eight<A>] {
    pulp::as_arrays::<LANES, A>(values).0
}

/// The values behind the last whole group of eight, padded to eight.
#[inline(always)]
pub(super) fn rest<A: Copy + Default>(values: &[A]) -> Eight<A> {
    let (mut padded, rest) = ([A::default(); LANES], pulp::as_arrays::<LANES, A>(values).1);
    padded[..rest.len()].copy_from_slice(rest);
    padded
}

/// The parts of several arrays in one block.
pub(super) struct Arrays<'a, T, const A: usize, const B: usize> {
    /// A arrays in double precision.
    a: [&'a [f64]; A],
    /// B arrays in the precision of the iteration.
    b: [&'a [T]; B],
    contact: &'a [bool],
}

impl<'a, T: Real, const A: usize, const B: usize> Arrays<'a, T, A, B> {
    /// The parts in `block` of arrays on the whole grid.
    #[inline(always)]
    pub(super) fn of(block: Block<'a>, a: [&'a [f64]; A], b: [&'a [T]; B]) -> Arrays<'a, T, A, B> {
        let elements = block.elements();
        let (a, b) = (a.map(|a| &a[elements.clone()]), b.map(|b| &b[elements.clone()]));
        Arrays { a, b, contact: block.contact }
    }

    /// Segment k, which must have eight elements.
    #[inline(always)]
    pub(super) fn at(&self, k: usize) -> Segment<'a, A, B> {
        let Arrays { a, b, contact } = self;
        Segment::new(a.map(|a| &eights(a)[k]), b.map(|b| &eights(b)[k]), &eights(contact)[k])
    }

    /// The last segment, which has fewer than eight elements, padded.
    #[inline(always)]
    pub(super) fn rest(&self) -> Rest<T, A, B> {
        Rest { a: self.a.map(rest), b: self.b.map(rest), contact: rest(self.contact) }
    }
}

/// The last segment of several arrays, padded to eight elements. Padding is not in contact.
pub(super) struct Rest<T, const A: usize, const B: usize> {
    a: [Eight<f64>; A],
    b: [Eight<T>; B],
    contact: Eight<bool>,
}

impl<T: Real, const A: usize, const B: usize> Rest<T, A, B> {
    /// The segment of these values.
    #[inline(always)]
    pub(super) fn segment(&self) -> Segment<'_, A, B> {
        Segment::new(self.a.each_ref(), self.b.each_ref(), &self.contact)
    }
}

/// The numbers of the segments of a block that have eight elements, and whether there is a last segment with fewer.
#[inline(always)]
pub(super) fn whole(block: Block<'_>) -> (&[u32], bool) {
    match block.segments.split_last() {
        Some((&last, others)) if last as usize == eights(block.contact).len() => (others, true),
        _ => (block.segments, false),
    }
}

/// One segment of several arrays, in double precision. `contact` is 1 for elements in contact, otherwise 0.
pub(super) struct Segment<'a, const A: usize, const B: usize> {
    a: [&'a Eight<f64>; A],
    b: [Eight<f64>; B],
    pub(super) contact: Eight<u64>,
}

impl<'a, const A: usize, const B: usize> Segment<'a, A, B> {
    #[inline(always)]
    fn new<T: Real>(a: [&'a Eight<f64>; A], b: [&Eight<T>; B], contact: &Eight<bool>) -> Segment<'a, A, B> {
        let mut doubles = [[0.0; LANES]; B];
        doubles.iter_mut().zip(b).for_each(|(doubles, values)| convert(values, doubles, Value::to_double));
        let mut ones = [0; LANES];
        convert(contact, &mut ones, u64::from);
        Segment { a, b: doubles, contact: ones }
    }

    /// Vector number `part` of the segment: the values of the arrays a and b, and a mask of the lanes in contact.
    #[inline(always)]
    pub(super) fn part<S: Simd>(&self, simd: S, part: usize) -> ([Lanes<S>; A], [Lanes<S>; B], Holds<S>) {
        let of = |values: &Eight<f64>| Lanes::new(simd, S::as_simd_f64s(values).0[part]);
        let inside = Holds::of_ones(simd, S::as_simd_u64s(&self.contact).0[part]);
        (from_fn(|i| of(self.a[i])), from_fn(|i| of(&self.b[i])), inside)
    }
}

/// Converts eight values through memory, which the compiler vectorises.
#[inline(always)]
pub(super) fn convert<A: Copy, B>(from: &Eight<A>, to: &mut Eight<B>, how: impl Fn(A) -> B) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = how(*from));
}

/// The number of SIMD vectors that hold one segment in double precision.
#[inline(always)]
pub(super) fn parts<S: Simd>() -> usize {
    size_of::<Eight<f64>>() / size_of::<S::f64s>()
}
