//! Negative forces (pulls): the stable one of two equilibria is found, and none for a pull stronger than the pull-off force.

use contact_normal::adhesion::Law;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Scene};
use contact_normal::solver::{self, InitialGuess, Options, Outcome, Solver};

use super::certificate::{displacements, traction, worst};
use super::dense::{matrix, tangent};
use super::random::range_of_kappa;
use super::support::{adhesion, bodies, range_of, Sphere, MODULUS};

// The prototype's least force is -1.6641, at an approach of about -.45, on a path in steps. The unstable state of the force -1.4 is at -.9006.
#[test]
fn a_pull_finds_the_stable_state() {
    let sphere = Sphere::by_tabor(1.0, 64, 3.0);
    for (force, below) in [(-1.4, 0.2), (-1.6, -0.1), (-1.65, -0.3)] {
        let adhesion = Some(Adhesion { stiffness: true, ..sphere.adhesion });
        let scene = Scene { adhesion, ..sphere.scene(Load::Force(force)) };
        let (_, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        let (approach, found) = (report.measures.approach, report.adhesion.expect("adhesion"));
        println!(
            "force {force}: approach {approach}, {:.1} work, stiffness {:?}",
            report.count.work_units, found.stiffness
        );
        assert!(approach > -0.55 && approach < below, "{force}: {approach}");
        assert!(found.stiffness.is_some_and(|stiffness| stiffness > 0.0));
        assert!((report.measures.force - force).abs() < 1e-5);
        // A solve with this approach gives the same force.
        let (_, by_approach) = sphere.solve(Load::Approach(approach));
        assert!((by_approach.force - force).abs() < 1e-4, "{} {force}", by_approach.force);
    }
}

#[test]
fn the_stiffness_is_a_difference_of_forces() {
    let sphere = Sphere::by_tabor(1.0, 64, 3.0);
    let adhesion = Some(Adhesion { stiffness: true, ..sphere.adhesion });
    let at = |sphere: &Sphere, approach: f64| {
        let scene = Scene { adhesion, ..sphere.scene(Load::Approach(approach)) };
        let (_, _, report) =
            solver::solve(&scene, &Options { tolerance: 1e-8, ..Options::default() }).expect("a solve");
        (report.measures.force, report.adhesion.and_then(|found| found.stiffness).expect("a stiffness"))
    };
    // The prototype (t10.py) printed 1.105 and -1.800, as differences of forces, which jump with the contact area; hence 3 %.
    for (approach, printed) in [(0.4, 1.105), (-0.9, -1.8)] {
        let (_, stiffness) = at(&sphere, approach);
        assert!((stiffness - printed).abs() < 0.03 * f64::abs(printed), "{approach}: {stiffness} {printed}");
    }
    // On larger grids the library solves the linear systems in parts. Differences of forces are smoother there.
    let fine = Sphere::by_tabor(1.0, 192, 3.0);
    let [(below, _), (_, stiffness), (above, _)] = [0.3, 0.4, 0.5].map(|approach| at(&fine, approach));
    let slope = (above - below) / 0.2;
    assert!((stiffness - slope).abs() < 0.01 * slope, "{stiffness} {slope}");
}

#[test]
fn below_the_pull_off_the_message_says_what_holds() {
    let sphere = Sphere::by_tabor(1.0, 64, 3.0);
    let scene = sphere.scene(Load::Force(0.0));
    let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
    let (outcome, report) = solver.pull_off(&scene, &Options::default(), None).expect("a pull-off");
    assert_eq!(outcome, Outcome::Converged);
    let least = report.measures.force;
    println!("pull-off {least} at {}, {:.1} work", report.measures.approach, report.count.work_units);
    // -1.6641 is the least force on the prototype's path in steps of .1. The least force of all states is lower by the sag of a parabola between such
    // steps. Also the edge of the contact rests at rings of elements, so that one approach has several states: paths with other steps find -1.66398
    // to -1.66410.
    assert!(least < -1.6641 + 2e-4 && least > -1.6641 - 5e-3, "{least}");
    for factor in [1.05, 3.0, 1e3] {
        match solver::solve(&sphere.scene(Load::Force(factor * least)), &Options::default()) {
            Err(Error::Infeasible(message)) => {
                let named =
                    message.split("a pull of ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a number");
                let named: f64 = named.parse().expect("a number");
                assert!((named - least).abs() < 2e-3 * least.abs(), "{message}");
                let approach: f64 =
                    message.split("an approach of ").nth(1).and_then(|rest| rest.parse().ok()).expect("one");
                let (_, at) = sphere.solve(Load::Approach(approach));
                assert!((at.force - named).abs() < 1e-4 * least.abs(), "{message}: {}", at.force);
            }
            other => panic!("{factor}: {:?}", other.map(|(_, outcome, report)| (outcome, report.measures))),
        }
    }
    let (_, outcome, report) =
        solver::solve(&sphere.scene(Load::Force(0.99 * least)), &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged);
    assert!((report.measures.force - 0.99 * least).abs() < 1e-5);
}

#[test]
fn a_handle_follows_a_pull_from_step_to_step() {
    let sphere = Sphere::by_tabor(1.0, 64, 3.0);
    let mut solver = Solver::new(&sphere.scene(Load::Force(0.0)), &Options::default()).expect("a solver");
    let mut last = f64::INFINITY;
    for (k, force) in [1.0, 0.0, -0.5, -1.0, -1.3, -1.5, -1.6].into_iter().enumerate() {
        let initial_guess = if k == 0 { InitialGuess::None } else { InitialGuess::Previous };
        let options = Options { initial_guess, ..Options::default() };
        let (outcome, report) = solver.solve(&sphere.scene(Load::Force(force)), &options, None, None).expect("a step");
        assert_eq!(outcome, Outcome::Converged);
        println!("{force}: {} {} products", report.measures.approach, report.count.matrix_products);
        assert!(report.measures.approach < last && report.measures.approach > -0.55);
        last = report.measures.approach;
    }
}

/// Two balls side by side on a grid. For each: its radius, and the height of its lowest point.
fn balls(n: usize, half_width: f64, balls: [(f64, f64); 2]) -> (Grid, Vec<f64>) {
    let d = 2.0 * half_width / n as f64;
    let grid = Grid::new(2 * n, n, d, d).expect("a grid");
    let at = |k: usize| (k as f64 + 0.5) * d - half_width;
    let h = |i: usize| {
        let ((radius, below), x, y) = (balls[(i % grid.mx) / n], at(i % grid.mx % n), at(i / grid.mx));
        below + (x * x + y * y) / (2.0 * radius)
    };
    (grid, (0..grid.len()).map(h).collect())
}

// The small ball parts first, and the force rises. Then the large ball alone carries a stronger pull than both did.
#[test]
fn the_least_force_lies_behind_a_minimum_of_less_depth() {
    let (range, options) = (range_of(2.0), Options::default());
    let pull_off = |below: [(f64, f64); 2]| {
        let (grid, h) = balls(80, 2.4, below);
        let own = adhesion(Law::Exponential, 1.0 / std::f64::consts::PI, range);
        let scene = Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(MODULUS), Load::Approach(2.0)) };
        let mut solver = Solver::new(&scene, &options).expect("a solver");
        let (outcome, report) = solver.pull_off(&scene, &options, None).expect("a pull-off");
        assert_eq!(outcome, Outcome::Converged);
        println!("{} at {}, {:.0} work", report.measures.force, report.measures.approach, report.count.work_units);
        report.measures.force
    };
    let alone = pull_off([(1.0, 0.0), (1.0, 50.0)]);
    let both = pull_off([(1.0, 0.0), (0.2, 1.2)]);
    // At the pull-off of the large ball the attraction of the small one has fallen to exp(-6) of that in contact.
    assert!((both - alone).abs() < 5e-3, "{both} {alone}");
}

