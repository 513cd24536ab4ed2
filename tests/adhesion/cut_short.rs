//! Solves with few cycles: the state agrees with the status, and more cycles do not make the result worse.

use contact_normal::adhesion::Law;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{Guess, InitialGuess, Options, Outcome, Solver};

use super::support::{adhesion, bodies, Sphere};

/// Waves that are pressed together have two states for one force. In one of them the force falls as the bodies approach, so that it is unstable. The
/// solve starts there and looks for the other state. If its cycles end on the way, the returned state does not have the force.
#[test]
fn the_stable_state_of_a_force_is_found_or_cycles_end() {
    let n = 32;
    let d = std::f64::consts::TAU / n as f64;
    let grid = Grid::new(n, n, d, d).expect("a grid");
    let wave = |k: usize| 1.0 - (k as f64 * d).cos();
    let h: Vec<f64> = (0..n * n).map(|i| 0.02 * (wave(i % n) + wave(i / n))).collect();
    let own = adhesion(Law::Exponential, 3e-4, 0.0);
    let apart = contact_normal::scene::Adhesion { start: contact_normal::adhesion::Start::Apart, ..own };
    let scene = |adhesion, load| Scene {
        adhesion: Some(adhesion),
        period: Some(Period { x: true, y: true }),
        ..Scene::new(grid, &h, bodies(1.0), load)
    };
    let mut ends = [0, 0];
    for max_cycles in [1, 2, 3, 4, 6, 1000] {
        let first = scene(apart, Load::Approach(0.039));
        let mut solver = Solver::new(&first, &Options::default()).expect("a solver");
        let (outcome, report) = solver.solve(&first, &Options::default(), None, None).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        let force = report.measures.force;
        let options = Options { initial_guess: InitialGuess::Previous, max_cycles, ..Options::default() };
        let next = scene(own, Load::Force(force));
        let (outcome, report) = solver.solve(&next, &options, None, None).expect("a solve");
        let (off, residual) = (report.measures.force / force - 1.0, report.measures.certificate.residual);
        println!("{max_cycles}: {outcome:?} {off:e} {residual:e}");
        match outcome {
            Outcome::Converged => {
                ends[0] += 1;
                assert!(off.abs() < 1e-5 && residual <= 1e-6, "{max_cycles}: {off:e} {residual:e}");
            }
            _ => ends[1] += 1,
        }
    }
    assert!(ends[0] > 0 && ends[1] > 0, "{ends:?}");
}

/// If the cycles end while the library follows the unloading to a given pull, the result is the state with the strongest pull that was found, not an
/// iterate between two states.
#[test]
fn more_cycles_do_not_lose_the_state_of_a_pull() {
    let n = 32;
    let grid = Grid::new(n, n, 0.1, 0.1).expect("a grid");
    let own = adhesion(Law::Exponential, 2e-2, 0.0);
    let equal = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
    for roughness in [0.0, 0.05] {
        let at = |k: usize| (k as f64 - 15.5) * 0.1;
        let random = |i: usize| ((i as f64 * 12.9898).sin() * 43758.5453).fract();
        let height = |i: usize| 0.5 * (at(i % n).powi(2) + at(i / n).powi(2)) + roughness * random(i);
        let h: Vec<f64> = (0..n * n).map(height).collect();
        let scene = |load| Scene { adhesion: Some(own), ..Scene::new(grid, &h, equal, load) };
        let options = Options::default();
        let none = scene(Load::Approach(0.0));
        let mut solver = Solver::new(&none, &options).expect("a solver");
        let strongest = solver.pull_off(&none, &options, None).expect("a pull-off").1.measures.force;
        let scene = scene(Load::Force(0.97 * strongest));
        let mut was_state = false;
        for max_cycles in 3..40 {
            let mut solver = Solver::new(&scene, &options).expect("a solver");
            let (outcome, report) =
                solver.solve(&scene, &Options { max_cycles, ..options }, None, None).expect("a solve");
            let found = report.adhesion.expect("adhesion");
            let is_state = found.law_residual <= 1e-6 && report.measures.force < 0.0;
            println!("{roughness} {max_cycles}: {outcome:?} {:e} {:e}", found.law_residual, report.measures.force);
            assert!(is_state || !was_state, "{roughness} {max_cycles}: {:e}", found.law_residual);
            was_state |= is_state;
        }
        assert!(was_state);
    }
}

