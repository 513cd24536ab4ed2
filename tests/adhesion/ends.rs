//! How searches for a pull end: bodies apart beyond the range of a law, pulls that no state carries, and the last part of a path.

use contact_normal::adhesion::Law;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Bodies, Load, Scene, Work};
use contact_normal::solver::{self, InitialGuess, Options, Outcome, Report, Solver};

use super::random::range_of_kappa;
use super::support::{adhesion, bodies};

/// A paraboloid on elements of given sizes. Its top lies at a place given in elements.
struct Bowl {
    grid: Grid,
    h: Vec<f64>,
}

impl Bowl {
    fn new(n: usize, [dx, dy]: [f64; 2], [x0, y0]: [f64; 2], curvature: f64) -> Bowl {
        let grid = Grid::new(n, n, dx, dy).expect("a grid");
        let at = |i: usize| ((i % n) as f64 * dx - x0).hypot((i / n) as f64 * dy - y0);
        Bowl { grid, h: (0..n * n).map(|i| 0.5 * curvature * at(i).powi(2)).collect() }
    }

    fn scene<'a>(&'a self, own: Adhesion<'a>, load: Load) -> Scene<'a> {
        let bodies: Bodies = bodies(1.0);
        Scene { adhesion: Some(own), ..Scene::new(self.grid, &self.h, bodies, load) }
    }
}

fn pull_off(scene: &Scene<'_>) -> (Solver, Report) {
    let mut solver = Solver::new(scene, &Options::default()).expect("a solver");
    let (outcome, report) = solver.pull_off(scene, &Options::default(), None).expect("a pull-off");
    assert_eq!(outcome, Outcome::Converged);
    (solver, report)
}

// If bodies are drawn apart beyond the reach of a law of finite range, all pressures are exactly 0, whatever was solved before.
#[test]
fn beyond_the_reach_of_a_law_pressures_are_zero_whatever_came_before() {
    let bowl = Bowl::new(12, [1.0, 1.0], [5.3, 5.6], 0.01);
    let lowest = bowl.h.iter().copied().fold(f64::INFINITY, f64::min);
    for (law, reach) in [(Law::Cubic, 3.0), (Law::Dugdale(0.3), 1.3), (Law::Exponential, 36.0)] {
        let range = range_of_kappa(law, 1e-4, 1.0, 1.0, 0.2);
        let scene = |apart: f64| bowl.scene(adhesion(law, 1e-4, range), Load::Approach(lowest - apart * reach * range));
        let mut solver = Solver::new(&scene(0.0), &Options::default()).expect("a solver");
        for (k, apart) in [-0.2, 0.5, 0.97, 1.01, 1.3, 2.0].into_iter().enumerate() {
            let initial_guess = if k == 0 { InitialGuess::None } else { InitialGuess::Previous };
            let options = Options { initial_guess, ..Options::default() };
            let (outcome, report) = solver.solve(&scene(apart), &options, None, None).expect("a step");
            assert_eq!(outcome, Outcome::Converged);
            let none = solver.state().p.iter().all(|p| *p == 0.0) && report.measures.force == 0.0;
            assert_eq!(none, apart > 1.0, "{law:?} {apart}: {:e}", report.measures.force);
        }
    }
}

// Only the highest element is in contact, and it has no attraction. The search ends where it leaves the contact, with a pull-off force of 0, from
// whatever load.
#[test]
fn what_nothing_holds_has_no_pull_off_from_any_load() {
    for (law, deep) in
        [(Law::Cubic, 20.0), (Law::Dugdale(0.3), 200.0), (Law::Exponential, 200.0), (Law::Exponential, 4e3)]
    {
        let mut bowl = Bowl::new(12, [1.0, 1.0], [5.3, 5.6], 0.01);
        let top = 65;
        let range = range_of_kappa(law, 1e-4, 1.0, 1.0, 0.2);
        bowl.h[top] -= deep * range;
        let works: Vec<f64> = (0..bowl.h.len()).map(|i| if i == top { 0.0 } else { 1e-4 }).collect();
        let own = Adhesion { work: Work::PerElement(&works), ..adhesion(law, 1e-4, range) };
        for force in [0.0, 1e-3, 1e-2] {
            let (_, report) = pull_off(&bowl.scene(own, Load::Force(force)));
            let (least, all) = (report.measures.force, works.iter().sum::<f64>() / range);
            println!("{law:?} {deep} {force}: pull-off {least:e}");
            assert!(least.abs() < 1e-7 * all, "{law:?} {deep} {force}: {least:e}");
        }
        if deep > 100.0 {
            let pulled = solver::solve(&bowl.scene(own, Load::Force(-1e-3)), &Options::default());
            assert!(matches!(pulled, Err(Error::Infeasible(_))), "{law:?} {deep}");
        }
    }
}