// Small scenes like seeds 6, 15, 27, 82, 192 and 291 of `campaign --adhesion`: laws of finite range, and a surface with one high point. Bodies apart
// are also a state of the force 0, but no path of unloading can begin there.
#[test]
fn pulls_on_what_parts_without_a_load_are_held_or_refused() {
    let grid = Grid::new(16, 13, 1.0, 1.0).expect("a grid");
    let h: Vec<f64> =
        (0..grid.len()).map(|i| if i == 90 { 0.0 } else { 3.0 + (i * 7919 % 13) as f64 / 13.0 }).collect();
    for law in [Law::Cubic, Law::Dugdale(0.4), Law::VanDerWaals, Law::Exponential] {
        let own = adhesion(law, 1e-2, 0.2);
        let scene = |load| Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), load) };
        let options = Options::default();
        let mut solver = Solver::new(&scene(Load::Force(0.0)), &options).expect("a solver");
        let (outcome, report) = solver.pull_off(&scene(Load::Approach(0.1)), &options, None).expect("a pull-off");
        assert_eq!(outcome, Outcome::Converged);
        let least = report.measures.force;
        assert!(least < 0.0);
        for part in [0.1, 0.9] {
            let (_, outcome, report) = solver::solve(&scene(Load::Force(part * least)), &options).expect("a solve");
            assert_eq!(outcome, Outcome::Converged, "{law:?} {part}");
            assert!(report.measures.contact_count > 0);
        }
        for factor in [1.1, 10.0, 1e6] {
            let refused = solver::solve(&scene(Load::Force(factor * least)), &options);
            assert!(matches!(refused, Err(Error::Infeasible(_))), "{law:?} {factor}");
        }
        let (_, outcome, report) = solver::solve(&scene(Load::Force(0.0)), &options).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        assert!(report.measures.contact_count > 0, "{law:?}: they hold each other");
    }
}

