//! The exponential function of several numbers at a time.

use std::f64::consts::LOG2_E;

use super::point_force::Lanes;

/// `exp(-x)` for `0 <= x < 700`, in lanes: `2^-n exp(r)` with `|r| <= ln(2)/2`, and Taylor's series of `exp(r)`.
#[inline(always)]
pub fn exp_of_minus(x: &Lanes) -> Lanes {
    /// If this is added to a number below 2^51, the nearest integer is in the last bits of the sum.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    /// The upper part of ln 2. It has 32 bits, so that its multiples are exact.
    const UPPER: f64 = 0.693_147_180_369_123_8;
    /// The rest of ln 2.
    const LOWER: f64 = 1.908_214_929_270_587_7e-10;
    std::array::from_fn(|i| {
        let shifted = x[i] * LOG2_E + SHIFT;
        let n = shifted - SHIFT;
        let r = (n * UPPER - x[i]) + n * LOWER;
        let power = f64::from_bits(1.0_f64.to_bits().wrapping_sub(shifted.to_bits() << 52));
        let series = TAYLOR.iter().rev().fold(0.0, |sum, term| sum * r + term);
        power * series
    })
}

/// The coefficients `1/n!` of Taylor's series. The first omitted term is 4e-18 at ln(2)/2.
const TAYLOR: [f64; 14] = {
    let mut terms = [1.0; 14];
    let mut n = 1;
    while n < 14 {
        terms[n] = terms[n - 1] / n as f64;
        n += 1;
    }
    terms
};
