//! A solve that must converge, and the contact conditions of a result.

use contact_normal::scene::Scene;
use contact_normal::solver::{solve, Options, Outcome, Report, Solver};

/// Solves, and asserts convergence. Returns the solver with its result, and the report.
pub fn run(scene: &Scene<'_>, options: &Options) -> (Solver, Report) {
    let (solver, stop, report) = solve(scene, options).unwrap();
    assert_eq!(stop, Outcome::Converged, "{:?} {:?}", options.method, scene.load);
    (solver, report)
}

/// Asserts the contact conditions to the default tolerance. `u`: A p by a product of the test.
pub fn assert_conditions(h: &[f64], approach: f64, p: &[f64], u: &[f64], what: &str) {
    let (mut residual, mut distance, mut penetration, mut count) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..p.len() {
        assert!(p[i] >= 0.0, "{what}");
        let e = h[i] - approach + u[i];
        if p[i] > 0.0 {
            residual += e * e;
            distance += (h[i] - approach).powi(2);
            count += 1.0;
        } else {
            penetration = f64::max(penetration, -e);
        }
    }
    // The tolerance of 1e-6, and 1 % of it for the different round-off of both products.
    assert!(residual.sqrt() <= 1.01e-6 * distance.sqrt(), "{what}: residual {}", (residual / distance).sqrt());
    assert!(penetration <= 1.01e-6 * (distance / count).sqrt(), "{what}: penetration {penetration}");
}
