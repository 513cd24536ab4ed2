//! A shift from rest with nu = 0 starts from the pressures of a smaller load: its conditions by direct sums, beside the start on coarser grids.

use contact_normal::friction::{Report, Solution};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, InitialGuess, Options, Outcome, Progress, Solver};

use super::support::residual;

const MU: f64 = 0.4;
const TOLERANCE: f64 = 1e-6;

/// Two bumps of different heights, waves, and a hole.
fn surface() -> (Grid, Vec<f64>) {
    let (mx, my) = (44, 36);
    let grid = Grid::new(mx, my, 0.05, 0.06).unwrap();
    let h = (0..grid.len())
        .map(|i| {
            let (x, y) = ((i % mx) as f64 - 21.3, (i / mx) as f64 - 17.6);
            let bump = |x: f64, y: f64| 1e-4 * (x * x + 1.3 * y * y);
            let h = bump(x - 8.0, y).min(bump(x + 9.0, y - 3.0) + 2e-3) + 4e-4 * (0.9 * x).sin() * (1.1 * y).cos();
            if (i % mx, i / mx) == (29, 17) {
                f64::INFINITY
            } else {
                h
            }
        })
        .collect();
    (grid, h)
}

fn by(x: Prescribed, y: Prescribed) -> Friction<'static> {
    Friction { prescribed: [x, y], ..Friction::new(MU) }
}

fn run(scene: &Scene<'_>) -> (Vec<f64>, Report, Solution) {
    let options = Options { tolerance: TOLERANCE, ..Options::default() };
    let (solver, stop, report) = solve(scene, &options).unwrap();
    assert_eq!(stop, Outcome::Converged, "{:?}", scene.friction);
    (solver.state().p.clone(), report.friction.unwrap(), solver.friction().unwrap().clone())
}

