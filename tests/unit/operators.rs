//! Products by operators for a part of the grid, compared with plain sums.

use super::{loaded, MadeOf, Operator, Operators, Rectangle};
use crate::grid::Grid;
use crate::influence::{Coefficients, HalfSpace, Layer, Table};
use crate::threads::Threads;

/// The error of a product by FFT is some rounding errors of the largest displacement.
const ROUND_OFF: f64 = 32.0 * f64::EPSILON;

fn grid() -> Grid {
    Grid::new(161, 130, 0.7, 0.4).expect("a grid")
}

fn coefficients(grid: &Grid) -> Coefficients {
    HalfSpace::new(grid.dx, grid.dy, 1.3).into()
}

/// Varying pressures on the given columns and rows, and 0 elsewhere.
fn pressures(grid: &Grid, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> Vec<f64> {
    let value = |i: usize| {
        let (x, y) = (i % grid.mx, i / grid.mx);
        let inside = columns.contains(&x) && rows.contains(&y);
        if inside {
            1.0 + ((7 * x + 13 * y) % 17) as f64
        } else {
            0.0
        }
    };
    (0..grid.len()).map(value).collect()
}

/// The kinds of coefficients for which a part of the grid may have its own operator: those of bodies, with an uneven layer, and of an even table.
fn all_coefficients(grid: &Grid) -> [(&'static str, Coefficients); 3] {
    let half_space = coefficients(grid);
    let layer: Vec<f64> = (0..grid.len()).map(|i| (i % 5) as f64).collect();
    let layer = Layer::per_element(&layer, half_space.at(0, 0)).expect("a layer");
    // A table has 2 mx by 2 my offsets, of either sign.
    let offset = |k: usize, m: usize| (k as f64 - m as f64).abs();
    let value = |i: usize| 1.0 / (1.0 + offset(i % (2 * grid.mx), grid.mx) + 2.0 * offset(i / (2 * grid.mx), grid.my));
    let table: Vec<f64> = (0..4 * grid.len()).map(value).collect();
    let table = Table::new(grid.mx, grid.my, &table, grid).expect("a table");
    [("bodies", half_space.clone()), ("layer", half_space.with_layer(layer)), ("table", table.into())]
}

/// `u = A p` of element i as a direct sum, row by row, so that its own round-off is also some rounding errors only.
fn sum(coefficients: &Coefficients, grid: &Grid, p: &[f64], i: usize) -> f64 {
    let of_row = |(y, p): (usize, &[f64])| {
        let loaded = p.iter().enumerate().filter(|(_, p)| **p != 0.0);
        loaded.map(|(x, p)| p * coefficients.entry(grid, i, y * grid.mx + x)).sum::<f64>()
    };
    p.chunks_exact(grid.mx).enumerate().map(of_row).sum()
}

/// Loaded columns and rows, and whether they get an operator of their own.
fn cases() -> [(&'static str, std::ops::Range<usize>, std::ops::Range<usize>, bool); 8] {
    [
        ("in the middle", 40..121, 30..100, true),
        ("one element in the middle", 80..81, 65..66, true),
        ("beside the middle", 30..100, 40..105, true),
        ("one row", 60..101, 64..65, true),
        ("in a corner", 0..40, 0..30, false),
        ("in the opposite corner", 150..161, 120..130, false),
        ("across", 0..161, 60..70, true),
        ("everywhere", 0..161, 0..130, false),
    ]
}

#[test]
fn products_of_a_part_are_those_of_all_elements() {
    let (grid, threads) = (grid(), Threads::One);
    for (kind, coefficients) in &all_coefficients(&grid) {
        let of = MadeOf { coefficients, grid: &grid, threads: &threads };
        let mut operators = Operators::default();
        for (name, columns, rows, is_part) in cases() {
            let p = pressures(&grid, columns, rows);
            assert_eq!(of.reach_of(&p).is_some(), is_part, "{name}");
            let mut u = vec![f64::NAN; grid.len()];
            operators.displace(of, &p, &mut u).expect("a product");
            let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.abs()));
            assert!(u.iter().all(|u| u.is_finite()), "{kind}, {name}");
            // Corners and edges are compared, because too short a period of a part would show there first.
            let edges = (0..grid.mx).step_by(20).flat_map(|x| [x, grid.len() - 1 - x]);
            let sides = (0..grid.my).step_by(16).flat_map(|y| [y * grid.mx, (y + 1) * grid.mx - 1]);
            for i in edges.chain(sides).chain((0..grid.len()).step_by(997)) {
                let exact = sum(coefficients, &grid, &p, i);
                assert!((u[i] - exact).abs() <= ROUND_OFF * largest, "{kind}, {name}: {} for {exact} at {i}", u[i]);
            }
        }
        let mut u = vec![f64::NAN; grid.len()];
        operators.displace(of, &vec![0.0; grid.len()], &mut u).expect("a product");
        assert!(u.iter().all(|u| *u == 0.0), "{kind}: nothing is displaced by nothing");
    }
}

#[test]
fn on_one_row_a_part_is_a_part_of_the_row() {
    let (grid, threads) = (Grid::new(17000, 1, 0.7, 0.4).expect("a grid"), Threads::One);
    let coefficients = coefficients(&grid);
    let of = MadeOf { coefficients: &coefficients, grid: &grid, threads: &threads };
    let p = pressures(&grid, 8000..9000, 0..1);
    assert!(of.reach_of(&p).is_some());
    let mut u = vec![f64::NAN; grid.len()];
    Operators::default().displace(of, &p, &mut u).expect("a product");
    for i in (0..grid.len()).step_by(1000).chain([grid.len() - 1]) {
        let (exact, own) = (sum(&coefficients, &grid, &p, i), 17.0 * coefficients.at(0, 0));
        // The plain sum of a thousand terms has more round-off.
        assert!((u[i] - exact).abs() <= 10.0 * ROUND_OFF * own, "{} for {exact} at {i}", u[i]);
    }
}

#[test]
fn products_on_few_elements_are_those_by_transforms() {
    let threads = Threads::One;
    for (mx, my) in [(1, 1), (2, 1), (1, 3), (2, 2), (3, 2)] {
        let grid = Grid::new(mx, my, 0.7, 0.4).expect("a grid");
        for (kind, coefficients) in &all_coefficients(&grid) {
            let of = MadeOf { coefficients, grid: &grid, threads: &threads };
            let p = pressures(&grid, 0..mx, 0..my);
            let (mut u, mut by_transforms) = (vec![f64::NAN; grid.len()], vec![f64::NAN; grid.len()]);
            Operators::default().displace(of, &p, &mut u).expect("a product");
            let operator = Operator::<f64>::new(coefficients, &grid, &threads).expect("an operator");
            operator.apply(&p, &mut by_transforms, &mut operator.workspace().expect("memory"));
            for (i, (u, other)) in u.iter().zip(&by_transforms).enumerate() {
                let largest = 17.0 * coefficients.entry(&grid, i, i);
                assert!((u - other).abs() <= ROUND_OFF * largest, "{kind}, {mx} x {my}: {u} and {other} at {i}");
                assert!((u - sum(coefficients, &grid, &p, i)).abs() <= ROUND_OFF * largest, "{kind}, {mx} x {my}");
            }
        }
    }
}

#[test]
fn no_bit_depends_on_the_products_before() {
    let (grid, threads) = (grid(), Threads::One);
    let coefficients = coefficients(&grid);
    let of = MadeOf { coefficients: &coefficients, grid: &grid, threads: &threads };
    let product = |operators: &mut Operators, p: &[f64]| {
        let mut u = vec![f64::NAN; grid.len()];
        operators.displace(of, p, &mut u).expect("a product");
        u
    };
    let mut operators = Operators::default();
    let others: Vec<Vec<f64>> = cases().map(|(_, columns, rows, _)| pressures(&grid, columns, rows)).into();
    for p in others.iter().chain(others.iter().rev()) {
        let after_others = product(&mut operators, p);
        assert!(after_others == product(&mut Operators::default(), p));
    }
    // Earlier products with other coefficients have no effect, either.
    let before = HalfSpace::new(grid.dy, grid.dx, 2.0).into();
    let mut operators = Operators::default();
    let of_before = MadeOf { coefficients: &before, ..of };
    for p in &others {
        operators.displace(of_before, p, &mut vec![0.0; grid.len()]).expect("a product");
        operators.renew(of_before).expect("an operator");
        operators.renew(of).expect("an operator");
        assert!(product(&mut operators, p) == product(&mut Operators::default(), p));
    }
}

#[test]
fn what_is_loaded_is_found() {
    let grid = grid();
    for (name, columns, rows, _) in cases() {
        assert_eq!(
            loaded(&pressures(&grid, columns.clone(), rows.clone()), &grid, &Threads::One),
            Some(Rectangle { x: columns, y: rows }),
            "{name}"
        );
    }
    assert_eq!(loaded(&vec![0.0; grid.len()], &grid, &Threads::One), None);
}
