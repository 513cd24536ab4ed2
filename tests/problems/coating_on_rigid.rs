//! Coatings on stiff and on rigid bodies: the transfer function, the coefficients, closed forms of thin layers, a product over waves of the test's
//! own, and two periods.

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{Kernel, Response, Transfer};
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Friction, Load, Period, Scene};
use contact_normal::solver::{solve, Method, Options};

use super::dense;
use crate::coating::{by_hankel_integrals, coated};
use crate::support::{assert_conditions, run};

const RIGID: Bodies = Bodies { shear_modulus: [f64::INFINITY; 2], poisson_ratio: [0.0, 0.3] };
const METHODS: [Method; 5] =
    [Method::Auto, Method::ProjectedCg, Method::Norm, Method::Multigrid, Method::FullMultigrid];

/// A coating of body 2.
fn layer(thickness: f64, shear_modulus: f64, poisson_ratio: f64) -> Option<Coating> {
    Some(Coating { layers: [None, Some(CoatingLayer { thickness, shear_modulus, poisson_ratio })] })
}

/// `sinh x - x`.
fn sinh_less(x: f64) -> f64 {
    match x < 1.0 {
        true => (1..12).rev().fold(0.0, |sum, k| (sum + x) * x * x / f64::from(2 * k * (2 * k + 1))),
        false => x.sinh() - x,
    }
}

/// The transfer function B of a bonded layer on a rigid base, in its usual form for a layer of finite thickness (for elastic strips, and in the
/// package ContactMechanics): `((3 - 4 nu) sinh 2s - 2s)/((3 - 4 nu) cosh 2s + 2 s^2 + 4 nu (2 nu - 3) + 5)`.
fn finite_thickness(nu: f64, s: f64) -> f64 {
    let q = 3.0 - 4.0 * nu;
    let sheared = q * sinh_less(2.0 * s) + (2.0 - 4.0 * nu) * 2.0 * s;
    sheared / (q * (2.0 * s).cosh() + 2.0 * s * s + 4.0 * nu * (2.0 * nu - 3.0) + 5.0)
}

#[test]
fn the_transfer_function_on_a_rigid_body_is_that_of_finite_thickness() {
    for nu in [-0.5, 0.0, 0.3, 0.49, 0.4999, 0.5] {
        let transfers = [0.0, 1e-300, 1e-30].map(|mu| Transfer::new(mu, [nu, 0.3]));
        let exact = |k: usize| match k {
            0 => 0.0,
            1 => 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu).powi(2),
            _ => 0.0,
        };
        for transfer in transfers {
            let taylor = transfer.taylor();
            for (k, found) in taylor.iter().take(3).enumerate() {
                assert!((found - exact(k)).abs() <= 1e-14, "nu {nu}: B{k} is {found}");
            }
            for s in [1e-3, 0.01, 0.1, 0.49, 0.51, 1.0, 2.0, 5.0, 10.0, 19.0, 21.0, 100.0] {
                let (found, exact) = (transfer.at(s), finite_thickness(nu, s));
                // The tolerance is the round-off of some ten terms, and that of cosh at large s.
                assert!((found / exact - 1.0).abs() <= 1e-13, "nu {nu} s {s}: {found} for {exact}");
            }
        }
    }
}

