//! A loop of loading and unloading: two branches, and a jump from one to the other on each way.

use contact_normal::adhesion::Start;
use contact_normal::scene::{Adhesion, Load, Scene};
use contact_normal::solver::{InitialGuess, Options, Outcome, Solver};

use super::support::Sphere;

/// Solves at the given approaches one after the other. Returns the approach, the force, and whether the state jumped, for each.
fn walk(sphere: &Sphere, approaches: &[f64]) -> Vec<(f64, f64, bool)> {
    let adhesion = Some(Adhesion { start: Start::Apart, ..sphere.adhesion });
    let scene = |approach: f64| Scene { adhesion, ..sphere.scene(Load::Approach(approach)) };
    let mut solver = Solver::new(&scene(approaches[0]), &Options::default()).expect("a solver");
    let step = |(k, &approach): (usize, &f64)| {
        let initial_guess = if k == 0 { InitialGuess::None } else { InitialGuess::Previous };
        let options = Options { initial_guess, ..Options::default() };
        let (outcome, report) = solver.solve(&scene(approach), &options, None, None).expect("a step");
        assert_eq!(outcome, Outcome::Converged, "{approach}");
        let jumped = report.adhesion.expect("adhesion").jumped;
        println!(
            "{approach:.1} {:.5} {} products, jumped {jumped}",
            report.measures.force, report.count.matrix_products
        );
        (approach, report.measures.force, jumped)
    };
    approaches.iter().enumerate().map(step).collect()
}

// The prototype's loop (recipes/adhesion/t13.py): Tabor's parameter 3, 128 x 128 elements. By the theory of Johnson, Kendall and Roberts the bodies
// snap out at -.909.
#[test]
fn the_loop_snaps_in_and_out_where_the_prototype_does() {
    let sphere = Sphere::by_tabor(3.0, 128, 2.0);
    let up: Vec<f64> = (-14..=2).map(|k| 0.1 * f64::from(k)).collect();
    let down: Vec<f64> = (-12..2).rev().map(|k| 0.1 * f64::from(k)).collect();
    let all = walk(&sphere, &[&up[..], &down[..]].concat());
    let (up, down) = all.split_at(up.len());
    let at = |way: &[(f64, f64, bool)], approach: f64| {
        way.iter().find(|(at, _, _)| (at - approach).abs() < 1e-9).map(|(_, force, _)| *force).expect("a step")
    };
    assert!((at(up, -0.7) + 0.0668).abs() < 1e-3, "before the snap-in: {}", at(up, -0.7));
    assert!((at(up, -0.6) + 1.5178).abs() < 1e-3, "after it: {}", at(up, -0.6));
    assert!((at(down, -0.9) + 1.1487).abs() < 1e-3, "before the snap-out: {}", at(down, -0.9));
    assert!((at(down, -1.0) + 0.01035).abs() < 1e-4, "after it: {}", at(down, -1.0));
    // After the snap-in both branches are the same. The residuals are 1e-6, and the forces differ by a few times that.
    for k in -6..=1 {
        let approach = 0.1 * f64::from(k);
        assert!(
            (at(up, approach) - at(down, approach)).abs() < 1e-5,
            "{approach}: {} {}",
            at(up, approach),
            at(down, approach)
        );
    }
    let jumps: Vec<f64> = all.iter().filter(|(_, _, jumped)| *jumped).map(|(at, _, _)| *at).collect();
    let snaps = jumps.len() == 2 && (jumps[0] + 0.6).abs() < 1e-9 && (jumps[1] + 1.0).abs() < 1e-9;
    assert!(snaps, "{jumps:?}");
}

#[test]
fn starts_from_contact_and_from_apart_find_their_branches() {
    let sphere = Sphere::by_tabor(3.0, 64, 2.2);
    let force = |start: Start| {
        let scene =
            Scene { adhesion: Some(Adhesion { start, ..sphere.adhesion }), ..sphere.scene(Load::Approach(-0.75)) };
        let (_, outcome, report) = contact_normal::solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        report.measures.force
    };
    let (contact, apart) = (force(Start::Contact), force(Start::Apart));
    assert!(contact < -1.2, "in contact: {contact}");
    assert!(apart > -0.1 && apart < 0.0, "apart: {apart}");
}
