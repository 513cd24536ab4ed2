//! A solve without a guess, or from a given one, has the same bits on any handle, whatever the handle solved before, and in a batch with any number
//! of threads.

use contact_normal::scene::{Bodies, Each, Friction, Load, Motion, Prescribed, PressureLimit, Previous, Scene};
use contact_normal::solver::{solve, Guess, InitialGuess, Method, Options, Problem, Solver};

use super::support::ball;

const UNLIKE: Bodies = Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.1, 0.45] };

/// The bits of the pressures, displacements, tractions and slips.
fn bits(solver: &Solver) -> Vec<u64> {
    let found = solver.friction().expect("tractions");
    let fields = found.traction.iter().chain(&found.slip).flatten();
    solver.state().p.iter().chain(&solver.state().u).chain(fields).map(|value| value.to_bits()).collect()
}

fn pushed(motion: Motion) -> Friction<'static> {
    let creepage = if motion == Motion::Shift { 0.004 } else { 0.01 };
    let prescribed = [Prescribed::Creepage(-creepage), Prescribed::Creepage(0.4 * creepage)];
    Friction { motion, prescribed, ..Friction::new(0.4) }
}

#[test]
fn on_a_handle_that_solved_other_scenes() {
    let (grid, h) = ball(26, 0.1);
    let rough: Vec<f64> = h.iter().enumerate().map(|(i, h)| h + 4e-3 * (7.0 * i as f64).sin().powi(2)).collect();
    let guess: Vec<f64> = h.iter().map(|h| (0.01 - h).max(0.0) * 2.0).collect();
    let inside: Vec<bool> = guess.iter().map(|p| *p > 0.0).collect();
    let motions = [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling];
    let limit = Some(PressureLimit(Each::Uniform(0.012)));
    for method in [Method::Auto, Method::Norm, Method::FullMultigrid] {
        for initial_guess in [InitialGuess::None, InitialGuess::Given] {
            for (k, motion) in motions.into_iter().enumerate() {
                let options = Options { method, initial_guess, ..Options::default() };
                let scene = Scene {
                    friction: Some(pushed(motion)),
                    pressure_limit: limit.filter(|_| k == 1),
                    ..Scene::new(grid, &h, UNLIKE, if k == 2 { Load::Force(0.03) } else { Load::Approach(0.01) })
                };
                let guess = Some(Guess { pressure: &guess, contact: &inside });
                let mut new = Solver::new(&scene, &options).unwrap();
                new.solve(&scene, &options, guess, None).unwrap();
                let expected = bits(&new);
                // What the handle solves before: other surfaces, loads, limits and motions, and steps in time.
                let others = [
                    (Scene { friction: None, undeformed_distance: &rough, ..scene.clone() }, InitialGuess::None),
                    (
                        Scene { friction: Some(pushed(Motion::Shift)), load: Load::Force(0.05), ..scene.clone() },
                        InitialGuess::Previous,
                    ),
                    (
                        Scene {
                            friction: Some(Friction { previous: Previous::Kept, ..pushed(motion) }),
                            undeformed_distance: &rough,
                            ..scene.clone()
                        },
                        InitialGuess::Previous,
                    ),
                    (Scene { pressure_limit: limit, load: Load::Approach(0.02), ..scene.clone() }, InitialGuess::None),
                ];
                for (other, initial_guess) in others {
                    new.solve(&other, &Options { initial_guess, ..options }, None, None).unwrap();
                    new.solve(&scene, &options, guess, None).unwrap();
                    assert!(bits(&new) == expected, "{method:?} {initial_guess:?} {motion:?}");
                }
            }
        }
    }
}

#[test]
fn in_batches_of_any_number_of_threads() {
    let (grid, h) = ball(22, 0.12);
    let surfaces: Vec<Vec<f64>> = (0..9)
        .map(|k| h.iter().enumerate().map(|(i, h)| h + 2e-3 * ((k + 2) as f64 * i as f64).sin().powi(2)).collect())
        .collect();
    let motions = [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling];
    let scenes: Vec<Scene<'_>> = surfaces
        .iter()
        .enumerate()
        .map(|(k, h)| Scene {
            friction: Some(pushed(motions[k % 3])),
            ..Scene::new(grid, h, UNLIKE, Load::Approach(0.008 + 1e-3 * k as f64))
        })
        .collect();
    let alone: Vec<Vec<u64>> = scenes.iter().map(|scene| bits(&solve(scene, &Options::default()).unwrap().0)).collect();
    for threads in [1, 2, 3] {
        let options = Options { threads, ..Options::default() };
        let mut solver = Solver::new(&scenes[0], &options).unwrap();
        for _ in 0..3 {
            let problems: Vec<Problem<'_>> =
                scenes.iter().map(|scene| Problem { scene: scene.clone(), guess: None }).collect();
            let found = solver.solve_batch(&problems, &options, |i, outcome, state| {
                outcome.unwrap();
                // The callback of a batch gets pressures and displacements, but no tractions.
                assert!(state.p.iter().zip(&alone[i]).all(|(p, bits)| p.to_bits() == *bits), "{i}, {threads} threads");
                state
                    .p
                    .iter()
                    .chain(&state.u)
                    .map(|value| value.to_bits())
                    .eq(alone[i][..2 * state.p.len()].iter().copied())
            });
            assert!(found.unwrap().into_iter().all(|same| same), "{threads} threads");
        }
    }
}

/// A batch does not define which scene a worker has solved before, so that it refuses friction that continues from earlier tractions.
#[test]
fn a_batch_refuses_friction_that_continues() {
    let (grid, h) = ball(20, 0.12);
    for bodies in [UNLIKE, Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] }] {
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            let scene = Scene { friction: Some(pushed(motion)), ..Scene::new(grid, &h, bodies, Load::Approach(0.01)) };
            let goes_on = Friction { previous: Previous::Kept, ..pushed(motion) };
            let continues = Scene { friction: Some(goes_on), ..scene.clone() };
            let options = Options { threads: 2, ..Options::default() };
            let mut solver = Solver::new(&scene, &options).unwrap();
            // After this solve the solver itself has tractions to continue from. The first batch below leaves tractions in its workers.
            solver.solve(&scene, &options, None, None).unwrap();
            for scenes in [[&scene; 4], [&continues, &scene, &continues, &scene]] {
                let problems: Vec<Problem<'_>> =
                    scenes.iter().map(|scene| Problem { scene: (*scene).clone(), guess: None }).collect();
                let found = solver.solve_batch(&problems, &options, |_, outcome, _| outcome.map(|_| ())).unwrap();
                for (outcome, scene) in found.into_iter().zip(scenes) {
                    match (outcome, scene.friction.as_ref().unwrap().previous) {
                        (Ok(()), Previous::None) => {}
                        (Err(error), Previous::Kept) => {
                            let message = error.to_string();
                            let said = ["friction->continues", "batch", "previous_traction"];
                            assert!(said.iter().all(|word| message.contains(word)), "{message}");
                        }
                        other => panic!("{other:?}"),
                    }
                }
            }
            // The solver itself continues from its own result.
            solver.solve(&continues, &options, None, None).unwrap();
        }
    }
}
