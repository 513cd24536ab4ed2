//! Solves to a given accuracy instead of on a given grid. The true error of the ellipse meets the target; limits end the refinement with the best
//! result so far; callbacks cancel it; and a message says what cannot be reached.

use crate::paper as case;

use contact_normal::analytic::{hertz, hertz_by_force, Hertz};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{
    cost_of_accuracy, solve_to_accuracy, Accuracy, Method, Options, Outcome, Quantity, Refinement,
};

/// The largest allowed ratio of the true error to the target if the target is met: an estimate may be too small by this factor (1 over the
/// effectivity of an error estimate).
const EFFECTIVITY: f64 = 3.0;
const START: usize = 16;

fn exact() -> Hertz {
    let compliance = Bodies::same(case::SHEAR_MODULUS, case::POISSON_RATIO).compliance();
    hertz(case::CURVATURE.0, case::CURVATURE.1, case::APPROACH, compliance).expect("a contact")
}

/// Refines the ellipse from 16 x 16 elements.
fn solved(load: Load, accuracy: Accuracy, options: &Options) -> Refinement {
    let h = case::undeformed_distance(START);
    let scene = Scene { load, ..case::scene(START, &h) };
    solve_to_accuracy(&scene, options, &accuracy, None, None).expect("a solvable scene")
}

fn grid_of(outcome: &Refinement) -> Grid {
    *outcome.solver.as_ref().expect("a result").grid()
}

fn by_approach(accuracy: Accuracy) -> Refinement {
    solved(Load::Approach(case::APPROACH), accuracy, &Options::default())
}

/// Asserts that the result is the converged one on the first grid of 16 x 16 elements.
fn assert_start_is_kept(outcome: &Refinement) {
    assert_eq!(grid_of(outcome).mx, START, "{}", outcome.reason);
    // With 16 x 16 elements the error of the force is some percent (tests/problems/hertz.rs).
    assert!((outcome.report.measures.force / exact().force - 1.0).abs() < 0.1);
    assert!(outcome.report.measures.certificate.residual <= 1e-6);
}

#[test]
fn the_true_error_meets_the_target() {
    let exact = exact();
    let by_force =
        hertz_by_force(case::CURVATURE.0, case::CURVATURE.1, exact.force, 0.72 / 82000.0).expect("a contact");
    for target in [1e-2, 1e-3, 1e-4] {
        for load in [Load::Approach(case::APPROACH), Load::Force(exact.force)] {
            let outcome = solved(load, Accuracy::new(target), &Options::default());
            assert_eq!(outcome.stop, Outcome::Converged, "{target:e}, {load:?}: {}", outcome.reason);
            let measures = &outcome.report.measures;
            let error = match load {
                Load::Approach(_) => (measures.force / exact.force - 1.0).abs(),
                Load::Force(_) => (measures.approach / by_force.approach - 1.0).abs(),
            };
            let (reached, grid) = (outcome.reached.expect("an estimate"), grid_of(&outcome));
            println!("{target:e} {load:?}: {reached:e} estimated, {error:e} true, {} x {}", grid.mx, grid.my);
            assert!(reached <= target);
            assert!(error <= EFFECTIVITY * target, "{target:e}, {load:?}: {error:e} on {} x {}", grid.mx, grid.my);
            // The grid covers the same rectangle. Its sides are multiplied by powers of two, which are exact.
            assert_eq!((grid.mx as f64 * grid.dx, grid.my as f64 * grid.dy), (20.0, 12.0));
            // The ledger has one row for each grid of full multigrid, the finest one last.
            let ledger = outcome.solver.as_ref().expect("a result").ledger();
            let last = ledger.last().expect("rows");
            assert!(ledger.len() >= 2, "{ledger:?}");
            assert_eq!((last.mx, last.measures.force), (grid.mx, measures.force));
        }
    }
}

#[test]
fn a_finer_target_takes_a_finer_grid() {
    let elements: Vec<usize> = [1e-2, 1e-3, 1e-4].map(|t| grid_of(&by_approach(Accuracy::new(t))).len()).to_vec();
    assert!(elements[0] < elements[2] && elements.is_sorted(), "{elements:?}");
}

#[test]
fn a_surface_callback_gives_what_a_refined_parabola_gives() {
    // The cubics that refine the array reproduce a parabola up to round-off, so that only the last digits differ.
    let accuracy = Accuracy::new(1e-3);
    let array = by_approach(accuracy);
    let mut asked = Vec::new();
    let mut surface = |grid: &Grid, h: &mut [f64]| {
        asked.push(grid.mx);
        h.copy_from_slice(&case::undeformed_distance(grid.mx));
        false
    };
    // If there is a callback, the array of the scene is not read.
    let scene = case::scene(START, &[]);
    let outcome =
        solve_to_accuracy(&scene, &Options::default(), &accuracy, Some(&mut surface), None).expect("a solvable scene");
    assert_eq!((outcome.stop, grid_of(&outcome)), (Outcome::Converged, grid_of(&array)));
    assert_eq!((asked.first(), asked.last()), (Some(&START), Some(&grid_of(&outcome).mx)));
    let (found, other) = (outcome.report.measures.force, array.report.measures.force);
    // Two solves, each with a residual of 1e-6.
    assert!((found / other - 1.0).abs() < 2e-6, "{found} and {other}");
}

