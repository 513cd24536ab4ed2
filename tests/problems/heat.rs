//! Flash temperatures, compared with closed forms and with integrals in polar coordinates.

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::heat::{flash_temperature, Flash, Heat};
use contact_normal::threads::Threads;

fn found(grid: Grid, flux: &[f64], speed: [f64; 2], share: Option<f64>) -> Flash {
    let heat = Heat { grid, flux, conductivity: [50.0, 2.0], diffusivity: [1.4e-5, 1e-6], speed, share };
    flash_temperature(&heat, &Threads::One).expect("temperatures")
}

/// A source q0 sqrt(1 - r^2/a^2) at rest: in the middle T = pi q0 a/(4 lambda), by the same integral of 1/r as Hertz' displacement, here with the
/// factor 1/(2 pi lambda).
#[test]
fn a_source_at_rest_is_as_warm_as_hertz_is_deep() {
    let (a, q0, n) = (1e-3, 1e7, 129);
    let grid = Grid::new(n, n, 2.2 * a / n as f64, 2.2 * a / n as f64).expect("a grid");
    let at = |k: usize| (k as f64 - 64.0) * grid.dx;
    let flux: Vec<f64> =
        (0..n * n).map(|i| q0 * (1.0 - (at(i % n).powi(2) + at(i / n).powi(2)) / (a * a)).max(0.0).sqrt()).collect();
    let rest = found(grid, &flux, [0.0; 2], Some(1.0));
    let exact = PI * q0 * a / (4.0 * 50.0);
    // The error is of second order in the element, which is 1/58 of the radius.
    assert!((rest.largest[0] / exact - 1.0).abs() < 1e-3, "{} {exact}", rest.largest[0]);
    assert!(rest.at[0] == 64 * n + 64 && rest.largest[1] == 0.0 && rest.share == 1.0);
}

/// A fast band (Jaeger 1942): T = 2 q/lambda sqrt(kappa x/(pi V)) at a distance x behind the leading edge. Behind the band T is the difference of two
/// such terms. Conduction along x adds an effect that falls as kappa/(V x).
#[test]
fn behind_the_edge_of_a_fast_band_the_temperature_grows_as_the_root() {
    let (n, d, speed, q) = (64, 1e-4, 20.0, 1e8);
    let grid = Grid::new(n, 1, d, 10.0).expect("a grid");
    for sign in [1.0, -1.0] {
        let inside = |k: usize| (8..40).contains(&if sign > 0.0 { k } else { n - 1 - k });
        let flux: Vec<f64> = (0..n).map(|k| if inside(k) { q } else { 0.0 }).collect();
        let fast = found(grid, &flux, [sign * speed, 0.0], Some(1.0));
        let root = |x: f64| 2.0 * q / 50.0 * (1.4e-5 * x.max(0.0) / (PI * speed)).sqrt();
        for k in 12..n {
            let x = (k as f64 + 0.5 - 8.0) * d;
            let exact = root(x) - root(x - 32.0 * d);
            let rise = fast.rise[0][if sign > 0.0 { k } else { n - 1 - k }];
            // The first place that is compared lies 4.5 elements behind an edge, where kappa/(V x) is .0016.
            let near = if (38..44).contains(&k) { 2e-2 } else { 4e-3 };
            assert!((rise / exact - 1.0).abs() < near, "{k}: {rise} {exact}");
        }
        assert!((0..6).all(|k| fast.rise[0][if sign > 0.0 { k } else { n - 1 - k }] < 1e-6 * fast.largest[0]));
    }
}

/// lambda T at the centre of a single element, in polar coordinates: `1/(2 pi) integral of (1 - exp(-P R (1 - cos))) / (P (1 - cos))` over the angle,
/// with R the distance of the edge.
fn own(grid: &Grid, wave: f64) -> f64 {
    let steps = 400_000;
    let of = |k: usize| {
        let angle = 2.0 * PI * (k as f64 + 0.5) / steps as f64;
        let (sine, cosine) = angle.sin_cos();
        let reach = (0.5 * grid.dx / cosine.abs()).min(0.5 * grid.dy / sine.abs());
        let a = 2.0 * wave * (0.5 * angle).sin().powi(2);
        if a * reach < 1e-12 {
            reach
        } else {
            -(-a * reach).exp_m1() / a
        }
    };
    (0..steps).map(of).sum::<f64>() / steps as f64
}

