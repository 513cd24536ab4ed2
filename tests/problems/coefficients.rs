//! The influence coefficients of every effect. The dense oracle (dense.rs) is compared with the test's own sum, and products with the oracle. Also: a
//! bounded effort for slender elements with periods, how a handle compares scenes, and renewed operators.

use std::f64::consts::PI;

use contact_normal::effects::Named;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel, Periodic, RowTables, Table};
use contact_normal::operator::{Operator, SetUp};
use contact_normal::scene::{Bodies, Each, Layer, Load, Patches, Period, Scene};
use contact_normal::threads::Threads;

use super::dense;

const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };

/// A generator of numbers in [0, 1) (Knuth's MMIX).
fn numbers(n: usize, mut seed: u64) -> Vec<f64> {
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| next()).collect()
}

/// A table of offsets and a row table of random coefficients, so that each coefficient differs from all others.
fn tables(grid: &Grid) -> (Vec<f64>, Vec<f64>) {
    let Grid { mx, my, .. } = *grid;
    let table: Vec<f64> = numbers(4 * mx * my, 1).iter().map(|c| c + 0.1).collect();
    let rows = numbers(2 * mx * my * my, 2).iter().map(|c| c + 0.1).collect();
    (table, rows)
}

#[test]
fn the_oracle_is_right_for_every_effect_and_products_agree_with_it() {
    let grid = Grid::new(7, 5, 0.5, 0.4).unwrap();
    let (Grid { mx, my, .. }, n) = (grid, grid.len());
    let (table, rows) = tables(&grid);
    let compliances = numbers(n, 3);
    let patch: Vec<i32> = (0..n as i32).map(|i| i % 3).collect();
    let factors = [1.0, 0.5, 0.0, 0.5, 1.0, 0.25, 0.0, 0.25, 1.0];
    let h = vec![0.0; n];
    let half_space = HalfSpace::new(0.5, 0.4, BODIES.compliance());
    let p = numbers(n, 4);
    for kernel in 0..3 {
        for layer in [None, Some(Layer(Each::Uniform(0.7))), Some(Layer(Each::PerElement(&compliances)))] {
            for coupled in [false, true] {
                let scene = Scene {
                    influence: (kernel == 1).then(|| Table::scaled(mx, my, &table, 0.5, &grid).unwrap()),
                    row_tables: (kernel == 2).then(|| RowTables::scaled(mx, my, &rows, 0.25, &grid).unwrap()),
                    patches: coupled.then_some(Patches { count: 3, patch: &patch, factors: &factors }),
                    layer,
                    ..Scene::new(grid, &h, BODIES, Load::Approach(0.0))
                };
                let coefficients = scene.coefficients().unwrap();
                let mut u = vec![0.0; n];
                dense::apply(&coefficients, &grid, &p, &mut u);
                let operator = Operator::<f64>::new(&coefficients, &grid, &Threads::One).unwrap();
                let (mut fast, mut in_place) = (vec![0.0; n], p.clone());
                let mut workspace = operator.workspace().unwrap();
                operator.apply(&p, &mut fast, &mut workspace);
                operator.apply_in_place(&mut in_place, &mut workspace);
                for i in 0..n {
                    let (ix, iy) = (i % mx, i / mx);
                    let mut sum = match layer {
                        None => 0.0,
                        Some(Layer(Each::Uniform(c))) => c * p[i],
                        Some(Layer(Each::PerElement(c))) => c[i] * p[i],
                    };
                    for j in 0..n {
                        let (jx, jy) = (j % mx, j / mx);
                        let c = match kernel {
                            0 => half_space.at(ix as i64 - jx as i64, iy as i64 - jy as i64),
                            1 => 0.5 * table[(iy + my - jy) * 2 * mx + ix + mx - jx],
                            _ => 0.25 * rows[(jy * my + iy) * 2 * mx + ix + mx - jx],
                        };
                        let factor = if coupled { factors[(patch[i] * 3 + patch[j]) as usize] } else { 1.0 };
                        sum += factor * c * p[j];
                    }
                    // Sums of 35 terms and a diagonal, each below 1.1, have magnitudes below 40. Direct sums may differ by 8 units of round-off of
                    // it, and FFT products of 14 x 10 values by a factor of about the logarithm of their size more.
                    let near = |value: f64, ulps: f64| (value - sum).abs() <= ulps * f64::EPSILON * 40.0;
                    assert!(near(u[i], 8.0), "{kernel} {layer:?} {coupled} {i}: {} {sum}", u[i]);
                    assert!(near(fast[i], 64.0), "{kernel} {layer:?} {coupled} {i}: {} {sum}", fast[i]);
                    assert!(near(in_place[i], 64.0), "{kernel} {layer:?} {coupled} {i} in place");
                }
            }
        }
    }
}