#[test]
fn limits_end_a_search_with_the_best_result() {
    let far = Accuracy::new(1e-6);
    let at_start: [(Accuracy, &str); 3] = [
        (Accuracy { max_elements: (2 * START * 2 * START - 1) as u64, ..far }, "max_elements"),
        (Accuracy { max_bytes: 1, ..far }, "max_bytes"),
        (Accuracy { max_seconds: 1e-9, ..far }, "max_seconds"),
    ];
    for (accuracy, limit) in at_start {
        let outcome = by_approach(accuracy);
        assert_eq!(outcome.stop, Outcome::IterationLimit, "{}", outcome.reason);
        assert!(outcome.reason.contains(limit) && outcome.reason.contains("16 x 16"), "{}", outcome.reason);
        assert_start_is_kept(&outcome);
    }
    let outcome = by_approach(Accuracy { max_elements: 64 * 64, ..far });
    assert_eq!((outcome.stop, grid_of(&outcome).mx), (Outcome::IterationLimit, 64), "{}", outcome.reason);
    assert!(outcome.reached.is_some_and(|reached| reached > 1e-6));
}

#[test]
fn callbacks_cancel_and_what_was_solved_is_kept() {
    let h = case::undeformed_distance(START);
    let (scene, accuracy, options) = (case::scene(START, &h), Accuracy::new(1e-6), Options::default());

    let mut surface = |grid: &Grid, h: &mut [f64]| {
        h.copy_from_slice(&case::undeformed_distance(grid.mx));
        grid.mx > START
    };
    let outcome = solve_to_accuracy(&scene, &options, &accuracy, Some(&mut surface), None).expect("a solvable scene");
    assert_eq!(outcome.stop, Outcome::Cancelled);
    assert!(outcome.reason.contains("surface") && outcome.reason.contains("16 x 16"), "{}", outcome.reason);
    assert_start_is_kept(&outcome);

    let mut at_once = |_: &Grid, _: &mut [f64]| true;
    let outcome = solve_to_accuracy(&scene, &options, &accuracy, Some(&mut at_once), None).expect("a solvable scene");
    assert!(outcome.stop == Outcome::Cancelled && outcome.solver.is_none() && outcome.reached.is_none());

    // Progress on 16 x 16 elements comes from the first solve, and from coarse grids of the second one. Only the second solve is cancelled.
    let mut progress = |told: &contact_normal::solver::Progress| told.mx > START;
    let outcome = solve_to_accuracy(&scene, &options, &accuracy, None, Some(&mut progress)).expect("a solvable scene");
    assert_eq!(outcome.stop, Outcome::Cancelled);
    assert!(outcome.reason.contains("progress"), "{}", outcome.reason);
    assert_start_is_kept(&outcome);
}

#[test]
fn a_target_below_round_off_says_the_best_reached() {
    let outcome = by_approach(Accuracy::new(1e-15));
    assert_eq!(outcome.stop, Outcome::Stagnated);
    let reached = outcome.reached.expect("an estimate");
    let said = ["round-off", "16 x 16", &format!("{reached:.2e}")].iter().all(|word| outcome.reason.contains(word));
    assert!(said, "{}", outcome.reason);
    assert_start_is_kept(&outcome);
}

#[test]
fn a_solve_that_does_not_converge_ends_a_search() {
    let options = Options { max_cycles: 1, method: Method::Norm, ..Options::default() };
    let outcome = solved(Load::Approach(case::APPROACH), Accuracy::new(1e-3), &options);
    assert_eq!(outcome.stop, Outcome::IterationLimit);
    assert!(outcome.reason.contains("max_cycles was reached on 16 x 16"), "{}", outcome.reason);
    // The estimated error includes the error that the residual causes.
    let residual = outcome.report.measures.certificate.residual;
    assert!(outcome.reached.is_some_and(|reached| reached >= residual) && residual > 1e-6);
}

#[test]
fn no_contact_is_no_error() {
    for load in [Load::Approach(-1.0), Load::Force(0.0)] {
        let outcome = solved(load, Accuracy::new(1e-3), &Options::default());
        assert_eq!((outcome.stop, outcome.reached), (Outcome::Converged, Some(0.0)), "{load:?}: {}", outcome.reason);
        assert_eq!((outcome.report.measures.force, outcome.report.measures.contact_count), (0.0, 0));
    }
}

