//! If a solve with a friction law or a plastic layer is cut short or has a loose tolerance, tractions are still at most mu p with the coefficient at
//! rest. The elements in stick and in slip add up to the contact area.

use contact_normal::effects::{Fall, FrictionLaw, Motion, PlasticLayer};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Scene};
use contact_normal::solver::{solve, Options};

const MU: f64 = 0.3;

/// A ball of steel on a plate of steel.
fn ball((mx, my): (usize, usize), d: f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(mx, my, d, d).expect("a grid");
    let at = |k: usize, m: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
    (grid, (0..mx * my).map(|i| (at(i % mx, mx).powi(2) + at(i / mx, my).powi(2)) / 100.0).collect())
}

fn check(scene: &Scene<'_>, options: &Options, told: &str) -> usize {
    let (solver, outcome, report) = solve(scene, options).expect("a solvable scene");
    let (p, found) = (&solver.state().p, solver.friction().expect("friction"));
    let mut beyond = 0.0_f64;
    for (q, p) in found.traction.iter().zip(p) {
        beyond = beyond.max(q[0].hypot(q[1]) - MU * p);
    }
    // The `hypot` of the test rounds: `beyond` is at most a few units of round-off of the largest pressure.
    assert!(beyond <= 1e-15 * report.measures.max_pressure, "{told} {outcome:?}: {beyond:e}");
    let of = report.friction.expect("a report of friction").certificate;
    let contacts = p.iter().filter(|p| **p > 0.0).count();
    assert_eq!(of.stick_count + of.slip_count, contacts, "{told} {outcome:?}");
    usize::from(outcome != contact_normal::solver::Outcome::Converged)
}

#[test]
fn tractions_are_bounded_where_cycles_end_and_at_loose_tolerances() {
    let steel = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };
    let mut cut_short = 0;
    for (shape, d, force) in [((24, 24), 0.02, 11.52), ((16, 2), 0.05, 6.4)] {
        let (grid, h) = ball(shape, d);
        let normal = Scene::new(grid, &h, steel, Load::Force(force));
        let largest = solve(&normal, &Options::default()).expect("a solve").2.measures.max_pressure;
        for (hardening, yields) in [(1e4, 0.1), (1e6, 0.02), (1e7, 0.1)] {
            let falls = FrictionLaw::new(Fall::Rational, (0.4, 0.6), 1e-3, 1.0);
            for law in [None, Some(falls), Some(FrictionLaw { memory_distance: 0.05, memory_speed: 1e-3, ..falls })] {
                for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
                    for prescribed in [Prescribed::Force(0.6 * MU * force), Prescribed::Creepage(1e-3)] {
                        let layer = Some(PlasticLayer { yield_limit: yields * MU * largest, hardening });
                        let prescribed = [prescribed, Prescribed::Creepage(0.0)];
                        let friction = Friction { motion, prescribed, law, layer, ..Friction::new(MU) };
                        let scene = Scene { friction: Some(friction), ..normal.clone() };
                        for (max_cycles, tolerance) in [(1, 1e-6), (5, 1e-6), (20, 1e-6), (1000, 1e-3), (1000, 1e-6)] {
                            let told = format!("{shape:?} {hardening:e} {yields} {law:?} {motion:?} {max_cycles}");
                            cut_short += check(&scene, &Options { max_cycles, tolerance, ..Options::default() }, &told);
                        }
                    }
                }
            }
        }
    }
    assert!(cut_short > 50, "{cut_short}");
}

/// With memory a particle keeps the coefficient of its last place, which is here twice that of its new one. The bound of its traction is that of the
/// particle's coefficient.
#[test]
fn with_memory_the_bound_is_that_of_what_particles_bring() {
    let (grid, h) = ball((24, 24), 0.02);
    let steel = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };
    let before = vec![2.0 * MU; grid.len()];
    let law = FrictionLaw {
        memory_distance: 1.0,
        memory_speed: 1e-6,
        ..FrictionLaw::new(Fall::Rational, (0.4, 0.6), 1e-3, 1.0)
    };
    for motion in [Motion::Shift, Motion::TransientRolling] {
        let friction = Friction {
            motion,
            prescribed: [Prescribed::Creepage(0.05), Prescribed::Creepage(0.0)],
            law: Some(law),
            coefficients_before: Some(&before),
            ..Friction::new(MU)
        };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, steel, Load::Force(11.52)) };
        let (_, outcome, report) = solve(&scene, &Options::default()).expect("a solvable scene");
        assert_eq!(outcome, contact_normal::solver::Outcome::Converged, "{motion:?}");
        let force = report.friction.expect("a report of friction").force[0].abs();
        assert!(force > 1.5 * MU * 11.52, "{motion:?}: {force}");
    }
}
