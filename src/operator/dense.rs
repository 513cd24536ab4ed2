//! `u = A p` by direct summation: the naive twin of [`Toeplitz`](super::Toeplitz), the oracle of its tests, and the
//! matrix of the small systems that are factorised.

use crate::grid::Grid;
use crate::influence::Influence;

/// `u_I = sum_J c(ix - jx, iy - jy) p_J`, term by term.
pub fn apply(influence: &Influence, grid: &Grid, p: &[f64], u: &mut [f64]) {
    assert!(p.len() == grid.len() && u.len() == grid.len());
    let (mx, my) = (grid.mx as i64, grid.my as i64);
    let width = 2 * grid.mx - 1;
    let mut table = vec![0.0; width * (2 * grid.my - 1)];
    for (row, ky) in table.chunks_exact_mut(width).zip(1 - my..) {
        for (value, kx) in row.iter_mut().zip(1 - mx..) {
            *value = influence.at(kx, ky);
        }
    }
    for iy in 0..grid.my {
        for ix in 0..grid.mx {
            let mut sum = 0.0;
            for jy in 0..grid.my {
                let row = &table[(iy + grid.my - 1 - jy) * width..][..width];
                for jx in 0..grid.mx {
                    sum += row[ix + grid.mx - 1 - jx] * p[jy * grid.mx + jx];
                }
            }
            u[grid.index(ix, iy)] = sum;
        }
    }
}

/// The matrix of the elements with the indices `elements` only, column by column; `coefficient(x, y)` is that of an offset.
pub fn fill_matrix(grid: &Grid, elements: &[usize], coefficient: impl Fn(i64, i64) -> f64, matrix: &mut Vec<f64>) {
    matrix.clear();
    matrix.reserve(elements.len() * elements.len());
    let offset = |i: usize, j: usize| {
        let x = (i % grid.mx) as i64 - (j % grid.mx) as i64;
        let y = (i / grid.mx) as i64 - (j / grid.mx) as i64;
        coefficient(x, y)
    };
    for &j in elements {
        matrix.extend(elements.iter().map(|&i| offset(i, j)));
    }
}