// Contact along the rim of a grid ends at once, and following the path beyond this takes some hundred cycles. The search for a given pull may use as
// many cycles as one for the pull-off force.
#[test]
fn a_pull_beyond_a_snap_of_all_is_refused_and_one_that_is_cut_short_says_so() {
    let bowl = Bowl::new(15, [1.0, 1.0], [6.78, 6.866], -0.01142);
    let own = adhesion(Law::Cubic, 0.007415, 0.14788);
    let (_, found) = pull_off(&bowl.scene(own, Load::Force(0.0)));
    let least = found.measures.force;
    for factor in [1.001, 1.2, 5.0] {
        match solver::solve(&bowl.scene(own, Load::Force(factor * least)), &Options::default()) {
            Err(Error::Infeasible(message)) => {
                let held = message.split("a pull of ").nth(1).and_then(|rest| rest.split(' ').next());
                let held: f64 = held.and_then(|held| held.parse().ok()).expect("a number");
                assert!((held / least - 1.0).abs() < 2e-3, "{message}");
            }
            other => panic!("{factor}: {:?}", other.map(|(_, outcome, report)| (outcome, report.measures))),
        }
    }
    let few = Options { max_cycles: 60, ..Options::default() };
    let (_, outcome, report) = solver::solve(&bowl.scene(own, Load::Force(1.2 * least)), &few).expect("a result");
    let (force, residual) = (report.measures.force, report.measures.certificate.residual);
    println!("pull-off {least}; cut short at {force}, residual {residual:e}");
    assert_eq!(outcome, Outcome::IterationLimit);
    assert!(report.adhesion.is_some_and(|found| found.is_short) && force < 0.9 * least, "{force}");
    // The residual is relative to the sum of |p|, which is larger than that of p, and must show that the force is missed.
    assert!(residual > 0.02, "{residual:e} hides that the force is missed");
}

/// A ball with waves of a few elements, which snap off one by one. The path from the unloaded state is short. The path from pressed bodies, which
/// carries stronger pulls, takes hundreds of cycles.
#[test]
fn a_pull_is_refused_only_if_each_way_was_gone_to_its_end() {
    let mut bowl = Bowl::new(15, [1.0, 1.0], [7.0, 7.0], 1.0 / 30.0);
    for (i, h) in bowl.h.iter_mut().enumerate() {
        *h += 0.2 * (2.1 * ((i % 15) as f64 - 7.0)).cos() * (2.3 * ((i / 15) as f64 - 7.0)).cos();
    }
    let law = Law::Dugdale(0.3);
    let own = adhesion(law, 1e-3, range_of_kappa(law, 1e-3, 1.0, 1.0, 1.6 * law.steepness()));
    let pull = Load::Force(-3.0 * std::f64::consts::PI * 1e-3 * 30.0);
    let by_cycles =
        |max_cycles: usize| solver::solve(&bowl.scene(own, pull), &Options { max_cycles, ..Options::default() });
    let (_, outcome, report) = by_cycles(50).expect("a result");
    assert_eq!(outcome, Outcome::IterationLimit);
    assert!(report.adhesion.is_some_and(|found| found.is_short));
    assert!(matches!(by_cycles(20_000), Err(Error::Infeasible(_))));
}

/// If the cycles end before an unloaded state is found, the result must not be the pressed bodies with which a path begins.
#[test]
fn a_pull_that_is_cut_short_does_not_come_back_as_pressed_bodies() {
    let bowl = Bowl::new(24, [0.2, 0.2], [2.3, 2.3], 1.0);
    let own = adhesion(Law::Exponential, 0.3, 0.6);
    for max_cycles in 1..=30 {
        let options = Options { max_cycles, ..Options::default() };
        let (_, outcome, report) = solver::solve(&bowl.scene(own, Load::Force(-0.8)), &options).expect("a result");
        let force = report.measures.force;
        assert!(
            outcome == Outcome::Converged || outcome == Outcome::IterationLimit && force <= 0.8,
            "{max_cycles}: {force}"
        );
    }
}

// A spike stands out of a ball, and is alone in contact without a load. On the path from pressed bodies to this state small steps are needed: with
// steps of 0.3 of the contact's length the pull-off force would be 1.2 % too weak. A dense path from pressed bodies, in steps of 0.005 of the range,
// has -5.2603e-3.
#[test]
fn a_pull_off_on_a_way_to_another_is_as_strong_as_small_steps_find() {
    let mut bowl = Bowl::new(10, [1.0, 0.68], [4.487, 3.195], 0.009834);
    bowl.h[55] -= 0.043;
    let own = adhesion(Law::Exponential, 6.37e-5, 0.014618);
    let (_, found) = pull_off(&bowl.scene(own, Load::Force(0.0)));
    let least = found.measures.force;
    println!("pull-off {least}, {:.0} work", found.count.work_units);
    assert!(least < -5.26e-3 * (1.0 - 2e-3), "{least}");
    let refused = solver::solve(&bowl.scene(own, Load::Force(1.003 * least)), &Options::default());
    assert!(matches!(refused, Err(Error::Infeasible(_))));
    for factor in [0.98, 0.99, 0.995, 0.999] {
        let held = solver::solve(&bowl.scene(own, Load::Force(factor * least)), &Options::default());
        let held = held.map(|(_, outcome, report)| (outcome, report.measures.approach > found.measures.approach));
        assert!(matches!(held, Ok((Outcome::Converged, true))), "{factor}: {held:?}");
    }
}

