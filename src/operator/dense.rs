//! The matrix of small systems that are factorised.

use crate::grid::Grid;

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
