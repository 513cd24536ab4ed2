//! Initial guesses with elements at their pressure limit. These elements begin at their limit, so that a solution needs no cycles, and solves that
//! were cut short continue.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, PressureLimit, Scene};
use contact_normal::solver::{Guess, InitialGuess, Method, Options, Outcome, Solver};

const M: usize = 32;

fn bumpy() -> (Grid, Vec<f64>) {
    let grid = Grid::new(M, M, 1.0 / M as f64, 1.0 / M as f64).expect("a grid");
    let place = |k: usize| (k as f64 + 0.5) / M as f64 - 0.5;
    let of = |i: usize| {
        let (x, y) = (place(i % M), place(i / M));
        x * x + y * y + 0.002 * (37.0 * x).sin() * (41.0 * y).cos()
    };
    (grid, (0..grid.len()).map(of).collect())
}

/// Calls `visit` with each scene: by approach and by force, with limits of a half and of four fifths of the largest pressure.
fn each(visit: impl Fn(&Scene<'_>, &str)) {
    let (grid, h) = bumpy();
    let scene = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.05));
    let (free, _) = crate::support::run(&scene, &Options::default());
    let largest = free.state().p.iter().copied().fold(0.0, f64::max);
    for part in [0.5, 0.8] {
        let pressure_limit = Some(PressureLimit(Each::Uniform(part * largest)));
        for load in [Load::Approach(0.05), Load::Force(0.9 * free.state().force())] {
            visit(&Scene { pressure_limit, load, ..scene.clone() }, &format!("{part} {load:?}"));
        }
    }
}

/// The elements of a guess that are at their limit begin there, so that a start from the solution takes no cycles.
#[test]
fn a_solution_is_one_at_once() {
    each(|scene, what| {
        for method in [Method::Auto, Method::ProjectedCg, Method::FullMultigrid, Method::Norm] {
            let tight = Options { method, tolerance: 1e-10, ..Options::default() };
            let (solved, _) = crate::support::run(scene, &tight);
            let (pressure, contact) = (solved.state().p.clone(), solved.state().contact.clone());
            assert!(solved.state().at_limit.iter().filter(|at_limit| **at_limit).count() > 10, "{what}");
            let inside: Vec<bool> = pressure.iter().map(|p| *p > 0.0).collect();
            // Two contact areas for the guess: that of C callers, in which elements at their limit are in contact, and that of the state.
            for contact in [&inside, &contact] {
                let options = Options { tolerance: 1e-6, initial_guess: InitialGuess::Given, ..tight };
                let mut solver = Solver::new(scene, &options).expect("a solver");
                let guess = Guess { pressure: &pressure, contact };
                let (outcome, report) = solver.solve(scene, &options, Some(guess), None).expect("a scene");
                assert_eq!(outcome, Outcome::Converged, "{what} {method:?}");
                assert!(contact != &inside || report.count.cycles == 0, "{what} {method:?}: {report:?}");
            }
            let mut solver = Solver::new(scene, &tight).expect("a solver");
            let previous = Options { initial_guess: InitialGuess::Previous, ..tight };
            solver.solve(scene, &tight, None, None).expect("a scene");
            let (outcome, report) = solver.solve(scene, &previous, None, None).expect("a scene");
            assert_eq!((outcome, report.count.cycles), (Outcome::Converged, 0), "{what} {method:?}");
        }
    });
}

/// Solves that were cut short after few cycles continue from their results, and converge.
#[test]
fn solves_that_are_cut_go_on() {
    each(|scene, what| {
        for method in [Method::Auto, Method::FullMultigrid] {
            for max_cycles in [2, 3, 5] {
                let options =
                    Options { method, max_cycles, initial_guess: InitialGuess::Previous, ..Options::default() };
                let mut solver = Solver::new(scene, &options).expect("a solver");
                let ended = (0..60).position(|_| {
                    let (outcome, _) = solver.solve(scene, &options, None, None).expect("a scene");
                    outcome == Outcome::Converged
                });
                assert!(ended.is_some(), "{what} {method:?} by {max_cycles}");
            }
        }
    });
}
