//! The product by FFT equals that by direct summation, and both are right.

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Table};
use contact_normal::operator::Operator;
use contact_normal::threads::Threads;

use super::dense;
use crate::families::case::Random;

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Numbers of elements in x and y: one element, one row, one column, primes, powers of two and their neighbours, and others.
const SIZES: [(usize, usize); 15] = [
    (1, 1),
    (1, 2),
    (2, 1),
    (1, 31),
    (37, 1),
    (2, 2),
    (3, 3),
    (4, 4),
    (7, 13),
    (17, 16),
    (31, 8),
    (33, 20),
    (5, 47),
    (64, 9),
    (29, 53),
];

fn product(influence: &Coefficients, grid: &Grid, p: &[f64], threads: &Threads) -> Vec<f64> {
    let operator = Operator::new(influence, grid, threads).unwrap();
    let mut u = vec![f64::NAN; grid.len()];
    operator.apply(p, &mut u, &mut operator.workspace().unwrap());
    assert!(u.iter().all(|u| u.is_finite()), "{grid:?}");
    u
}

/// Asserts that the product by FFT equals the direct sum to 1e-13 of max |u|. The round-off of an FFT is about eps log2(px py) = 3e-15.
fn check(influence: &Coefficients, grid: &Grid, p: &[f64]) {
    let u = product(influence, grid, p, &Threads::One);
    let mut exact = vec![0.0; grid.len()];
    dense::apply(influence, grid, p, &mut exact);
    let difference = u.iter().zip(&exact).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    assert!(difference <= 1e-13 * largest(&exact), "{grid:?}: {difference} of {}", largest(&exact));
}

#[test]
fn fft_and_direct_summation_agree_for_the_half_space() {
    let mut random = Random(1);
    for (mx, my) in SIZES {
        for (dx, dy) in [(1.0, 1.0), (0.02, 1.0), (4.0, 0.7)] {
            let grid = Grid::new(mx, my, dx, dy).unwrap();
            let influence = Coefficients::from(HalfSpace::new(dx, dy, 1e-5));
            // Pressures everywhere, and in the middle row only, where the FFT of the other rows is left out.
            let full: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
            check(&influence, &grid, &full);
            let rows: Vec<f64> =
                full.iter().enumerate().map(|(i, &v)| if i / mx == my / 2 { v } else { 0.0 }).collect();
            check(&influence, &grid, &rows);
        }
    }
}

#[test]
fn fft_and_direct_summation_agree_for_tables_without_any_symmetry() {
    let mut random = Random(2);
    for (mx, my) in SIZES {
        for (cx, cy) in [(mx, my), (mx + 3, 2 * my + 1)] {
            let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
            let mut values: Vec<f64> = (0..4 * cx * cy).map(|_| random.next() - 0.5).collect();
            values[cy * 2 * cx + cx] = 3.0;
            // The library does not read the row -cy and the column -cx of a table.
            values[..2 * cx].fill(f64::NAN);
            values.iter_mut().step_by(2 * cx).for_each(|v| *v = f64::INFINITY);
            let influence = Coefficients::from(Table::new(cx, cy, &values, &grid).unwrap());
            let p: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
            check(&influence, &grid, &p);
        }
    }
}

/// FFTs of rows and columns work on several of them at once or one by one, with different code for different lengths. All numbers of columns and many
/// lengths are tested, in both precisions. The bounds are those of [`check`] and of `a_single_precision_product_has_single_precision`.
#[test]
fn any_number_of_columns_and_either_precision_agree_with_direct_summation() {
    let mut random = Random(7);
    for (mx, my) in (1..=20).map(|k| (2 * k - 1, 3 * k + 2)).chain([(40, 3), (9, 61), (33, 41), (16, 46)]) {
        let grid = Grid::new(mx, my, 0.5, 0.25).unwrap();
        let influence = Coefficients::from(HalfSpace::new(0.5, 0.25, 1.0));
        let p: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
        check(&influence, &grid, &p);
        let mut exact = vec![0.0; grid.len()];
        dense::apply(&influence, &grid, &p, &mut exact);
        let double = Operator::<f64>::new(&influence, &grid, &Threads::One).unwrap();
        let of_double = double.in_precision::<f32>(1.0).unwrap();
        for operator in [Operator::<f32>::new(&influence, &grid, &Threads::One).unwrap(), of_double] {
            let single: Vec<f32> = p.iter().map(|&value| value as f32).collect();
            let mut u = vec![f32::NAN; grid.len()];
            operator.apply(&single, &mut u, &mut operator.workspace().unwrap());
            assert!(u.iter().all(|u| u.is_finite()), "{grid:?}");
            let difference = u.iter().zip(&exact).fold(0.0, |m: f64, (a, b)| m.max((f64::from(*a) - b).abs()));
            assert!(difference <= 1e-6 * largest(&exact), "{grid:?}: {difference} of {}", largest(&exact));
        }
    }
}