/// lambda T at a place outside the element, by Simpson's rule: the integrand is smooth there.
fn offset(grid: &Grid, (kx, ky): (f64, f64), wave: f64) -> f64 {
    let steps = 400;
    let part = |k: usize, d: f64| (k as f64 / steps as f64 - 0.5) * d;
    let weight = |k: usize| if k == 0 || k == steps { 1.0 } else { (2 + 2 * (k % 2)) as f64 };
    let mut sum = 0.0;
    for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
        let (x, y) = (kx * grid.dx - part(i, grid.dx), ky * grid.dy - part(j, grid.dy));
        let r = x.hypot(y);
        // r - x without cancellation.
        let lag = if x > 0.0 { y * y / (r + x) } else { r - x };
        sum += weight(i) * weight(j) * (-wave * lag).exp() / r;
    }
    sum * grid.element_area() / (2.0 * PI * (9 * steps * steps) as f64)
}

#[test]
fn one_element_heats_as_the_integral_of_jaegers_source() {
    let grid = Grid::new(49, 31, 2e-4, 3e-4).expect("a grid");
    let mut flux = vec![0.0; 49 * 31];
    flux[15 * 49 + 24] = 1.0;
    for speed in [1e-3, 0.1, 1.0, 30.0] {
        let wave = speed / (2.0 * 1.4e-5);
        let found = found(grid, &flux, [speed, 0.0], Some(1.0));
        let scale = found.largest[0] * 50.0;
        let at = |kx: i64, ky: i64| 50.0 * found.rise[0][((15 + ky) * 49 + 24 + kx) as usize];
        assert!((at(0, 0) - own(&grid, wave)).abs() < 1e-6 * scale, "{speed}: {} {}", at(0, 0), own(&grid, wave));
        let near = [(1_i64, 0_i64), (4, 0), (-1, 0), (-4, 1), (0, 1), (2, 2), (1, -3)];
        for (kx, ky) in near.into_iter().chain([(19, 0), (24, 3), (-20, 0), (20, -8), (0, 14), (-9, 13)]) {
            let exact = offset(&grid, (kx as f64, ky as f64), wave);
            // The error of Simpson's rule with steps of 1/400 of an element. For a fast source there is a thin layer at the edge, which needs a
            // larger tolerance.
            let allowed = if kx.abs() + ky.abs() < 13 || speed > 1.0 { 2e-5 } else { 1e-10 };
            assert!((at(kx, ky) - exact).abs() < allowed * scale, "{speed} {kx} {ky}: {} {exact}", at(kx, ky));
        }
    }
}

/// Elements that are much longer than wide, much wider than long, or much larger than kappa/V. lambda T at their centres is `1/(2 pi)` times the sum
/// over the edges of `d integral of (1 - exp(-z))/z dt`, `z = P (d cosh t - x)`: d is the distance of an edge, and d sinh t the place along it. The
/// integrals are computed by Simpson's rule.
#[test]
fn long_and_large_elements_heat_as_their_edges_say() {
    for (dx, dy) in [(100.0, 1.0), (1.0, 1.0), (1.0, 100.0), (1e4, 3.0)] {
        for peclet in [1e-2, 1.0, 30.0, 1e3, 1e5] {
            let (wave, steps) = (peclet / dx, 40_000);
            let edge = |d: f64, half: f64, x: &dyn Fn(f64) -> f64| {
                // The substitution t = s^3 resolves the narrow peak that the integrand has at 0 behind a fast source.
                let (end, step) = ((half / d).asinh().cbrt(), 2.0 / f64::from(steps));
                let at = |k: i32| {
                    let s = end * (f64::from(k) * step - 1.0);
                    let t = s.powi(3);
                    let z = wave * (d * t.cosh() - x(d * t.sinh()));
                    3.0 * s * s * if z > 1e-9 { -(-z).exp_m1() / z } else { 1.0 - 0.5 * z }
                };
                let weight = |k: i32| if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
                d * end * step / 3.0 * (0..=steps).map(|k| weight(k) * at(k)).sum::<f64>()
            };
            let (long, wide) = (0.5 * dx, 0.5 * dy);
            let ends = edge(long, wide, &|_| long) + edge(long, wide, &|_| -long);
            let exact = (ends + 2.0 * edge(wide, long, &|along| along)) / (2.0 * PI);
            let grid = Grid::new(1, 1, dx, dy).expect("a grid");
            let found = 50.0 * found(grid, &[1.0], [wave * 2.8e-5, 0.0], Some(1.0)).largest[0];
            println!("{dx} {dy} {peclet}: {:.1e}", found / exact - 1.0);
            // 1e-9 is the error of the library's quadrature rules, on panels that grow by a factor of four, and of the logarithm on the first panel.
            assert!((found / exact - 1.0).abs() < 1e-9, "{dx} {dy} {peclet}: {found} {exact}");
        }
    }
}

