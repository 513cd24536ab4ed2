//! Passes over the segments of a block: sums, and changes of what an array holds on C. They are computed in vectors of this machine, on which no bit
//! depends: a sum is taken in lanes, one for each place in a segment.

use std::array::from_fn;
use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::segments::EIGHT;
use super::vector::{Holds, Vector};
use crate::operator::fft::Real;
use crate::sums::Value;

/// What a pass sums, in K sums, of A arrays in double precision and B of the iteration's.
pub trait Terms<const A: usize, const B: usize, const K: usize> {
    fn of<S: Simd>(&self, a: [Vector<S>; A], b: [Vector<S>; B]) -> [Vector<S>; K];
}

/// What a value becomes, beside A arrays in double precision and B of the iteration's.
pub trait Change<const A: usize, const B: usize> {
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
    start: usize,
    contact: &'a [bool],
    segments: &'a [u32],
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
        pulp::Arch::new().dispatch(Sum { segments: self.segments, arrays, terms })
    }

    /// Changes the block's part of an array on C; a and b are arrays on the whole grid.
    #[inline(always)]
    pub fn change<D: Real, T: Real, const A: usize, const B: usize>(
        self,
        data: &mut [D],
        a: [&[f64]; A],
        b: [&[T]; B],
        change: impl Change<A, B>,
    ) {
        let arrays = Arrays::of(self, a, b);
        pulp::Arch::new().dispatch(Changes { segments: self.segments, data, arrays, change });
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
        pulp::Arch::new().dispatch(List { block: self, list, data: eights(data), arrays, wanted });
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
        change: impl Change<A, B>,
        wanted: impl Wanted<A>,
    ) {
        let arrays = Arrays::of(self, a, b);
        pulp::Arch::new().dispatch(Everywhere { first: self.start, data, list, arrays, change, wanted });
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

/// One segment of an array.
type Eight<A> = [A; EIGHT];

/// The whole segments of a part of an array, and the rest of it, padded.
#[inline(always)]
fn eights<A: Copy + Default>(values: &[A]) -> (&[Eight<A>], Eight<A>) {
    let (eights, rest) = pulp::as_arrays::<EIGHT, A>(values);
    (eights, padded(rest))
}

#[inline(always)]
fn padded<A: Copy + Default>(rest: &[A]) -> Eight<A> {
    let mut last = [A::default(); EIGHT];
    if !rest.is_empty() {
        last[..rest.len()].copy_from_slice(rest);
    }
    last
}

/// The parts of some arrays in a block.
struct Arrays<'a, T, const A: usize, const B: usize> {
    a: [&'a [Eight<f64>]; A],
    b: [&'a [Eight<T>]; B],
    contact: &'a [Eight<bool>],
    /// The rest of each, padded.
    last: ([Eight<f64>; A], [Eight<T>; B], Eight<bool>),
}

impl<'a, T: Real, const A: usize, const B: usize> Arrays<'a, T, A, B> {
    #[inline(always)]
    fn of(block: Block<'a>, a: [&'a [f64]; A], b: [&'a [T]; B]) -> Arrays<'a, T, A, B> {
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
    fn at(&self, k: usize) -> Segment<'_, A, B> {
        Segment::new(from_fn(|i| &self.a[i][k]), from_fn(|i| &self.b[i][k]), &self.contact[k])
    }

    /// The rest.
    #[inline(always)]
    fn last(&self) -> Segment<'_, A, B> {
        let (a, b, contact) = &self.last;
        Segment::new(a.each_ref(), b.each_ref(), contact)
    }
}

/// Whole segments among some of a block with n of those, and whether the rest is among them.
#[inline(always)]
fn whole(segments: &[u32], n: usize) -> (&[u32], bool) {
    match segments.split_last() {
        Some((&last, others)) if last as usize == n => (others, true),
        _ => (segments, false),
    }
}

/// A segment of some arrays.
struct Segment<'a, const A: usize, const B: usize> {
    a: [&'a Eight<f64>; A],
    b: [Eight<f64>; B],
    contact: Eight<u64>,
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
    fn part<S: Simd>(&self, simd: S, part: usize) -> ([Vector<S>; A], [Vector<S>; B], Holds<S>) {
        let of = |values: &Eight<f64>| Vector::new(simd, S::as_simd_f64s(values).0[part]);
        let inside = Holds::of_ones(simd, S::as_simd_u64s(&self.contact).0[part]);
        (from_fn(|i| of(self.a[i])), from_fn(|i| of(&self.b[i])), inside)
    }
}

/// Into memory, one after the other: so the compiler vectorises it.
#[inline(always)]
fn convert<A: Copy, B>(from: &Eight<A>, to: &mut Eight<B>, how: impl Fn(A) -> B) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = how(*from));
}

/// Vectors of a segment.
#[inline(always)]
fn parts<S: Simd>() -> usize {
    size_of::<Eight<f64>>() / size_of::<S::f64s>()
}

struct Sum<'a, T, F, const A: usize, const B: usize, const K: usize> {
    segments: &'a [u32],
    arrays: Arrays<'a, T, A, B>,
    terms: F,
}

impl<T: Real, F: Terms<A, B, K>, const A: usize, const B: usize, const K: usize> WithSimd for Sum<'_, T, F, A, B, K> {
    type Output = [f64; K];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; K] {
        let Sum { arrays, terms, .. } = &self;
        let (segments, rest) = whole(self.segments, arrays.contact.len());
        let mut sums = [[0.0; EIGHT]; K];
        for &k in segments {
            add(simd, arrays.at(k as usize), terms, &mut sums);
        }
        if rest {
            add(simd, arrays.last(), terms, &mut sums);
        }
        sums.map(|lanes| lanes.iter().sum())
    }
}

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
            *sum = (Vector::new(simd, *sum) + inside.choose(term, Vector::splat(simd, 0.0))).values();
        }
    }
}

