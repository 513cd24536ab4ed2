//! Steps of the undeformed distance, beside which pressures are singular. The beginning of a period is no step.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{solve, solve_to_accuracy, Accuracy, Options, Outcome, Quantity};

const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };

/// A ball of radius 10 on m x m elements, which is lower by `deep` beyond `edge`.
fn ball(m: usize, edge: f64, deep: f64) -> (Grid, Vec<f64>) {
    let d = 6.0 / m as f64;
    let at = |k: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
    let of = |i: usize| {
        let (x, y) = (at(i % m), at(i / m));
        (x * x + y * y) / 20.0 + if x > edge { deep } else { 0.0 }
    };
    (Grid::new(m, m, d, d).expect("a grid"), (0..m * m).map(of).collect())
}

/// The estimated error of the largest pressure, and the pressure.
fn largest((grid, h): &(Grid, Vec<f64>)) -> (Option<f64>, f64) {
    let options = Options { estimates: true, ..Options::default() };
    let scene = Scene::new(*grid, h, BODIES, Load::Force(0.5));
    let (_, outcome, report) = solve(&scene, &options).expect("a solvable scene");
    assert_eq!(outcome, Outcome::Converged);
    (report.error.max_pressure, report.measures.max_pressure)
}

/// The largest pressure on these grids is in the middle of the ball. It must not have an estimate, because pressures at the step grow without bound
/// on finer grids.
#[test]
fn the_largest_pressure_has_no_estimate_where_contact_ends_at_a_step() {
    for edge in [1.1, 1.15, 1.2, 1.25] {
        for deep in [0.05, f64::INFINITY] {
            let (error, pressure) = largest(&ball(32, edge, deep));
            assert_eq!(error, None, "edge {edge}, {deep} deep: of {pressure}");
        }
    }
    // The contact radius is 1.6. A step outside the contact changes nothing.
    let [plain, outside] = [10.0, 2.0].map(|edge| largest(&ball(32, edge, 0.05)).0.expect("an estimate"));
    assert!((outside / plain - 1.0).abs() < 0.1, "{outside} for {plain}");
}

/// The results of a search on one period do not depend on its beginning.
#[test]
fn a_search_does_not_depend_on_where_a_period_begins() {
    let (mx, my) = (12, 10);
    let grid = Grid::new(mx, my, 1.0, 1.0).expect("a grid");
    let waves =
        |x: f64, y: f64| (2.0 * PI * x / 12.0).cos() + 0.3 * (2.0 * PI * (3.0 * x / 12.0 + 2.0 * y / 10.0)).cos();
    let of = |x: usize, y: usize| 0.01 * waves(x as f64, y as f64);
    let searched = |by: (usize, usize)| {
        let h: Vec<f64> = (0..mx * my).map(|i| of((i % mx + by.0) % mx, (i / mx + by.1) % my)).collect();
        let period = Some(Period { x: true, y: true });
        let scene = Scene { period, ..Scene::new(grid, &h, BODIES, Load::Force(0.05)) };
        let accuracy = Accuracy::new(1e-2).with(Quantity::MaxPressure, 0.1);
        let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene");
        assert_eq!(found.stop, Outcome::Converged, "{by:?} {}", found.reason);
        let solver = found.solver.expect("a solver");
        (solver.grid().len(), found.report.measures.approach, found.report.measures.max_pressure)
    };
    let (elements, approach, pressure) = searched((0, 0));
    for by in [(6, 0), (0, 5), (5, 3)] {
        let (others, other_approach, other_pressure) = searched(by);
        assert_eq!(others, elements, "{by:?}");
        // The solves of the search have a tolerance of at most 1e-4 of the pressures.
        assert!((other_approach - approach).abs() < 1e-4 * 0.01, "{by:?}: {other_approach} for {approach}");
        assert!((other_pressure / pressure - 1.0).abs() < 1e-3, "{by:?}: {other_pressure} for {pressure}");
    }
}

/// A search from an array with a step ends only where the estimate covers the change to finer grids. If the estimate on the array's own grid did not
/// include jumps, the search would end there, and miss a target of 3 % by a factor of three.
#[test]
fn a_search_of_an_array_with_a_step_keeps_its_target() {
    let m = 32;
    let grid = Grid::new(m, m, 0.031, 0.031).expect("a grid");
    let h: Vec<f64> = (0..m * m).map(|i| if (18..m).contains(&(i % m)) { 0.0493 } else { 0.0 }).collect();
    let scene = Scene::new(
        grid,
        &h,
        Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0; 2] },
        Load::Force(0.005),
    );
    let searched = |target: f64, most: u64| {
        let accuracy = Accuracy { max_elements: most, ..Accuracy::new(target) };
        solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene")
    };
    let finest = searched(1e-6, 1 << 16).report.measures.approach;
    for target in [0.05, 0.03, 0.02] {
        let found = searched(target, 1 << 16);
        let off = (found.report.measures.approach / finest - 1.0).abs();
        println!("target {target}: off by {off:.2e}, {}", found.reason);
        assert!(found.stop != Outcome::Converged || off <= target, "{target}: {off}");
    }
}
