//! Coefficients of bodies that relax and roll steadily, against their integral, their limits, and what CONTACT printed (its example visc_cylindr; eve70a/CONTACT).

use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::visco::{rolling_table, RollingBody, Series};

fn body(compliance: f64, g: f64, modulus: &[f64], time: &[f64]) -> RollingBody {
    RollingBody { compliance, series: Series::new(g, modulus, time).expect("a series") }
}

fn elastic(compliance: f64) -> RollingBody {
    RollingBody { compliance, series: Series::default() }
}

/// The integral of 1/rho over an element of dx by dy, from `(x, y)` (Love 1929).
fn love(x: f64, y: f64, dx: f64, dy: f64) -> f64 {
    let f = |a: f64, b: f64| {
        let of = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        of(a, b) + of(b, a)
    };
    let (xp, xm, yp, ym) = (x + 0.5 * dx, x - 0.5 * dx, y + 0.5 * dy, y - 0.5 * dy);
    f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym)
}

/// A body with one branch of half its modulus: `J(t)/J(0) = 2 - exp(-t/(2 tau))`, for a relaxation time tau.
#[test]
fn coefficients_are_those_of_the_integral_over_what_has_passed() {
    let (cx, cy, dx, dy, time) = (5, 3, 0.5, 0.8, 0.3);
    for speed in [0.02, 0.5, 5.0, 200.0] {
        let table = rolling_table((cx, cy), (dx, dy), &[body(0.7, 2.0, &[1.0], &[time]), elastic(0.2)], speed).unwrap();
        let length = 2.0 * time * speed;
        let own = love(0.0, 0.0, dx, dy);
        for (kx, ky) in [(0, 0), (-1, 0), (1, 0), (-5, 0), (4, 0), (0, 1), (-1, 2), (3, -3), (-2, -2)] {
            let (x, y) = (f64::from(kx) * dx, f64::from(ky) * dy);
            // exp(-s/L) to 1e-15, by midpoints; the slope of a is infinite at two places as a logarithm.
            let steps = 100_000;
            let h = 36.0 / f64::from(steps);
            let of = |k: i32| {
                let u = (f64::from(k) + 0.5) * h;
                (-u).exp() * love(x + length * u, y, dx, dy)
            };
            let passed = h * (0..steps).map(of).sum::<f64>();
            let exact = (0.9 * love(x, y, dx, dy) + 0.7 * passed) / std::f64::consts::PI;
            let found = table[((ky + cy as i32) * 2 * cx as i32 + kx + cx as i32) as usize];
            // Midpoints are h L apart.
            let tolerance = 1e-9 + 0.1 * (h * length / dx).powi(2) + 1e-8;
            assert!((found - exact).abs() <= tolerance * own, "{speed} {kx} {ky}: {found} {exact}");
        }
        let back = rolling_table((cx, cy), (dx, dy), &[body(0.7, 2.0, &[1.0], &[time]), elastic(0.2)], -speed).unwrap();
        for row in 0..2 * cy {
            for k in 1..2 * cx {
                assert_eq!(back[row * 2 * cx + k], table[row * 2 * cx + 2 * cx - k]);
            }
        }
    }
}

#[test]
fn slow_bodies_are_relaxed_and_fast_ones_elastic() {
    let of = |speed: f64| {
        let bodies = [body(0.7, 2.0, &[0.5, 0.5], &[0.3, 0.01]), elastic(0.0)];
        rolling_table((4, 4), (0.5, 0.5), &bodies, speed).unwrap()
    };
    let at =
        |k: usize| love((k % 8) as f64 * 0.5 - 2.0, (k / 8) as f64 * 0.5 - 2.0, 0.5, 0.5) * 0.7 / std::f64::consts::PI;
    let own = at(4 * 8 + 4);
    for (slow, k) in of(1e-9).iter().zip(0..) {
        // In L = 6e-10 the slope of a is at most of the order of log(1e9).
        assert!((slow - 2.0 * at(k)).abs() <= 1e-7 * own, "{k}: {slow} {}", at(k));
    }
    for (fast, k) in of(1e9).iter().zip(0..) {
        // What is within L of 1e7 to 1e9 elements: logarithm over L.
        assert!((fast - at(k)).abs() <= 1e-5 * own, "{k}: {fast} {}", at(k));
    }
}

#[test]
fn what_creeps_for_ever_or_stands_still_is_refused() {
    let fluid = [body(1.0, 2.0, &[2.0], &[1.0]), elastic(0.0)];
    assert!(rolling_table((2, 2), (1.0, 1.0), &fluid, 1.0).unwrap_err().to_string().contains("body 1"));
    let still = [body(1.0, 2.0, &[1.0], &[1.0]), elastic(0.0)];
    assert!(rolling_table((2, 2), (1.0, 1.0), &still, 0.0).unwrap_err().to_string().contains("speed is 0"));
}

/// Two cylinders that relax alike to half their modulus, 99 x 1 elements, rolling at 1000 mm/s: approach, largest pressure and elements in contact
/// as printed, and how far the force is ahead of the middle (NumPy, dense matrices).
#[test]
fn cylinders_that_roll_are_those_of_contact() {
    let (mx, dx, dy, nu, g) = (99, 0.16, 1000.0, 0.4, 1143.0);
    let grid = Grid::new(mx, 1, dx, dy).unwrap();
    let x = |i: usize| -7.92 + i as f64 * dx;
    let h: Vec<f64> = (0..mx).map(|i| 0.01 * x(i) * x(i)).collect();
    for (creep, approach, pressure, count, ahead) in
        [(0.009, 2.36736, 78.74, 62, 1.222), (0.045, 2.06321, 84.72, 57, 0.595), (2.0, 1.45462, 85.31, 56, 0.028)]
    {
        // The creep time is twice the relaxation time.
        let one = || body((1.0 - nu) / (2.0 * g), g, &[0.5 * g], &[0.5 * creep]);
        let table = rolling_table((mx, 1), (dx, dy), &[one(), one()], 1000.0).unwrap();
        let influence = Table::scaled(mx, 1, &table, 1.0, &grid).unwrap();
        let plain = Scene::new(grid, &h, Bodies::same(g, nu), Load::Force(6e5));
        let scene = Scene { influence: Some(influence), ..plain };
        let (solver, stop, report) = solve(&scene, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let measures = &report.measures;
        println!("{creep} {} {} {}", measures.approach, measures.max_pressure, measures.contact_count);
        // The digits printed; with the slow one CONTACT's tail ends early, at some 1e-5.
        assert!((measures.approach - approach).abs() <= 4e-5, "{creep}: {}", measures.approach);
        assert!((measures.max_pressure - pressure).abs() <= 0.011, "{creep}: {}", measures.max_pressure);
        assert_eq!(measures.contact_count, count);
        let moment: f64 = solver.state().p.iter().enumerate().map(|(i, p)| p * x(i) * dx * dy).sum();
        assert!((moment / 6e5 - ahead).abs() <= 1e-3, "{creep}: {}", moment / 6e5);
    }
}
