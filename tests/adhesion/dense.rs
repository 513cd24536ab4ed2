//! The tangent of an equilibrium by a dense matrix: dF/dapproach, and whether the energy has a minimum there.
//!
//! ```text
//! [ A_CC          A_CO r         ]        [ 1 ]      p in C is x, p outside is r x,    r^2: the slope of the attraction
//! [ r A_OC     r A_OO r - 1      ]  x  =  [ r ]      dF/dapproach is the right-hand side times x
//! ```
//!
//! C is the contact area, O the elements outside. By elimination from the top the pivots of C are positive. For a fixed contact area the energy has a
//! minimum if all pivots outside C are negative.

use contact_normal::adhesion::Law;
use contact_normal::contact::State;
use contact_normal::grid::Grid;

use super::certificate::{displacements, traction};

/// The tangent of a state, by a dense matrix.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// The stiffness dF/dapproach.
    pub stiffness: f64,
    /// Whether the energy has a minimum at the approach.
    pub is_least: bool,
}

/// The matrix A of half-spaces, by rows.
pub fn matrix(grid: &Grid, modulus: f64) -> Vec<Vec<f64>> {
    let unit = |i: usize| {
        let mut p = vec![0.0; grid.len()];
        p[i] = 1.0;
        displacements(grid, modulus, &p)
    };
    (0..grid.len()).map(unit).collect()
}

/// The tangent of a state under a law with its work and range.
pub fn tangent(grid: &Grid, a: &[Vec<f64>], state: &State, (law, work, range): (Law, f64, f64)) -> Tangent {
    let distance = |i: usize| {
        let u: f64 = a[i].iter().zip(&state.p).map(|(a, p)| a * p).sum();
        state.h[i] - state.approach + u
    };
    let by = 1e-6 * range;
    let slope = |e: f64| (traction(law, work, range, e) - traction(law, work, range, e + by)) / by;
    let inside: Vec<usize> = (0..grid.len()).filter(|&i| state.contact[i]).collect();
    let mut order: Vec<(usize, f64, f64)> = inside.iter().map(|&i| (i, 1.0, 0.0)).collect();
    for i in (0..grid.len()).filter(|&i| !state.contact[i]) {
        let s = slope(distance(i).max(0.0));
        if s > 1e-12 * work / range / range {
            order.push((i, s.sqrt(), 1.0));
        }
    }
    let mut rows: Vec<Vec<f64>> = order
        .iter()
        .enumerate()
        .map(|(k, &(i, r, one))| {
            let mut row: Vec<f64> = order.iter().map(|&(j, other, _)| r * a[i][j] * other).collect();
            row[k] -= one;
            row
        })
        .collect();
    let right: Vec<f64> = order.iter().map(|&(_, r, _)| r).collect();
    // Factors L D L' without pivoting: the stiffness is the sum of (L^-1 right)^2/D.
    let (mut left, mut stiffness, mut is_least) = (right, 0.0, true);
    for k in 0..rows.len() {
        let pivot = rows[k][k];
        is_least &= (pivot > 0.0) == (k < inside.len());
        stiffness += left[k] * left[k] / pivot;
        let (done, rest) = rows.split_at_mut(k + 1);
        let above = &done[k];
        for (row, i) in rest.iter_mut().zip(k + 1..) {
            let factor = row[k] / pivot;
            left[i] -= factor * left[k];
            row.iter_mut().zip(above).skip(k).for_each(|(value, above)| *value -= factor * above);
        }
    }
    Tangent { stiffness: stiffness * grid.element_area(), is_least }
}