#[test]
fn the_heat_is_shared_so_that_both_are_as_warm() {
    let grid = Grid::new(24, 16, 1e-4, 1e-4).expect("a grid");
    let flux: Vec<f64> = (0..grid.len()).map(|i| if (8..16).contains(&(i % 24)) { 1e6 } else { 0.0 }).collect();
    let both = found(grid, &flux, [-2.0, 0.5], None);
    assert!((both.largest[0] / both.largest[1] - 1.0).abs() < 1e-12 && both.share > 0.5 && both.share < 1.0);
    let one = found(grid, &flux, [-2.0, 0.5], Some(1.0));
    assert!((one.largest[0] * both.share / both.largest[0] - 1.0).abs() < 1e-12);
    // Without a heat flux both bodies share equally, and there is no temperature.
    let none = found(grid, &vec![0.0; grid.len()], [1.0, 1.0], None);
    assert!(none.share == 0.5 && none.rise.iter().flatten().all(|t| *t == 0.0));
}

#[test]
fn numbers_out_of_their_range_are_refused() {
    let grid = Grid::new(2, 2, 1.0, 1.0).expect("a grid");
    let heat =
        Heat { grid, flux: &[1.0; 4], conductivity: [1.0; 2], diffusivity: [1.0; 2], speed: [0.0; 2], share: None };
    let refused = |heat: &Heat<'_>| flash_temperature(heat, &Threads::One).expect_err("a refusal").to_string();
    assert!(refused(&Heat { conductivity: [0.0, 1.0], ..heat }).contains("conductivity[0]"));
    assert!(refused(&Heat { diffusivity: [1.0, f64::NAN], ..heat }).contains("diffusivity[1]"));
    assert!(refused(&Heat { share: Some(1.5), ..heat }).contains("share"));
    assert!(refused(&Heat { flux: &[1.0; 3], ..heat }).contains("heat_flux"));
    let not_finite = flash_temperature(&Heat { flux: &[1.0, f64::INFINITY, 0.0, 0.0], ..heat }, &Threads::One);
    assert!(matches!(not_finite, Err(Error::NotFinite(_))));
}

/// Temperatures beyond the range of numbers are refused, and the message names the input.
#[test]
fn what_is_beyond_the_range_is_refused_by_its_name() {
    let grid = Grid::new(3, 3, 1.0, 1.0).expect("a grid");
    let of = |flux: f64, conductivity: f64, speed: f64| {
        let flux = [flux; 9];
        let (conductivity, speed) = ([conductivity, 1.0], [0.5 * speed, speed]);
        let heat = Heat { grid, flux: &flux, conductivity, diffusivity: [1.0; 2], speed, share: None };
        flash_temperature(&heat, &Threads::One).map(|found| found.largest)
    };
    let cases = [
        (of(1e308, 1.0, 1.0), "heat_flux reaches 1e308 with conductivity[0] of 1e0"),
        (of(1e200, 1e-200, 1.0), "heat_flux reaches 1e200 with conductivity[0] of 1e-200"),
        (of(1.0, 1.0, -1e308), "speed[1] is -1e308 with diffusivity[1] of 1e0"),
    ];
    for (found, words) in cases {
        let Err(Error::NotFinite(message)) = found else { panic!("{words}: {found:?}") };
        assert!(message.starts_with(words), "{message}");
    }
    // Temperatures within the range are of the order of the flux.
    assert!(of(1e300, 1.0, 1.0).is_ok_and(|largest| largest.iter().all(|top| *top > 1e299 && *top < 1e301)));
}

/// If the share is not given, it makes the largest temperatures of both bodies equal, provided that both get warmer. A negative flux cools.
#[test]
fn a_flux_that_cools_too_leaves_both_as_warm() {
    let (n, d) = (12, 1e-4);
    let grid = Grid::new(n, n, d, d).expect("a grid");
    let mut flux = vec![0.0; n * n];
    (flux[5 * n + 3], flux[5 * n + 4], flux[5 * n + 8]) = (2e8, 1e8, -1.5e8);
    let both = found(grid, &flux, [1.0, 0.0], None);
    assert!((both.largest[0] / both.largest[1] - 1.0).abs() <= 1e-12, "{:?}", both.largest);
    assert!(both.share > 0.0 && both.share < 1.0 && both.rise[0].iter().any(|rise| *rise < 0.0));
    let cold: Vec<f64> = flux.iter().map(|flux| -flux.abs()).collect();
    let cold = found(grid, &cold, [1.0, 0.0], None);
    assert!(cold.share == 0.5 && cold.rise.iter().flatten().all(|rise| *rise <= 0.0), "{}", cold.share);
}

