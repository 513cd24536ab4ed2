//! The arrays of a pass in segments: loads for vectors of any length.

use std::array::from_fn;

use pulp::Simd;

use super::block::Block;
use super::vector::{Holds, Vector};
use crate::operator::fft::Real;
use crate::sums::Value;

/// Elements of a segment, one in each byte of a word.
pub(super) const EIGHT: usize = 8;

/// One segment of an array.
pub(super) type Eight<A> = [A; EIGHT];

/// The whole segments of a part of an array, and the rest of it, padded.
#[inline(always)]
pub(super) fn eights<A: Copy + Default>(values: &[A]) -> (&[Eight<A>], Eight<A>) {
    let (eights, rest) = pulp::as_arrays::<EIGHT, A>(values);
    (eights, padded(rest))
}

#[inline(always)]
pub(super) fn padded<A: Copy + Default>(rest: &[A]) -> Eight<A> {
    let mut last = [A::default(); EIGHT];
    if !rest.is_empty() {
        last[..rest.len()].copy_from_slice(rest);
    }
    last
}

/// The parts of some arrays in a block.
pub(super) struct Arrays<'a, T, const A: usize, const B: usize> {
    a: [&'a [Eight<f64>]; A],
    b: [&'a [Eight<T>]; B],
    pub(super) contact: &'a [Eight<bool>],
    /// The rest of each, padded.
    last: ([Eight<f64>; A], [Eight<T>; B], Eight<bool>),
}

impl<'a, T: Real, const A: usize, const B: usize> Arrays<'a, T, A, B> {
    #[inline(always)]
    pub(super) fn of(block: Block<'a>, a: [&'a [f64]; A], b: [&'a [T]; B]) -> Arrays<'a, T, A, B> {
        let elements = block.elements();
        let a = a.map(|a| eights(&a[elements.clone()]));
        let b = b.map(|b| eights(&b[elements.clone()]));
        let contact = eights(block.contact);
        Arrays {
            a: from_fn(|i| a[i].0),
            b: from_fn(|i| b[i].0),
            contact: contact.0,
            last: (from_fn(|i| a[i].1), from_fn(|i| b[i].1), contact.1),
        }
    }

    /// Segment k.
    #[inline(always)]
    pub(super) fn at(&self, k: usize) -> Segment<'_, A, B> {
        Segment::new(from_fn(|i| &self.a[i][k]), from_fn(|i| &self.b[i][k]), &self.contact[k])
    }

    /// The rest.
    #[inline(always)]
    pub(super) fn last(&self) -> Segment<'_, A, B> {
        let (a, b, contact) = &self.last;
        Segment::new(a.each_ref(), b.each_ref(), contact)
    }
}

/// Those segments of a block that are whole, of which the block has n, and whether the rest is one of its segments.
#[inline(always)]
pub(super) fn whole(segments: &[u32], n: usize) -> (&[u32], bool) {
    match segments.split_last() {
        Some((&last, others)) if last as usize == n => (others, true),
        _ => (segments, false),
    }
}

/// A segment of some arrays.
pub(super) struct Segment<'a, const A: usize, const B: usize> {
    a: [&'a Eight<f64>; A],
    b: [Eight<f64>; B],
    pub(super) contact: Eight<u64>,
}

impl<'a, const A: usize, const B: usize> Segment<'a, A, B> {
    #[inline(always)]
    fn new<T: Real>(a: [&'a Eight<f64>; A], b: [&Eight<T>; B], contact: &Eight<bool>) -> Segment<'a, A, B> {
        let mut doubles = [[0.0; EIGHT]; B];
        doubles.iter_mut().zip(b).for_each(|(doubles, values)| convert(values, doubles, Value::to_double));
        let mut ones = [0; EIGHT];
        convert(contact, &mut ones, u64::from);
        Segment { a, b: doubles, contact: ones }
    }

    /// Vector number `part` of it: values of a and of b, and which are in contact.
    #[inline(always)]
    pub(super) fn part<S: Simd>(&self, simd: S, part: usize) -> ([Vector<S>; A], [Vector<S>; B], Holds<S>) {
        let of = |values: &Eight<f64>| Vector::new(simd, S::as_simd_f64s(values).0[part]);
        let inside = Holds::of_ones(simd, S::as_simd_u64s(&self.contact).0[part]);
        (from_fn(|i| of(self.a[i])), from_fn(|i| of(&self.b[i])), inside)
    }
}

/// Into memory, one after the other: so the compiler vectorises it.
#[inline(always)]
pub(super) fn convert<A: Copy, B>(from: &Eight<A>, to: &mut Eight<B>, how: impl Fn(A) -> B) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = how(*from));
}

/// Vectors of a segment.
#[inline(always)]
pub(super) fn parts<S: Simd>() -> usize {
    size_of::<Eight<f64>>() / size_of::<S::f64s>()
}
