//! Effect `period`: the coefficients compared with their symbol, Westergaard's wavy contact, full contact, and a period so long that it has no
//! effect.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel, Periodic};
use contact_normal::methods::multigrid::coarsen;
use contact_normal::operator::Operator;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome, Solver};
use contact_normal::threads::Threads;

use super::dense;
use crate::families::case::Random;

/// Bodies with 1/E* = 1, so that the factor c of the coefficients is 1/pi.
fn bodies() -> Bodies {
    Bodies::same(1.0, 0.0)
}

fn scene<'a>(grid: Grid, h: &'a [f64], (x, y): (bool, bool), load: Load) -> Scene<'a> {
    Scene { period: Some(Period { x, y }), ..Scene::new(grid, h, bodies(), load) }
}

fn periodic(grid: &Grid, directions: (bool, bool)) -> Periodic {
    Periodic::new(HalfSpace::new(grid.dx, grid.dy, 1.0), directions, grid).unwrap()
}

/// `sum over n of (-1)^n f(n)` from n = 0 on, for a smooth f that falls: algorithm 1 of Cohen, Rodriguez Villegas & Zagier (2000). The error is
/// 5.8^-24 of the sum.
fn alternating(f: impl Fn(f64) -> f64) -> f64 {
    const TERMS: i32 = 24;
    let d = (3.0 + 8f64.sqrt()).powi(TERMS);
    let d = 0.5 * (d + 1.0 / d);
    let (mut b, mut c, mut sum) = (-1.0, -d, 0.0);
    for k in 0..TERMS {
        c = b - c;
        sum += c * f(f64::from(k));
        b *= f64::from((k + TERMS) * (k - TERMS)) / ((f64::from(k) + 0.5) * f64::from(k + 1));
    }
    sum / d
}

/// `sum over all n of (-1)^n f(a + n)/(a + n)`, 0 < a < 1.
fn over_aliases(a: f64, f: impl Fn(f64) -> f64) -> f64 {
    alternating(|n| f(a + n) / (a + n)) + alternating(|n| f(1.0 - a + n) / (1.0 - a + n))
}

/// The symbol of the exact coefficients at the wave (jx, jy), `sum over aliases of 2 c pi/|q| sinc sinc` with c pi = 1.
fn exact_spectrum(grid: &Grid, jx: usize, jy: usize) -> f64 {
    let (a, b) = (jx as f64 / grid.mx as f64, jy as f64 / grid.my as f64);
    let q = |a: f64, b: f64| 2.0 * PI * (a / grid.dx).hypot(b / grid.dy);
    // sin(pi (a + n))/(pi (a + n)) = (-1)^n sin(pi a)/(pi (a + n)). For a = 0 only n = 0 remains.
    let in_x = |b: f64| match jx {
        0 => 2.0 / q(0.0, b),
        _ => (PI * a).sin() / PI * over_aliases(a, |a| 2.0 / q(a, b)),
    };
    match (jx, jy) {
        (0, 0) => 0.0,
        (_, 0) => in_x(0.0),
        _ => (PI * b).sin() / PI * over_aliases(b, in_x),
    }
}

#[test]
fn with_two_periods_the_coefficients_have_the_exact_spectrum() {
    for (mx, my, dx, dy) in
        [(8, 8, 1.0, 1.0), (9, 4, 0.5, 0.75), (1, 12, 2.0, 1.0), (32, 2, 1.0, 1.0), (3, 5, 1.0, 20.0)]
    {
        let grid = Grid::new(mx, my, dx, dy).unwrap();
        let periodic = periodic(&grid, (true, true));
        for jy in 0..=my / 2 {
            for jx in 0..=mx / 2 {
                let mut sum = 0.0;
                for ky in 0..my {
                    for kx in 0..mx {
                        let phase = 2.0 * PI * ((jx * kx) as f64 / mx as f64 + (jy * ky) as f64 / my as f64);
                        sum += periodic.at(kx as i64, ky as i64) * phase.cos();
                    }
                }
                // Coefficients have errors of some 1e-14 of the sum of the largest images, and n of them are added.
                let exact = exact_spectrum(&grid, jx, jy);
                let scale = periodic.at(0, 0) * grid.len() as f64;
                assert!((sum - exact).abs() <= 1e-13 * scale, "{grid:?} ({jx}, {jy}): {sum}, exact {exact}");
            }
        }
    }
}

