//! Vectorised passes over fields, component by component.
//!
//! A pass processes fields of the same length, a multiple of [`LANES`]. It sums in so many lanes for any vector length of the machine. So no bit of a
//! sum depends on the machine.
//!
//! Loops run over indices, because closures of array methods are not always compiled for the vector instructions of this machine.
#![allow(clippy::needless_range_loop)]

use pulp::Simd;

use crate::blocks::LANES;

/// Vectors of both components.
pub type Pair<S> = [<S as Simd>::f64s; 2];

/// Arithmetic of vectors, without fused operations.
#[derive(Clone, Copy)]
pub struct Arithmetic<S: Simd>(pub S);

impl<S: Simd> Arithmetic<S> {
    /// One number in all lanes.
    #[inline(always)]
    pub fn splat(self, a: f64) -> S::f64s {
        self.0.splat_f64s(a)
    }

    #[inline(always)]
    pub fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    #[inline(always)]
    pub fn sub(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.sub_f64s(a, b)
    }

    #[inline(always)]
    pub fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.mul_f64s(a, b)
    }

    #[inline(always)]
    pub fn div(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.div_f64s(a, b)
    }

    #[inline(always)]
    pub fn sqrt(self, a: S::f64s) -> S::f64s {
        self.0.sqrt_f64s(a)
    }

    /// |a|.
    #[inline(always)]
    pub fn abs(self, a: S::f64s) -> S::f64s {
        self.0.max_f64s(a, self.sub(self.splat(0.0), a))
    }

    /// a where the mask is set, b elsewhere.
    #[inline(always)]
    pub fn select(self, mask: S::m64s, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.select_f64s(mask, a, b)
    }

    /// The same for pairs.
    #[inline(always)]
    pub fn select_pair(self, mask: S::m64s, a: Pair<S>, b: Pair<S>) -> Pair<S> {
        [self.select(mask, a[0], b[0]), self.select(mask, a[1], b[1])]
    }

    /// `a v`.
    #[inline(always)]
    pub fn scale(self, a: S::f64s, v: Pair<S>) -> Pair<S> {
        [self.mul(a, v[0]), self.mul(a, v[1])]
    }

    /// `v + w`.
    #[inline(always)]
    pub fn add_pair(self, v: Pair<S>, w: Pair<S>) -> Pair<S> {
        [self.add(v[0], w[0]), self.add(v[1], w[1])]
    }

    /// `v - w`.
    #[inline(always)]
    pub fn sub_pair(self, v: Pair<S>, w: Pair<S>) -> Pair<S> {
        [self.sub(v[0], w[0]), self.sub(v[1], w[1])]
    }

    /// `v + a w`.
    #[inline(always)]
    pub fn plus(self, v: Pair<S>, a: S::f64s, w: Pair<S>) -> Pair<S> {
        self.add_pair(v, self.scale(a, w))
    }

    /// `v . w`.
    #[inline(always)]
    pub fn dot(self, v: Pair<S>, w: Pair<S>) -> S::f64s {
        self.add(self.mul(v[0], w[0]), self.mul(v[1], w[1]))
    }

    /// `|v|^2`.
    #[inline(always)]
    pub fn square(self, v: Pair<S>) -> S::f64s {
        self.dot(v, v)
    }
}

/// One pass over some fields. The closure maps each vector of `read` and `write` to its new values and its terms of K sums.
#[inline(always)]
pub fn pass<S: Simd, const A: usize, const B: usize, const K: usize>(
    a: Arithmetic<S>,
    read: [&[f64]; A],
    write: [&mut [f64]; B],
    each: impl Fn([S::f64s; A], [S::f64s; B]) -> ([S::f64s; B], [S::f64s; K]),
) -> [f64; K] {
    let (per_lanes, zero) = (LANES / S::F64_LANES, a.splat(0.0));
    let length = read.first().map_or_else(|| write[0].len(), |field| field.len()) / S::F64_LANES;
    let read = read.map(|field| &S::as_simd_f64s(field).0[..length]);
    let write = write.map(|field| &mut S::as_mut_simd_f64s(field).0[..length]);
    let mut sums = [[zero; LANES]; K];
    for first in (0..length).step_by(per_lanes) {
        for lane in 0..per_lanes {
            let i = first + lane;
            let (mut from, mut to) = ([zero; A], [zero; B]);
            for k in 0..A {
                from[k] = read[k][i];
            }
            for k in 0..B {
                to[k] = write[k][i];
            }
            let (values, terms) = each(from, to);
            for k in 0..B {
                write[k][i] = values[k];
            }
            for k in 0..K {
                sums[k][lane] = a.add(sums[k][lane], terms[k]);
            }
        }
    }
    sums.map(|lanes| pulp::bytemuck::cast_slice::<_, f64>(&lanes[..per_lanes]).iter().sum())
}
