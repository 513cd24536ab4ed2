//! `u = A q` by direct summation, as the reference in tests of [`Toeplitz`](super::Toeplitz).

use super::coefficients::Tangential;
use super::plane::Vector;
use crate::grid::Grid;

/// `u_I = sum_J A(I - J + by) q_J`, term by term: displacements at `by` from each centre, in elements.
pub fn apply(tangential: &Tangential, grid: &Grid, by: (f64, f64), q: &[Vector], u: &mut [Vector]) {
    assert!(q.len() == grid.len() && u.len() == grid.len());
    let place = |i: usize| ((i % grid.mx) as f64, (i / grid.mx) as f64);
    for (i, u) in u.iter_mut().enumerate() {
        let (x, y) = place(i);
        *u = [0.0; 2];
        for (j, q) in q.iter().enumerate().filter(|(_, q)| **q != [0.0; 2]) {
            let (from_x, from_y) = place(j);
            let [xx, yy, xy] = tangential.at(x - from_x + by.0, y - from_y + by.1);
            *u = [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]];
        }
    }
}