/// Far coefficients are below the round-off of the nearest one, so that errors are relative to the nearest.
#[test]
fn coefficients_on_stiff_and_rigid_bodies_are_direct_hankel_integrals() {
    let mut worst: f64 = 0.0;
    for mu in [1e-5, 6e-6, 4e-8, 1e-9, 1e-12, 1e-100, 1e-300, 0.0] {
        for nu in [[0.3, 0.25], [0.5, 0.3]] {
            for (t, dy, offsets, points) in [
                (16.0, 1.0, &[0, 1, 5, 40, 300][..], (1, 6)),
                (4.0, 0.8, &[0, 1, 4, 9, 60], (1, 8)),
                (1.0, 0.5, &[0, 1, 2, 9, 23], (1, 12)),
                (0.3, 1.0, &[0, 1, 7], (2, 16)),
            ] {
                let table = coated(mu, nu, t, &Grid::new(offsets[offsets.len() - 1] + 1, 1, 1.0, dy).unwrap());
                let rigid = coated(0.0, nu, t, &Grid::new(offsets[offsets.len() - 1] + 1, 1, 1.0, dy).unwrap());
                for &kx in offsets {
                    let (found, nearest) = (table.at(kx as i64, 0), table.at(0, 0));
                    let error = (found - by_hankel_integrals(mu, nu, t, (1.0, dy), kx, points)).abs() / nearest;
                    assert!(error <= 1e-12, "mu {mu} nu {nu:?} t {t} offset {kx}: {error:e}");
                    // The substrate changes a coefficient in first order of mu: by mu (1 - nu2)/(1 - nu1) times Love's integral, which is at most 4.
                    let change = (found - rigid.at(kx as i64, 0)).abs();
                    assert!(change <= 4.0 * 1.5 * mu + 1e-13 * nearest, "mu {mu} nu {nu:?} t {t}: {change:e}");
                    worst = worst.max(error);
                }
            }
        }
    }
    println!("largest difference from Hankel integrals: {worst:e}");
}

/// A ball of radius 1 on `m x m` elements over a square of side 2 L.
fn ball(m: usize, half: f64) -> (Grid, Vec<f64>) {
    let d = 2.0 * half / m as f64;
    let place = |k: usize| (k as f64 + 0.5) * d - half;
    let h = (0..m * m).map(|i| 0.5 * (place(i % m).powi(2) + place(i / m).powi(2))).collect();
    (Grid::new(m, m, d, d).unwrap(), h)
}

/// Thin compressible layers, M the oedometric modulus: `F = pi M a^4/(4 R t)`, `a^2 = 2 R delta`. The error
/// is of order `t/a`.
#[test]
fn a_ball_on_a_thin_layer_on_a_rigid_body_has_the_force_of_the_closed_form() {
    let (grid, h) = ball(96, 0.55);
    let (a, modulus) = (0.4_f64, 2.0 * 0.7 / 0.4);
    for (t, part) in [(0.1, 0.015), (0.03, 0.002)] {
        let approach = 0.5 * a * a;
        let scene = Scene { coating: layer(t, 1.0, 0.3), ..Scene::new(grid, &h, RIGID, Load::Approach(approach)) };
        let thin = 0.25 * PI * modulus * a.powi(4) / t;
        for method in METHODS {
            let options = Options { method, ..Options::default() };
            let (_, report) = run(&scene, &options);
            let force = report.measures.force;
            assert!((force / thin - 1.0).abs() <= part, "t {t} {method:?}: {force} for {thin}");
            // With this force given, the approach must come back. dF/F is about 2 d(delta)/delta.
            let (_, report) = run(&Scene { load: Load::Force(force), ..scene.clone() }, &options);
            let off = (report.measures.approach / approach - 1.0).abs();
            assert!(off <= 1e-5, "t {t} {method:?}: {off:e}");
        }
    }
}

/// A layer much thinner than an element acts as one spring per element, `p = M (delta - h)/t`. Other elements are displaced by some t/d of this
/// element's displacement.
#[test]
fn a_layer_far_thinner_than_elements_is_springs() {
    for (m, dy) in [(24, 1.0), (24, 10.0)] {
        let (square, h) = ball(m, 0.55);
        let grid = Grid { dy: dy * square.dy, ..square };
        for t in [1e-6, 1e-9, 1e-12, 1e-15, 1e-18, 1e-40, 1e-90] {
            let scene = Scene { coating: layer(t, 1.0, 0.3), ..Scene::new(grid, &h, RIGID, Load::Approach(0.08)) };
            let (_, report) = run(&scene, &Options { tolerance: 1e-12, ..Options::default() });
            let springs = h.iter().map(|h| 2.0 * 0.7 / 0.4 / t * (0.08 - h).max(0.0)).sum::<f64>();
            let off = report.measures.force / (springs * grid.element_area()) - 1.0;
            assert!(off.abs() <= 2.0 * t / grid.dx + 1e-12, "{dy} {t:e}: {off:e}");
        }
    }
}