/// Elements with kappa of 0.71 and 0.82 part one after the other. The path to a given force must not skip the last part of the path to the pull-off.
#[test]
fn a_pull_just_above_the_pull_off_is_held_by_coarse_elements() {
    let cases = [
        (33, Law::Cubic, (0.12624077426576064, 0.47581758789852013), (3.48212370758722e-7, 1.0580140531823262e-4)),
        (
            30,
            Law::Exponential,
            (0.3371282038712927, -0.1276652065491285),
            (2.3724786010874395e-7, 1.0387426116274776e-4),
        ),
    ];
    for (n, law, (x0, y0), (work, range)) in cases {
        let d = 1.0 / n as f64;
        let grid = Grid::new(n, n, d, d).expect("a grid");
        let at = |k: usize, off: f64| (k as f64 - 0.5 * (n - 1) as f64 - off) * d;
        let h: Vec<f64> = (0..n * n).map(|i| at(i % n, x0).powi(2) / 100.0 + at(i / n, y0).powi(2) / 100.0).collect();
        let at_load = |load: Load| Scene {
            adhesion: Some(adhesion(law, work, range)),
            ..Scene::new(grid, &h, bodies(1.0), load)
        };
        let unloaded = at_load(Load::Force(0.0));
        let mut solver = Solver::new(&unloaded, &Options::default()).expect("a solver");
        let (outcome, report) = solver.pull_off(&unloaded, &Options::default(), None).expect("a pull-off");
        assert_eq!(outcome, Outcome::Converged);
        let force = report.measures.force;
        let (_, outcome, held) =
            solver::solve(&at_load(Load::Force(0.999 * force)), &Options::default()).expect("it is held");
        assert_eq!(outcome, Outcome::Converged);
        assert!((held.measures.force / force - 0.999).abs() < 1e-6, "{}", held.measures.force / force);
        let refused = solver::solve(&at_load(Load::Force(1.01 * force)), &Options::default());
        assert!(matches!(refused, Err(Error::Infeasible(_))), "{law:?}");
    }
}

/// Lines on which the last asperity carries a stronger pull than the ones before, in the very step in which it parts. An unloading from pressed
/// bodies in 2500 steps has these pulls.
#[test]
fn the_last_asperity_may_hold_the_most() {
    const ROUGH: [f64; 21] = [
        0.25741, 0.29101, 0.19291, 0.13415, 0.03954, 0.01080, 0.05957, 0.04974, -0.03837, -0.08421, 0.01940, 0.03620,
        -0.00559, -0.00717, 0.05475, 0.03931, 0.09935, 0.16030, 0.12367, 0.21586, 0.27299,
    ];
    const OTHER: [f64; 13] = [
        0.03470, 0.02899, 0.00025, 0.00986, 0.00757, 0.01440, -0.02184, 0.00147, 0.00359, 0.00800, 0.01756, 0.04730,
        0.04036,
    ];
    for (h, work, range) in [(&ROUGH[..], 7.920833352e-4, 0.0438793903529), (&OTHER, 9.117354419e-5, 0.0179758101087)] {
        let grid = Grid::new(h.len(), 1, 1.0, 1.0).expect("a grid");
        let own = adhesion(Law::Cubic, work, range);
        let at_load = |load: Load| Scene { adhesion: Some(own), ..Scene::new(grid, h, bodies(1.0), load) };
        let (_, found) = pull_off(&at_load(Load::Force(0.0)));
        let walked = walk_down(&at_load, 0.05, -0.15, 2500);
        assert!(found.measures.force <= walked * (1.0 - 1e-3), "{} of {walked}", found.measures.force);
        let held = solver::solve(&at_load(Load::Force(0.995 * walked)), &Options::default());
        assert!(matches!(held, Ok((_, Outcome::Converged, _))), "{:?}", held.map(|(_, outcome, _)| outcome));
    }
}

/// The least force of an unloading by approach in equal small steps.
fn walk_down<'a>(at_load: &dyn Fn(Load) -> Scene<'a>, from: f64, to: f64, steps: usize) -> f64 {
    let options = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
    let first = at_load(Load::Approach(from));
    let mut solver = Solver::new(&first, &options).expect("a solver");
    solver.solve(&first, &Options::default(), None, None).expect("a solve");
    let step = |k: usize| at_load(Load::Approach(from + (to - from) * k as f64 / steps as f64));
    let force = |k: usize| solver.solve(&step(k), &options, None, None).expect("a solve").1.measures.force;
    (1..=steps).map(force).fold(0.0, f64::min)
}
