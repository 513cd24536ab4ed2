//! The discrete Fourier transforms of R = 2, 3, 4 or 5 complex values, `y_q = sum_k x_k exp(-2 pi i q k/R)` for q, k = 0 to R - 1.
//!
//! Each value is a vector of the same value of several columns. In the formulas below with `+-` or `-+`, the upper sign belongs to the first of both
//! outputs.

use pulp::Simd;

use crate::fft::lanes::{Arithmetic, C};
use crate::lengths::LONGEST;
use crate::real::Scalar;

/// Transforms the first `R` values of x in place. `math` is the complex arithmetic of the vectors.
#[inline(always)]
pub(crate) fn butterfly<T: Scalar, S: Simd, const R: usize>(math: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    match R {
        2 => two(math, x),
        3 => three(math, x),
        4 => four(math, x),
        5 => five(math, x),
        _ => unreachable!("no stage has {R} values"),
    }
}

/// `y_0, y_1 = x_0 +- x_1`.
#[inline(always)]
fn two<T: Scalar, S: Simd>(math: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    (x[0], x[1]) = (math.add(x[0], x[1]), math.sub(x[0], x[1]));
}

/// `y_0 = x_0 + x_1 + x_2` and, with `s = sin(2 pi/3)`, `y_1, y_2 = x_0 - (x_1 + x_2)/2 -+ i s (x_1 - x_2)`.
#[inline(always)]
fn three<T: Scalar, S: Simd>(math: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    let (half, sine) = (math.splat(T::of(0.5)), math.splat(T::of(0.75f64.sqrt())));
    let (sum, difference) = (math.add(x[1], x[2]), math.sub(x[1], x[2]));
    let (symmetric, antisymmetric) = (math.sub(x[0], math.scale(sum, half)), math.scale(difference, sine));
    x[0] = math.add(x[0], sum);
    (x[1], x[2]) = (math.sub_i(symmetric, antisymmetric), math.add_i(symmetric, antisymmetric));
}

/// `y_0, y_2 = (x_0 + x_2) +- (x_1 + x_3)` and `y_1, y_3 = (x_0 - x_2) -+ i (x_1 - x_3)`.
#[inline(always)]
fn four<T: Scalar, S: Simd>(math: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    let (even_sum, odd_sum) = (math.add(x[0], x[2]), math.add(x[1], x[3]));
    let (even_difference, odd_difference) = (math.sub(x[0], x[2]), math.sub(x[1], x[3]));
    (x[0], x[2]) = (math.add(even_sum, odd_sum), math.sub(even_sum, odd_sum));
    (x[1], x[3]) = (math.sub_i(even_difference, odd_difference), math.add_i(even_difference, odd_difference));
}

/// `y_0` is the sum of all. With `c_k = cos(2 pi k/5)` and `s_k = sin(2 pi k/5)`:
///
/// ```text
/// y_1, y_4 = x_0 + c_1 (x_1 + x_4) + c_2 (x_2 + x_3) -+ i (s_1 (x_1 - x_4) + s_2 (x_2 - x_3))
/// y_2, y_3 = x_0 + c_2 (x_1 + x_4) + c_1 (x_2 + x_3) -+ i (s_2 (x_1 - x_4) - s_1 (x_2 - x_3))
/// ```
#[inline(always)]
fn five<T: Scalar, S: Simd>(math: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    // c_1, c_2 = (+-sqrt(5) - 1)/4 and s_1, s_2 = sqrt((5 +- sqrt(5))/8).
    let root = 5f64.sqrt();
    let (c1, c2) = (math.splat(T::of((root - 1.0) / 4.0)), math.splat(T::of(-(root + 1.0) / 4.0)));
    let (s1, s2) = (math.splat(T::of(((5.0 + root) / 8.0).sqrt())), math.splat(T::of(((5.0 - root) / 8.0).sqrt())));
    let (outer_sum, inner_sum) = (math.add(x[1], x[4]), math.add(x[2], x[3]));
    let (outer_difference, inner_difference) = (math.sub(x[1], x[4]), math.sub(x[2], x[3]));
    let symmetric_1 = math.add(x[0], math.add(math.scale(outer_sum, c1), math.scale(inner_sum, c2)));
    let symmetric_2 = math.add(x[0], math.add(math.scale(outer_sum, c2), math.scale(inner_sum, c1)));
    let antisymmetric_1 = math.add(math.scale(outer_difference, s1), math.scale(inner_difference, s2));
    let antisymmetric_2 = math.sub(math.scale(outer_difference, s2), math.scale(inner_difference, s1));
    x[0] = math.add(x[0], math.add(outer_sum, inner_sum));
    (x[1], x[4]) = (math.sub_i(symmetric_1, antisymmetric_1), math.add_i(symmetric_1, antisymmetric_1));
    (x[2], x[3]) = (math.sub_i(symmetric_2, antisymmetric_2), math.add_i(symmetric_2, antisymmetric_2));
}