#[test]
fn direct_summation_gives_the_displacement_of_a_uniform_pressure() {
    // A uniform pressure of 1 on a rectangle 2a x 2b displaces its centre by 4 [a asinh(b/a) + b asinh(a/b)]/(pi E*) (Love).
    let (mx, my) = (7, 5);
    let grid = Grid::new(mx, my, 0.3, 0.2).unwrap();
    let influence = Coefficients::from(HalfSpace::new(0.3, 0.2, std::f64::consts::PI));
    let mut u = vec![0.0; grid.len()];
    dense::apply(&influence, &grid, &vec![1.0; grid.len()], &mut u);
    let (a, b): (f64, f64) = (0.5 * 0.3 * mx as f64, 0.5 * 0.2 * my as f64);
    let exact = 4.0 * (a * (b / a).asinh() + b * (a / b).asinh());
    assert!((u[grid.index(3, 2)] - exact).abs() < 1e-13 * exact);
}

#[test]
fn a_product_has_the_same_bits_for_one_two_and_three_threads() {
    let mut random = Random(3);
    let grid = Grid::new(75, 52, 1.0, 0.5).unwrap();
    let influence = Coefficients::from(HalfSpace::new(1.0, 0.5, 1.0));
    let p: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
    let bits = |threads: usize| -> Vec<u64> {
        let u = product(&influence, &grid, &p, &Threads::new(threads).unwrap());
        u.iter().map(|v| v.to_bits()).collect()
    };
    assert_eq!(bits(1), bits(2));
    assert_eq!(bits(1), bits(3));
}

#[test]
fn a_single_precision_product_has_single_precision() {
    let mut random = Random(4);
    let grid = Grid::new(48, 33, 1.0, 1.0).unwrap();
    let influence = Coefficients::from(HalfSpace::new(1.0, 1.0, 1.0));
    let p: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
    let exact = product(&influence, &grid, &p, &Threads::One);
    let single: Vec<f32> = p.iter().map(|&v| v as f32).collect();
    let operator = Operator::<f32>::new(&influence, &grid, &Threads::One).unwrap();
    let mut u = vec![0f32; grid.len()];
    operator.apply(&single, &mut u, &mut operator.workspace().unwrap());
    // 16 rounding errors of 6e-8 along the transforms.
    for (a, b) in u.iter().zip(&exact) {
        assert!((f64::from(*a) - b).abs() <= 1e-6 * largest(&exact));
    }
}

/// A table of offsets from `(-cx, -cy)`, in which `c(k)` and `c(-k)` differ by a relative 2 `skew`.
fn skew_table(grid: &Grid, skew: f64, random: &mut Random) -> Table {
    let (cx, cy) = (grid.mx as i64, grid.my as i64);
    let mut values: Vec<f64> = (0..4 * cx * cy).map(|_| random.next()).collect();
    let place = |kx: i64, ky: i64| ((ky + cy) * 2 * cx + kx + cx) as usize;
    for (kx, ky) in (1 - cy..cy).flat_map(|ky| (1 - cx..cx).map(move |kx| (kx, ky))) {
        if (ky, kx) > (0, 0) {
            let value = values[place(kx, ky)];
            values[place(kx, ky)] = (1.0 + skew) * value;
            values[place(-kx, -ky)] = (1.0 - skew) * value;
        }
    }
    values[place(0, 0)] = 1.5;
    Table::new(grid.mx, grid.my, &values, grid).unwrap()
}

/// If a table is symmetric to the round-off of single precision, its single-precision operator treats it as symmetric and takes half the memory.
#[test]
fn in_single_precision_a_table_symmetric_to_round_off_has_a_real_spectrum() {
    let mut random = Random(5);
    for (mx, my) in SIZES {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        let p: Vec<f64> = (0..grid.len()).map(|_| random.next()).collect();
        let single: Vec<f32> = p.iter().map(|&v| v as f32).collect();
        let mut bytes = Vec::new();
        for skew in [2e-8, 1e-3] {
            let influence = Coefficients::from(skew_table(&grid, skew, &mut random));
            let mut exact = vec![0.0; grid.len()];
            dense::apply(&influence, &grid, &p, &mut exact);
            let double = Operator::<f64>::new(&influence, &grid, &Threads::One).unwrap();
            let own = Operator::<f32>::new(&influence, &grid, &Threads::One).unwrap();
            for operator in [own, double.in_precision(1.0).unwrap()] {
                let mut u = vec![f32::NAN; grid.len()];
                operator.apply(&single, &mut u, &mut operator.workspace().unwrap());
                assert!(u.iter().all(|u| u.is_finite()), "{grid:?} {skew}");
                let difference = u.iter().zip(&exact).fold(0.0, |m: f64, (a, b)| m.max((f64::from(*a) - b).abs()));
                // 16 rounding errors of 6e-8 along the transforms.
                assert!(difference <= 1e-6 * largest(&exact), "{grid:?} {skew}: {difference} of {}", largest(&exact));
                bytes.push(operator.bytes());
            }
        }
        // A table of one column or row is both symmetric and even, up to the skew, so that memory does not differ as below.
        if mx > 2 && my > 2 {
            assert!(bytes[..2].iter().all(|symmetric| 10 * symmetric < 7 * bytes[2]), "{grid:?}: {bytes:?}");
            assert_eq!(bytes[2], bytes[3], "{grid:?}");
        }
    }
}
