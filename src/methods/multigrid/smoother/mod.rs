//! Smoothers: cheap iterations that remove the short waves of the error and leave the long ones to the coarser grids.

mod fft;
mod gauss_seidel;
mod long_rows;

pub use fft::Fft;
pub use gauss_seidel::GaussSeidel;

use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::zeros;
use crate::threads::Threads;

/// The kind of a smoother.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmootherKind {
    /// Gauss-Seidel in lexicographic order, x fastest: the smoother of the paper, with the relaxation 0.8. A relaxation below 1 is under-relaxation
    /// (SUR), above 1 over-relaxation (SOR).
    GaussSeidel,
    /// Gauss-Seidel in red-black order. For this problem it reduces errors less than lexicographic order, and needs one more product.
    RedBlack,
    /// (Damped) Jacobi, for comparison only: it does not converge on fine grids.
    Jacobi,
    /// The inverse of a circulant, with the step length of least energy. It needs no more products than Gauss-Seidel, and makes the cycle nonlinear.
    Fft,
}

impl SmootherKind {
    /// The relaxation that suits this smoother. For Gauss-Seidel 0.8 is the best of the paper (table 1). Jacobi needs 1/2. The FFT smoother computes
    /// a step length and needs no relaxation.
    pub fn default_relaxation(self) -> f64 {
        match self {
            SmootherKind::GaussSeidel | SmootherKind::RedBlack => 0.8,
            SmootherKind::Jacobi => 0.5,
            SmootherKind::Fft => 1.0,
        }
    }
}

/// A smoother on one grid.
pub enum Smoother {
    /// See [`SmootherKind::GaussSeidel`].
    GaussSeidel(GaussSeidel),
    /// See [`SmootherKind::RedBlack`]. The first array has the changes of the red elements, the second the residual before the sweep.
    RedBlack(GaussSeidel, Vec<f64>, Vec<f64>),
    /// See [`SmootherKind::Jacobi`]. The number is the diagonal coefficient.
    Jacobi(f64),
    /// See [`SmootherKind::Fft`].
    Fft(Box<Fft>),
}

impl Smoother {
    /// Sets up a smoother on one grid.
    pub fn new(kind: SmootherKind, coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Smoother> {
        Ok(match kind {
            SmootherKind::GaussSeidel => Smoother::GaussSeidel(GaussSeidel::new(coefficients, grid)?),
            SmootherKind::RedBlack => {
                let array = || zeros(grid.len(), "the smoother");
                Smoother::RedBlack(GaussSeidel::new(coefficients, grid)?, array()?, array()?)
            }
            SmootherKind::Jacobi => Smoother::Jacobi(coefficients.at(0, 0)),
            SmootherKind::Fft => Smoother::Fft(Box::new(Fft::new(coefficients, grid, threads)?)),
        })
    }

    /// Whether a sweep leaves the residual of the new p in `residual`.
    pub fn keeps_residual(&self) -> bool {
        matches!(self, Smoother::Fft(_))
    }

    /// Makes one sweep on `A p = b` over the elements in contact. `residual` is `b - A p` before. It is overwritten, or updated by a smoother that
    /// [keeps the residual](Self::keeps_residual). `displace(changes, product)` computes `product = A changes`.
    pub fn sweep(
        &mut self,
        p: &mut [f64],
        residual: &mut [f64],
        contact: &[bool],
        relaxation: f64,
        mut displace: impl FnMut(&[f64], &mut [f64]),
    ) {
        match self {
            Smoother::GaussSeidel(gauss_seidel) => gauss_seidel.sweep(p, residual, relaxation, |i| contact[i]),
            // A is dense, so the elements of one colour depend on each other. Each colour is swept in lexicographic order, and the residual is
            // updated between the two sweeps.
            Smoother::RedBlack(gauss_seidel, changes, before) => {
                let mx = gauss_seidel.mx;
                let red = |i: usize| (i / mx + i % mx) % 2 == 0;
                before.copy_from_slice(residual);
                changes.fill(0.0);
                gauss_seidel.sweep(changes, residual, relaxation, |i| contact[i] && red(i));
                p.iter_mut().zip(&*changes).for_each(|(p, change)| *p += change);
                displace(changes, residual);
                residual.iter_mut().zip(before).for_each(|(r, before)| *r = *before - *r);
                gauss_seidel.sweep(p, residual, relaxation, |i| contact[i] && !red(i));
            }
            Smoother::Fft(fft) => fft.sweep(p, residual, contact, relaxation, displace),
            Smoother::Jacobi(diagonal) => {
                for ((p, r), _) in p.iter_mut().zip(residual).zip(contact).filter(|(_, &inside)| inside) {
                    *p += relaxation * *r / *diagonal;
                }
            }
        }
    }
}
