//! The entries of A between given elements, for small systems that are factorised.

use crate::grid::Grid;

/// Fills `matrix`, column by column, with the influence coefficients between `elements`. `coefficient(kx, ky)` is that of an offset.
pub fn fill_matrix(grid: &Grid, elements: &[usize], coefficient: impl Fn(i64, i64) -> f64, matrix: &mut Vec<f64>) {
    matrix.clear();
    matrix.reserve(elements.len() * elements.len());
    // Divisions would dominate the time. So there is one for each column, and one for each row of the grid in it, but not one for each pair of
    // elements.
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
