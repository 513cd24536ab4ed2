//! Bodies that are pulled apart: flat ones, rough ones, and some with elements that are too coarse for the range.

use contact_normal::adhesion::{Law, Start};
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Period, Scene};
use contact_normal::solver::{self, Options, Outcome, Report, Solver};

use super::certificate::{displacements, traction, worst};
use super::random::{range_of_kappa, rough, Draw};
use super::support::{adhesion, bodies, Sphere, MODULUS};

fn solved(scene: &Scene<'_>) -> (Solver, Report) {
    let (solver, outcome, report) = solver::solve(scene, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged, "{:?}", scene.load);
    (solver, report)
}

/// The pull-off force of a scene, with a search that begins at the scene's load.
fn pull_off(scene: &Scene<'_>) -> f64 {
    let mut solver = Solver::new(scene, &Options::default()).expect("a solver");
    let (outcome, report) = solver.pull_off(scene, &Options::default(), None).expect("a pull-off");
    assert_eq!(outcome, Outcome::Converged);
    report.measures.force
}

fn is_infeasible(scene: &Scene<'_>) -> bool {
    matches!(solver::solve(scene, &Options::default()), Err(Error::Infeasible(_)))
}

// Small versions of seeds 112, 1045, 2786 and 3056 of `campaign --adhesion`. Under a flat punch without a load the contact pressures and the
// attraction are both w/rho, so that the total pressures are round-off.
#[test]
fn flat_tops_without_a_load_touch_and_carry_nothing() {
    let (n, work) = (24, 1e-3);
    let grid = Grid::new(n, n, 1.0, 1.0).expect("a grid");
    let period = [None, Some(Period { x: true, y: true })];
    for law in [Law::Exponential, Law::Cubic, Law::Dugdale(0.3)] {
        let range = range_of_kappa(law, work, 1.0, 1.0, 0.05);
        for (is_top, offset) in [
            (Box::new(|i: usize| i % n < 10) as Box<dyn Fn(usize) -> bool>, 0.0),
            (Box::new(|i: usize| i % n % 8 < 4 && i / n % 8 < 4), 1e4 * range),
            (Box::new(|i: usize| i == 90), -1e4 * range),
            (Box::new(|i: usize| i % 97 == 5), 0.0),
        ] {
            let h: Vec<f64> = (0..n * n)
                .map(|i| offset + if is_top(i) { 0.0 } else { (60 + i * 7919 % 13) as f64 * range })
                .collect();
            for period in period {
                let own = Some(adhesion(law, work, range));
                let scene = Scene { adhesion: own, period, ..Scene::new(grid, &h, bodies(1.0), Load::Force(0.0)) };
                let (solver, report) = solved(&scene);
                let state = solver.state();
                assert!(
                    (0..n * n).all(|i| state.contact[i] == is_top(i)),
                    "{law:?}: {}",
                    report.measures.contact_count
                );
                // The tolerance of e is 1e-6 of the displacement of an element by w/rho. So pressures have errors of 1e-6 of w/rho, times the
                // condition number of A.
                let largest = state.p.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
                assert!(largest < 1e-4 * work / range, "{law:?}: {largest:e} {:e}", work / range);
                assert!((state.approach - offset).abs() < 1e-5 * range, "{law:?}: {:e}", state.approach - offset);
            }
        }
    }
}

// Kendall (1971): a round flat punch of radius a parts at sqrt(8 pi E* w a^3), by a crack that begins at its edge. The process zone of the crack
// makes the punch effectively smaller. For Dugdale's law the zone is pi/8 K^2/sigma(0)^2 = pi/4 E* w/sigma(0)^2 long, 2.2 elements at the shortest
// range that they resolve. For an exponential law, whose zone has no end, the test assumes less than twice that.
#[test]
fn full_contact_is_pulled_off_as_kendalls_punch() {
    let (n, work) = (48, 1e-3);
    let grid = Grid::new(n, n, 1.0, 1.0).expect("a grid");
    let at = |k: usize| k as f64 + 0.5 - 0.5 * n as f64;
    let radius = 20.0;
    let h: Vec<f64> =
        (0..n * n).map(|i| if at(i % n).hypot(at(i / n)) < radius { 0.0 } else { f64::INFINITY }).collect();
    let all = h.iter().filter(|h| h.is_finite()).count();
    let own = adhesion(Law::Exponential, work, 0.0);
    let scene = |load| Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), load) };
    let (_, report) = solved(&scene(Load::Force(1.0)));
    assert_eq!(report.measures.contact_count, all);
    let least = pull_off(&scene(Load::Force(1.0)));
    let kendall = -(8.0 * std::f64::consts::PI * work * radius.powi(3)).sqrt();
    let strength = work / report.adhesion.expect("adhesion").range;
    let zone = 0.25 * std::f64::consts::PI * work / strength.powi(2);
    let part = least / kendall;
    println!("pull-off {least} of {kendall}, zone {zone}");
    assert!(part < 1.0 && part > (1.0 - 2.0 * zone / radius).powf(1.5), "{part}");
    let (_, report) = solved(&scene(Load::Force(0.9 * least)));
    assert!(report.measures.contact_count > all / 2);
    assert!(is_infeasible(&scene(Load::Force(1.1 * least))));
}

