//! Elastic constants at their limits. Results depend on 1/E* = sum of (1 - nu)/(2 G) only.

use contact_normal::scene::{Bodies, Load};

use super::case::{distance, grid, Case};

pub fn cases() -> Vec<Case> {
    let inf = f64::INFINITY;
    let pairs = [
        ("nu = 0", [1.0, 1.0], [0.0, 0.0]),
        ("nu = 0.4999", [1.0, 1.0], [0.4999, 0.4999]),
        ("nu = 0.5", [1.0, 1.0], [0.5, 0.5]),
        ("nu = -0.5", [1.0, 1.0], [-0.5, -0.5]),
        ("nu = -0.999 on 0.5", [1.0, 1.0], [-0.999, 0.5]),
        ("G 1 on 1e9", [1.0, 1e9], [0.3, 0.3]),
        ("G 1e9 on 1", [1e9, 1.0], [0.0, 0.5]),
        ("a rigid body below", [1.0, inf], [0.3, 0.3]),
        ("a rigid body above", [inf, 1.0], [0.3, -0.5]),
        ("G = 1e-60", [1e-60, inf], [0.3, 0.3]),
        ("G = 1e60", [1e60, 1e60], [0.3, 0.3]),
    ];
    let grid = grid(45, 40, 0.1, 0.12);
    let h = distance(&grid, |x, y| 0.05 * x * x + 0.08 * y * y + 0.002 * (5.0 * x).sin() * (4.0 * y).cos());
    let mut cases = Vec::new();
    for (name, shear_modulus, poisson_ratio) in pairs {
        let bodies = Bodies { shear_modulus, poisson_ratio };
        for load in [Load::Approach(0.1), Load::Force(0.2 / bodies.compliance())] {
            cases.push(Case { bodies, ..Case::new(name, grid, h.clone(), load) });
        }
    }
    cases
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_certified, assert_solved_or_told, run_with};
    use super::*;
    use contact_normal::solver::Options;

    #[test]
    fn elastic_constants_at_their_limits() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn pressures_are_those_of_unit_modulus_times_the_modulus() {
        let options = Options { tolerance: 1e-10, ..Options::default() };
        for case in cases() {
            let modulus = 1.0 / case.bodies.compliance();
            let load = match case.load {
                Load::Approach(approach) => Load::Approach(approach),
                Load::Force(force) => Load::Force(force / modulus),
            };
            let unit = Case { load, ..Case::new(&case.name, case.grid, case.h.clone(), load) };
            let [found, expected] = [&case, &unit].map(|case| {
                let found = run_with(case, &options).expect("a solve");
                assert_certified(case, "AUTO", &found, options.tolerance);
                found
            });
            let largest = expected.p.iter().copied().fold(0.0, f64::max);
            for (p, q) in found.p.iter().zip(&expected.p) {
                // Two residuals of 1e-10, times the condition number of A on this grid (below 100).
                assert!((p / modulus - q).abs() <= 1e-8 * largest, "{}: {p} and {q}", case.name);
            }
        }
    }
}
