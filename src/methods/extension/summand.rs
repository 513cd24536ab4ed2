//! What boxes sum: counts, and values of K components.

use std::array::from_fn;

use crate::operator::fft::Real;

/// A value that can be added up.
pub trait Summand: Copy {
    /// 0.
    fn zero() -> Self;

    /// The sum of two.
    fn plus(self, other: Self) -> Self;
}

impl Summand for u8 {
    #[inline(always)]
    fn zero() -> u8 {
        0
    }

    #[inline(always)]
    fn plus(self, other: u8) -> u8 {
        self + other
    }
}

impl<T: Real, const K: usize> Summand for [T; K] {
    #[inline(always)]
    fn zero() -> [T; K] {
        [T::zero(); K]
    }

    #[inline(always)]
    fn plus(self, other: [T; K]) -> [T; K] {
        from_fn(|k| self[k] + other[k])
    }
}

/// A multiple.
#[inline(always)]
pub fn times<T: Real, const K: usize>(value: [T; K], by: T) -> [T; K] {
    value.map(|value| value * by)
}
