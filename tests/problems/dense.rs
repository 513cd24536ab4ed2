//! `u = A p` by direct summation, for every effect: the oracle for the tests of `Operator`.

use contact_normal::grid::Grid;
use contact_normal::influence::Coefficients;

/// `u_I = sum_J A_IJ p_J`, term by term.
pub fn apply(coefficients: &Coefficients, grid: &Grid, p: &[f64], u: &mut [f64]) {
    assert!(p.len() == grid.len() && u.len() == grid.len());
    let loaded = || p.iter().enumerate().filter(|(_, p)| **p != 0.0);
    if coefficients.row_tables().is_some() {
        return u.iter_mut().enumerate().for_each(|(i, u)| {
            *u = loaded().map(|(j, p)| coefficients.entry(grid, i, j) * p).sum();
        });
    }
    // Each offset is evaluated once.
    let (width, height) = (2 * grid.mx - 1, 2 * grid.my - 1);
    let (mx, my) = (grid.mx as i64, grid.my as i64);
    let offsets = (0..width * height).map(|k| ((k % width) as i64 - (mx - 1), (k / width) as i64 - (my - 1)));
    let table: Vec<f64> = offsets.map(|(kx, ky)| coefficients.kernel().at(kx, ky)).collect();
    let kernel = |i: usize, j: usize| {
        let (x, y) = (i % grid.mx + grid.mx - 1 - j % grid.mx, i / grid.mx + grid.my - 1 - j / grid.mx);
        table[y * width + x]
    };
    for (i, u) in u.iter_mut().enumerate() {
        *u = loaded().map(|(j, p)| coefficients.entry_of(kernel(i, j), i, j) * p).sum();
    }
}
