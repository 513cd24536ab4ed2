//! Special functions that the standard library lacks.

/// Euler's constant.
pub const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// The Hurwitz zeta function `sum over n >= 0 of (a + n)^-s` for s > 1 and a >= 10, by the Euler-Maclaurin formula.
pub fn hurwitz_zeta(s: f64, a: f64) -> f64 {
    // `B_2k/(2k)!` for k = 1 to 6, with the Bernoulli numbers B.
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
