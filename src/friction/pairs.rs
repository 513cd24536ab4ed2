//! Vectors of the plane in SIMD lanes, one lane for each element, and passes over fields of numbers.
//!
//! A pass reads and writes fields of the same length, a multiple of [`LANES`]. It sums in [`LANES`] lanes, whatever the vector length of the machine
//! is, so that no bit of a sum depends on the machine.
//!
//! Loops use indices, because closures in array methods are not always compiled for the vector instructions of this machine.
#![allow(clippy::needless_range_loop)]

use pulp::Simd;

use crate::blocks::LANES;
use crate::lanes::{Holds, Lanes};

/// The x and y components of vectors of several elements.
pub type Pair<S> = [Lanes<S>; 2];

/// `a v`.
#[inline(always)]
pub fn scaled<S: Simd>(a: Lanes<S>, v: Pair<S>) -> Pair<S> {
    [a * v[0], a * v[1]]
}

/// `v + w`.
#[inline(always)]
pub fn add<S: Simd>(v: Pair<S>, w: Pair<S>) -> Pair<S> {
    [v[0] + w[0], v[1] + w[1]]
}

/// `v - w`.
#[inline(always)]
pub fn subtract<S: Simd>(v: Pair<S>, w: Pair<S>) -> Pair<S> {
    [v[0] - w[0], v[1] - w[1]]
}

/// `v + a w`.
#[inline(always)]
pub fn plus<S: Simd>(v: Pair<S>, a: Lanes<S>, w: Pair<S>) -> Pair<S> {
    add(v, scaled(a, w))
}

/// `v . w`.
#[inline(always)]
pub fn dot<S: Simd>(v: Pair<S>, w: Pair<S>) -> Lanes<S> {
    v[0] * w[0] + v[1] * w[1]
}

/// v in the lanes where the condition holds, w in the others.
#[inline(always)]
pub fn choose<S: Simd>(condition: Holds<S>, v: Pair<S>, w: Pair<S>) -> Pair<S> {
    [condition.choose(v[0], w[0]), condition.choose(v[1], w[1])]
}

/// A pass over A fields that are read and B fields that are read and written. `each` gets a SIMD vector of each field. It returns the new values of
/// the written fields, and terms of K sums. Returns these sums.
#[inline(always)]
pub fn pass<S: Simd, const A: usize, const B: usize, const K: usize>(
    simd: S,
    read: [&[f64]; A],
    write: [&mut [f64]; B],
    each: impl Fn([Lanes<S>; A], [Lanes<S>; B]) -> ([Lanes<S>; B], [Lanes<S>; K]),
) -> [f64; K] {
    let (per_lanes, zero) = (LANES / S::F64_LANES, Lanes::splat(simd, 0.0));
    let length = read.first().map_or_else(|| write[0].len(), |field| field.len()) / S::F64_LANES;
    let read = read.map(|field| &S::as_simd_f64s(field).0[..length]);
    let write = write.map(|field| &mut S::as_mut_simd_f64s(field).0[..length]);
    let mut sums = [[zero.values(); LANES]; K];
    for first in (0..length).step_by(per_lanes) {
        for lane in 0..per_lanes {
            let i = first + lane;
            let (mut inputs, mut old_values) = ([zero; A], [zero; B]);
            for k in 0..A {
                inputs[k] = Lanes::new(simd, read[k][i]);
            }
            for k in 0..B {
                old_values[k] = Lanes::new(simd, write[k][i]);
            }
            let (values, terms) = each(inputs, old_values);
            for k in 0..B {
                write[k][i] = values[k].values();
            }
            for k in 0..K {
                sums[k][lane] = simd.add_f64s(sums[k][lane], terms[k].values());
            }
        }
    }
    sums.map(|lanes| pulp::bytemuck::cast_slice::<_, f64>(&lanes[..per_lanes]).iter().sum())
}
