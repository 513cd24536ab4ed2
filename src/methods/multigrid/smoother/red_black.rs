//! Gauss-Seidel in red-black order: first the elements with ix + iy even, then the others. A is dense, so the red elements
//! depend on each other too: each colour is swept in lexicographic order, and the residual is brought up to date between.

use super::GaussSeidel;
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::zeros;

/// Memory for a sweep.
pub struct Workspace {
    /// What the red elements change.
    changes: Vec<f64>,
    /// The residual before the sweep.
    before: Vec<f64>,
}

impl Workspace {
    /// For one grid.
    pub fn new(grid: &Grid) -> Result<Workspace> {
        let array = || zeros(grid.len(), "the smoother");
        Ok(Workspace { changes: array()?, before: array()? })
    }
}

/// One sweep over both colours of the elements in contact.
pub fn sweep(
    gauss_seidel: &mut GaussSeidel,
    workspace: &mut Workspace,
    p: &mut [f64],
    residual: &mut [f64],
    contact: &[bool],
    relaxation: f64,
    mut displace: impl FnMut(&[f64], &mut [f64]),
) {
    let mx = gauss_seidel.row_length();
    let red = |i: usize| (i / mx + i % mx) % 2 == 0;
    let Workspace { changes, before } = workspace;
    before.copy_from_slice(residual);
    changes.fill(0.0);
    gauss_seidel.sweep(changes, residual, relaxation, |i| contact[i] && red(i));
    p.iter_mut().zip(&*changes).for_each(|(p, change)| *p += change);
    displace(changes, residual);
    residual.iter_mut().zip(before).for_each(|(r, before)| *r = *before - *r);
    gauss_seidel.sweep(p, residual, relaxation, |i| contact[i] && !red(i));
}