/// Thin incompressible layers tend to `a^2 = 4 R delta`, `p = 3 G (a^2 - r^2)^2/(32 R t^3)`. The convergence is slow: the difference has to halve
/// with t.
#[test]
fn a_ball_on_a_thin_incompressible_layer_tends_to_the_closed_form() {
    let (grid, h) = ball(128, 0.5);
    let (a, mut before) = (0.4_f64, f64::INFINITY);
    for t in [0.06, 0.03, 0.015] {
        let scene = Scene { coating: layer(t, 1.0, 0.5), ..Scene::new(grid, &h, RIGID, Load::Approach(0.25 * a * a)) };
        let (_, report) = run(&scene, &Options::default());
        let off = report.measures.force / (PI * a.powi(6) / (32.0 * t.powi(3))) - 1.0;
        assert!(off > 0.0 && off < 0.65 * before, "t {t}: {off} after {before}");
        before = off;
    }
    assert!(before < 0.1, "{before}");
}

/// The mean of u over elements under a wave of unit pressure, by the test's own transfer function, over all aliases of the wave. The aliases beyond n
/// contribute a part that falls as 1/n, so that two values of n give the rest. `number`: the waves per element, in x and in y.
fn wave_response(nu: f64, t: f64, d: f64, number: [f64; 2]) -> f64 {
    const LAST: i64 = 40;
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
    let alias = |a: i64, b: i64| {
        let [kx, ky] = [number[0] + a as f64, number[1] + b as f64].map(|number| 2.0 * PI * number / d);
        let k = kx.hypot(ky);
        let of_mean = 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu) * t;
        let u = if k == 0.0 { of_mean } else { (1.0 - nu) / k * finite_thickness(nu, (k * t).min(300.0)) };
        u * sinc(0.5 * kx * d) * sinc(0.5 * ky * d)
    };
    let sum = |n: i64| -> f64 { (-n..=n).flat_map(|a| (-n..=n).map(move |b| alias(a, b))).sum() };
    let (less, more) = (sum(LAST / 2), sum(LAST));
    more + (more - less) / 3.0
}

/// The displacements `u` of elements by a sum over waves, computed by the test's own Fourier transform. The period is longer than the range of the
/// layer's kernel.
fn by_waves(nu: f64, t: f64, p: &[f64], m: usize, d: f64, period: usize) -> Vec<f64> {
    let waves = |cosine: bool| -> Vec<f64> {
        let at = |i: usize, k: usize| 2.0 * PI * ((i * k) % period) as f64 / period as f64;
        let value = |i: usize, k: usize| if cosine { at(i, k).cos() } else { at(i, k).sin() };
        (0..period * m).map(|n| value(n / m, n % m)).collect()
    };
    let (cosines, sines) = (waves(true), waves(false));
    let mut u = vec![0.0; m * m];
    let half = period / 2;
    // Waves of both signs have the same response.
    let responses: Vec<f64> = (0..(half + 1) * (half + 1))
        .map(|k| wave_response(nu, t, d, [k % (half + 1), k / (half + 1)].map(|i| i as f64 / period as f64)))
        .collect();
    for j in 0..period {
        // The rows of p, multiplied by the wave in y and summed over y.
        let (c, s) = (&cosines[j * m..][..m], &sines[j * m..][..m]);
        let column =
            |x: usize| (0..m).fold((0.0, 0.0), |(re, im), y| (re + p[y * m + x] * c[y], im - p[y * m + x] * s[y]));
        let columns: Vec<(f64, f64)> = (0..m).map(column).collect();
        for i in 0..period {
            let (cx, sx) = (&cosines[i * m..][..m], &sines[i * m..][..m]);
            let (mut re, mut im) = (0.0, 0.0);
            for (x, (a, b)) in columns.iter().enumerate() {
                (re, im) = (re + a * cx[x] + b * sx[x], im + b * cx[x] - a * sx[x]);
            }
            let response = responses[j.min(period - j) * (half + 1) + i.min(period - i)] / (period * period) as f64;
            (re, im) = (re * response, im * response);
            for y in 0..m {
                // Multiplies by e^{i ky y}.
                let (a, b) = (re * c[y] - im * s[y], re * s[y] + im * c[y]);
                for x in 0..m {
                    u[y * m + x] += a * cx[x] - b * sx[x];
                }
            }
        }
    }
    u
}

