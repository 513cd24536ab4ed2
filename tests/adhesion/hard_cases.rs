//! Extreme scenes end with the right answer or with a status that says what happened.

use std::f64::consts::PI;

use contact_normal::adhesion::{Law, Start};
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Period, Scene, Work};
use contact_normal::solver::{self, Options, Outcome, Progress, Solver};

use super::support::{adhesion, bodies, Sphere, MODULUS};

/// Solves, and checks all values that are returned. Returns the outcome, or the message of a refusal.
fn solve(scene: &Scene<'_>) -> Result<Outcome, String> {
    let options = Options { max_cycles: 300, ..Options::default() };
    let (solver, outcome, report) = solver::solve(scene, &options).map_err(|error| error.to_string())?;
    let state = solver.state();
    assert!(state.p.iter().all(|p| p.is_finite()) && state.approach.is_finite(), "{outcome:?}");
    let found = report.adhesion.expect("adhesion");
    assert!(
        found.resolution.is_finite() && found.law_residual >= 0.0 && found.adhesive_energy.is_finite(),
        "{found:?}"
    );
    Ok(outcome)
}

#[test]
fn ranges_and_works_out_of_all_proportion_end() {
    let sphere = Sphere::by_tabor(1.0, 24, 3.0);
    for (work, range) in [(1.0 / PI, 1e-12), (1.0 / PI, 1e12), (1e-30, 0.5), (1e30, 0.5), (1e30, 0.0), (1e-30, 0.0)] {
        for load in [Load::Approach(0.3), Load::Approach(-0.5), Load::Force(1.0), Load::Force(-1e-3)] {
            let scene = Scene { adhesion: Some(adhesion(Law::Exponential, work, range)), ..sphere.scene(load) };
            let ended = solve(&scene);
            println!("{work:e} {range:e} {load:?}: {ended:?}");
            if work < 1e-20 && range > 0.0 && load == Load::Force(-1e-3) {
                assert!(ended.is_err_and(|message| message.contains("holds a pull of")));
            }
        }
    }
}

#[test]
fn a_surface_that_is_nowhere_holds_nothing() {
    let sphere = Sphere::by_tabor(1.0, 8, 3.0);
    let nowhere = vec![f64::INFINITY; 64];
    let scene = |load: Load| Scene { undeformed_distance: &nowhere, ..sphere.scene(load) };
    assert_eq!(solve(&scene(Load::Approach(0.3))), Ok(Outcome::Converged));
    assert!(solve(&scene(Load::Force(-1.0))).is_err_and(|message| message.contains("infinite")));
}

#[test]
fn elements_without_a_surface_stay_exterior() {
    let sphere = Sphere::by_tabor(1.0, 32, 3.0);
    let mut h = sphere.h.clone();
    (0..h.len()).filter(|i| i % 32 < 14).for_each(|i| h[i] = f64::INFINITY);
    for load in [Load::Approach(0.3), Load::Force(0.5), Load::Force(-0.3)] {
        let scene = Scene { undeformed_distance: &h, ..sphere.scene(load) };
        let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged, "{load:?}");
        let state = solver.state();
        let largest = state.p.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
        for i in (0..h.len()).filter(|i| h[*i].is_infinite()) {
            assert!(!state.contact[i] && state.p[i].abs() < 1e-5 * largest, "{i}: {}", state.p[i]);
        }
    }
}

#[test]
fn one_element_has_its_closed_form() {
    // Without contact e = h - approach - a0 w/rho exp(-e/rho), with Love's a0.
    let grid = Grid::new(1, 1, 1.0, 1.0).expect("a grid");
    let (work, range, gap) = (0.02, 1.0, 0.5);
    let h = [gap];
    let scene = Scene {
        adhesion: Some(adhesion(Law::Exponential, work, range)),
        ..Scene::new(grid, &h, bodies(MODULUS), Load::Approach(0.0))
    };
    let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged);
    let a0 = 4.0 * 1f64.asinh() / (PI * MODULUS);
    let p = solver.state().p[0];
    let e = gap + a0 * p;
    assert!((p + work / range * (-e / range).exp()).abs() < 1e-6 * p.abs(), "{p}");
    let periodic = Scene { period: Some(Period { x: true, y: true }), ..scene };
    assert!(solve(&periodic).is_err_and(|message| message.contains("one element")));
}

#[test]
fn values_that_are_none_are_refused_by_name() {
    let sphere = Sphere::by_tabor(1.0, 8, 3.0);
    let works = vec![f64::NAN; 64];
    let base = sphere.adhesion;
    for (name, wrong) in [
        ("work_of_adhesion", Adhesion { work: Work::Uniform(-1.0), ..base }),
        ("work_of_adhesion", Adhesion { work: Work::Uniform(f64::NAN), ..base }),
        ("works_of_adhesion", Adhesion { work: Work::PerElement(&works), ..base }),
        ("works_of_adhesion", Adhesion { work: Work::PerElement(&works[..3]), ..base }),
        ("range", Adhesion { range: -1.0, ..base }),
        ("range", Adhesion { range: f64::INFINITY, ..base }),
        ("smear", Adhesion { law: Law::Dugdale(0.0), ..base }),
    ] {
        let scene = Scene { adhesion: Some(wrong), ..sphere.scene(Load::Approach(0.3)) };
        let message =
            solver::solve(&scene, &Options::default()).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(message.contains(name), "{name}: {message}");
    }
}

#[test]
fn a_solve_with_adhesion_can_be_cancelled_at_every_callback() {
    let sphere = Sphere::by_tabor(1.0, 40, 3.0);
    for (start, load, pull_off) in [
        (Start::Auto, Load::Approach(0.3), false),
        (Start::Apart, Load::Approach(-0.2), false),
        (Start::Auto, Load::Force(-1.2), false),
        (Start::Auto, Load::Force(0.0), true),
    ] {
        let scene = Scene { adhesion: Some(Adhesion { start, ..sphere.adhesion }), ..sphere.scene(load) };
        let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
        // A search for the pull-off has some hundred callbacks. It is cancelled at the first ones and at every 16th.
        for at in (1..2000).filter(|at| !pull_off || *at < 8 || at % 16 == 0) {
            let mut calls = 0;
            let mut cancel = |_: &Progress| {
                calls += 1;
                calls >= at
            };
            let options = Options::default();
            let ended = match pull_off {
                true => solver.pull_off(&scene, &options, Some(&mut cancel)),
                false => solver.solve(&scene, &options, None, Some(&mut cancel)),
            };
            let (outcome, report) = ended.expect("a solve");
            assert!(calls <= at, "asked again after having cancelled");
            if calls < at {
                assert_eq!(outcome, Outcome::Converged);
                assert!(at > 3, "only {at} callbacks");
                break;
            }
            assert_eq!(outcome, Outcome::Cancelled, "{load:?} {at}");
            let residual = report.measures.certificate.residual;
            assert!(residual.is_finite() && residual > 0.0, "{load:?} {at}: {residual}");
            assert!(solver.state().p.iter().all(|p| p.is_finite()), "{load:?} {at}");
        }
    }
}
