//! A callback cancels once, at any of its calls. It is not called again, and the last iterate is returned as CANCELLED.

use contact_normal::grid::Grid;
use contact_normal::scene::{
    Bodies, Each, Friction, Layer, Load, Motion, Period, Prescribed, PressureLimit, Previous, Scene,
};
use contact_normal::solver::{
    cost_of_accuracy, solve, solve_friction_batch, solve_tangential, solve_to_accuracy, Accuracy, ActiveSet, Entry,
    Guess, InitialGuess, Method, Options, Outcome, Progress, ProgressCallback, Quantity, Solver,
};
use contact_normal::stress::{subsurface_stress, Body, Loads, Wanted};
use contact_normal::threads::Threads;

use super::support::ball;

const LIKE: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
const UNLIKE: Bodies = Bodies { shear_modulus: [1.0, 4.0], poisson_ratio: [0.1, 0.4] };
/// With a Poisson's ratio of 0 tractions displace the surface in their own direction only.
const WITHOUT_POISSON: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.0; 2] };

/// Solves once to count the calls of the callback, then once for each of them, cancelled at that call. `run` solves and returns the outcome. Returns
/// the number of calls.
fn cancelled_once(what: &str, mut run: impl FnMut(ProgressCallback<'_>) -> Outcome) -> usize {
    let mut all = 0;
    let whole = run(&mut |_: &Progress| {
        all += 1;
        false
    });
    assert_ne!(whole, Outcome::Cancelled, "{what}");
    for at in 1..=all {
        let mut calls = 0;
        let stop = run(&mut |_: &Progress| {
            calls += 1;
            calls == at
        });
        // The last call for stresses comes when all depths are done, so that there is nothing left to cancel.
        let expected = if what == "stresses" && at == all { Outcome::Converged } else { Outcome::Cancelled };
        assert_eq!((stop, calls), (expected, at), "{what}: cancelled at call {at} of {all}");
    }
    all
}

fn pushed(motion: Motion, by_force: bool) -> Friction<'static> {
    let prescribed = match (by_force, motion) {
        (true, _) => [Prescribed::Force(0.005), Prescribed::Force(-0.002)],
        (_, Motion::Shift) => [Prescribed::Creepage(-0.004), Prescribed::Creepage(0.002)],
        _ => [Prescribed::Creepage(-0.02), Prescribed::Creepage(0.01)],
    };
    Friction { motion, prescribed, spin: if by_force { 0.0 } else { 1e-3 }, ..Friction::new(0.4) }
}

/// Solves on a handle. The result must be complete: all numbers are finite, and pressures and tractions are within their bounds.
fn on_a_handle<'s>(
    scene: &Scene<'s>,
    options: &Options,
    fixed: bool,
) -> impl FnMut(ProgressCallback<'_>) -> Outcome + use<'s> {
    let n = scene.grid.len();
    let scene = scene.clone();
    let options = *options;
    let contact: Vec<bool> = (0..n).map(|i| (6..20).contains(&(i % 28)) && (8..18).contains(&(i / 28))).collect();
    move |progress| {
        let mut solver = Solver::new(&scene, &options).unwrap();
        let pressure = vec![0.0; n];
        let guess = fixed.then_some(Guess { pressure: &pressure, contact: &contact });
        let (stop, report) = solver.solve(&scene, &options, guess, Some(progress)).unwrap();
        assert!(solver.has_solved());
        let state = solver.state();
        assert!(state.p.iter().chain(&state.u).all(|value| value.is_finite()) && state.approach.is_finite());
        assert_eq!(report.friction.is_some(), scene.friction.is_some());
        if let Some(friction) = &scene.friction {
            let found = solver.friction().unwrap();
            for (i, (q, s)) in found.traction.iter().zip(&found.slip).enumerate() {
                assert!(q[0].hypot(q[1]) <= friction.coefficient.at(i) * state.p[i].max(0.0));
                assert!(s[0].is_finite() && s[1].is_finite());
            }
        }
        stop
    }
}

#[test]
fn the_normal_problem_by_every_method() {
    let (grid, h) = ball(28, 0.1);
    let limit = Some(PressureLimit(Each::Uniform(0.01)));
    for load in [Load::Force(0.03), Load::Approach(0.015)] {
        let plain = Scene::new(grid, &h, LIKE, load);
        // The limit is above the largest pressure of the solution: iterates reach it, but the result has the pressures of the scene without a limit.
        let largest = solve(&plain, &Options::default()).expect("a solve").2.measures.max_pressure;
        let above = Some(PressureLimit(Each::Uniform(1.0001 * largest)));
        let scenes = [
            ("plain", plain.clone(), false),
            ("a limit", Scene { pressure_limit: limit, ..plain.clone() }, false),
            ("a limit above", Scene { pressure_limit: above, ..plain.clone() }, false),
            ("a fixed area", plain.clone(), true),
            ("a period", Scene { period: Some(Period { x: true, y: false }), ..plain.clone() }, false),
            ("a layer", Scene { layer: Some(Layer(Each::Uniform(0.01))), ..plain }, false),
        ];
        for (name, scene, fixed) in &scenes {
            for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg] {
                if scene.period.is_some() && matches!(method, Method::Multigrid | Method::FullMultigrid) {
                    continue;
                }
                let active_set = if *fixed { ActiveSet::Fixed } else { ActiveSet::default() };
                let options = Options { method, active_set, estimates: true, ..Options::default() };
                let what = format!("{name} {load:?} {method:?}");
                assert!(cancelled_once(&what, on_a_handle(scene, &options, *fixed)) > 0, "{what}");
            }
        }
    }
}

