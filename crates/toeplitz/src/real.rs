//! Real numbers of single and double precision, and complex numbers of both.

use std::f64::consts::PI;

use par::sums::Value;
use rustfft::num_traits::{Float, FromPrimitive};
use rustfft::FftNum;

pub use rustfft::num_complex::Complex;

use crate::fft::lanes::Lanes;

/// A real number, `f32` or `f64`.
pub trait Scalar:
    Value + Lanes + FftNum + Float + FromPrimitive + Default + std::iter::Sum + std::ops::AddAssign
{
    /// The nearest value of this precision.
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::from_f64(value).unwrap_or_default()
    }
}

impl Scalar for f32 {}
impl Scalar for f64 {}

/// `exp(-2 pi i k/n)`.
pub(crate) fn twiddle<T: Scalar>(k: usize, n: usize) -> Complex<T> {
    let angle = -2.0 * PI * k as f64 / n as f64;
    Complex::new(T::of(angle.cos()), T::of(angle.sin()))
}
