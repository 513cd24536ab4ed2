//! The time loop of a host, which solves normal (NORM) and tangential problems (TANG) in turns on one handle. Solves without friction do not change
//! the tractions from which the next step continues.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{Options, Outcome, Solver};

use super::support::ball;

fn step(previous: Previous<'static>, k: usize) -> Friction<'static> {
    let prescribed = [Prescribed::Creepage(-0.002 * (k + 1) as f64), Prescribed::Creepage(0.001)];
    Friction { motion: Motion::TransientRolling, prescribed, previous, ..Friction::new(0.3) }
}

fn converged<'a>(solver: &'a mut Solver, scene: &Scene<'_>) -> &'a Solver {
    let (stop, _) = solver.solve(scene, &Options::default(), None, None).expect("a scene");
    assert_eq!(stop, Outcome::Converged);
    solver
}

/// The tractions and slips of three steps, as bits: NORM and TANG on one handle, or, if `alone`, TANG on a handle of its own.
fn three_steps((grid, h): &(Grid, Vec<f64>), bodies: Bodies, alone: bool) -> Vec<Vec<[u64; 4]>> {
    let scene = |k: usize, friction| Scene {
        friction,
        ..Scene::new(*grid, h, bodies, Load::Approach(0.01 + 0.001 * k as f64))
    };
    let mut of_both = Solver::new(&scene(0, None), &Options::default()).expect("a solver");
    let mut of_tang = Solver::new(&scene(0, None), &Options::default()).expect("a solver");
    let mut steps = Vec::new();
    for k in 0..3 {
        let pressure = converged(&mut of_both, &scene(k, None)).state().p.clone();
        assert!(of_both.friction().is_none(), "the last solve had no friction");
        let rolling = scene(k, Some(step(if k == 0 { Previous::None } else { Previous::Kept }, k)));
        let solver = if alone { &mut of_tang } else { &mut of_both };
        let (stop, found, _) = solver.solve_tangential(&rolling, &pressure, &Options::default(), None).expect("a step");
        assert_eq!(stop, Outcome::Converged);
        let of_element = |(q, s): (&[f64; 2], &[f64; 2])| [q[0], q[1], s[0], s[1]].map(f64::to_bits);
        steps.push(found.traction.iter().zip(&found.slip).map(of_element).collect());
    }
    steps
}

#[test]
fn a_normal_problem_between_two_steps_leaves_their_tractions() {
    let ball = ball(24, 0.1);
    for bodies in [Bodies::same(1.0, 0.3), Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.2, 0.4] }] {
        assert!(three_steps(&ball, bodies, false) == three_steps(&ball, bodies, true), "{bodies:?}");
    }
}

/// The same with solves of both problems at once: a solve without friction between two steps has no effect on the second step.
#[test]
fn a_step_continues_after_solves_without_friction() {
    let (grid, h) = ball(24, 0.1);
    let scene = |friction| Scene { friction, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.012)) };
    let traction = |between: bool| {
        let mut solver = Solver::new(&scene(None), &Options::default()).expect("a solver");
        converged(&mut solver, &scene(Some(step(Previous::None, 0))));
        if between {
            converged(&mut solver, &scene(None));
        }
        let solver = converged(&mut solver, &scene(Some(step(Previous::Kept, 1))));
        solver.friction().expect("tractions").traction.clone()
    };
    assert!(traction(true) == traction(false));
}