#[test]
fn an_own_product_over_waves_certifies_a_layer_on_a_rigid_body() {
    for (nu, t) in [(0.3, 0.12), (0.5, 0.12), (0.45, 0.05)] {
        let m = 20;
        let (grid, h) = ball(m, 0.5);
        let scene = Scene { coating: layer(t, 1.0, nu), ..Scene::new(grid, &h, RIGID, Load::Approach(0.06)) };
        let (solver, report) = run(&scene, &Options::default());
        let p = &solver.state().p;
        // The gap between images is 2, at least sixteen thicknesses: kernels on rigid bodies decay exponentially.
        let u = by_waves(nu, t, p, m, grid.dx, 60);
        let (mut residual, mut distance) = (0.0, 0.0);
        for i in (0..m * m).filter(|&i| p[i] > 0.0) {
            residual += (h[i] - report.measures.approach + u[i]).powi(2);
            distance += (h[i] - report.measures.approach).powi(2);
        }
        let part = (residual / distance).sqrt();
        println!("nu {nu} t {t}: {part:e}");
        assert!(part <= 1e-5, "nu {nu} t {t}: {part:e}");
    }
}

/// Rubber on steel and gel on glass, in MPa and mm: the conditions of contact hold, with products by direct sums.
#[test]
fn rubber_on_steel_and_gel_on_glass_are_solved_by_every_method() {
    let (grid, h) = ball(48, 0.6);
    for (g, below, nu_below) in [(0.5, 8e4, 0.28), (1e-3, 2.5e4, 0.2), (0.5, f64::INFINITY, 0.0)] {
        for (nu, t, load) in [(0.5, 0.1, 0.05), (0.4999, 0.05, 0.03), (0.3, 0.02, 0.08)] {
            let bodies = Bodies { shear_modulus: [f64::INFINITY, below], poisson_ratio: [0.0, nu_below] };
            for method in METHODS {
                let scene = Scene { coating: layer(t, g, nu), ..Scene::new(grid, &h, bodies, Load::Approach(load)) };
                let (solver, report) = run(&scene, &Options { method, ..Options::default() });
                let mut u = vec![0.0; h.len()];
                dense::apply(&scene.coefficients().unwrap(), &grid, &solver.state().p, &mut u);
                let what = format!("{g} on {below}, nu {nu}, {method:?}");
                assert_conditions(&h, load, &solver.state().p, &u, &what);
                println!("{what}: {} cycles, {:.1} work units", report.count.cycles, report.count.work_units);
            }
        }
    }
}

