//! Random scenes: none fails, and the conditions of each are recomputed with the test's own product.

use std::f64::consts::PI;

use contact_normal::adhesion::Law;
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Period, Scene};
use contact_normal::solver::{self, Options, Outcome};

use super::certificate::{displacements, traction, worst};
use super::support::{adhesion, bodies, range_of, Sphere, MODULUS};

/// Pseudo-random numbers in [0, 1), with Knuth's multiplier.
pub struct Draw(pub u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn law(&mut self) -> Law {
        [Law::Exponential, Law::VanDerWaals, Law::Cubic, Law::Dugdale(0.3)][(4.0 * self.next()) as usize % 4]
    }
}

/// The range with a given kappa on square elements: kappa = `steepness w/rho^2 a0`, with a0 = 4 d asinh(1)/(pi E*).
pub fn range_of_kappa(law: Law, work: f64, d: f64, modulus: f64, kappa: f64) -> f64 {
    (law.steepness() * work * 4.0 * d * 1f64.asinh() / (PI * modulus) / kappa).sqrt()
}

#[test]
fn spheres_of_all_laws_are_solved_and_certified() {
    let (mut draw, mut products) = (Draw(5), Vec::new());
    while products.len() < 40 {
        let law = draw.law();
        let range = range_of(10f64.powf(draw.between(-1.0, 0.45)));
        let half_width = (2.2 + (6.0 * range).sqrt()).clamp(2.4, 9.0);
        let sphere = Sphere::new(40, half_width, law, range);
        if law.steepness() / PI / range.powi(2) * 4.0 * sphere.grid.dx * 1f64.asinh() / (PI * MODULUS) > 0.6 {
            continue;
        }
        let load = match products.len() % 2 {
            0 => Load::Approach(draw.between(-0.5, 1.5)),
            _ => Load::Force(draw.between(-1.2, 2.0)),
        };
        let (solver, found) = sphere.solve(load);
        let u = displacements(&sphere.grid, MODULUS, &solver.state().p);
        let worst = worst(solver.state(), &u, |_, e| traction(law, 1.0 / PI, range, e));
        assert!(worst < 2e-6, "{law:?} {range} {load:?}: {worst:e}");
        products.push(found.work_units);
    }
    products.sort_by(f64::total_cmp);
    println!("spheres: median work {}, most {}", products[products.len() / 2], products[products.len() - 1]);
}

/// A surface of waves with random phases, with an rms slope of .1 and amplitudes that fall with a power of the wave number; and the elastic energy
/// per area that flattens it.
pub fn rough(n: usize, draw: &mut Draw, hurst: f64) -> (Vec<f64>, f64) {
    let mut waves = Vec::new();
    for kx in 0..=12i32 {
        for ky in -12..=12i32 {
            let k = f64::from(kx * kx + ky * ky).sqrt();
            if (3.0..=12.0).contains(&k) && (kx > 0 || ky > 0) {
                waves.push((kx, ky, k, k.powf(-1.0 - hurst), 2.0 * PI * draw.next()));
            }
        }
    }
    let slope: f64 = waves.iter().map(|(_, _, k, a, _)| 0.5 * (2.0 * PI * k * a).powi(2)).sum::<f64>().sqrt();
    let scale = 0.1 / slope;
    let at = |i: usize| {
        let (x, y) = ((i % n) as f64 / n as f64, (i / n) as f64 / n as f64);
        let wave = |(kx, ky, _, a, phase): &(i32, i32, f64, f64, f64)| {
            a * (2.0 * PI * (f64::from(*kx) * x + f64::from(*ky) * y) + phase).cos()
        };
        -scale * waves.iter().map(wave).sum::<f64>()
    };
    // The elastic energy per area of full contact, for E* = 1: a wave of amplitude a and wave number q has E* q a^2/8.
    let energy = waves.iter().map(|(_, _, k, a, _)| 2.0 * PI * k * (scale * a).powi(2) / 8.0).sum();
    ((0..n * n).map(at).collect(), energy)
}

#[test]
fn rough_surfaces_are_solved_and_certified() {
    let (mut draw, mut products) = (Draw(11), Vec::new());
    let n = 48;
    let grid = Grid::new(n, n, 1.0 / n as f64, 1.0 / n as f64).expect("a grid");
    for case in 0..30 {
        let hurst = draw.between(0.3, 1.0);
        let (h, full) = rough(n, &mut draw, hurst);
        let law = draw.law();
        let work = full * 10f64.powf(draw.between(-3.0, -0.5));
        let kappa = 10f64.powf(draw.between(-1.5, -0.4));
        let range = range_of_kappa(law, work, grid.dx, 1.0, kappa);
        let load = match case % 3 {
            0 => Load::Approach(
                -0.5 * work.sqrt() * draw.next() - h.iter().copied().fold(0.0, |m: f64, h| m.max(-h)) * 0.7,
            ),
            _ => Load::Force(10f64.powf(draw.between(-3.3, -2.0))),
        };
        let scene = Scene { adhesion: Some(adhesion(law, work, range)), ..Scene::new(grid, &h, bodies(1.0), load) };
        let (solver, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged, "{case} {law:?} {load:?}");
        let u = displacements(&grid, 1.0, &solver.state().p);
        let worst = worst(solver.state(), &u, |_, e| traction(law, work, range, e));
        assert!(worst < 2e-6, "{case} {law:?} {load:?}: {worst:e}");
        products.push(report.count.work_units);
    }
    products.sort_by(f64::total_cmp);
    println!("rough: median work {}, most {}", products[products.len() / 2], products[products.len() - 1]);
}