// Small versions of seeds 5155 and 5610 of `campaign --adhesion`. With two periods uniform pressures cause no displacement, so that full contact
// carries a pull of all the attraction.
#[test]
fn full_contact_of_two_periods_holds_a_pull_of_all_attraction() {
    for (law, n) in [(Law::Exponential, 7), (Law::VanDerWaals, 15), (Law::Cubic, 40)] {
        let grid = Grid::new(n, n, 1.0, 1.0).expect("a grid");
        let (h, work) = (vec![0.0; n * n], 1e-3);
        let range = range_of_kappa(law, work, 1.0, 1.0, 0.1);
        let all = (n * n) as f64 * work / range;
        for part in [0.01, 0.5, 0.99] {
            let (period, own) = (Some(Period { x: true, y: true }), Some(adhesion(law, work, range)));
            let load = Load::Force(-part * all);
            let scene = Scene { adhesion: own, period, ..Scene::new(grid, &h, bodies(1.0), load) };
            let (solver, report) = solved(&scene);
            assert_eq!(report.measures.contact_count, n * n);
            let off = |p: &f64| (p / (-part * work / range) - 1.0).abs();
            assert!(solver.state().p.iter().map(off).fold(0.0, f64::max) < 1e-4);
        }
    }
}

// A small version of seed 5546 of `campaign --adhesion`: a law of finite range, and a force of 0, which bodies apart have, too.
#[test]
fn a_law_that_ends_leaves_nothing_of_bodies_apart() {
    let n = 24;
    let grid = Grid::new(n, n, 1.0, 1.0).expect("a grid");
    let h: Vec<f64> = (0..n * n).map(|i| if i == 90 { -0.5 } else { (i * 7919 % 101) as f64 * 1e-3 }).collect();
    for law in [Law::Cubic, Law::Dugdale(0.3)] {
        for start in [Start::Auto, Start::Contact, Start::Apart] {
            let own = Adhesion { start, ..adhesion(law, 1e-5, range_of_kappa(law, 1e-5, 1.0, 1.0, 0.07)) };
            let period = Some(Period { x: true, y: true });
            let scene = Scene { adhesion: Some(own), period, ..Scene::new(grid, &h, bodies(1.0), Load::Force(0.0)) };
            let (_, report) = solved(&scene);
            let most = 1e-5 / own.range;
            assert!(report.measures.force.abs() < 1e-6 * most, "{law:?} {:e} {most:e}", report.measures.force);
        }
    }
}

#[test]
fn rough_surfaces_are_pulled_by_forces() {
    let n = 40;
    let grid = Grid::new(n, n, 1.0 / n as f64, 1.0 / n as f64).expect("a grid");
    for (seed, part, law) in [(3, 0.3, Law::Exponential), (8, 0.5, Law::Cubic), (21, 1.0, Law::VanDerWaals)] {
        let (h, full) = rough(n, &mut Draw(seed), 0.8);
        let work = part * full;
        let range = range_of_kappa(law, work, grid.dx, 1.0, 0.3);
        let own = Adhesion { stiffness: true, ..adhesion(law, work, range) };
        let scene = |load| Scene { adhesion: Some(own), ..Scene::new(grid, &h, bodies(1.0), load) };
        let least = pull_off(&scene(Load::Force(0.0)));
        println!("{law:?}: pull-off {least:e}");
        assert!(least < 0.0);
        for part in [0.3, 0.9] {
            let (solver, report) = solved(&scene(Load::Force(part * least)));
            assert!(report.adhesion.and_then(|found| found.stiffness).is_some_and(|stiffness| stiffness > 0.0));
            let u = displacements(&grid, 1.0, &solver.state().p);
            let worst = worst(solver.state(), &u, |_, e| traction(law, work, range, e));
            assert!(worst < 2e-6, "{law:?} {part}: {worst:e}");
        }
        assert!(is_infeasible(&scene(Load::Force(1.1 * least))));
    }
}

