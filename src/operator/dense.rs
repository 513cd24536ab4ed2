//! `u = A p` by direct summation: the naive twin of [`Operator`](super::Operator) for every effect, the oracle of its tests. Also the
//! matrix of small systems that are factorised.

use crate::grid::Grid;
use crate::influence::Coefficients;

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

/// The matrix of the elements `elements`, column by column, from the coefficients `coefficient(x, y)` of offsets.
pub fn fill_matrix(grid: &Grid, elements: &[usize], coefficient: impl Fn(i64, i64) -> f64, matrix: &mut Vec<f64>) {
    matrix.clear();
    matrix.reserve(elements.len() * elements.len());
    // Divisions dominate the time: there is one for each column and row of elements, not for each pair.
    for &j in elements {
        let (mut row, mut end) = (0, grid.mx);
        let (jx, jy) = ((j % grid.mx) as i64, (j / grid.mx) as i64);
        matrix.extend(elements.iter().map(|&i| {
            if !(end - grid.mx..end).contains(&i) {
                row = i / grid.mx;
                end = (row + 1) * grid.mx;
            }
            coefficient((i + grid.mx - end) as i64 - jx, row as i64 - jy)
        }));
    }
}
