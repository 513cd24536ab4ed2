//! The spectral radius of a small matrix, by Gelfand's formula: the limit of |M^q|^(1/q).

use contact_normal::operator::fft::Complex;

/// q = 2^SQUARINGS. |M^q|^(1/q) exceeds the spectral radius by a factor of at most k^(1/q), with k a condition number of the eigenvectors: 1e-5 for k
/// = 1e4, and less for defective eigenvalues of a 256 x 256 matrix.
const SQUARINGS: i32 = 20;

/// The spectral radius of an n x n matrix, given column by column.
pub(super) fn spectral_radius(n: usize, mut matrix: Vec<Complex<f64>>) -> f64 {
    let mut logarithm = 0.0;
    let mut square = matrix.clone();
    for squarings in 0..=SQUARINGS {
        let norm = matrix.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        if norm == 0.0 {
            return 0.0;
        }
        matrix.iter_mut().for_each(|value| *value /= norm);
        logarithm += norm.ln() * 0.5f64.powi(squarings);
        for (column, to) in matrix.chunks_exact(n).zip(square.chunks_exact_mut(n)) {
            to.fill(Complex::default());
            for (factor, of) in column.iter().zip(matrix.chunks_exact(n)) {
                to.iter_mut().zip(of).for_each(|(to, of)| *to += factor * of);
            }
        }
        std::mem::swap(&mut matrix, &mut square);
    }
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(n: usize, columns: &[f64]) -> f64 {
        spectral_radius(n, columns.iter().map(|&value| Complex::new(value, 0.0)).collect())
    }

    #[test]
    fn a_spectral_radius_is_the_largest_modulus_of_an_eigenvalue() {
        // Rotation by 0.7, scaled by 0.3: eigenvalues 0.3 e^(+-0.7 i). The rounding errors are those of 20 squarings, each halved by the next.
        let (s, c) = 0.7f64.sin_cos();
        assert!((of(2, &[0.3 * c, 0.3 * s, -0.3 * s, 0.3 * c]) - 0.3).abs() <= 1e-6 * 0.3);
        // Defective, eigenvalue 0.5 twice: |M^q|^(1/q) <= 0.5 (1 + 2 q)^(1/q), 1e-5 more.
        assert!((of(2, &[0.5, 0.0, 1.0, 0.5]) - 0.5).abs() <= 2e-5);
        // Nilpotent.
        assert_eq!(of(2, &[0.0, 0.0, 1.0, 0.0]), 0.0);
    }
}
