//! Gauss-Seidel on rows of thousands of elements: a sweep equals its formula, summed term by term.

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, Table};
use contact_normal::methods::multigrid::smoother::{Smoother, SmootherKind};
use contact_normal::threads::Threads;

use super::dense;
use crate::families::case::Random;

/// An unsymmetric table whose coefficients fall as 1/k.
fn influence(grid: &Grid) -> Coefficients {
    let (mx, my) = (grid.mx as i64, grid.my as i64);
    let at = |kx: i64, ky: i64| (if kx > 0 { 1.0 } else { 0.9 }) / ((kx * kx + 9 * ky * ky) as f64 + 0.04).sqrt();
    let table: Vec<f64> = (-my..my).flat_map(|ky| (-mx..mx).map(move |kx| at(kx, ky))).collect();
    Coefficients::from(Table::new(grid.mx, grid.my, &table, grid).unwrap())
}

#[test]
fn sweeps_of_long_rows_are_those_of_the_formula() {
    let mut random = Random(11);
    for (mx, my) in [(4097, 1), (6001, 1), (9000, 1), (4500, 2)] {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        let influence = influence(&grid);
        // Contact areas: all elements, a random half of them, and a piece inside the grid.
        for (fill, piece) in [(1.0, 0..grid.len()), (0.5, 0..grid.len()), (0.9, 700..grid.len() - 1234)] {
            let contact: Vec<bool> = (0..grid.len()).map(|i| random.next() < fill && piece.contains(&i)).collect();
            let b: Vec<f64> = (0..grid.len()).map(|_| random.next() - 0.4).collect();
            let mut expected = vec![0.0; grid.len()];
            let mut elements: Vec<usize> = Vec::new();
            for i in (0..grid.len()).filter(|&i| contact[i]) {
                let place = |i: usize| ((i % mx) as i64, (i / mx) as i64);
                let sum: f64 = elements
                    .iter()
                    .map(|&j| influence.at(place(i).0 - place(j).0, place(i).1 - place(j).1) * expected[j])
                    .sum();
                expected[i] = 0.8 * (b[i] - sum) / influence.at(0, 0);
                elements.push(i);
            }
            let (mut p, mut residual) = (vec![0.0; grid.len()], b.clone());
            let mut smoother = Smoother::new(SmootherKind::GaussSeidel, &influence, &grid, &Threads::One).unwrap();
            let displace = |p: &[f64], u: &mut [f64]| dense::apply(&influence, &grid, p, u);
            smoother.sweep(&mut p, &mut residual, &contact, 0.8, displace);
            let size = expected.iter().fold(0.0, |size: f64, p| size.max(p.abs()));
            for (found, expected) in p.iter().zip(&expected) {
                assert!((found - expected).abs() <= 1e-12 * size, "{mx} x {my}: {found} for {expected}");
            }
        }
    }
}
