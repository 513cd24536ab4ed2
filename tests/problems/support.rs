//! A solve that must converge.

use contact_normal::scene::Scene;
use contact_normal::solver::{solve, Options, Report, Solver, Stop};

/// The solver with its result, and the report.
pub fn run(scene: &Scene<'_>, options: &Options) -> (Solver, Report) {
    let (solver, stop, report) = solve(scene, options).unwrap();
    assert_eq!(stop, Stop::Converged, "{:?} {:?}", options.method, scene.load);
    (solver, report)
}
