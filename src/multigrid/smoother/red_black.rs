//! Gauss-Seidel in red-black order: first the elements with ix + iy even, then the others. A is dense, so the red elements
//! depend on each other too: each colour is swept in lexicographic order, and the residual is brought up to date between.

use super::GaussSeidel;

/// One sweep over both colours of the elements in contact.
pub fn sweep(
    gauss_seidel: &mut GaussSeidel,
    changes: &mut [f64],
    p: &mut [f64],
    residual: &mut [f64],
    contact: &[bool],
    relaxation: f64,
    mut displace: impl FnMut(&[f64], &mut [f64]),
) {
    let mx = gauss_seidel.row_length();
    let red = |i: usize| (i / mx + i % mx) % 2 == 0;
    let before = residual.to_vec();
    changes.fill(0.0);
    gauss_seidel.sweep(changes, residual, relaxation, |i| contact[i] && red(i));
    p.iter_mut().zip(&*changes).for_each(|(p, change)| *p += change);
    displace(changes, residual);
    residual.iter_mut().zip(before).for_each(|(r, before)| *r = before - *r);
    gauss_seidel.sweep(p, residual, relaxation, |i| contact[i] && !red(i));
}