#[test]
fn a_factor_that_is_a_power_of_two_changes_no_bit() {
    let grid = Grid::new(9, 8, 0.5, 0.4).unwrap();
    let coefficients = Coefficients::from(HalfSpace::new(0.5, 0.4, 1.0));
    let p = numbers(grid.len(), 5);
    let product = |factor: f64| {
        let operator = Operator::<f64>::scaled(&coefficients, factor, &grid, &Threads::One).unwrap();
        let mut u = p.clone();
        operator.apply_in_place(&mut u, &mut operator.workspace().unwrap());
        u
    };
    let expected: Vec<f64> = product(1.0).iter().map(|u| 1024.0 * u).collect();
    assert_eq!(product(1024.0), expected);
}

#[test]
fn a_renewed_operator_is_a_new_one() {
    let grid = Grid::new(9, 8, 0.5, 0.4).unwrap();
    let (table, rows) = tables(&grid);
    let uneven = Coefficients::from(Table::new(9, 8, &table, &grid).unwrap());
    let per_row = Coefficients::from(RowTables::new(9, 8, &rows, &grid).unwrap());
    let half_space = |c: f64| Coefficients::from(HalfSpace::new(0.5, 0.4, c));
    let p = numbers(grid.len(), 6);
    let product = |operator: &Operator<f64>| {
        let mut u = p.clone();
        operator.apply_in_place(&mut u, &mut operator.workspace().unwrap());
        u
    };
    let mut renewed = Operator::new(&half_space(1.0), &grid, &Threads::One).unwrap();
    let mut set_up = SetUp::default();
    for other in [half_space(2.5), uneven.clone(), per_row, uneven, half_space(3.0)] {
        renewed.renew(&other, 1.0, &grid, &mut set_up).unwrap();
        assert_eq!(product(&renewed), product(&Operator::new(&other, &grid, &Threads::One).unwrap()));
    }
}

/// `integral over |s| < dx/2 of -2 log|2 sin(pi (x - s)/L)|` by its Fourier series, `sum 2/n cos(2 pi n x/L)` times the mean of the wave over the
/// element. The factors `sin(pi n dx/L)` make the terms fall as 1/n^2, so that the error after `terms` is at most 2 L/(pi terms).
fn waves_along(x: f64, dx: f64, length: f64, terms: usize) -> f64 {
    let term = |n: f64| 2.0 / n * (2.0 * PI * n * x / length).cos() * length / (PI * n) * (PI * n * dx / length).sin();
    (1..=terms).rev().map(|n| term(n as f64)).sum()
}

