//! The terms of box sums: counts and values.

use crate::operator::fft::Real;

/// A value that box sums add up.
pub trait Summand: Copy {
    /// The value 0.
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

/// A sum of real values.
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
