//! Estimated errors of the forces of small shifts. The errors are linear in the shift, and the edge of a punch is their only cause.

use contact_normal::friction::Report;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome};

/// A round punch, 0.3 high, of radius 0.62, on m x m elements of a square of side 2.
fn punch(m: usize, shift: f64) -> Report {
    let d = 2.0 / m as f64;
    let place = |k: usize| (k as f64 + 0.5) * d - 1.0;
    let of = |i: usize| if place(i % m).hypot(place(i / m)) < 0.62 { 0.0 } else { 0.3 };
    let h: Vec<f64> = (0..m * m).map(of).collect();
    let grid = Grid::new(m, m, d, d).expect("a grid");
    let prescribed = [Prescribed::Creepage(-shift), Prescribed::Creepage(0.0)];
    let friction = Some(Friction { prescribed, ..Friction::new(0.3) });
    let scene = Scene { friction, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.05)) };
    let options = Options { estimates: true, tolerance: 1e-9, ..Options::default() };
    let (_, outcome, report) = solve(&scene, &options).expect("a solvable scene");
    assert_eq!(outcome, Outcome::Converged);
    report.friction.expect("friction")
}

/// The estimate must be linear in the shift, including its part that comes from the error of the normal force.
#[test]
fn errors_of_a_punch_are_covered_however_small_the_shift() {
    for shift in [1e-2, 1e-4, 1e-6, 1e-8, 1e-12] {
        let (found, finer) = (punch(20, shift), punch(120, shift));
        let (error, off) = (found.error[0].expect("an estimate"), (found.force[0] - finer.force[0]).abs());
        // The estimate is often much larger than the error (docs/friction.md), but never larger than the force.
        assert!(error >= off && error <= found.force[0], "{shift:e}: {error:e} for {off:e} of {:e}", found.force[0]);
    }
}
