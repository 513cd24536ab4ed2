//! Transforms of two to five values, `y_q = sum_k x_k exp(-2 pi i q k/R)`, of many columns at a time.

use pulp::Simd;

use crate::fft::lanes::{Arithmetic, C};
use crate::lengths::LONGEST;
use crate::real::Scalar;

/// The transform of the first `R` of x, in place.
#[inline(always)]
pub(crate) fn butterfly<T: Scalar, S: Simd, const R: usize>(a: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    match R {
        2 => two(a, x),
        3 => three(a, x),
        4 => four(a, x),
        5 => five(a, x),
        _ => unreachable!("no stage has {R} values"),
    }
}

#[inline(always)]
fn two<T: Scalar, S: Simd>(a: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    (x[0], x[1]) = (a.add(x[0], x[1]), a.sub(x[0], x[1]));
}

/// With `s = sin(2 pi/3)`: `y_1, y_2 = x_0 - (x_1 + x_2)/2 -+ i s (x_1 - x_2)`.
#[inline(always)]
fn three<T: Scalar, S: Simd>(a: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    let (half, sine) = (a.splat(T::of(0.5)), a.splat(T::of(0.75f64.sqrt())));
    let (sum, difference) = (a.add(x[1], x[2]), a.scale(a.sub(x[1], x[2]), sine));
    let mean = a.sub(x[0], a.scale(sum, half));
    x[0] = a.add(x[0], sum);
    (x[1], x[2]) = (a.sub_i(mean, difference), a.add_i(mean, difference));
}

#[inline(always)]
fn four<T: Scalar, S: Simd>(a: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    let (even, odd) = (a.add(x[0], x[2]), a.add(x[1], x[3]));
    let (across, along) = (a.sub(x[0], x[2]), a.sub(x[1], x[3]));
    (x[0], x[2]) = (a.add(even, odd), a.sub(even, odd));
    (x[1], x[3]) = (a.sub_i(across, along), a.add_i(across, along));
}

/// With `c_k, s_k` of the angle `2 pi k/5`:
///
/// ```text
/// y_1, y_4 = x_0 + c_1 (x_1 + x_4) + c_2 (x_2 + x_3) -+ i (s_1 (x_1 - x_4) + s_2 (x_2 - x_3))
/// y_2, y_3 = x_0 + c_2 (x_1 + x_4) + c_1 (x_2 + x_3) -+ i (s_2 (x_1 - x_4) - s_1 (x_2 - x_3))
/// ```
#[inline(always)]
fn five<T: Scalar, S: Simd>(a: Arithmetic<T, S>, x: &mut [C<T, S>; LONGEST]) {
    // c_1, c_2 = (+-sqrt(5) - 1)/4 and s_1, s_2 = sqrt((5 +- sqrt(5))/8).
    let root = 5f64.sqrt();
    let (c1, c2) = (a.splat(T::of((root - 1.0) / 4.0)), a.splat(T::of(-(root + 1.0) / 4.0)));
    let (s1, s2) = (a.splat(T::of(((5.0 + root) / 8.0).sqrt())), a.splat(T::of(((5.0 - root) / 8.0).sqrt())));
    let (outer, inner) = (a.add(x[1], x[4]), a.add(x[2], x[3]));
    let (far, near) = (a.sub(x[1], x[4]), a.sub(x[2], x[3]));
    let mean_1 = a.add(x[0], a.add(a.scale(outer, c1), a.scale(inner, c2)));
    let mean_2 = a.add(x[0], a.add(a.scale(outer, c2), a.scale(inner, c1)));
    let turned_1 = a.add(a.scale(far, s1), a.scale(near, s2));
    let turned_2 = a.sub(a.scale(far, s2), a.scale(near, s1));
    x[0] = a.add(x[0], a.add(outer, inner));
    (x[1], x[4]) = (a.sub_i(mean_1, turned_1), a.add_i(mean_1, turned_1));
    (x[2], x[3]) = (a.sub_i(mean_2, turned_2), a.add_i(mean_2, turned_2));
}
