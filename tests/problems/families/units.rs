//! The same problem in other units, and with all distances scaled, gives the same digits, and the same bits if the factors are powers of two.

use contact_normal::scene::{Bodies, Load};

use super::case::{distance, grid, Case};

/// A scene of steel in mm, N and MPa.
fn steel(load: Load) -> Case {
    let grid = grid(47, 40, 0.2, 0.15);
    let h = distance(&grid, |x, y| x * x / 900.0 + y * y / 500.0 + 1e-4 * (3.0 * x).sin() * (4.0 * y).cos());
    Case { bodies: Bodies::same(82000.0, 0.28), ..Case::new("mm, MPa", grid, h, load) }
}

const LOADS: [Load; 2] = [Load::Approach(0.015), Load::Force(8000.0)];

/// The case in a unit of length of which one mm is `length`, and in a unit of pressure of which one MPa is `pressure`. All distances, pressures and
/// the approach are multiplied by `scale`.
fn converted(case: &Case, name: &str, length: f64, pressure: f64, scale: f64) -> Case {
    let grid = grid(case.grid.mx, case.grid.my, case.grid.dx * length, case.grid.dy * length);
    let bodies = Bodies { shear_modulus: case.bodies.shear_modulus.map(|g| g * pressure), ..case.bodies };
    let h = case.h.iter().map(|h| h * length * scale).collect();
    let load = match case.load {
        Load::Approach(approach) => Load::Approach(approach * length * scale),
        Load::Force(force) => Load::Force(force * length * length * pressure * scale),
    };
    Case { bodies, ..Case::new(name, grid, h, load) }
}

/// Each: a name, and the factors `length`, `pressure` and `scale`.
const UNITS: [(&str, f64, f64, f64); 5] = [
    ("m, Pa", 1e-3, 1e6, 1.0),
    ("nm, GPa", 1e6, 1e-3, 1.0),
    ("h times 1e-30", 1.0, 1.0, 1e-30),
    ("h times 1e30", 1.0, 1.0, 1e30),
    ("light years, TPa", 1.057e-19, 1e-6, 1.0),
];

pub fn cases() -> Vec<Case> {
    let mut cases = LOADS.map(steel).to_vec();
    for (name, length, pressure, scale) in UNITS {
        cases.extend(LOADS.map(|load| converted(&steel(load), name, length, pressure, scale)));
    }
    cases
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_certified, assert_solved_or_told, run, run_with};
    use super::*;
    use contact_normal::solver::{Method, Options};

    const METHODS: [Method; 4] = [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm];

    #[test]
    fn any_consistent_units() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn other_units_give_the_same_digits() {
        let options = Options { tolerance: 1e-10, ..Options::default() };
        for load in LOADS {
            let here = run_with(&steel(load), &options).expect("a solve");
            let largest = here.p.iter().copied().fold(0.0, f64::max);
            for (name, length, pressure, scale) in UNITS {
                let case = converted(&steel(load), name, length, pressure, scale);
                let there = run_with(&case, &options).expect("a solve");
                assert_certified(&case, name, &there, options.tolerance);
                for (p, q) in here.p.iter().zip(&there.p) {
                    // Two residuals of 1e-10, times the condition number of A on this grid (below 100).
                    assert!((p - q / (pressure * scale)).abs() <= 1e-8 * largest, "{name}: {p} and {q}");
                }
            }
        }
    }

    #[test]
    fn powers_of_two_give_the_same_bits() {
        let two = |exponent: i32| 2f64.powi(exponent);
        for load in LOADS {
            for method in METHODS {
                let here = run(&steel(load), method).expect("a solve");
                for (length, pressure, scale) in
                    [(two(-10), two(20), 1.0), (two(20), two(-10), 1.0), (1.0, 1.0, two(100)), (1.0, 1.0, two(-100))]
                {
                    let case = converted(&steel(load), "powers of two", length, pressure, scale);
                    let there = run(&case, method).expect("a solve");
                    assert_eq!(
                        (there.stop, there.report.count.cycles),
                        (here.stop, here.report.count.cycles),
                        "{method:?}"
                    );
                    assert_eq!(there.approach, here.approach * length * scale, "{method:?} {load:?}");
                    for (p, q) in here.p.iter().zip(&there.p) {
                        assert_eq!((p * pressure * scale).to_bits(), q.to_bits(), "{method:?} {load:?}");
                    }
                }
            }
        }
    }
}
