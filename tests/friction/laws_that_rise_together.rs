//! Friction bounds that rise together with the slips of all elements: particles below the coefficient at rest, and layers that harden.

use contact_normal::grid::Grid;
use contact_normal::scene::{Branch, Fall, Friction, FrictionLaw, Motion, PlasticLayer};
use contact_normal::solver::Outcome;

use super::laws_that_rise::{along, Scene, TOLERANCE};

const PRESSURE: f64 = 0.03;
const MU: f64 = 0.3;

/// The pressures of a ball on m x m elements of side 1, and the shift at which all elements slip.
fn ball(m: usize) -> (Grid, Vec<f64>, f64) {
    let radius = 0.45 * m as f64;
    let off = |k: usize| (k as f64 - 0.5 * (m - 1) as f64) / radius;
    let of = |i: usize| PRESSURE * (1.0 - off(i % m).powi(2) - off(i / m).powi(2)).max(0.0).sqrt();
    (Grid::new(m, m, 1.0, 1.0).expect("a grid"), (0..m * m).map(of).collect(), MU * PRESSURE * radius)
}

/// The slip of one element hardly changes by its own bound, but it does by the bounds of all elements together. Turns with the bounds of the last
/// slips would alternate.
#[test]
fn particles_below_the_coefficient_at_rest_find_their_solution() {
    let mut found = 0;
    for m in [12, 24, 40] {
        let (grid, pressure, shift) = ball(m);
        for had in [0.01, 0.1] {
            let before = vec![had; pressure.len()];
            for memory in [0.02, 0.1, 0.3, 1.0, 3.0] {
                for part in [0.5, 1.0, 2.0] {
                    let memory_distance = memory * shift;
                    let law = FrictionLaw {
                        memory_distance,
                        memory_speed: 0.01 * memory_distance,
                        ..FrictionLaw::new(Fall::Exponential, (0.4, 0.6), 10.0 * shift, 1.0)
                    };
                    let (law, prescribed) = (Some(law), along(-part * shift));
                    let friction =
                        Friction { law, prescribed, coefficients_before: Some(&before), ..Friction::new(MU) };
                    let scene = Scene { grid, pressure: &pressure, friction };
                    let (outcome, report, solution) = scene.solve(TOLERANCE);
                    assert_eq!(outcome, Outcome::Converged, "{m} {had} {memory} {part}: {report:?}");
                    let residuals = scene.residuals(&solution);
                    // Twice the tolerance, for the round-off of sums over up to 1600 elements.
                    assert!(
                        residuals.iter().all(|residual| *residual <= 2.0 * TOLERANCE),
                        "{m} {had} {memory} {part}: {residuals:?}"
                    );
                    found += 1;
                }
            }
        }
    }
    assert_eq!(found, 90);
}

/// Without a friction law no bound falls with the slip: the solution is unique, and each branch has to find it.
#[test]
fn all_branches_beside_a_layer_that_hardens_are_one() {
    for m in [12, 24] {
        let (grid, pressure, shift) = ball(m);
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            for hardening in [0.1, 0.3, 1.0, 3.0] {
                let of = |branch: Branch| {
                    let layer = Some(PlasticLayer { yield_limit: 0.2 * MU * PRESSURE, hardening });
                    let along = along(-shift * if motion == Motion::SteadyRolling { 0.1 } else { 1.0 });
                    let friction = Friction { layer, motion, branch, prescribed: along, ..Friction::new(MU) };
                    let scene = Scene { grid, pressure: &pressure, friction };
                    let (outcome, report, _) = scene.solve(TOLERANCE);
                    assert_eq!(outcome, Outcome::Converged, "{m} {motion:?} {hardening} {branch:?}: {report:?}");
                    report.force[0]
                };
                let near = of(Branch::Near);
                for branch in [Branch::Low, Branch::High] {
                    assert!((of(branch) - near).abs() <= 1e-4 * near.abs(), "{m} {motion:?} {hardening} {branch:?}");
                }
            }
        }
    }
}