struct Changes<'a, D, T, F, const A: usize, const B: usize> {
    segments: &'a [u32],
    data: &'a mut [D],
    arrays: Arrays<'a, T, A, B>,
    change: F,
}

impl<D: Real, T: Real, F: Change<A, B>, const A: usize, const B: usize> WithSimd for Changes<'_, D, T, F, A, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Changes { data, arrays, change, .. } = self;
        let (eights, rest) = pulp::as_arrays_mut::<EIGHT, D>(data);
        let (segments, with_rest) = whole(self.segments, eights.len());
        for &k in segments {
            change_segment(simd, &mut eights[k as usize], arrays.at(k as usize), &change);
        }
        if with_rest {
            let mut last = padded(rest);
            change_segment(simd, &mut last, arrays.last(), &change);
            rest.copy_from_slice(&last[..rest.len()]);
        }
    }
}

#[inline(always)]
fn change_segment<D: Real, S: Simd, const A: usize, const B: usize>(
    simd: S,
    values: &mut Eight<D>,
    segment: Segment<'_, A, B>,
    change: &impl Change<A, B>,
) {
    let mut doubles = [0.0; EIGHT];
    convert(values, &mut doubles, Value::to_double);
    for part in 0..parts::<S>() {
        let (a, b, inside) = segment.part(simd, part);
        let value = &mut S::as_mut_simd_f64s(&mut doubles).0[part];
        let before = Vector::new(simd, *value);
        *value = inside.choose(change.of(before, a, b), before).values();
    }
    convert(&doubles, values, D::of);
}

struct List<'a, T, F, const B: usize> {
    block: Block<'a>,
    list: &'a mut Vec<u32>,
    data: (&'a [Eight<f64>], Eight<f64>),
    arrays: Arrays<'a, T, 0, B>,
    wanted: F,
}

impl<T: Real, F: Wanted<B>, const B: usize> WithSimd for List<'_, T, F, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let List { block, list, data: (data, last), arrays, wanted } = self;
        let (segments, rest) = whole(block.segments, data.len());
        let first = |k: usize| block.start + EIGHT * k;
        for &k in segments {
            let k = k as usize;
            list_segment(simd, (first(k), &data[k]), arrays.at(k), &wanted, list);
        }
        if rest {
            list_segment(simd, (first(data.len()), &last), arrays.last(), &wanted, list);
        }
    }
}

#[inline(always)]
fn list_segment<S: Simd, const B: usize>(
    simd: S,
    (first, values): (usize, &Eight<f64>),
    segment: Segment<'_, 0, B>,
    wanted: &impl Wanted<B>,
    list: &mut Vec<u32>,
) {
    for part in 0..parts::<S>() {
        let first = first + part * EIGHT / parts::<S>();
        let value = Vector::new(simd, S::as_simd_f64s(values).0[part]);
        let ([], b, inside) = segment.part(simd, part);
        append(simd, first, inside & wanted.of(first, value, b), list);
    }
}

/// Appends the elements, from `first` on, of which something holds.
#[inline(always)]
fn append<S: Simd>(simd: S, first: usize, wanted: Holds<S>, list: &mut Vec<u32>) {
    if wanted.anywhere() {
        let mut ones = [0.0; EIGHT];
        let some = wanted.choose(Vector::splat(simd, 1.0), Vector::splat(simd, 0.0));
        S::as_mut_simd_f64s(&mut ones).0[0] = some.values();
        list.extend((first as u32..).zip(ones).filter(|(_, one)| *one > 0.0).map(|(i, _)| i));
    }
}

struct Everywhere<'a, T, F, G, const A: usize, const B: usize> {
    first: usize,
    data: &'a mut [f64],
    list: &'a mut Vec<u32>,
    arrays: Arrays<'a, T, A, B>,
    change: F,
    wanted: G,
}

impl<T: Real, F: Change<A, B>, G: Wanted<A>, const A: usize, const B: usize> WithSimd
    for Everywhere<'_, T, F, G, A, B>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Everywhere { first, data, list, arrays, change, wanted } = self;
        let (eights, rest) = pulp::as_arrays_mut::<EIGHT, f64>(data);
        let whole = eights.len();
        for (k, values) in eights.iter_mut().enumerate() {
            everywhere(simd, (first + EIGHT * k, values), arrays.at(k), (&change, &wanted), list);
        }
        if !rest.is_empty() {
            let (mut last, first) = (padded(rest), first + EIGHT * whole);
            everywhere(simd, (first, &mut last), arrays.last(), (&change, &wanted), list);
            let end = (first + rest.len()) as u32;
            list.truncate(list.partition_point(|i| *i < end));
            rest.copy_from_slice(&last[..rest.len()]);
        }
    }
}

#[inline(always)]
fn everywhere<S: Simd, const A: usize, const B: usize>(
    simd: S,
    (first, values): (usize, &mut Eight<f64>),
    segment: Segment<'_, A, B>,
    (change, wanted): (&impl Change<A, B>, &impl Wanted<A>),
    list: &mut Vec<u32>,
) {
    for part in 0..parts::<S>() {
        let first = first + part * EIGHT / parts::<S>();
        let (a, b, _) = segment.part(simd, part);
        let outside = Holds::of_zeros(simd, S::as_simd_u64s(&segment.contact).0[part]);
        let to = &mut S::as_mut_simd_f64s(values).0[part];
        let value = change.of(Vector::new(simd, *to), a, b);
        *to = value.values();
        append(simd, first, outside & wanted.of(first, value, a), list);
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/segment_passes.rs"]
mod tests;
