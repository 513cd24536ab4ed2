//! The library's fast Gauss-Seidel sweep has the iterates of the sweep by its formula, term by term.

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Table};
use contact_normal::methods::multigrid::smoother::{Smoother, SmootherKind};
use contact_normal::threads::Threads;

use super::dense;
use crate::families::case::Random;

/// The sweep by its formula, in the order of `elements`.
fn dense_sweep(influence: &Coefficients, grid: &Grid, p: &mut [f64], b: &[f64], relaxation: f64, elements: &[usize]) {
    for &i in elements {
        let mut sum = 0.0;
        for (j, p) in p.iter().enumerate() {
            let (x, y) = ((i % grid.mx) as i64 - (j % grid.mx) as i64, (i / grid.mx) as i64 - (j / grid.mx) as i64);
            sum += influence.at(x, y) * p;
        }
        p[i] += relaxation * (b[i] - sum) / influence.at(0, 0);
    }
}

fn influences(grid: &Grid, random: &mut Random) -> [Coefficients; 2] {
    let mut table: Vec<f64> = (0..4 * grid.len()).map(|_| random.next() - 0.5).collect();
    table[grid.my * 2 * grid.mx + grid.mx] = 20.0;
    [
        Coefficients::from(HalfSpace::new(grid.dx, grid.dy, 1.0)),
        Coefficients::from(Table::new(grid.mx, grid.my, &table, grid).unwrap()),
    ]
}

/// Grids below and above one strip of 16 rows, and below and above blocks of strips, with contact areas of all shapes.
#[test]
fn a_fast_sweep_is_the_dense_sweep_to_twelve_digits() {
    let mut random = Random(5);
    for (mx, my) in [(1, 1), (1, 40), (40, 1), (9, 7), (13, 16), (11, 17), (8, 33), (20, 70), (5, 130)] {
        let grid = Grid::new(mx, my, 1.0, 0.6).unwrap();
        for influence in influences(&grid, &mut random) {
            for fill in [1.0, 0.6, 0.05] {
                let contact: Vec<bool> = (0..grid.len()).map(|_| random.next() < fill).collect();
                let start: Vec<f64> = contact.iter().map(|&inside| if inside { random.next() } else { 0.0 }).collect();
                let b: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
                let in_contact = |i: &usize| contact[*i];
                let lexicographic: Vec<usize> = (0..grid.len()).filter(in_contact).collect();
                let is_red = |i: &usize| (i / mx + i % mx) % 2 == 0;
                let mut red_black: Vec<usize> = lexicographic.iter().copied().filter(is_red).collect();
                red_black.extend(lexicographic.iter().filter(|i| !is_red(i)));
                for (kind, order) in [(SmootherKind::GaussSeidel, lexicographic), (SmootherKind::RedBlack, red_black)] {
                    let mut expected = start.clone();
                    dense_sweep(&influence, &grid, &mut expected, &b, 0.8, &order);

                    let displace = |p: &[f64], u: &mut [f64]| dense::apply(&influence, &grid, p, u);
                    let (mut p, mut residual) = (start.clone(), vec![0.0; grid.len()]);
                    displace(&p, &mut residual);
                    residual.iter_mut().zip(&b).for_each(|(r, b)| *r = b - *r);
                    let mut smoother = Smoother::new(kind, &influence, &grid, &Threads::One).unwrap();
                    smoother.sweep(&mut p, &mut residual, &contact, 0.8, displace);

                    let size = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                    for (a, b) in p.iter().zip(&expected) {
                        assert!((a - b).abs() <= 1e-12 * size, "{kind:?} on {mx} x {my}: {a} for {b}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_second_sweep_does_not_remember_the_first() {
    let mut random = Random(6);
    let grid = Grid::new(12, 50, 1.0, 1.0).unwrap();
    let influence = Coefficients::from(HalfSpace::new(1.0, 1.0, 1.0));
    let mut used = Smoother::new(SmootherKind::GaussSeidel, &influence, &grid, &Threads::One).unwrap();
    for _ in 0..3 {
        let contact: Vec<bool> = (0..grid.len()).map(|_| random.next() < 0.4).collect();
        let b: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
        let sweep = |smoother: &mut Smoother| {
            let (mut p, mut residual) = (vec![0.0; grid.len()], b.clone());
            smoother.sweep(&mut p, &mut residual, &contact, 1.0, |_, _| {});
            p
        };
        let fresh = sweep(&mut Smoother::new(SmootherKind::GaussSeidel, &influence, &grid, &Threads::One).unwrap());
        assert_eq!(sweep(&mut used), fresh);
    }
}