/// The integral of `log(w/|y|)` from 0 to y.
fn log_integral(y: f64, w: f64) -> f64 {
    if y == 0.0 {
        0.0
    } else {
        y * ((w / y.abs()).ln() + 1.0)
    }
}

#[test]
fn with_one_period_coefficients_are_the_sum_of_images_and_their_mean_is_that_of_plane_strain() {
    for (mx, my, dx, dy) in
        [(8, 8, 1.0, 1.0), (9, 4, 0.5, 0.75), (1, 12, 2.0, 1.0), (6, 40, 0.1, 0.2), (40, 3, 1.0, 2.0)]
    {
        let grid = Grid::new(mx, my, dx, dy).unwrap();
        let half_space = HalfSpace::new(dx, dy, 1.0);
        let along_x = periodic(&grid, (true, false));
        let turned = periodic(&Grid::new(my, mx, dy, dx).unwrap(), (false, true));
        let (length, width) = (mx as f64 * dx, my as f64 * dy);
        for ky in 0..my as i64 {
            let mean = (0..mx as i64).map(|kx| along_x.at(kx, ky)).sum::<f64>() / mx as f64;
            let (from, to) = ((ky as f64 - 0.5) * dy, (ky as f64 + 0.5) * dy);
            // Exact: c dx 2/L times the integral of log(W/|y|) over the element, with c = 1/pi.
            let exact = 2.0 * dx / (PI * length) * (log_integral(to, width) - log_integral(from, width));
            let scale = along_x.at(0, 0);
            assert!((mean - exact).abs() <= 1e-13 * scale, "{grid:?} {ky}: {mean}, exact {exact}");
            for kx in 0..mx as i64 {
                // The sum has 40000 images on either side. Less the same sum at (0, 0) its error is of second order, x^2/(N L)^2.
                let images = (1..=40_000).rev().map(|n| n * mx as i64);
                let sum: f64 = images
                    .map(|n| {
                        let here = half_space.at(kx + n, ky) + half_space.at(kx - n, ky);
                        here - 2.0 * half_space.at(n, 0)
                    })
                    .sum::<f64>()
                    + half_space.at(kx, ky)
                    - half_space.at(0, 0);
                let found = along_x.at(kx, ky) - along_x.at(0, 0);
                assert!((found - sum).abs() <= 1e-8 * scale, "{grid:?} ({kx}, {ky}): {found}, by images {sum}");
                let turned = turned.at(ky, kx);
                assert!((turned - along_x.at(kx, ky)).abs() <= 1e-14 * scale, "{grid:?} ({kx}, {ky}) turned");
            }
        }
    }
}

#[test]
fn products_are_those_of_the_direct_sum_for_every_length() {
    for (mx, my) in [(1, 1), (1, 7), (2, 2), (5, 3), (6, 11), (8, 8), (13, 4)] {
        let grid = Grid::new(mx, my, 1.0, 0.7).unwrap();
        for directions in [(true, true), (true, false), (false, true)] {
            let influence = Coefficients::from(periodic(&grid, directions));
            let operator = Operator::<f64>::new(&influence, &grid, &Threads::One).unwrap();
            let p: Vec<f64> = (0..grid.len()).map(|i| ((i * i + 3 * i) % 7) as f64).collect();
            let (mut u, mut direct) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
            operator.apply(&p, &mut u, &mut operator.workspace().unwrap());
            dense::apply(&influence, &grid, &p, &mut direct);
            let scale = influence.at(0, 0) * p.iter().sum::<f64>();
            for (a, b) in u.iter().zip(&direct) {
                assert!((a - b).abs() <= 1e-13 * scale, "{grid:?} {directions:?}: {a}, direct {b}");
            }
        }
    }
}