/// Two flat surfaces approach by `P t/M`. For a wave in full contact the amplitude of p is that of h divided by the layer's response to the wave, as
/// a mean over elements.
#[test]
fn with_two_periods_the_layer_is_compressed_and_waves_are_pressed_flat() {
    let (m, d, t, nu) = (24, 0.25, 0.3, 0.3);
    let grid = Grid::new(m, m, d, d).unwrap();
    let area = (m as f64 * d).powi(2);
    let both = Some(Period { x: true, y: true });
    let oedometric = 2.0 * (1.0 - nu) / (1.0 - 2.0 * nu);
    let k = 2.0 * PI / (m as f64 * d);
    let wave: Vec<f64> = (0..m * m).map(|i| 0.01 * (k * d * (i % m) as f64).cos()).collect();
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg] {
        let options = Options { method, tolerance: 1e-9, ..Options::default() };
        let scene = Scene {
            coating: layer(t, 1.0, nu),
            period: both,
            ..Scene::new(grid, &wave, RIGID, Load::Force(3.0 * area))
        };
        let (solver, report) = run(&scene, &options);
        assert!(
            (report.measures.approach - 3.0 * t / oedometric).abs() <= 1e-12,
            "{method:?} {}",
            report.measures.approach
        );
        // The nearest alias has 1/23^2 of the amplitude, so that a sum over elements gives the amplitude of the wave.
        let p = &solver.state().p;
        let amplitude = 2.0 * p.iter().zip(&wave).map(|(p, w)| p * w / 0.01).sum::<f64>() / (m * m) as f64;
        let response: f64 = (-4000..=4000)
            .map(|a| {
                let k = k + 2.0 * PI * f64::from(a) / d;
                (1.0 - nu) / k.abs() * finite_thickness(nu, (k.abs() * t).min(300.0)) * (0.5 * k * d).sin()
                    / (0.5 * k * d)
            })
            .sum();
        // Leaving out the aliases beyond n = 4000 has an error of order 1/n^2.
        assert!((amplitude * response / -0.01 - 1.0).abs() <= 1e-6, "{method:?}: {amplitude}");
        let (_, by_approach) = run(&Scene { load: Load::Approach(3.0 * t / oedometric), ..scene.clone() }, &options);
        assert!((by_approach.measures.force / (3.0 * area) - 1.0).abs() <= 1e-8, "{}", by_approach.measures.force);
        // An incompressible layer has no compression, so that its approach is 0 in full contact, whatever the force.
        let scene = Scene { coating: layer(t, 1.0, 0.5), ..scene };
        let (_, report) = run(&scene, &options);
        assert!(report.measures.approach.abs() <= 1e-12, "{method:?} {}", report.measures.approach);
        let scene = Scene { load: Load::Approach(0.001), ..scene };
        let refused = solve(&scene, &options).map(drop).unwrap_err();
        assert!(matches!(&refused, Error::Infeasible(text) if text.contains("mean plane")), "{refused}");
    }
}

#[test]
fn what_is_not_solved_on_a_rigid_body_is_refused_by_name() {
    let (grid, h) = ball(16, 0.5);
    let plain = Scene::new(grid, &h, RIGID, Load::Approach(0.02));
    let refusal = |scene: &Scene<'_>| solve(scene, &Options::default()).map(drop).unwrap_err().to_string();
    let thin = refusal(&Scene { coating: layer(0.12 * grid.dx, 1.0, 0.5), ..plain.clone() });
    assert!(thin.contains("coating[1]->thickness") && thin.contains("incompressible"), "{thin}");
    run(&Scene { coating: layer(0.13 * grid.dx, 1.0, 0.5), ..plain.clone() }, &Options::default());
    run(&Scene { coating: layer(0.001 * grid.dx, 1.0, 0.3), ..plain.clone() }, &Options::default());
    // Both surfaces are rigid: the coating has no thickness, or there is no coating.
    for coating in [None, layer(0.0, 1.0, 0.3)] {
        let rigid = refusal(&Scene { coating, ..plain.clone() });
        assert!(rigid.contains("infinite for both bodies"), "{rigid}");
    }
    let rubbed = Scene { coating: layer(0.1, 1.0, 0.3), friction: Some(Friction::new(0.3)), ..plain.clone() };
    let rubbed = refusal(&rubbed);
    assert!(rubbed.contains("friction and coating"), "{rubbed}");
    let one = Scene { coating: layer(0.1, 1.0, 0.3), period: Some(Period { x: true, y: false }), ..plain };
    assert!(refusal(&one).contains("a period in one direction"));
}