// If a single element is unstable (kappa > 1), a load has several states. The result is one of them, and its error estimates are marked as untrusted.
#[test]
fn elements_that_snap_alone_have_a_certified_state() {
    let mut sphere = Sphere::by_tabor(1.0, 32, 3.0);
    sphere.adhesion.range = range_of_kappa(Law::Exponential, 1.0 / std::f64::consts::PI, sphere.grid.dx, MODULUS, 2.0);
    for load in [Load::Approach(0.5), Load::Approach(-0.3), Load::Force(1.0), Load::Force(-0.5)] {
        let (solver, report) = solved(&sphere.scene(load));
        let found = report.adhesion.expect("adhesion");
        assert!((found.resolution - 2.0).abs() < 1e-9 && report.error.untrusted != 0, "{found:?}");
        let u = displacements(&sphere.grid, MODULUS, &solver.state().p);
        let worst =
            worst(solver.state(), &u, |_, e| traction(Law::Exponential, 1.0 / std::f64::consts::PI, found.range, e));
        assert!(worst < 2e-6, "{load:?}: {worst:e}");
    }
}

// With two periods the approach is constant while all elements are in contact and the force falls. In full contact the pressures are those that
// flatten a wave, h/A with A = 2/(E* q) (Johnson 1985, section 13.2), and each element can carry a pull of w/range.
#[test]
fn full_contact_of_two_periods_has_a_pull_off() {
    let (n, options) = (32, Options::default());
    let grid = Grid::new(n, n, 1.0 / n as f64, 1.0 / n as f64).expect("a grid");
    let wave = |k: usize| (2.0 * std::f64::consts::PI * k as f64 / n as f64).cos();
    for (depth, work, range) in [(0.003, 1e-2, 0.1), (0.0, 1e-3, 0.1)] {
        let h: Vec<f64> = (0..n * n).map(|i| depth * (2.0 - wave(i % n) - wave(i / n))).collect();
        let own = adhesion(Law::Exponential, work, range);
        let period = Some(Period { x: true, y: true });
        let scene = |load| Scene { adhesion: Some(own), period, ..Scene::new(grid, &h, bodies(1.0), load) };
        // In the common valley of both waves the pressure is least: less than the mean by pi E* depth for each of them.
        let opens = work / range - 2.0 * std::f64::consts::PI * depth;
        let mut solver = Solver::new(&scene(Load::Force(0.0)), &options).expect("a solver");
        let (outcome, report) = solver.pull_off(&scene(Load::Force(0.0)), &options, None).expect("a pull-off");
        let (least, approach) = (report.measures.force, report.measures.approach);
        println!("pull-off {least} at {approach}, full contact ends at {opens}");
        assert_eq!(outcome, Outcome::Converged);
        // Elements average the wave, which reduces it by (pi/n)^2/6. And nothing carries more than the whole attraction.
        assert!(
            approach.is_finite() && least <= -opens * (1.0 - 1e-3) + 1e-6 && least >= -1.000001 * work / range,
            "{least} {opens}"
        );
        assert!((approach - 2.0 * depth).abs() < range, "{approach}");
        for part in [0.5, 0.98] {
            let (solver, report) = solved(&scene(Load::Force(-part * opens)));
            assert_eq!(report.measures.contact_count, n * n);
            let mean = solver.state().p.iter().sum::<f64>() / (n * n) as f64;
            assert!((mean + part * opens).abs() < 1e-6 * opens && report.measures.approach.is_finite());
        }
        match solver::solve(&scene(Load::Force(1.05 * least)), &options) {
            Err(Error::Infeasible(message)) => {
                let named = |after: &str| {
                    let rest = message.split(after).nth(1).expect("a number");
                    rest.split([' ', ',']).next().and_then(|number| number.parse::<f64>().ok()).expect("a number")
                };
                assert!((named("a pull of ") - least).abs() < 1e-3 * least.abs(), "{message}");
                assert!(named("an approach of ").is_finite(), "{message}");
            }
            other => panic!("{:?}", other.map(|(_, outcome, report)| (outcome, report.measures))),
        }
    }
}
