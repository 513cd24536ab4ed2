//! The terms of sums over boxes: bytes for counts, and real values.

use crate::operator::fft::Real;

/// A value that can be added up in the sums over boxes.
pub trait Summand: Copy {
    /// The value 0.
    fn zero() -> Self;

    /// `self + other`.
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

/// A real value, or a sum of real values.
#[derive(Clone, Copy)]
pub struct Sum<T>(pub T);

impl<T: Real> Summand for Sum<T> {
    #[inline(always)]
    fn zero() -> Sum<T> {
        Sum(T::zero())
    }

    #[inline(always)]
    fn plus(self, other: Sum<T>) -> Sum<T> {
        Sum(self.0 + other.0)
    }
}
