//! The stability margin 1 - lambda of a state, which is 0 where it snaps. Compared with printed values and with the test's own power iteration.

use contact_normal::adhesion::{Law, Start};
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Scene};
use contact_normal::solver::{self, Options, Outcome, Solver};

use super::certificate::{displacements, traction, worst};
use super::dense::{matrix, tangent};
use super::random::range_of_kappa;
use super::support::{adhesion, bodies, Sphere, MODULUS};

fn solved(sphere: &Sphere, approach: f64) -> (Solver, f64, u64) {
    let adhesion = Some(Adhesion { stability: true, ..sphere.adhesion });
    let scene = Scene { adhesion, ..sphere.scene(Load::Approach(approach)) };
    let (solver, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged);
    let found = report.adhesion.and_then(|found| found.stability).expect("asked for");
    (solver, found, report.count.matrix_products)
}

// Values that the prototype (t10.py) printed for Tabor's parameter 1 on 64 x 64 elements, with its tolerance of 1e-2.
#[test]
fn lambda_is_that_of_the_prototype() {
    let sphere = Sphere::by_tabor(1.0, 64, 3.0);
    for (approach, lambda) in [(0.4, 0.520), (-0.3, 0.541), (-0.6, 0.579), (-0.9, 0.700), (-0.95, 0.769)] {
        let (_, found, products) = solved(&sphere, approach);
        println!("{approach}: lambda {} for {lambda}, {products} products", 1.0 - found);
        assert!((1.0 - found - lambda).abs() < 1e-2, "{approach}: {} {lambda}", 1.0 - found);
    }
    // On larger grids the library solves the linear systems in parts.
    let fine = Sphere::by_tabor(1.0, 192, 3.0);
    for (approach, lambda) in [(0.4, 0.520), (-0.9, 0.700)] {
        let (_, found, products) = solved(&fine, approach);
        println!("192 x 192, {approach}: lambda {} for {lambda}, {products} products", 1.0 - found);
        assert!((1.0 - found - lambda).abs() < 1e-2, "{approach}: {} {lambda}", 1.0 - found);
    }
}

#[test]
fn lambda_is_the_factor_of_a_power_iteration() {
    let sphere = Sphere::by_tabor(1.5, 24, 2.4);
    for approach in [0.5, -0.6] {
        let (solver, found, _) = solved(&sphere, approach);
        let own = power_iteration(&sphere, &solver);
        assert!((1.0 - found - own).abs() < 2e-3, "{approach}: {} {own}", 1.0 - found);
    }
}

/// The largest eigenvalue of v -> s A~ v, with the attraction v outside, the slope s of the attraction, and A~ v the displacement outside by v and by
/// the pressures in C that keep e = 0 there.
fn power_iteration(sphere: &Sphere, solver: &Solver) -> f64 {
    let (state, grid) = (solver.state(), &sphere.grid);
    assert!(sphere.adhesion.law == Law::Exponential);
    let range = sphere.adhesion.range;
    let u = displacements(grid, MODULUS, &state.p);
    let slope = |i: usize| {
        let e = state.h[i] - state.approach + u[i];
        if state.contact[i] {
            0.0
        } else {
            (-e / range).exp() / (std::f64::consts::PI * range * range)
        }
    };
    let s: Vec<f64> = (0..grid.len()).map(slope).collect();
    let (mut v, mut lambda) = (s.clone(), 0.0);
    for _ in 0..60 {
        let moved = with_contact_held(sphere, &state.contact, &v);
        let next: Vec<f64> = s.iter().zip(&moved).map(|(s, u)| s * u).collect();
        let size = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        lambda = size(&next) / size(&v);
        v = next.iter().map(|value| value / size(&next)).collect();
    }
    lambda
}

/// A (v + x), with x in C such that the displacement is 0 there. Solved by conjugate gradients.
fn with_contact_held(sphere: &Sphere, contact: &[bool], v: &[f64]) -> Vec<f64> {
    let held = |mut field: Vec<f64>| {
        field.iter_mut().zip(contact).filter(|(_, inside)| !**inside).for_each(|(value, _)| *value = 0.0);
        field
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let product = |field: &[f64]| displacements(&sphere.grid, MODULUS, field);
    let own = product(v);
    let mut x = vec![0.0; v.len()];
    let mut r: Vec<f64> = held(own.iter().map(|u| -u).collect());
    let mut t = r.clone();
    let first = dot(&r, &r);
    while dot(&r, &r) > 1e-16 * first {
        let at = held(product(&t));
        let (before, a) = (dot(&r, &r), dot(&r, &r) / dot(&t, &at));
        for i in 0..x.len() {
            x[i] += a * t[i];
            r[i] -= a * at[i];
        }
        let b = dot(&r, &r) / before;
        t = r.iter().zip(&t).map(|(r, t)| r + b * t).collect();
    }
    product(&x).iter().zip(own).map(|(x, own)| x + own).collect()
}

// In these scenes Newton's method from contact, or without coarser grids, ends at a saddle of the energy, above the minimum of bodies apart. The
// library must find the minimum.
#[test]
fn an_approach_finds_a_least_energy() {
    for (n, half, radius, law, work, kappa, part, start) in [
        (10, 0.5, 5.0, Law::Cubic, 1e-3, 0.45, -2.2, Start::Contact),
        (11, 0.5, 0.5, Law::Dugdale(0.3), 5e-3, 0.45, -1.1, Start::Auto),
    ] {
        let d = 2.0 * half / n as f64;
        let grid = Grid::new(n, n, d, d).expect("a grid");
        let at = |k: usize| (k as f64 - 0.5 * (n as f64 - 1.0)) * d;
        let h: Vec<f64> = (0..n * n).map(|i| 0.5 * (at(i % n).powi(2) + at(i / n).powi(2)) / radius).collect();
        let range = range_of_kappa(law, work, d, 1.0, kappa);
        let own = Adhesion { start, stability: true, ..adhesion(law, work, range) };
        let scene = Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), Load::Approach(part * range)) };
        let (solver, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        let found = tangent(&grid, &matrix(&grid, 1.0), solver.state(), (law, work, range));
        let told = report.adhesion.and_then(|found| found.stability).expect("asked for");
        println!("{law:?}: force {:e}, {found:?}, {told}", report.measures.force);
        assert!(found.is_least && told > 0.0, "{law:?}: {found:?} {told}");
        let u = displacements(&grid, 1.0, &solver.state().p);
        let worst = worst(solver.state(), &u, |_, e| traction(law, work, range, e));
        assert!(worst < 2e-6, "{law:?}: {worst:e}");
    }
}
