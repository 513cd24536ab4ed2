//! Polynomials on [-1, 1]: interpolation at Chebyshev nodes, conversion to powers, integrals and values.

use std::f64::consts::PI;

/// The i-th of m Chebyshev nodes of the first kind.
pub fn node(i: usize, m: usize) -> f64 {
    angle(i, m).cos()
}

fn angle(i: usize, m: usize) -> f64 {
    PI * (i as f64 + 0.5) / m as f64
}

/// The Chebyshev coefficients of the polynomial with these values at the M Chebyshev nodes.
pub fn chebyshev<const M: usize>(values: &[f64; M]) -> [f64; M] {
    std::array::from_fn(|k| {
        let sum: f64 = (0..M).map(|i| values[i] * (k as f64 * angle(i, M)).cos()).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / M as f64
    })
}

/// `sum of c[k] T_k(x)`, by Clenshaw's recursion.
pub fn clenshaw(coefficients: &[f64], x: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for c in coefficients[1..].iter().rev() {
        (one, two) = (2.0 * x * one - two + c, one);
    }
    x * one - two + coefficients[0]
}

/// The number of Chebyshev coefficients to keep, at least one: the absolute values of the dropped ones add up to at most `allowed`.
pub fn terms(coefficients: &[f64], allowed: f64) -> usize {
    let mut dropped = 0.0;
    let is_needed = |c: &f64| {
        dropped += c.abs();
        dropped > allowed
    };
    coefficients.iter().rposition(is_needed).map_or(1, |last| last + 1)
}

/// Converts at most M Chebyshev coefficients to the coefficients of the powers of x.
pub fn powers<const M: usize>(chebyshev: &[f64]) -> [f64; M] {
    // The sum of `c[k] T_k`. `before` and `now` hold the powers of two successive T_k.
    let (mut before, mut now) = ([0.0; M], [0.0; M]);
    (before[0], now[1]) = (1.0, 1.0);
    let mut sum = [0.0; M];
    sum[0] = chebyshev[0];
    for c in &chebyshev[1..] {
        for (sum, now) in sum.iter_mut().zip(now) {
            *sum += c * now;
        }
        let mut next = [0.0; M];
        for k in 0..M {
            next[k] = if k > 0 { 2.0 * now[k - 1] } else { 0.0 } - before[k];
        }
        (before, now) = (now, next);
    }
    sum
}

/// The polynomial `start + factor * (integral of the given one from -1 to x)`. M must be N + 1.
pub fn integral<const N: usize, const M: usize>(polynomial: &[f64; N], factor: f64, start: f64) -> [f64; M] {
    let mut integral = [0.0; M];
    for (k, c) in polynomial.iter().enumerate() {
        integral[k + 1] = factor * c / (k + 1) as f64;
    }
    integral[0] = start - evaluate(&integral, -1.0);
    integral
}

/// The value of the polynomial at x, by Horner's scheme.
#[inline]
pub fn evaluate(polynomial: &[f64], x: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
}