#[test]
fn elements_without_surface_stay_excluded_on_finer_grids() {
    let mut h = case::undeformed_distance(START);
    // The contact area has a hole in its middle.
    h[START * 7 + 8] = f64::INFINITY;
    let scene = case::scene(START, &h);
    let accuracy = Accuracy { max_elements: 64 * 64, ..Accuracy::new(1e-9) };
    let outcome = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene");
    let solver = outcome.solver.as_ref().expect("a result");
    let parts = solver.grid().mx / START;
    assert_eq!(parts, 4);
    let contact = &solver.state().contact;
    let in_hole = |ix: usize, iy: usize| ix / parts == 8 && iy / parts == 7;
    for (iy, ix) in (7 * parts - 1..=8 * parts).flat_map(|iy| (8 * parts - 1..=9 * parts).map(move |ix| (iy, ix))) {
        assert_eq!(contact[solver.grid().index(ix, iy)], !in_hole(ix, iy), "({ix}, {iy})");
    }
}

#[test]
fn a_solve_that_takes_too_long_is_dropped() {
    // The prediction allows 32 x 32 elements. Then the surface callback takes longer than the time limit.
    let h = case::undeformed_distance(START);
    let (scene, seconds) = (case::scene(START, &h), 1.0);
    let mut surface = |grid: &Grid, h: &mut [f64]| {
        h.copy_from_slice(&case::undeformed_distance(grid.mx));
        if grid.mx > START {
            std::thread::sleep(std::time::Duration::from_secs_f64(1.1 * seconds));
        }
        false
    };
    let accuracy = Accuracy { max_seconds: seconds, ..Accuracy::new(1e-6) };
    let outcome =
        solve_to_accuracy(&scene, &Options::default(), &accuracy, Some(&mut surface), None).expect("a solvable scene");
    assert_eq!(outcome.stop, Outcome::IterationLimit);
    assert!(outcome.reason.contains("max_seconds"), "{}", outcome.reason);
    assert_start_is_kept(&outcome);
}

#[test]
fn a_search_without_an_estimate_is_given_up() {
    // A pin of one element, which is the last of a block of 4 x 4 elements. Coarser grids sample the middle of blocks and miss the pin, so that they
    // have no contact.
    let mut surface = |grid: &Grid, h: &mut [f64]| {
        h.fill(1.0);
        h[grid.index(grid.mx / 2 + 3, grid.my / 2 + 3)] = 0.0;
        false
    };
    let scene = Scene { load: Load::Approach(0.5), ..case::scene(START, &[]) };
    let outcome = solve_to_accuracy(&scene, &Options::default(), &Accuracy::new(1e-2), Some(&mut surface), None)
        .expect("a scene");
    assert_eq!((outcome.stop, outcome.reached), (Outcome::Stagnated, None), "{}", outcome.reason);
    // The search ends after three finer grids without an estimate.
    assert_eq!(grid_of(&outcome).mx, 128);
    assert!(outcome.reason.contains("no estimate") && outcome.reason.contains("not known"), "{}", outcome.reason);
}

/// A wave in plane strain, on grids with two periods that are one element wide. Finer grids keep the one element, across which nothing varies. The
/// pressures are those of Westergaard (J. Appl. Mech. 6, 1939): the largest is `2 sqrt(pm p*)` for a mean of pm, with `p* = pi E*` times the height
/// over the length of the wave.
#[test]
fn a_line_in_plane_strain_keeps_its_one_element() {
    let (amplitude, across, part) = (0.01, 0.5, 0.3);
    let full = std::f64::consts::PI * amplitude;
    let bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0; 2] };
    for along_x in [true, false] {
        let place = |i: usize| 2.0 * std::f64::consts::PI * (i as f64 + 0.5) / 40.0;
        let h: Vec<f64> = (0..40).map(|i| amplitude * (1.0 - place(i).cos())).collect();
        let grid = match along_x {
            true => Grid::new(40, 1, 1.0 / 40.0, across),
            false => Grid::new(1, 40, across, 1.0 / 40.0),
        };
        let load = Load::Force(part * full * across);
        let period = Some(Period { x: true, y: true });
        let scene = Scene { period, ..Scene::new(grid.unwrap(), &h, bodies, load) };
        let options = Options { threads: 1, ..Options::default() };
        let found = solve_to_accuracy(&scene, &options, &Accuracy::new(1e-4), None, None).unwrap();
        assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
        let on = |grid: &Grid| if along_x { (grid.mx, grid.my) } else { (grid.my, grid.mx) };
        let (along, one) = on(&grid_of(&found));
        assert!(along >= 80 && one == 1, "{along} x {one}");
        let off = found.report.measures.max_pressure / (2.0 * full * part.sqrt()) - 1.0;
        // The pressure of the element at the top is a mean over it, smaller than the peak by a part of about `(pi/along)^2/6`.
        assert!(off.abs() <= 2e-3, "{off:e} on {along}");
        let wanted = (Quantity::Force, &[1e-2, 1e-3, 1e-4][..]);
        let (_, rows) = cost_of_accuracy(&scene, &options, &Accuracy::new(0.0), wanted, None, None).unwrap();
        for row in rows {
            let grid = row.grid.unwrap_or_else(|| panic!("{row:?}"));
            assert!(on(&grid).1 == 1 && on(&grid).0 <= 4 * along, "{row:?}");
        }
    }
}