#[test]
fn a_superposed_start_meets_the_conditions_with_fewer_products() {
    let (grid, h) = surface();
    let bodies = Bodies::same(1.0, 0.0);
    let plain = Scene::new(grid, &h, bodies, Load::Force(0.012));
    let depth = {
        let (solver, ..) = solve(&plain, &Options::default()).unwrap();
        solver.state().approach - h.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let (shift, force) = (Prescribed::Creepage, Prescribed::Force);
    let bound = MU * 0.012;
    let none = vec![0.0; grid.len()];
    for (friction, most) in [
        (by(shift(-0.1 * MU * depth), shift(0.0)), 0.9),
        (by(shift(0.3 * MU * depth), shift(-0.2 * MU * depth)), 0.9),
        (by(shift(0.0), shift(0.8 * MU * depth)), 0.9),
        // All slips: there is no smaller load.
        (by(shift(3.0 * MU * depth), shift(1.0 * MU * depth)), 1.0),
        (by(force(0.2 * bound), force(0.1 * bound)), 0.9),
        (by(force(-0.95 * bound), force(0.0)), 0.9),
        (by(force(0.5 * bound), shift(0.0)), 0.9),
        // Too little to tell p* from p, or not one direction: the coarser grids start these.
        (by(shift(1e-6 * depth), shift(0.0)), 1.0),
        (by(force(0.5 * bound), shift(0.1 * MU * depth)), 1.0),
    ] {
        for load in [plain.load, Load::Approach(depth)] {
            let scene = Scene { friction: Some(friction), load, ..plain.clone() };
            if matches!(load, Load::Approach(_)) && matches!(friction.prescribed[0], Prescribed::Force(_)) {
                continue;
            }
            let (p, report, solution) = run(&scene);
            let still = vec![[0.0; 2]; grid.len()];
            let left = residual((&grid, 0.0), &p, &friction, &still, (&report, &solution));
            // The tolerance, and round-off of two products.
            assert!(left <= 1.001 * TOLERANCE, "{friction:?}: {left}");
            assert!((left - report.certificate.residual).abs() <= 1e-10, "{friction:?}");
            // Tractions before, even of 0, are not known to be none: these begin on the coarser grids.
            let previous = Previous::Given([&none, &none]);
            let nested = run(&Scene { friction: Some(Friction { previous, ..friction }), ..scene.clone() });
            assert!(
                report.products <= most * nested.1.products,
                "{friction:?}: {} {}",
                report.products,
                nested.1.products
            );
            let carried: f64 = MU * p.iter().sum::<f64>() * grid.element_area();
            for k in 0..2 {
                // Residuals leave less than that of a force (docs/friction.md), and of a shift the same part.
                assert!((report.force[k] - nested.1.force[k]).abs() <= 2.0 * TOLERANCE * carried, "{friction:?}");
                let change = (report.creepage[k] - nested.1.creepage[k]).abs();
                assert!(change <= 10.0 * TOLERANCE * MU * depth, "{friction:?}: {change}");
            }
        }
    }
}

#[test]
fn pressures_handles_and_derivatives_do_not_notice_how_a_shift_starts() {
    let (grid, h) = surface();
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.0), Load::Force(0.012));
    let friction = Friction { sensitivities: true, ..by(Prescribed::Force(2e-3), Prescribed::Force(0.0)) };
    let scene = Scene { friction: Some(friction), ..plain.clone() };
    let options = Options { tolerance: TOLERANCE, ..Options::default() };
    let (p, report, solution) = run(&scene);
    let (alone, ..) = solve(&plain, &options).unwrap();
    assert_eq!(alone.state().p, p);
    // A handle that solved something else before; from nothing it finds the same bits.
    let mut solver = Solver::new(&plain, &options).unwrap();
    let other = Scene {
        friction: Some(by(Prescribed::Creepage(1e-4), Prescribed::Creepage(1e-3))),
        load: Load::Force(0.03),
        ..plain.clone()
    };
    for scene in [&other, &scene, &plain, &scene] {
        solver.solve(scene, &options, None, None).unwrap();
    }
    assert_eq!(solver.state().p, p);
    assert_eq!(solver.friction().unwrap().traction, solution.traction);
    // The next one continues.
    let again = Options { initial_guess: InitialGuess::Previous, ..options };
    assert_eq!(solver.solve(&plain, &again, None, None).unwrap().0, Outcome::Converged);
    let none = vec![0.0; grid.len()];
    let previous = Previous::Given([&none, &none]);
    let nested = run(&Scene { friction: Some(Friction { previous, ..friction }), ..plain.clone() }).1;
    let (found, expected) = (report.sensitivities.unwrap(), nested.sensitivities.unwrap());
    let largest = expected.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        // Linear solves to 1e-5; the same elements slip.
        assert!((found - expected).abs() <= 1e-3 * largest, "{found} {expected}");
    }
}

#[test]
fn a_callback_cancels_the_smaller_load_too() {
    let (grid, h) = surface();
    let friction = by(Prescribed::Creepage(1e-3), Prescribed::Creepage(0.0));
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, Bodies::same(1.0, 0.0), Load::Force(0.012)) };
    let options = Options::default();
    let told = |last: u32| {
        let mut count = 0;
        let mut callback = |_: &Progress| {
            count += 1;
            count >= last
        };
        let mut solver = Solver::new(&scene, &options).unwrap();
        let (stop, _) = solver.solve(&scene, &options, None, Some(&mut callback)).unwrap();
        // What is there is feasible.
        let solution = solver.friction().unwrap();
        assert!(solution.traction.iter().zip(&solver.state().p).all(|(q, p)| q[0].hypot(q[1]) <= MU * p));
        (stop, count)
    };
    let (stop, total) = told(u32::MAX);
    assert_eq!(stop, Outcome::Converged);
    for last in 1..=total {
        let (stop, count) = told(last);
        // The normal problem may finish a step that it began.
        assert!(stop == Outcome::Cancelled && count <= last + 2, "{stop:?}, {last} {count}");
    }
}