/// A sphere on n x n elements within 1 x 1, for E* = 1; and the range that gives `kappa`.
fn small_sphere(n: usize, radius: f64, (law, work, kappa): (Law, f64, f64)) -> (Grid, Vec<f64>, f64) {
    let d = 1.0 / n as f64;
    let grid = Grid::new(n, n, d, d).expect("a grid");
    let at = |k: usize| (k as f64 - 0.5 * (n as f64 - 1.0)) * d;
    let h = (0..n * n).map(|i| 0.5 * (at(i % n).powi(2) + at(i / n).powi(2)) / radius).collect();
    (grid, h, range_of_kappa(law, work, d, 1.0, kappa))
}

// Near the pull-off the unstable equilibrium of a force is close to the stable one.
#[test]
fn just_above_the_pull_off_the_stable_state_is_found() {
    let options = Options::default();
    let scenes = [
        (Law::Exponential, 0.002, 0.3),
        (Law::Cubic, 0.005, 0.2),
        (Law::Dugdale(0.3), 0.001, 0.4),
        (Law::VanDerWaals, 1e-3, 0.3),
    ];
    for (k, (law, work, kappa)) in scenes.into_iter().enumerate() {
        let (grid, h, range) = small_sphere(17 - 2 * k, 1.0, (law, work, kappa));
        let own = Adhesion { stiffness: true, ..adhesion(law, work, range) };
        let scene = |load| Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), load) };
        let mut solver = Solver::new(&scene(Load::Force(0.0)), &options).expect("a solver");
        let (outcome, report) = solver.pull_off(&scene(Load::Force(0.0)), &options, None).expect("a pull-off");
        assert_eq!(outcome, Outcome::Converged);
        let (least, a) = (report.measures, matrix(&grid, 1.0));
        for part in [0.9, 0.98, 0.99, 0.999] {
            let (solver, outcome, report) =
                solver::solve(&scene(Load::Force(part * least.force)), &options).expect("a solve");
            assert_eq!(outcome, Outcome::Converged, "{law:?} {part}");
            let found = tangent(&grid, &a, solver.state(), (law, work, range));
            let told = report.adhesion.and_then(|found| found.stiffness).expect("a stiffness");
            println!("{law:?} {part}: approach {} of {}, {found:?} {told}", report.measures.approach, least.approach);
            assert!(found.stiffness > 0.0 && found.is_least, "{law:?} {part}: {found:?}");
            // The stiffness has a relative error of 1e-3. Near the pull-off its terms cancel, hence the absolute tolerance.
            assert!((told - found.stiffness).abs() < 5e-3 * found.stiffness + 1e-3, "{law:?} {part}: {told} {found:?}");
            assert!(report.measures.approach > least.approach, "{law:?} {part}");
            let u = displacements(&grid, 1.0, &solver.state().p);
            let worst = worst(solver.state(), &u, |_, e| traction(law, work, range, e));
            assert!(worst < 2e-6, "{law:?} {part}: {worst:e}");
        }
    }
}