/// Westergaard (1939; Johnson section 13.2): `h = d (1 - cos(2 pi x/L))`, mean pressure pm < p* = pi E* d/L, contact |x| <= a with `sin^2(pi a/L) =
/// pm/p*`, and `p = 2 pm cos(pi x/L)/sin^2(pi a/L) sqrt(sin^2(pi a/L) - sin^2(pi x/L))`.
fn westergaard(m: usize, share: f64, along_x: bool) -> (f64, f64) {
    let (length, d): (f64, f64) = (3.0, 0.01);
    // Across the waves one element as long as a period suffices: results do not depend on its size.
    let grid = match along_x {
        true => Grid::new(m, 1, length / m as f64, length).unwrap(),
        false => Grid::new(1, m, length, length / m as f64).unwrap(),
    };
    let x = |i: usize| length * ((i as f64 + 0.5) / m as f64 - 0.5);
    let h: Vec<f64> = (0..m).map(|i| d * (1.0 - (2.0 * PI * x(i) / length).cos())).collect();
    let mean = share * PI * d / length;
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let (solver, stop, report) =
        solve(&scene(grid, &h, (true, true), Load::Force(mean * length * length)), &options).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let edge = share.sqrt().asin() * length / PI;
    let (mut error, mut size) = (0.0, 0.0);
    for (i, p) in solver.state().p.iter().enumerate() {
        let inside = (share - (PI * x(i) / length).sin().powi(2)).max(0.0);
        let exact = 2.0 * mean / share * (PI * x(i) / length).cos() * inside.sqrt();
        error += (p - exact).powi(2);
        size += exact * exact;
    }
    ((error / size).sqrt(), (report.measures.contact_area / (2.0 * edge * length) - 1.0).abs())
}

#[test]
fn westergaards_wavy_contact() {
    for (share, along_x) in [(0.1, true), (0.5, false), (0.9, true)] {
        for m in [256, 1024, 4096] {
            let (pressure, area) = westergaard(m, share, along_x);
            let in_contact = m as f64 * 2.0 * share.sqrt().asin() / PI;
            // The contact area is a whole number of elements, and its edges cut two of them. At the edge the pressure is like a square root, so that
            // the error in the last elements is the root of their size: the measured rms is 0.1 to 0.6 over the number of elements.
            assert!(area <= 2.0 / in_contact, "{m}, {share}: area off by {area}");
            assert!(pressure <= 1.0 / in_contact, "{m}, {share}: pressures off by {pressure}, {in_contact}");
            if m == 4096 {
                assert!(pressure <= 1e-3 && area <= 2.5e-3, "{share}: {pressure} {area}");
            }
        }
    }
}

