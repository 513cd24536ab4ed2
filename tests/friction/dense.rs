//! `u = A q` by direct summation: the reference for tests of `Toeplitz`.

use contact_normal::friction::{Tangential, Vector};
use contact_normal::grid::Grid;

/// `u_I = sum_J A(I - J + by) q_J`, term by term: displacements at `by` from each centre, in elements.
pub fn apply(tangential: &Tangential, grid: &Grid, by: (f64, f64), q: &[Vector], u: &mut [Vector]) {
    assert!(q.len() == grid.len() && u.len() == grid.len());
    let (mx, my) = (grid.mx, grid.my);
    // Coefficient k + l (2 mx - 1) is that of I - J = (k - mx + 1, l - my + 1).
    let wide = 2 * mx - 1;
    let at = |k: usize, m: usize| k as f64 - (m - 1) as f64;
    let row = |l: usize| (0..wide).map(move |k| tangential.at(at(k, mx) + by.0, at(l, my) + by.1));
    let coefficients: Vec<[f64; 3]> = (0..2 * my - 1).flat_map(row).collect();
    for (i, u) in u.iter_mut().enumerate() {
        *u = [0.0; 2];
        let first = i % mx + mx - 1 + (i / mx + my - 1) * wide;
        for (j, q) in q.iter().enumerate().filter(|(_, q)| **q != [0.0; 2]) {
            let [xx, yy, xy] = coefficients[first - j % mx - j / mx * wide];
            *u = [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]];
        }
    }
}