/// `exp(P x) K0(P |x|)`, the temperature of a line source of pi at a distance x downstream: `integral over t > 0 of exp(-P (|x| cosh t - x))` by the
/// trapezoidal rule, to round-off.
fn of_line(x: f64, wave: f64) -> f64 {
    let a = (wave * x.abs()).max(1e-300);
    // The integrand has a width of 1/sqrt(1 + a), and is analytic in a strip of half-width pi/2: with this step the trapezoidal rule is exact to
    // round-off.
    let step = 0.2 / (1.0 + a).sqrt();
    let fades = if x < 0.0 { (-2.0 * a).exp() } else { 1.0 };
    let term = |k: u32| (-2.0 * a * (0.5 * step * f64::from(k)).sinh().powi(2)).exp();
    let terms = (2.0 * (20.0 / a).sqrt().asinh() / step) as u32 + 1;
    fades * step * (0.5 + (1..terms).map(term).sum::<f64>())
}

/// The integral of f from a to b by the double exponential rule, which allows a square root or a logarithm of the distance at the ends.
fn between(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = 1.0 / 16.0;
    let term = |k: i32| {
        let t = step * f64::from(k);
        let s = 0.5 * PI * t.sinh();
        let from_end = (b - a) / (1.0 + (2.0 * s.abs()).exp());
        0.5 * PI * t.cosh() / s.cosh().powi(2) * f(if s < 0.0 { a + from_end } else { b - from_end })
    };
    0.5 * (b - a) * step * (-56..=56).map(term).sum::<f64>()
}

/// A band with Hertz's pressure, `q0 sqrt(1 - x^2/a^2)`, that moves at any speed: the integral of line sources (Carslaw & Jaeger, section 10.7), and
/// the limits of slow and fast bands. `P a` is the Peclet number.
#[test]
fn a_band_of_hertz_is_as_warm_as_its_lines() {
    let (n, a, q0) = (401, 1e-3, 1e7);
    let d = 2.4 * a / n as f64;
    let x = |k: usize| (k as f64 - 200.0) * d;
    // The antiderivative of the pressure, for means over elements.
    let whole = |x: f64| {
        let s = (x / a).clamp(-1.0, 1.0);
        0.5 * a * (s * (1.0 - s * s).sqrt() + s.asin())
    };
    let flux: Vec<f64> = (0..n).map(|k| q0 * (whole(x(k) + 0.5 * d) - whole(x(k) - 0.5 * d)) / d).collect();
    for peclet in [0.05, 0.5, 5.0, 50.0, 2e3] {
        let (wave, speed) = (peclet / a, 2.0 * 1.4e-5 * peclet / a);
        // The strip is so wide that its ends have no effect in the middle: it decays as exp(-P r).
        let grid = Grid::new(n, 1, d, 1.0).expect("a grid");
        let warm = found(grid, &flux, [speed, 0.0], Some(1.0));
        let exact = |at: f64| {
            let line = |s: f64| (1.0 - (s / a).powi(2)).max(0.0).sqrt() * of_line(at - s, wave);
            let upstream = if at > -a { between(-a, at.min(a), line) } else { 0.0 };
            let downstream = if at < a { between(at.max(-a), a, line) } else { 0.0 };
            q0 / (PI * 50.0) * (upstream + downstream)
        };
        let largest = warm.largest[0];
        for k in (0..n).step_by(10) {
            let (rise, exact) = (warm.rise[0][k], exact(x(k)));
            // The error is of second order in the element, which is 1/167 of a. For a fast band the flux within an element differs from that in its
            // middle, which causes an error of (2/3) q' (d/2)^(3/2), relative to 2.19 q0 a^(1/2). Near the edges the flux grows as the square root of
            // the distance.
            let s = (x(k) / a).abs().min(1.0);
            let slope = s / (1.0 - s * s).max(8.0 * d / a).sqrt();
            let near = if (x(k).abs() - a).abs() < 4.0 * d { 5e-4 } else { 2e-5 };
            let tolerance = near + 0.31 * slope * (0.5 * d / a).powf(1.5);
            assert!((rise - exact).abs() < tolerance * largest, "{peclet} {k}: {rise} {exact} of {largest}");
        }
        if peclet > 1e3 {
            // Blok (1937): the largest temperature is 1.11 times the heat per length over the square root of lambda rho c V 2 a.
            let blok = 1.11 * (0.5 * PI * q0 * a) / (50.0 * (speed / 1.4e-5 * 2.0 * a).sqrt());
            assert!((largest / blok - 1.0).abs() < 5e-3, "{largest} {blok}");
        }
    }
}