/// The remaining work W(e) of a law, by the formulas of src/adhesion/law.rs.
fn work_left(law: Law, work: f64, range: f64, e: f64) -> f64 {
    let t = e.max(0.0) / range;
    work * match law {
        Law::Exponential => (-t).exp(),
        Law::Dugdale(smear) if t <= 1.0 - smear => 1.0 - t,
        Law::Dugdale(smear) => (1.0 + smear - t).max(0.0).powi(2) / (4.0 * smear),
        Law::Cubic => (1.0 - t / 3.0).max(0.0).powi(3),
        Law::VanDerWaals => (1.0 + 0.5 * t).powi(-2),
    }
}

#[test]
fn areas_and_energies_of_rough_surfaces_are_those_of_a_firm_solve() {
    let n = 48;
    let grid = Grid::new(n, n, 1.0 / n as f64, 1.0 / n as f64).expect("a grid");
    for (seed, law, part) in [
        (21, Law::Exponential, 0.003),
        (22, Law::Exponential, 0.3),
        (23, Law::Cubic, 0.1),
        (24, Law::VanDerWaals, 0.03),
        (25, Law::Dugdale(0.3), 0.1),
    ] {
        let (h, full) = rough(n, &mut Draw(seed), 0.8);
        let work = part * full;
        let range = range_of_kappa(law, work, grid.dx, 1.0, 0.2);
        let own = adhesion(law, work, range);
        let scene = Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), Load::Force(3e-3)) };
        let solved = |tolerance: f64| {
            let (solver, outcome, report) =
                solver::solve(&scene, &Options { tolerance, ..Options::default() }).expect("a solve");
            assert_eq!(outcome, Outcome::Converged, "{law:?} {tolerance}");
            let state = solver.state();
            let u = displacements(&grid, 1.0, &state.p);
            let [mut elastic, mut adhesive] = [0.0; 2];
            for i in 0..h.len() {
                elastic += 0.5 * state.p[i] * u[i] * grid.element_area();
                adhesive -= work_left(law, work, range, h[i] - state.approach + u[i]) * grid.element_area();
            }
            let found = report.adhesion.expect("adhesion");
            let size = elastic - adhesive;
            assert!((found.elastic_energy - elastic).abs() < 1e-9 * size, "{law:?}: {found:?} {elastic}");
            assert!((found.adhesive_energy - adhesive).abs() < 1e-9 * size, "{law:?}: {found:?} {adhesive}");
            // An error of the force changes the energy by this error times the approach, which is subtracted here.
            let total = elastic + adhesive - report.measures.force * state.approach;
            (report.measures.contact_count, total, size)
        };
        let (firm_count, firm, _) = solved(1e-10);
        // The residual (distances in contact that are not 0) changes the energy in proportion.
        for (tolerance, most) in [(1e-6, 1e-6), (1e-7, 3e-7)] {
            let (count, energy, size) = solved(tolerance);
            println!("{law:?} {part}: {count} elements, energies differ by {:e}", (energy - firm) / size);
            assert_eq!(count, firm_count, "{law:?} {part}");
            assert!((energy - firm).abs() < most * size, "{law:?} {part}: {energy} {firm}");
        }
    }
}

// The library stores the directions of a linear solve with 8 bytes an element if there are up to eleven of them, and with 4 bytes if there are more.
#[test]
fn rough_surfaces_take_200_bytes_an_element() {
    for (n, part, force) in [(384, 0.1, 1e-3), (192, 0.3, 1e-3), (192, 1.0, 1e-3), (192, 1.0, 4e-3)] {
        let grid = Grid::new(n, n, 1.0 / n as f64, 1.0 / n as f64).expect("a grid");
        let (h, full) = rough(n, &mut Draw(3), 0.8);
        let work = part * full;
        let range = range_of_kappa(Law::Exponential, work, grid.dx, 1.0, 0.25);
        let own = Adhesion { stiffness: true, stability: true, ..adhesion(Law::Exponential, work, range) };
        let period = Some(Period { x: true, y: true });
        let scene = Scene { adhesion: Some(own), period, ..Scene::new(grid, &h, bodies(1.0), Load::Force(force)) };
        let (_, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged, "{n} {part}");
        let bytes = report.bytes as f64 / (n * n) as f64;
        println!("{n} {part} {force}: {bytes:.0} bytes an element, {:.0} work", report.count.work_units);
        assert!(bytes <= 200.0, "{n} {part} {force}: {bytes}");
    }
}
