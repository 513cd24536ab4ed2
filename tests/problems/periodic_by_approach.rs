//! Two periods with a given approach. An approach just below the mean of h has a solution on the finest grid, but on coarser grids only if their h
//! has the same mean. The certificates are recomputed by direct sums.

use std::f64::consts::TAU;

use crate::support::assert_conditions;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome};

/// A random surface with all wave numbers up to `m/part`, and amplitudes that fall as `k^-1.8`.
pub fn rough(m: usize, part: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let most = (m / part) as i64;
    let mut h = vec![0.0; m * m];
    for ky in -most..=most {
        for kx in 0..=most {
            let square = kx * kx + ky * ky;
            if square == 0 || square > most * most || (kx == 0 && ky < 0) {
                continue;
            }
            let (phase, amplitude) = (TAU * next(), (0.2 + next()) * (square as f64).powf(-0.9));
            for (i, h) in h.iter_mut().enumerate() {
                let turn = (kx * (i % m) as i64 + ky * (i / m) as i64).rem_euclid(m as i64);
                *h += amplitude * (TAU * turn as f64 / m as f64 + phase).cos();
            }
        }
    }
    h
}

/// The displacements u = A p by direct sums over coefficients that are even in x and y.
pub fn displacements(scene: &Scene<'_>, p: &[f64]) -> Vec<f64> {
    let (mx, my) = (scene.grid.mx, scene.grid.my);
    let coefficients = scene.coefficients().unwrap();
    let a: Vec<f64> = (0..p.len()).map(|i| coefficients.at((i % mx) as i64, (i / mx) as i64)).collect();
    let mut u = vec![0.0; p.len()];
    for (k, p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
        for y in 0..my {
            let a = &a[y.abs_diff(k / mx) * mx..][..mx];
            let u = &mut u[y * mx..][..mx];
            u.iter_mut().enumerate().for_each(|(x, u)| *u += a[x.abs_diff(k % mx)] * p);
        }
    }
    u
}

/// Measured: approaches of 0.98 of the mean take 25 to 120 work units, because a constant converges slowly on nearly full contact. The library shifts
/// the h of coarse grids to the same mean.
#[test]
fn approaches_near_the_mean_are_solved() {
    for m in [25, 36, 50, 100, 101] {
        for part in [2, 4, 8] {
            let h = rough(m, part, (m + part) as u64);
            let mean = h.iter().sum::<f64>() / h.len() as f64;
            let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
            for share in [0.5, 0.9, 0.98] {
                let approach = lowest + share * (mean - lowest);
                let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
                let scene = Scene {
                    period: Some(Period { x: true, y: true }),
                    ..Scene::new(grid, &h, Bodies::same(1.0, 0.0), Load::Approach(approach))
                };
                let what = format!("{m} x {m}, waves to m/{part}, {share} of the mean");
                let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
                assert_eq!(stop, Outcome::Converged, "{what}");
                assert!(report.count.work_units <= 200.0, "{what}: {} work units", report.count.work_units);
                let p = &solver.state().p;
                let u = displacements(&scene, p);
                assert_conditions(&h, approach, p, &u, &what);
            }
        }
    }
}

/// A single element with two periods has no displacement. An approach below its h leaves it without contact, and an approach equal to its h is full
/// contact.
#[test]
fn a_single_element_has_its_own_distance_for_an_approach() {
    let (grid, h) = (Grid::new(1, 1, 0.8, 0.8).unwrap(), [0.3]);
    let scene = |approach| Scene {
        period: Some(Period { x: true, y: true }),
        ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(approach))
    };
    for below in [0.2, 0.3 - 1e-9] {
        let (solver, stop, _) = solve(&scene(below), &Options::default()).unwrap();
        assert_eq!((stop, &solver.state().p[..]), (Outcome::Converged, &[0.0][..]));
    }
    match solve(&scene(0.3), &Options::default()) {
        Ok((solver, stop, _)) => assert_eq!((stop, &solver.state().p[..]), (Outcome::Converged, &[0.0][..])),
        Err(refused) => assert!(refused.to_string().contains("contact is full"), "{refused}"),
    }
}

/// With an approach beyond its h a single element is at its limit, however large the approach is.
#[test]
fn a_single_element_carries_its_limit() {
    let (grid, h) = (Grid::new(1, 1, 0.8, 0.8).unwrap(), [0.3]);
    for approach in [0.3 + 1e-9, 0.4, 7.0] {
        for limit in [PressureLimit(Each::Uniform(2.0)), PressureLimit(Each::PerElement(&[2.0]))] {
            let scene = Scene {
                period: Some(Period { x: true, y: true }),
                pressure_limit: Some(limit),
                ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(approach))
            };
            let (solver, stop, _) = solve(&scene, &Options::default()).unwrap();
            assert_eq!((stop, &solver.state().p[..]), (Outcome::Converged, &[2.0][..]), "{approach} {limit:?}");
        }
    }
}