/// A solve from given pressures starts at the approach of their contact, as the solve of a handle does from its own. So a replay of a dump follows
/// the path of the recorded call.
#[test]
fn given_pressures_follow_the_path_of_previous_pressures() {
    let sphere = Sphere::by_tabor(1.0, 48, 3.0);
    let (first, next) = (sphere.scene(Load::Force(-1.1)), sphere.scene(Load::Force(-1.2)));
    let mut solver = Solver::new(&first, &Options::default()).expect("a solver");
    assert_eq!(solver.solve(&first, &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
    let (pressure, contact) = (solver.state().p.clone(), solver.state().contact.clone());
    let mut other = Solver::new(&first, &Options::default()).expect("a solver");
    let of = |initial_guess| Options { initial_guess, ..Options::default() };
    let guess = Guess { pressure: &pressure, contact: &contact };
    let given = other.solve(&next, &of(InitialGuess::Given), Some(guess), None).expect("a solve");
    let previous = solver.solve(&next, &of(InitialGuess::Previous), None, None).expect("a solve");
    assert_eq!((given.0, previous.0), (Outcome::Converged, Outcome::Converged));
    let (given, previous) = (given.1.count.cycles, previous.1.count.cycles);
    assert!(given <= previous + 1, "{given} {previous}");
    assert!((other.state().approach - solver.state().approach).abs() < 1e-5);
}

/// Flat bodies with two periods part at once, at a pull of all their attraction. At a stronger one the contact problem with this attraction has no
/// solution.
#[test]
fn flat_bodies_with_two_periods_part_at_once() {
    let grid = Grid::new(4, 4, 1.0, 1.0).expect("a grid");
    let h = [0.0; 16];
    let scene = Scene {
        adhesion: Some(adhesion(Law::Exponential, 1e-3, 1e-3)),
        period: Some(Period { x: true, y: true }),
        ..Scene::new(grid, &h, bodies(1.0), Load::Force(0.01))
    };
    let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
    let (outcome, report) = solver.pull_off(&scene, &Options::default(), None).expect("a pull-off");
    // w/rho is 1, on an area of 16.
    assert_eq!(outcome, Outcome::Converged);
    assert!((report.measures.force + 16.0).abs() < 1e-12, "{:e}", report.measures.force);
}

/// All contact problems on the way to a pull share the cycles that the solve is allowed.
#[test]
fn a_descent_takes_no_more_cycles_than_it_may() {
    let n = 64;
    let grid = Grid::new(n, n, 0.1, 0.1).expect("a grid");
    let at = |k: usize| (k as f64 - 31.5) * 0.1;
    let random = |i: usize| ((i as f64 * 12.9898).sin() * 43758.5453).fract();
    let h: Vec<f64> = (0..n * n).map(|i| 0.05 * (at(i % n).powi(2) + at(i / n).powi(2)) + 0.1 * random(i)).collect();
    let apart = contact_normal::scene::Adhesion {
        start: contact_normal::adhesion::Start::Apart,
        ..adhesion(Law::Exponential, 0.05, 0.1)
    };
    let scene = Scene { adhesion: Some(apart), ..Scene::new(grid, &h, bodies(0.375), Load::Approach(0.5)) };
    for max_cycles in [1, 2, 10, 40] {
        let options = Options { max_cycles, ..Options::default() };
        let (_, outcome, report) = contact_normal::solver::solve(&scene, &options).expect("a solve");
        assert!(report.count.cycles <= max_cycles as u64, "{max_cycles}: {outcome:?} {}", report.count.cycles);
    }
}
