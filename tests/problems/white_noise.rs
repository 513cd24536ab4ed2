//! AUTO by approach on white noise. The h of coarse grids is a mean over elements, so that coarse grids have full contact and eight times the force,
//! which the fine grid has to release. The certificates are recomputed with the test's own product.

use std::f64::consts::{PI, TAU};

use crate::support::assert_conditions;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Options, Outcome};

/// Uniform random numbers in [0, 1): splitmix64.
fn noise(m: usize, border: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let inside = |k: usize| (border..m - border).contains(&k);
    (0..m * m)
        .map(|i| {
            let h = next();
            if inside(i % m) && inside(i / m) {
                h
            } else {
                f64::INFINITY
            }
        })
        .collect()
}

/// A Fourier transform in place, of a power of two values, without scaling.
fn transform(values: &mut [(f64, f64)], sign: f64) {
    let n = values.len();
    for i in 0..n {
        let k = i.reverse_bits() >> (usize::BITS - n.trailing_zeros());
        if i < k {
            values.swap(i, k);
        }
    }
    let mut half = 1;
    while half < n {
        for k in 0..half {
            let (s, c) = (sign * PI * k as f64 / half as f64).sin_cos();
            for i in (k..n).step_by(2 * half) {
                let ((a, b), (x, y)) = (values[i], values[i + half]);
                let (x, y) = (c * x - s * y, c * y + s * x);
                (values[i], values[i + half]) = ((a + x, b + y), (a - x, b - y));
            }
        }
        half *= 2;
    }
}

fn transform_2d(values: &mut [(f64, f64)], n: usize, sign: f64) {
    for _ in 0..2 {
        values.chunks_exact_mut(n).for_each(|row| transform(row, sign));
        for i in 0..n {
            for k in 0..i {
                values.swap(i * n + k, k * n + i);
            }
        }
    }
}

/// Love's coefficients for square elements of side 1 and E* = 1: the integral of `1/(pi r)` over an element.
fn coefficient(kx: i64, ky: i64) -> f64 {
    let corner = |x: f64, y: f64| x * (y / x.abs()).asinh() + y * (x / y.abs()).asinh();
    let (x, y) = (kx as f64, ky as f64);
    (corner(x + 0.5, y + 0.5) + corner(x - 0.5, y - 0.5) - corner(x + 0.5, y - 0.5) - corner(x - 0.5, y + 0.5)) / PI
}

/// The displacements u = A p, by a convolution of the test's own.
pub fn displacements(m: usize, p: &[f64]) -> Vec<f64> {
    let n = (2 * m).next_power_of_two();
    let offset = |k: usize| if k <= n / 2 { k as i64 } else { k as i64 - n as i64 };
    let mut a: Vec<(f64, f64)> = (0..n * n).map(|i| (coefficient(offset(i % n), offset(i / n)), 0.0)).collect();
    let mut b = vec![(0.0, 0.0); n * n];
    p.iter().enumerate().for_each(|(i, p)| b[i / m * n + i % m].0 = *p);
    transform_2d(&mut a, n, -1.0);
    transform_2d(&mut b, n, -1.0);
    a.iter_mut().zip(&b).for_each(|(a, b)| *a = (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0));
    transform_2d(&mut a, n, 1.0);
    (0..m * m).map(|i| a[i / m * n + i % m].0 / (n * n) as f64).collect()
}

#[test]
fn the_product_of_this_test_is_a_convolution() {
    // The displacement of the centre of a square of side 1 under unit pressure: 4 log(1 + sqrt 2)/pi (Johnson, eq. 3.23, for a square of side 2a).
    assert!((coefficient(0, 0) - 4.0 * (1.0 + 2f64.sqrt()).ln() / PI).abs() < 1e-15);
    let m = 6;
    let p: Vec<f64> = (0..m * m).map(|i| (i as f64 * TAU / 7.0).sin()).collect();
    for (i, u) in displacements(m, &p).iter().enumerate() {
        let at = |k: usize| coefficient((k % m) as i64 - (i % m) as i64, (k / m) as i64 - (i / m) as i64) * p[k];
        let sum: f64 = (0..m * m).map(at).sum();
        assert!((u - sum).abs() < 1e-13, "{u} {sum}");
    }
}

/// Solves, and checks the conditions. Returns the work units.
fn work_units(m: usize, border: usize, load: Load, h: &[f64]) -> f64 {
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let scene = Scene::new(grid, h, Bodies::same(1.0, 0.0), load);
    let what = format!("{m} x {m}, border {border}, {load:?}");
    let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged, "{what}");
    let p = &solver.state().p;
    let u = displacements(m, p);
    assert_conditions(h, report.measures.approach, p, &u, &what);
    if let Load::Force(force) = load {
        assert!((p.iter().sum::<f64>() / force - 1.0).abs() < 1e-11, "{what}");
    }
    report.count.work_units
}

/// The mean pressure is a part of E*, up to nearly full contact. Measured: 13 to 24 work units.
#[test]
fn white_noise_by_force_takes_at_most_40_work_units() {
    for (seed, part) in [1e-4, 1e-3, 0.01, 0.1, 0.5].into_iter().enumerate() {
        let (m, h) = (256, noise(256, 0, seed as u64));
        let work = work_units(m, 0, Load::Force(part * (m * m) as f64), &h);
        assert!(work <= 40.0, "{part}: {work} work units");
    }
}

/// Measured: 12 to 47 work units. After large truncations the library scales pressures to the least energy; otherwise these solves would not
/// converge. Displacements outside a window must be finite.
#[test]
fn white_noise_by_approach_takes_at_most_80_work_units() {
    for m in [64, 100, 128, 256] {
        for border in [0, m / 8] {
            for approach in [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.95, 1.2, 3.0] {
                if m == 256 && ![0.1, 0.5, 0.9].contains(&approach) {
                    continue;
                }
                let h = noise(m, border, (m + border) as u64 + (approach * 1000.0) as u64);
                let work = work_units(m, border, Load::Approach(approach), &h);
                assert!(work <= 80.0, "{m} x {m}, border {border}, approach {approach}: {work} work units");
            }
        }
    }
}