#[test]
fn full_contact_of_a_wavy_surface() {
    // h = d cos(qx x) cos(qy y) is flattened by p - mean = -d |q|/2 E* cos cos (Johnson 13.3). Pressures on elements have factors sinc sinc and
    // aliases, so that 2/|q| becomes the exact symbol.
    let (mx, my) = (24, 18);
    let grid = Grid::new(mx, my, 0.5, 0.5).unwrap();
    let wave =
        |i: usize| (2.0 * PI * (i % mx) as f64 / mx as f64).cos() * (4.0 * PI * (i / mx) as f64 / my as f64).cos();
    let (amplitude, lift) = (0.01, 0.3);
    let h: Vec<f64> = (0..grid.len()).map(|i| lift + amplitude * wave(i)).collect();
    let peak = amplitude / exact_spectrum(&grid, 1, 2);
    let (mean, area) = (1.25 * peak, grid.len() as f64 * grid.element_area());
    let scene = scene(grid, &h, (true, true), Load::Force(mean * area));
    for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
        let (solver, stop, report) =
            solve(&scene, &Options { method, tolerance: 1e-10, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged, "{method:?}");
        assert_eq!(report.measures.contact_count, grid.len());
        // In full contact the mean plane does not move: the approach is the mean of h, to the tolerance relative to d.
        assert!(
            (report.measures.approach - lift).abs() <= 1e-9 * amplitude,
            "{method:?}: {}",
            report.measures.approach
        );
        for (i, p) in solver.state().p.iter().enumerate() {
            let exact = mean - peak * wave(i);
            assert!((p - exact).abs() <= 1e-8 * peak, "{method:?}, element {i}: {p}, exact {exact}");
        }
    }
    // At .75 of the force of full contact the contact is not full.
    let partial = Scene { load: Load::Force(0.75 * peak * area), ..scene };
    let (_, _, report) = solve(&partial, &Options::default()).unwrap();
    assert!(report.measures.contact_count < grid.len());
    // If the approach of this result is prescribed, the force is the same to 1e-5: the tolerance is 1e-6, and near full contact the force is
    // sensitive to the approach.
    let by_approach = Scene { load: Load::Approach(report.measures.approach), ..partial };
    let (_, stop, again) = solve(&by_approach, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let change = again.measures.force / report.measures.force - 1.0;
    assert!(change.abs() <= 1e-4, "{change}");
}

#[test]
fn a_period_much_longer_than_the_contact_is_as_good_as_none() {
    // A ball with the contact radius a, in the middle of a period L. The displacement by the images is uniform over the contact up to a^2/L^2. It is
    // F/(pi L) times a lattice sum of order 4, beside an approach of 3 F/(4 a). So the error is of order (a/L)^3, with a constant below 10.
    let m = 96;
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let h: Vec<f64> = (0..grid.len())
        .map(|i| {
            let (x, y) = ((i % m) as f64 - 47.5, (i / m) as f64 - 47.5);
            (x * x + y * y) / 2000.0
        })
        .collect();
    let radius: f64 = 8.0;
    // Hertz: F = 4 E* a^3/(3 R), with E* = 1 and R = 1000.
    let load = Load::Force(4.0 * radius.powi(3) / 3000.0);
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let (free, _, _) = solve(&Scene::new(grid, &h, bodies(), load), &options).unwrap();
    let largest = free.state().p.iter().copied().fold(0.0, f64::max);
    for directions in [(true, true), (true, false), (false, true)] {
        let (found, stop, _) = solve(&scene(grid, &h, directions, load), &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        for (a, b) in found.state().p.iter().zip(&free.state().p) {
            // At the edge of contact the pressure is like a square root, so that elements there may change by the root of that error.
            assert!(
                (a - b).abs() <= largest * (10.0 * (radius / m as f64).powi(3)).sqrt(),
                "{directions:?}: {a}, free {b}"
            );
        }
        let inner = grid.index(m / 2, m / 2);
        let change = found.state().p[inner] / free.state().p[inner] - 1.0;
        assert!(change.abs() <= 10.0 * (radius / m as f64).powi(3), "{directions:?}: {change}");
    }
}

/// A rough periodic surface of `mx` by `my` elements.
fn rough(mx: usize, my: usize) -> Vec<f64> {
    let mut random = Random(12345);
    let mut h = vec![0.0; mx * my];
    for j in 0..5usize {
        for i in usize::from(j == 0)..5 {
            let phase = 2.0 * PI * random.next();
            let amplitude = ((i * i + j * j) as f64).powf(-0.9);
            for (k, h) in h.iter_mut().enumerate() {
                let x = 2.0 * PI * ((i * (k % mx)) as f64 / mx as f64 + (j * (k / mx)) as f64 / my as f64);
                *h += amplitude * (x + phase).cos();
            }
        }
    }
    h
}

#[test]
fn moving_the_origin_moves_the_solution_and_no_count_of_elements_is_refused() {
    for (mx, my) in [(48, 64), (45, 50), (37, 31), (1, 97), (100, 2)] {
        let grid = Grid::new(mx, my, 0.2, 0.25).unwrap();
        let h = rough(mx, my);
        let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
        let shift = |i: usize| ((i / mx + 7) % my) * mx + (i % mx + mx / 3) % mx;
        let moved: Vec<f64> = (0..h.len()).map(|i| h[shift(i)]).collect();
        for load in [Load::Force(0.05 * grid.len() as f64), Load::Approach(0.6 * lowest)] {
            let options = Options { tolerance: 1e-9, ..Options::default() };
            let (solver, stop, report) = solve(&scene(grid, &h, (true, true), load), &options).unwrap();
            assert_eq!(stop, Outcome::Converged, "{mx} x {my} {load:?}");
            let (again, stop, _) = solve(&scene(grid, &moved, (true, true), load), &options).unwrap();
            assert_eq!(stop, Outcome::Converged);
            // A relative residual of 1e-9 in displacements allows errors of pressures in the shortest waves: that times the condition number, which
            // is about the number of elements across. 1e-6 includes a margin.
            for i in 0..h.len() {
                let change = (again.state().p[i] - solver.state().p[shift(i)]).abs();
                assert!(change <= 1e-6 * report.measures.max_pressure, "{mx} x {my} {load:?}: {change}");
            }
            let certificate = report.measures.certificate;
            assert!(certificate.residual <= 1e-9 && certificate.min_pressure >= 0.0);
        }
    }
}

#[test]
fn the_iteration_needs_no_more_products_than_without_a_period() {
    // On a period the circulant equals the operator, except for the restriction to the contact area. Measured: 9 to 16 products, and 9 to 15 without
    // a period.
    let (mx, my) = (128, 128);
    let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
    let h = rough(mx, my);
    for share in [0.02, 0.2, 1.0] {
        let (_, stop, report) =
            solve(&scene(grid, &h, (true, true), Load::Force(share * grid.len() as f64)), &Options::default()).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert!(report.count.matrix_products <= 24, "{share}: {} products", report.count.matrix_products);
    }
}

#[test]
fn coarser_grids_have_the_coefficients_that_their_elements_have() {
    for (mx, my, directions) in [
        (64, 64, (true, true)),
        (256, 1, (true, true)),
        (256, 1, (false, true)),
        (8, 128, (true, true)),
        (48, 32, (true, false)),
        (50, 21, (true, true)), // of which the coarser ones are longer by an element
    ] {
        let mut grid = Grid::new(mx, my, 0.5, 0.4).unwrap();
        let mut coefficients = Coefficients::from(periodic(&grid, directions));
        while let Some(coarse) = coarsen(&grid, 8) {
            coefficients = coefficients.coarsen(&grid, &coarse).unwrap();
            grid = coarse;
            let anew = periodic(&grid, directions);
            let largest = anew.at(0, 0);
            for (kx, ky) in (0..grid.len() as i64).map(|i| (i % grid.mx as i64, i / grid.mx as i64)) {
                // The tolerance is the error of 12 Chebyshev nodes (src/influence/periodic.rs), and of sums over up to 1300 images.
                let (value, exact) = (coefficients.at(kx, ky), anew.at(kx, ky));
                assert!((value - exact).abs() <= 1e-12 * largest, "{grid:?} ({kx}, {ky}): {value} {exact}");
            }
        }
        assert!(grid.mx <= 8 && grid.my <= 8);
    }
}

#[test]
fn what_a_period_cannot_do_is_refused_by_name() {
    let grid = Grid::new(8, 8, 1.0, 1.0).unwrap();
    let h = rough(8, 8);
    let refuse = |scene: &Scene<'_>, method: Method, words: &[&str]| {
        let Err(error) = solve(scene, &Options { method, ..Options::default() }) else { panic!("{words:?}: solved") };
        let message = error.to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    let mean = h.iter().sum::<f64>() / 64.0;
    let full = scene(grid, &h, (true, true), Load::Approach(mean + 0.1));
    refuse(&full, Method::Auto, &["approach", "mean plane", "force"]);
    let by_force = Scene { load: Load::Force(1.0), ..full };
    refuse(&by_force, Method::Multigrid, &["MULTIGRID", "period"]);
    refuse(&by_force, Method::FullMultigrid, &["FULL_MULTIGRID", "period"]);
    refuse(&scene(grid, &h, (false, false), Load::Force(1.0)), Method::Auto, &["period", "0"]);
    // An element without a surface carries no pressure. If there is one, even an approach beyond the mean has a solution.
    let mut hole = h.clone();
    hole[27] = f64::INFINITY;
    let (_, stop, report) =
        solve(&scene(grid, &hole, (true, true), Load::Approach(mean + 0.1)), &Options::default()).unwrap();
    assert_eq!((stop, report.measures.contact_count), (Outcome::Converged, 63));
    // A handle keeps its period, and refuses a scene with another one.
    let mut solver = Solver::new(&by_force, &Options::default()).unwrap();
    assert!(solver.solve(&by_force, &Options::default(), None, None).is_ok());
    let other = Scene { period: Some(Period { x: true, y: false }), ..by_force };
    assert!(solver.solve(&other, &Options::default(), None, None).is_err());
}
