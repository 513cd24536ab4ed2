//! The exact solve on the coarsest grid: Gaussian elimination restricted to the contact area.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::Mat;

use crate::grid::Grid;
use crate::influence::Influence;
use crate::operator::dense;

/// Solves `A x = b` on the elements in contact; `x = 0` elsewhere.
pub fn solve(influence: &Influence, grid: &Grid, contact: &[bool], b: &[f64], x: &mut [f64]) {
    x.fill(0.0);
    let elements: Vec<usize> = (0..grid.len()).filter(|&i| contact[i]).collect();
    if elements.is_empty() {
        return;
    }
    let factors: PartialPivLu<f64> = dense::matrix(influence, grid, &elements).partial_piv_lu();
    let mut solution = Mat::from_fn(elements.len(), 1, |row, _| b[elements[row]]);
    factors.solve_in_place(&mut solution);
    for (row, &i) in elements.iter().enumerate() {
        x[i] = solution[(row, 0)];
    }
}
