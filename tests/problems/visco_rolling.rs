//! Coefficients of viscoelastic bodies in steady rolling, compared with their integral, their limits, and the output of CONTACT (its example
//! visc_cylindr; eve70a/CONTACT).

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

/// A body with half its modulus in one branch, of relaxation time tau: `J(t)/J(0) = 2 - exp(-t/(2 tau))`.
#[test]
fn coefficients_are_those_of_the_integral_over_what_has_passed() {
    let (cx, cy, dx, dy, time) = (5, 3, 0.5, 0.8, 0.3);
    for speed in [0.02, 0.5, 5.0, 200.0] {
        let table = rolling_table((cx, cy), (dx, dy), &[body(0.7, 2.0, &[1.0], &[time]), elastic(0.2)], speed).unwrap();
        let length = 2.0 * time * speed;
        let own = love(0.0, 0.0, dx, dy);
        for (kx, ky) in [(0, 0), (-1, 0), (1, 0), (-5, 0), (4, 0), (0, 1), (-1, 2), (3, -3), (-2, -2)] {
            let (x, y) = (f64::from(kx) * dx, f64::from(ky) * dy);
            // The midpoint rule, up to exp(-s/L) = 1e-15. The slope of a has two logarithmic singularities.
            let steps = 100_000;
            let h = 36.0 / f64::from(steps);
            let of = |k: i32| {
                let u = (f64::from(k) + 0.5) * h;
                (-u).exp() * love(x + length * u, y, dx, dy)
            };
            let passed = h * (0..steps).map(of).sum::<f64>();
            let exact = (0.9 * love(x, y, dx, dy) + 0.7 * passed) / std::f64::consts::PI;
            let found = table[((ky + cy as i32) * 2 * cx as i32 + kx + cx as i32) as usize];
            // The error of the midpoint rule, whose points are h L apart, and 1e-8 for the singularities.
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
        // Relaxation changes the coefficient by the slope of a over L = 6e-10. The slope is at most of the order of log(1e9).
        assert!((slow - 2.0 * at(k)).abs() <= 1e-7 * own, "{k}: {slow} {}", at(k));
    }
    for (fast, k) in of(1e9).iter().zip(0..) {
        // The part of a that lies within L, which is 1e7 to 1e9 elements: a logarithm over L.
        assert!((fast - at(k)).abs() <= 1e-5 * own, "{k}: {fast} {}", at(k));
    }
}

/// Limits at both ends of the range of numbers: bodies are relaxed if the material relaxes before it moves, and elastic if it has passed before it
/// relaxes.
#[test]
fn at_the_ends_of_the_range_of_numbers_bodies_are_relaxed_or_elastic() {
    // With half the modulus in one branch the final compliance is twice the instantaneous one.
    let of = |speed: f64, time: f64, (dx, dy): (f64, f64)| {
        rolling_table((4, 4), (dx, dy), &[body(0.7, 2.0, &[1.0], &[time]), elastic(0.0)], speed).unwrap()
    };
    let (slow, fast) = (2.0, 1.0);
    for (speed, time, d, times) in [
        (5e-324, 1.0, 0.5, slow),
        (1e-200, 1e-200, 0.5, slow),
        (1.0, 5e-324, 0.5, slow),
        (1e-300, 1e-300, 1e300, slow),
        (1e-10, 1e-30, 1e-10, slow),
        (1e308, 1e308, 0.5, fast),
        (1.0, 1e308, 0.5, fast),
        (1e300, 1e10, 1e-300, fast),
        (1e200, 1e-10, 1e-200, fast),
    ] {
        let table = of(speed, time, (d, d));
        for (k, value) in table.iter().enumerate() {
            let (x, y) = ((k % 8) as f64 - 4.0, (k / 8) as f64 - 4.0);
            let exact = times * d * love(x, y, 1.0, 1.0) * 0.7 / std::f64::consts::PI;
            // L is below 1e-29 elements or above 1e180. The differences in Love's formula lose a digit or two.
            assert!((value / exact - 1.0).abs() <= 1e-13, "{speed} {time} {d} {k}: {value} {exact}");
        }
    }
    // Coefficients are a length times a function of V t/dx, also if intermediate values underflow or overflow.
    let middle = of(3.0, 0.2, (0.5, 0.5));
    for (speed, time, size) in
        [(1000, -900, 100), (-1000, 1000, 0), (-300, -300, -600), (500, 200, 700), (-900, 0, -900)]
    {
        let by = |value: f64, power: i32| value * 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
        let table = of(by(3.0, speed), by(0.2, time), (by(0.5, size), by(0.5, size)));
        for (value, exact) in table.iter().zip(&middle) {
            assert_eq!(*value, by(*exact, size), "{speed} {time} {size}");
        }
    }
}

/// Two branches whose times are far apart. If most of the modulus relaxes, the final compliance is reached late. A fast branch beside one that does
/// not relax makes a body with a smaller modulus.
#[test]
fn branches_far_apart_are_each_at_its_end() {
    let of = |modulus: &[f64], time: &[f64]| {
        rolling_table((3, 3), (1.0, 1.0), &[body(1.0, 1.0, modulus, time), elastic(0.0)], 1.0).unwrap()
    };
    let [apart, middle] = [of(&[0.5, 0.25], &[1e300, 1e-300]), of(&[0.25, 0.25], &[1e-300, 1e-310])];
    for (k, value) in apart.iter().enumerate() {
        let a = love((k % 6) as f64 - 3.0, (k / 6) as f64 - 3.0, 1.0, 1.0) / std::f64::consts::PI;
        assert!((value * 0.75 / a - 1.0).abs() <= 1e-13, "{k}: {value} {a}");
        assert!((middle[k] * 0.5 / a - 1.0).abs() <= 1e-13, "{k}: {} {a}", middle[k]);
    }
}

/// The quadrature may meet the edge of a slender element, and must still give finite coefficients. They are above those of the body before
/// relaxation, and below the largest ones of the relaxed body.
#[test]
fn coefficients_of_slender_elements_are_numbers() {
    for dy in [1e-3, 1e-6, 1e-9, 1e-12] {
        let table = rolling_table((2, 2), (1.0, dy), &[body(1.0, 1.0, &[0.5], &[1.0]), elastic(0.0)], 1.0).unwrap();
        for (k, value) in table.iter().enumerate() {
            let a = love((k % 4) as f64 - 2.0, dy * ((k / 4) as f64 - 2.0), 1.0, dy) / std::f64::consts::PI;
            // The differences in the test's Love formula have round-off: 1e-16 of 1 at dy = 1e-12.
            let (slack, most) = (1e-3, 2.0 * love(0.0, 0.0, 1.0, dy) / std::f64::consts::PI);
            assert!(*value >= (1.0 - slack) * a && *value <= (1.0 + slack) * most, "{dy:e} {k}: {value:e} {a:e}");
        }
    }
}

/// Coefficients beyond the range of numbers and invalid sizes are refused.
#[test]
fn coefficients_beyond_the_range_of_numbers_are_refused() {
    let refused = |compliance: f64, sizes: (f64, f64), speed: f64| {
        let bodies = [body(compliance, 2.0, &[1.0], &[1.0]), elastic(0.0)];
        rolling_table((2, 2), sizes, &bodies, speed).unwrap_err().to_string()
    };
    for (compliance, sizes, what) in [
        (1e200, (1e200, 1e200), "a coefficient is inf"),
        (1e-200, (1e-200, 1e-200), "a coefficient is"),
        (1.0, (1e-300, 1e300), "a coefficient is"),
        (1.0, (0.0, 1.0), "dx is 0"),
        (1.0, (1.0, f64::NAN), "dy is NaN"),
        (0.0, (1.0, 1.0), "a body must give way"),
        (f64::NAN, (1.0, 1.0), "compliance is NaN"),
    ] {
        let message = refused(compliance, sizes, 1.0);
        assert!(message.contains(what), "{compliance} {sizes:?}: {message}");
    }
}

#[test]
fn what_creeps_for_ever_or_stands_still_is_refused() {
    let fluid = [body(1.0, 2.0, &[2.0], &[1.0]), elastic(0.0)];
    assert!(rolling_table((2, 2), (1.0, 1.0), &fluid, 1.0).unwrap_err().to_string().contains("body 1"));
    let still = [body(1.0, 2.0, &[1.0], &[1.0]), elastic(0.0)];
    assert!(rolling_table((2, 2), (1.0, 1.0), &still, 0.0).unwrap_err().to_string().contains("speed is 0"));
}

/// Two equal cylinders that relax to half their modulus, on 99 x 1 elements, roll at 1000 mm/s. The approach, the largest pressure and the number of
/// elements in contact are those that CONTACT printed. The offset of the force from the middle is from a computation with dense matrices in NumPy.
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
        // The tolerances are those of the printed digits. For slow creep CONTACT cuts off the tail of the displacements, an error of some 1e-5.
        assert!((measures.approach - approach).abs() <= 4e-5, "{creep}: {}", measures.approach);
        assert!((measures.max_pressure - pressure).abs() <= 0.011, "{creep}: {}", measures.max_pressure);
        assert_eq!(measures.contact_count, count);
        let moment: f64 = solver.state().p.iter().enumerate().map(|(i, p)| p * x(i) * dx * dy).sum();
        assert!((moment / 6e5 - ahead).abs() <= 1e-3, "{creep}: {}", moment / 6e5);
    }
}