// A small ball stands out beyond a large one. Without a load only the small one is in contact. Once the large one is in contact, it carries a
// stronger pull.
#[test]
fn a_pull_that_only_pressed_bodies_hold_is_held() {
    let (n, options) = (64, Options::default());
    let d = 6.0 / n as f64;
    let grid = Grid::new(n, n, d, d).expect("a grid");
    let at = |k: usize| (k as f64 - 31.5) * d;
    let ball = |i: usize, x: f64, radius: f64, below: f64| {
        below + 0.5 * ((at(i % n) - x).powi(2) + at(i / n).powi(2)) / radius
    };
    let h: Vec<f64> = (0..n * n).map(|i| ball(i, -1.0, 1.0, 2.0).min(ball(i, 2.0, 0.1, 0.0))).collect();
    let (work, range) = (1.0 / std::f64::consts::PI, 0.45);
    let scene = |load| Scene {
        adhesion: Some(adhesion(Law::Cubic, work, range)),
        ..Scene::new(grid, &h, bodies(MODULUS), load)
    };
    let certified = |solver: &Solver| {
        let u = displacements(&grid, MODULUS, &solver.state().p);
        let worst = worst(solver.state(), &u, |_, e| traction(Law::Cubic, work, range, e));
        assert!(worst < 2e-6, "{worst:e}");
    };
    let mut solver = Solver::new(&scene(Load::Force(0.0)), &options).expect("a solver");
    let (outcome, report) = solver.pull_off(&scene(Load::Force(0.0)), &options, None).expect("a pull-off");
    let least = report.measures.force;
    println!("pull-off {least}, {:.0} work", report.count.work_units);
    certified(&solver);
    // A ball carries a pull of some 1.5 to 2 pi w R, the large one 1.5 to 2.
    assert!(outcome == Outcome::Converged && least < -1.0, "{least}");
    let (solver, outcome, held) = solver::solve(&scene(Load::Approach(1.6)), &options).expect("a solve");
    assert!(outcome == Outcome::Converged && held.measures.force < -0.9, "{}", held.measures.force);
    certified(&solver);
    let (solver, outcome, again) = solver::solve(&scene(Load::Force(held.measures.force)), &options).expect("a solve");
    assert!(outcome == Outcome::Converged && (again.measures.force - held.measures.force).abs() < 1e-5);
    certified(&solver);
    match solver::solve(&scene(Load::Force(1.05 * least)), &options) {
        Err(Error::Infeasible(message)) => assert!(message.contains("was found"), "{message}"),
        other => panic!("{:?}", other.map(|(_, outcome, report)| (outcome, report.measures))),
    }
}

// A handle continues from a state by approach to a positive force. The nearest equilibrium of this force is unstable.
#[test]
fn a_force_that_presses_finds_a_stable_state_too() {
    let n = 9;
    let d = 1.0 / n as f64;
    let grid = Grid::new(n, n, d, d).expect("a grid");
    let (law, work, range) = (Law::Dugdale(0.3), 0.001579, 0.02891);
    let balls =
        [(-0.2826, -0.03212, 3.364, 0.1353), (0.0131, 0.1257, 0.2282, 0.0729), (0.1516, 0.1178, 0.1058, 0.1394)];
    let at = |k: usize| (k as f64 - 4.0) * d;
    let h: Vec<f64> = (0..n * n)
        .map(|i| {
            let ball = |(x, y, radius, below)| {
                let from: [f64; 2] = [at(i % n) - x, at(i / n) - y];
                below + 0.5 * (from[0].powi(2) + from[1].powi(2)) / radius
            };
            balls.into_iter().map(ball).fold(f64::INFINITY, f64::min)
        })
        .collect();
    let scene = |load| Scene { adhesion: Some(adhesion(law, work, range)), ..Scene::new(grid, &h, bodies(1.0), load) };
    let mut solver = Solver::new(&scene(Load::Approach(0.0)), &Options::default()).expect("a solver");
    let loads = [Load::Approach(0.0636), Load::Force(0.0004135)];
    for (load, initial_guess) in loads.into_iter().zip([InitialGuess::None, InitialGuess::Previous]) {
        let options = Options { initial_guess, ..Options::default() };
        let (outcome, report) = solver.solve(&scene(load), &options, None, None).expect("a step");
        assert_eq!(outcome, Outcome::Converged);
        let found = tangent(&grid, &matrix(&grid, 1.0), solver.state(), (law, work, range));
        println!("{load:?}: approach {} force {}, {found:?}", report.measures.approach, report.measures.force);
        assert!(found.is_least && (found.stiffness > 0.0 || matches!(load, Load::Approach(_))), "{load:?}: {found:?}");
        let u = displacements(&grid, 1.0, &solver.state().p);
        let worst = worst(solver.state(), &u, |_, e| traction(law, work, range, e));
        assert!(worst < 2e-6, "{load:?}: {worst:e}");
    }
}
