//! A Toeplitz matrix, given by its coefficients at offsets.

/// Coefficients `c(k)` and `c(-k)` that differ by no more than this, relative to the largest, count as equal: tables are often written in
/// single precision.
pub const SYMMETRY: f64 = 1e-7;

/// Coefficients that need not be even. Element J acts on element I by the coefficient at the offset `k = I - J`.
pub trait Coefficients: Sync {
    /// Fills `out` with the coefficients at offsets `(kx, ky)`, `(kx + 1, ky)`, ...
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Fills `out` with the symmetric parts `(c(k) + c(-k))/2` at the same offsets.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Whether `c(k) = c(-k)` to within [`SYMMETRY`].
    fn are_symmetric(&self) -> bool;
}

/// Coefficients that are even in both directions.
pub struct Even<F, G> {
    /// The offsets in x and in y from which on all coefficients are 0.
    pub given: (usize, usize),
    /// `fill(ky, row)` gives the coefficients at offsets `(0.., ky)`.
    pub fill: F,
    /// Applied to each value of the symbol before normalisation.
    pub finish: G,
}

/// Symmetry: whether coefficients are even or odd in the offsets of x and of y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// `c(kx, ky) = c(-kx, ky) = c(kx, -ky)`.
    Even,
    /// `c(kx, ky) = -c(-kx, ky) = -c(kx, -ky)`; 0 at offsets of half a period.
    Odd,
}

/// Coefficients of products of two components: the matrix `[xx, xy; xy, yy]` of each offset, of which xx and yy are even in both directions and xy
/// is odd in both.
pub struct EvenMatrix<F, G> {
    /// The offsets in x and in y from which on all coefficients are 0.
    pub given: (usize, usize),
    /// Whether there is xy.
    pub is_coupled: bool,
    /// `fill(component, ky, row)` gives xx (component 0), yy (1) or xy (2) at offsets `(0.., ky)`.
    pub fill: F,
    /// Applied to xx, yy and xy of each value of the symbol before normalisation.
    pub finish: G,
}