#[test]
fn friction_of_like_and_unlike_bodies() {
    let (grid, h) = ball(28, 0.1);
    for bodies in [LIKE, UNLIKE, WITHOUT_POISSON] {
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            for by_force in [false, true] {
                for sensitivities in [false, true] {
                    let friction = Friction { sensitivities, ..pushed(motion, by_force) };
                    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(0.03)) };
                    let what = format!("{bodies:?} {motion:?} {by_force} {sensitivities}");
                    let options = Options { estimates: true, ..Options::default() };
                    assert!(cancelled_once(&what, on_a_handle(&scene, &options, false)) > 10, "{what}");
                }
            }
        }
    }
}

#[test]
fn steps_in_time_and_what_a_cancelled_one_leaves() {
    let (grid, h) = ball(28, 0.1);
    for bodies in [LIKE, UNLIKE] {
        let friction = Friction { spin: 0.0, ..pushed(Motion::TransientRolling, false) };
        let first = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Approach(0.015)) };
        let next = Scene {
            friction: Some(Friction { previous: Previous::Kept, ..friction }),
            load: Load::Approach(0.016),
            ..first.clone()
        };
        let options = Options::default();
        let again = Options { initial_guess: InitialGuess::Previous, ..options };
        cancelled_once(&format!("{bodies:?}"), |progress| {
            let mut solver = Solver::new(&first, &options).unwrap();
            solver.solve(&first, &options, None, None).unwrap();
            let (stop, _) = solver.solve(&next, &again, None, Some(progress)).unwrap();
            // The next step can continue from the result of a cancelled one.
            let (end, _) = solver.solve(&next, &again, None, None).unwrap();
            assert_eq!(end, Outcome::Converged);
            stop
        });
    }
}

#[test]
fn the_tangential_problem_alone_and_tables() {
    let (grid, h) = ball(28, 0.1);
    let pressure: Vec<f64> = h.iter().map(|h| 0.02 * (1.0 - h / 0.01).max(0.0).sqrt()).collect();
    for bodies in [LIKE, UNLIKE] {
        for motion in [Motion::Shift, Motion::SteadyRolling] {
            let friction = pushed(motion, false);
            let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(0.03)) };
            cancelled_once(&format!("{bodies:?} {motion:?}"), |progress| {
                solve_tangential(&scene, &pressure, &Options::default(), Some(progress)).unwrap().0
            });
            let entries: Vec<Entry> =
                (0..5).map(|k| Entry { amount: [-1e-3 * f64::from(k + 1), 0.0], spin: 0.0 }).collect();
            for pressure in [Some(&pressure[..]), None] {
                cancelled_once(&format!("a table, {bodies:?} {motion:?} {}", pressure.is_some()), |progress| {
                    let options = Options::default();
                    // The callback is also called after the last entry, when there is nothing left to cancel.
                    solve_friction_batch(&scene, pressure, &entries, &options, Some(progress), |_, _, _| ()).unwrap().0
                });
            }
        }
    }
}

#[test]
fn a_wanted_accuracy_its_price_list_and_stresses() {
    let (grid, h) = ball(24, 0.1);
    let scene = Scene::new(grid, &h, LIKE, Load::Force(0.03));
    let accuracy = Accuracy { max_elements: 1 << 14, ..Accuracy::new(1e-3) };
    let calls = cancelled_once("an accuracy", |progress| {
        solve_to_accuracy(&scene, &Options::default(), &accuracy, None, Some(progress)).unwrap().stop
    });
    assert!(calls > 10, "{calls}");
    let surface = |grid: &Grid, h: &mut [f64]| {
        for (i, h) in h.iter_mut().enumerate() {
            let x = ((i % grid.mx) as f64 + 0.5 - 0.5 * grid.mx as f64) * grid.dx;
            let y = ((i / grid.mx) as f64 + 0.5 - 0.5 * grid.my as f64) * grid.dy;
            *h = (x * x + y * y) / 100.0;
        }
    };
    for at in 1..6 {
        let mut calls = 0;
        let mut cancels = |grid: &Grid, h: &mut [f64]| {
            surface(grid, h);
            calls += 1;
            calls == at
        };
        let wanted = (Quantity::Force, &[1e-2, 1e-3][..]);
        let (stop, _) =
            cost_of_accuracy(&scene, &Options::default(), &accuracy, wanted, Some(&mut cancels), None).unwrap();
        assert!(stop == Outcome::Cancelled && calls == at || calls < at, "{stop:?} {calls} {at}");
    }
    let body = Body { grid, poisson_ratio: 0.3, periodic: false };
    let pressure = vec![1.0; grid.len()];
    let loads = Loads { pressure: Some(&pressure), traction_x: None, traction_y: None, patches: None };
    let depths = [0.1, 0.2, 0.3, 0.4];
    cancelled_once("stresses", |progress| {
        let all =
            subsurface_stress(&body, &loads, &depths, &Wanted::default(), &Threads::One, Some(progress), |_, _| ());
        if all.unwrap() {
            Outcome::Converged
        } else {
            Outcome::Cancelled
        }
    });
}