#[test]
fn slender_elements_have_periodic_coefficients_in_bounded_time() {
    let log_integral = |y: f64, w: f64| y * ((w / y).ln() + 1.0);
    for slenderness in [1e-3, 1e-6, 1e-9, 1e-100] {
        // A direct sum over all images of the period would take unbounded time here.
        for m in [1, 4, 32] {
            for two in [false, true] {
                let grid = Grid::new(m, m, slenderness, 1.0).unwrap();
                let (dx, dy, length) = (slenderness, 1.0, m as f64 * slenderness);
                let along_x = Periodic::new(HalfSpace::new(dx, dy, 1.0), (true, two), &grid).unwrap();
                let turned = Grid::new(m, m, dy, dx).unwrap();
                let along_y = Periodic::new(HalfSpace::new(dy, dx, 1.0), (two, true), &turned).unwrap();
                let scale = along_x.at(0, 0);
                for (kx, ky) in (0..m * m).map(|k| ((k % m) as i64, (k / m) as i64)) {
                    let found = along_x.at(kx, ky);
                    let turned = along_y.at(ky, kx);
                    assert!(
                        (found - turned).abs() <= 1e-14 * scale,
                        "{slenderness} ({kx}, {ky}): {found}, turned {turned}"
                    );
                    if two || 6.0 * length > 0.5 {
                        continue;
                    }
                    // The exact coefficient: the mean along x is c dx 2/L log(W/|y|), integrated over the element in y; on the loaded row the waves
                    // of plane strain add to it.
                    let (a, b, w) = ((ky as f64 - 0.5) * dy, (ky as f64 + 0.5) * dy, m as f64 * dy);
                    let mean = match ky {
                        0 => 2.0 * log_integral(b, w),
                        _ => log_integral(b, w) - log_integral(a, w),
                    };
                    let waves = if ky == 0 { waves_along(kx as f64 * dx, dx, length, 40_000) } else { 0.0 };
                    let exact = (2.0 * dx / length * mean + waves) / PI;
                    // The error of the series after 40000 terms of m/(2 n^2) each, relative to dx.
                    let left = if ky == 0 { 2.0 * length / (PI * 40_000.0) / PI } else { 0.0 };
                    assert!(
                        (found - exact).abs() <= left + 1e-13 * scale,
                        "{slenderness} {m} ({kx}, {ky}): {found} {exact}"
                    );
                }
            }
        }
    }
}

#[test]
fn with_two_periods_slender_elements_have_the_spectrum_of_plane_strain_across() {
    // The mean of A along the shorter period is, in the Fourier domain, `sum over kx of A = sum over aliases of 2 pi c/|q| sinc(q dy/2)` at waves q
    // in y. It is even and has mean zero. In real space it is the log-sine series of images of lines.
    for slenderness in [1e-2, 1e-4, 1e-8] {
        let (mx, my) = (4, 12);
        let grid = Grid::new(mx, my, slenderness, 1.0).unwrap();
        let found = Periodic::new(HalfSpace::new(slenderness, 1.0, 1.0), (true, true), &grid).unwrap();
        for ky in 0..my as i64 {
            let mean = (0..mx as i64).map(|kx| found.at(kx, ky)).sum::<f64>() / mx as f64;
            // c dx 2/Lx times the integral of -log(2 sin(pi y/Ly)) over the element, which is 1/12 of the period: the series above, along y.
            let terms = 400_000;
            let exact = 2.0 / mx as f64 / PI * 0.5 * waves_along(ky as f64, 1.0, my as f64, terms);
            let left = 2.0 * my as f64 / (PI * terms as f64);
            assert!((mean - exact).abs() <= left, "{slenderness} {ky}: {mean} {exact}");
        }
    }
}

#[test]
fn coefficients_do_not_jump_between_the_ways_of_summation() {
    // With two periods of which one is much longer, the library sums one line of images below a ratio of 24, and three lines above it. The
    // coefficients must be smooth functions of dy there.
    let at = |dy: f64, kx: i64, ky: i64| {
        let grid = Grid::new(8, 8, 1.0, dy).unwrap();
        let periodic = Periodic::new(HalfSpace::new(1.0, dy, 1.0), (true, true), &grid).unwrap();
        periodic.at(kx, ky) / periodic.at(0, 0)
    };
    for (kx, ky) in (0..16).map(|k| (k % 4, k / 4)) {
        let (below, above) = (at(24.0 * (1.0 - 1e-13), kx, ky), at(24.0, kx, ky));
        assert!((below - above).abs() <= 2e-12, "({kx}, {ky}): {below} {above}");
    }
}

