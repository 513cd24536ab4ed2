//! The FFT smoother: a step along the residual times the inverse of a circulant near A, with a computed step length.
//!
//! ```text
//! z = M r on C, 0 outside             M: the inverse of a circulant near A
//! q = A z
//! v = v + omega alpha z,              alpha = (r, z)/(z, q), sums over C
//! r = r - omega alpha q
//! ```
//!
//! *Why a step length.* All eigenvalues of M A on a part C of the grid are at least 1. The largest eigenvalue grows like the logarithm of the number
//! of elements (about 3 at 64 x 64, 4.6 at 512 x 512), because a circulant ignores the boundary of C. The large eigenvalues belong to waves that the
//! coarse grid resolves as well. So a fixed alpha = 1 amplifies errors that the coarse grid has just removed, and a fixed alpha small enough for all
//! waves hardly smooths. With omega = 1 the alpha above minimises the elastic energy J along z:
//!
//! ```text
//! J(v) = (v, A v)/2 - (d, v) on C,    J(v + omega alpha z) - J(v) = -omega (2 - omega) (r, z)^2 / (2 (z, q)) <= 0
//! ```
//!
//! *Why the coarse-grid correction has a step length as well.* Coarse coefficients are computed anew, not by the Galerkin product, and the coarse
//! contact area differs from the fine one. So nothing bounds the energy of the correction. If the correction is one more direction z, it cannot
//! increase J. Then no part of a cycle increases J, whatever C is, and each sweep lowers J at least as much as one step of preconditioned steepest
//! descent. Therefore the cycles converge for every symmetric positive definite A.
//!
//! *Cost.* q updates the residual, so the step length costs no product. The sum of all steps, `A v`, is known at the end of the cycle and saves the
//! next product. M has nearly the period of the grid and costs a quarter of a product.
//!
//! *Nonlinearity.* alpha depends on r, so the cycle is not linear in the defect d. But it is homogeneous: `cycle(c d) = c cycle(d)`.
//!
//! *Other matrices.* If A is not symmetric, there is no energy. Then alpha = (r, q)/(q, q) minimises the norm of the residual, as it does if an A
//! that is not positive definite makes (z, q) <= 0. If the circulant is not positive definite, M = 1, and the smoother is steepest descent.

use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::{zeros, Operator, Workspace};
use crate::threads::Threads;

/// The FFT smoother on one grid.
pub struct Fft {
    /// M, and the memory of its products. None: M = 1.
    inverse_circulant: Option<(Operator<f64>, Workspace<f64>)>,
    /// Whether A is symmetric.
    symmetric: bool,
    /// The direction z.
    direction: Vec<f64>,
    /// q = A z, on the whole grid.
    displacement: Vec<f64>,
    /// A v, on the whole grid, where v is the sum of the steps since the last [`start`](Self::start).
    product: Vec<f64>,
}

impl Fft {
    /// Sets up the smoother on `grid`.
    pub fn new(coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Fft> {
        let period = Operator::<f64>::circulant_period(coefficients, grid);
        let inverse_circulant = match Operator::inverse_circulant(coefficients, grid, period, threads)? {
            Some(inverse) => {
                let workspace = inverse.workspace()?;
                Some((inverse, workspace))
            }
            None => {
                log::info!("the circulant of the influence coefficients is not positive: steepest descent smooths");
                None
            }
        };
        let array = || zeros(grid.len(), "the smoother");
        Ok(Fft {
            inverse_circulant,
            symmetric: coefficients.is_symmetric(grid),
            direction: array()?,
            displacement: array()?,
            product: array()?,
        })
    }

    /// Begins a cycle with v = 0.
    pub fn start(&mut self) {
        self.product.fill(0.0);
    }

    /// `A v` on the whole grid, where v is the sum of all steps since the start.
    pub fn product(&self) -> &[f64] {
        &self.product
    }

    /// Makes one sweep, which updates v and the residual.
    pub fn sweep(
        &mut self,
        v: &mut [f64],
        residual: &mut [f64],
        contact: &[bool],
        relaxation: f64,
        displace: impl FnMut(&[f64], &mut [f64]),
    ) {
        for ((z, r), &inside) in self.direction.iter_mut().zip(&*residual).zip(contact) {
            *z = if inside { *r } else { 0.0 };
        }
        if let Some((inverse, workspace)) = &mut self.inverse_circulant {
            inverse.apply_in_place(&mut self.direction, workspace);
        }
        self.step(v, residual, contact, relaxation, displace);
    }

    /// Adds a given correction to v, times the step length that minimises the energy, and updates the residual. `fill` writes the correction on the
    /// whole grid.
    pub fn correct(
        &mut self,
        v: &mut [f64],
        residual: &mut [f64],
        contact: &[bool],
        fill: impl FnOnce(&mut [f64]),
        displace: impl FnMut(&[f64], &mut [f64]),
    ) {
        fill(&mut self.direction);
        self.step(v, residual, contact, 1.0, displace);
    }

    /// Makes a step along z on C.
    fn step(
        &mut self,
        v: &mut [f64],
        residual: &mut [f64],
        contact: &[bool],
        relaxation: f64,
        mut displace: impl FnMut(&[f64], &mut [f64]),
    ) {
        for (z, _) in self.direction.iter_mut().zip(contact).filter(|(_, &inside)| !inside) {
            *z = 0.0;
        }
        displace(&self.direction, &mut self.displacement);
        let n = v.len();
        let (z, q, contact) = (&self.direction[..n], &self.displacement[..n], &contact[..n]);
        let (mut rz, mut zq, mut rq, mut qq) = (0.0, 0.0, 0.0, 0.0);
        for i in (0..n).filter(|&i| contact[i]) {
            rz += residual[i] * z[i];
            zq += z[i] * q[i];
            rq += residual[i] * q[i];
            qq += q[i] * q[i];
        }
        let alpha = relaxation * if self.symmetric && zq > 0.0 { rz / zq } else { rq / qq };
        // alpha is not finite if z is 0 (because the residual is 0) or not finite. Then there is no step.
        if !alpha.is_finite() {
            return;
        }
        for i in 0..n {
            v[i] += alpha * z[i];
            self.product[i] += alpha * q[i];
            residual[i] -= if contact[i] { alpha * q[i] } else { 0.0 };
        }
    }
}
