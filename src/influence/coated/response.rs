//! The response of a bonded layer on a half-space to waves of a load.

/// The number of Taylor coefficients of a response at s = 0.
pub const TERMS: usize = 12;

/// The displacement of a layered surface by a wave of a load, over that of a half-space of the layer's material: a function B of `s = k t` that
/// tends to 1 for short waves.
pub trait Response {
    /// B(s), s >= 0.
    fn at(&self, s: f64) -> f64;

    /// `B(s) - 1`, without cancellation at large s, where B is near 1.
    fn less_one(&self, s: f64) -> f64;

    /// B(0), the response of the substrate alone.
    fn substrate(&self) -> f64;

    /// The Taylor coefficients of B at s = 0.
    fn taylor(&self) -> [f64; TERMS];
}

/// The Taylor coefficients of a quotient. `n(k)` and `d(k)` are the coefficients of its numerator and denominator.
pub(super) fn quotient(n: impl Fn(i32) -> f64, d: impl Fn(i32) -> f64) -> [f64; TERMS] {
    let mut taylor = [0.0; TERMS];
    for k in 0..TERMS {
        let known: f64 = (1..=k).map(|j| d(j as i32) * taylor[k - j]).sum();
        taylor[k] = (n(k as i32) - known) / d(0);
    }
    taylor
}
