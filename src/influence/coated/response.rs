//! The response of a bonded layer to the waves of a load.

/// Number of Taylor coefficients.
pub const TERMS: usize = 12;

/// The displacement of a surface with a layer by a wave, over that of a half-space of the layer's material: a function of `s = k t` that is 1 for
/// short waves.
pub trait Response {
    /// B(s), s >= 0.
    fn at(&self, s: f64) -> f64;

    /// `B(s) - 1`, without cancellation where B is near 1 for large s.
    fn less_one(&self, s: f64) -> f64;

    /// B(0).
    fn substrate(&self) -> f64;

    /// The Taylor coefficients of B at 0.
    fn taylor(&self) -> [f64; TERMS];
}

/// The Taylor coefficients of a quotient, from those of numerator and denominator.
pub(super) fn quotient(n: impl Fn(i32) -> f64, d: impl Fn(i32) -> f64) -> [f64; TERMS] {
    let mut taylor = [0.0; TERMS];
    for k in 0..TERMS {
        let known: f64 = (1..=k).map(|j| d(j as i32) * taylor[k - j]).sum();
        taylor[k] = (n(k as i32) - known) / d(0);
    }
    taylor
}
