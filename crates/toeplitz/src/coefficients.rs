//! What a matrix is made of: the coefficients of its offsets.

/// Coefficients `c(k)` and `c(-k)` that differ by no more than this, relative to the largest, count as equal: tables are often written in
/// single precision.
pub const SYMMETRY: f64 = 1e-7;

/// Coefficients that need not be even. Those of an element J act on element I at the offset `k = I - J`.
pub trait Coefficients: Sync {
    /// Those at offsets `(kx, ky)`, `(kx + 1, ky)`, ...
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Their symmetric parts `(c(k) + c(-k))/2`, likewise.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Whether `c(k) = c(-k)` to within [`SYMMETRY`].
    fn are_symmetric(&self) -> bool;
}

/// Coefficients that are even in both directions.
pub struct Even<F, G> {
    /// Coefficients that are not zero: offsets less than that.
    pub given: (usize, usize),
    /// `fill(ky, row)` gives the coefficients at offsets `(0.., ky)`.
    pub fill: F,
    /// What is kept of each value of the symbol, but for the normalisation.
    pub finish: G,
}
