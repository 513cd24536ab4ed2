//! The coefficients of a block Toeplitz matrix, as functions of the offset k = (kx, ky) = I - J between an element I and an element J.

/// Coefficients `c(k)` and `c(-k)` count as equal if they differ by at most this, relative to the largest coefficient. Tables are often written in
/// single precision, whose round-off is as large.
pub const SYMMETRY: f64 = 1e-7;

/// Coefficients that need not be even. The value of element J contributes to that of element I by the coefficient at the offset `k = I - J`.
pub trait Coefficients: Sync {
    /// Fills `out` with the coefficients at offsets `(kx, ky)`, `(kx + 1, ky)`, ...
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Fills `out` with the symmetric parts `(c(k) + c(-k))/2` at the same offsets.
    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]);

    /// Whether `c(k)` and `c(-k)` are equal to within [`SYMMETRY`] at all offsets.
    fn are_symmetric(&self) -> bool;
}

/// Coefficients that are even in both directions: `c(kx, ky) = c(-kx, ky) = c(kx, -ky)`.
pub struct Even<F, G> {
    /// The numbers of offsets in x and in y that `fill` gives: `0 .. given.0` and `0 .. given.1`. Coefficients at larger offsets are 0.
    pub given: (usize, usize),
    /// `fill(ky, row)` fills `row` with the coefficients at the offsets `(0, ky)`, `(1, ky)`, ...
    pub fill: F,
    /// Applied to each value of the symbol before its normalisation. For example, `|s| 1.0 / s` makes the product by the inverse of a circulant
    /// matrix.
    pub finish: G,
}

/// The symmetry of coefficients: whether they are even or odd in both directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// `c(kx, ky) = c(-kx, ky) = c(kx, -ky)`.
    Even,
    /// `c(kx, ky) = -c(-kx, ky) = -c(kx, -ky)`. They are 0 at offsets of half a period, which are their own opposites.
    Odd,
}

/// The coefficients of a product of two components: a matrix `[xx, xy; xy, yy]` for each offset. xx and yy are even in both directions, xy is odd in
/// both.
pub struct EvenMatrix<F, G> {
    /// The numbers of offsets in x and in y that `fill` gives: `0 .. given.0` and `0 .. given.1`. Coefficients at larger offsets are 0.
    pub given: (usize, usize),
    /// Whether the components are coupled. If not, xy is 0 and is not asked for.
    pub is_coupled: bool,
    /// `fill(component, ky, row)` fills `row` with xx (component 0), yy (1) or xy (2) at the offsets `(0, ky)`, `(1, ky)`, ...
    pub fill: F,
    /// Applied to [xx, yy, xy] of each value of the symbol before its normalisation.
    pub finish: G,
}