#[test]
fn what_differs_from_the_set_up_is_named_with_its_values() {
    let grid = Grid::new(3, 2, 1.0, 1.0).unwrap();
    let h = [0.0; 6];
    let plain = Scene::new(grid, &h, BODIES, Load::Approach(0.1));
    let (c, other_c) = ([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0.1, 0.2, 0.3, 0.4, 0.6, 0.5]);
    let (patch, other_patch) = ([0, 0, 1, 1, 0, 0], [0, 0, 1, 0, 1, 0]);
    let factors = |f: f64| [1.0, f, f, 1.0];
    let (low, high) = (factors(0.25), factors(0.5));
    let table = |far: f64| {
        let values: Vec<f64> = (0..24).map(|k| if k == 2 * 6 + 3 { 1.0 } else { far }).collect();
        Table::new(3, 2, &values, &grid).unwrap()
    };
    let layer = |layer: Layer<'static>| Scene { layer: Some(layer), ..plain.clone() };
    let per_element = |c| Scene { layer: Some(Layer(Each::PerElement(c))), ..plain.clone() };
    let patches = |patch, factors| Scene { patches: Some(Patches { count: 2, patch, factors }), ..plain.clone() };
    let period = |x, y| Scene { period: Some(Period { x, y }), ..plain.clone() };
    let own = |far| Scene { influence: Some(table(far)), ..plain.clone() };
    let softer = Scene { bodies: Bodies::same(0.5, 0.3), ..plain.clone() };
    let cases: &[(&Scene, &Scene, &[&str])] = &[
        (&plain, &softer, &["shear_modulus[0]", "0.5", "1"]),
        (&layer(Layer(Each::Uniform(0.25))), &layer(Layer(Each::Uniform(0.5))), &["layer->compliance", "0.5", "0.25"]),
        (&layer(Layer(Each::Uniform(0.25))), &plain, &["layer", "not given"]),
        (&layer(Layer(Each::Uniform(0.25))), &layer(Layer(Each::Uniform(0.0))), &["layer", "not given"]),
        (&plain, &layer(Layer(Each::Uniform(0.25))), &["layer", "without"]),
        (&per_element(&c), &per_element(&other_c), &["layer->compliances"]),
        (&per_element(&c), &layer(Layer(Each::Uniform(0.1))), &["layer->compliance", "without"]),
        (&patches(&patch, &low), &patches(&other_patch, &low), &["patches->patch"]),
        (&patches(&patch, &low), &patches(&patch, &high), &["patches->factors"]),
        (&patches(&patch, &low), &plain, &["patches", "not given"]),
        (&period(true, false), &period(true, true), &["period->y", "1", "0"]),
        (&own(0.25), &own(0.5), &["influence->coefficients", "0.5", "0.25"]),
        (&plain, &own(0.25), &["influence", "without"]),
    ];
    for (set_up, scene, words) in cases {
        let Err(difference) = Named::new(set_up).check(scene) else { panic!("{words:?}: no difference") };
        let difference = difference.to_string();
        assert!(words.iter().all(|word| difference.contains(word)), "{words:?}: {difference}");
        assert_eq!(Named::new(set_up).check(set_up), Ok(()), "{words:?}");
    }
    // Three scenes are accepted: one without the caller's coefficients of the set-up, one with a layer of compliance 0, which counts as none, and one
    // whose table replaces the bodies.
    assert_eq!(Named::new(&own(0.25)).check(&softer), Ok(()));
    assert_eq!(Named::new(&plain).check(&layer(Layer(Each::Uniform(0.0)))), Ok(()));
}
