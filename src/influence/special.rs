//! Special functions that the standard library lacks.

use std::f64::consts::PI;

/// Euler's constant.
pub const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// `erfc(x) = 2/sqrt(pi) integral from x of exp(-t^2)`, x >= 0: the series of erf (Abramowitz & Stegun 7.1.6) below 2, the continued
/// fraction (7.1.14) above.
pub fn complementary_error_function(x: f64) -> f64 {
    let gaussian = (-x * x).exp() / PI.sqrt();
    if x < 2.0 {
        let (mut term, mut sum) = (2.0 * x, 2.0 * x);
        for n in 1..60 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        return 1.0 - gaussian * sum;
    }
    let mut fraction = x;
    for n in (1..=60).rev() {
        fraction = x + 0.5 * f64::from(n) / fraction;
    }
    gaussian / fraction
}

/// `sum over n >= 0 of (a + n)^-s`, s > 1, a >= 10: the Euler-Maclaurin formula.
pub fn hurwitz_zeta(s: f64, a: f64) -> f64 {
    // B_2k/(2k)!
    const BERNOULLI: [f64; 6] =
        [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30240.0, -1.0 / 1_209_600.0, 1.0 / 47_900_160.0, -691.0 / 1_307_674_368_000.0];
    let power = a.powf(-s);
    let mut sum = power * (a / (s - 1.0) + 0.5);
    let mut factor = s * power / a;
    for (k, bernoulli) in BERNOULLI.into_iter().enumerate() {
        sum += bernoulli * factor;
        let k = 2.0 * k as f64 + 1.0;
        factor *= (s + k) * (s + k + 1.0) / (a * a);
    }
    sum
}
