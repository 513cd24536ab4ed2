//! Full contact with two periods. The contact has no edge, whose outline would give an error estimate. Still searches and price lists choose grids
//! with enough elements, and the approach has an error.
//!
//! If the force is given, the approach is the mean of the undeformed distance: 0.01 for `0.01 (1 - cos x cos y)`, on any grid of two or more elements
//! each way.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{
    cost_of_accuracy, quantities, solve, solve_to_accuracy, Accuracy, Options, Outcome, Quantity,
};

const LENGTH: f64 = 6.4;
const AMPLITUDE: f64 = 0.01;
/// The mean pressure is 24000, a quarter of E*. Full contact needs `pi sqrt(2) E* 0.01/6.4`, some 700.
const FORCE: f64 = 1e6;

fn on(m: usize) -> Grid {
    Grid::new(m, m, LENGTH / m as f64, LENGTH / m as f64).expect("a grid")
}

fn wave(grid: &Grid, h: &mut [f64]) {
    let cos = |k: usize| (2.0 * PI / LENGTH * (k as f64 - 0.5 * (grid.mx as f64 - 1.0)) * grid.dx).cos();
    h.iter_mut().enumerate().for_each(|(i, h)| *h = AMPLITUDE * (1.0 - cos(i % grid.mx) * cos(i / grid.mx)));
}

fn distance(grid: &Grid) -> Vec<f64> {
    let mut h = vec![0.0; grid.len()];
    wave(grid, &mut h);
    h
}

/// E* = 1e5.
fn scene(grid: Grid, h: &[f64]) -> Scene<'_> {
    let bodies = Bodies::same(7e4, 0.3);
    Scene { period: Some(Period { x: true, y: true }), ..Scene::new(grid, h, bodies, Load::Force(FORCE)) }
}

#[test]
fn price_lists_name_grids_of_enough_elements() {
    let grid = on(64);
    let h = distance(&grid);
    let list = |quantity: Quantity, targets: &[f64]| {
        let wanted = (quantity, targets);
        cost_of_accuracy(&scene(grid, &h), &Options::default(), &Accuracy::new(0.1), wanted, None, None)
            .expect("a list")
            .1
    };
    for row in list(Quantity::Force, &[1e-2, 1e-3, 1e-4]) {
        let found = row.grid.expect("a grid");
        assert!(row.obstacle.is_none() && found.mx >= Quantity::Force.enough_across() && row.bytes > 0, "{row:?}");
        let h = distance(&found);
        let (_, stop, report) = solve(&scene(found, &h), &Options::default()).expect("a solvable scene");
        assert_eq!((stop, report.measures.contact_count), (Outcome::Converged, found.len()));
        let off = (report.measures.approach / AMPLITUDE - 1.0).abs();
        assert!(off <= row.target, "{row:?}: {off:e}");
    }
    let row = list(Quantity::MaxVonMises, &[1e-2])[0];
    let found = row.grid.expect("a grid");
    assert!(row.obstacle.is_none() && found.mx >= Quantity::MaxVonMises.enough_across(), "{row:?}");
}

/// A search that starts from one element sees only the distance in the middle, which is 0.
#[test]
fn a_search_goes_on_to_enough_elements() {
    for m in [1, 2, 4] {
        let accuracy = Accuracy::new(1e-2);
        let mut write = |grid: &Grid, h: &mut [f64]| {
            wave(grid, h);
            false
        };
        let found = solve_to_accuracy(&scene(on(m), &[]), &Options::default(), &accuracy, Some(&mut write), None)
            .expect("a solvable scene");
        assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
        assert!((found.report.measures.approach / AMPLITUDE - 1.0).abs() <= 1e-2, "{m}: {}", found.reason);
        assert!(found.solver.expect("a result").grid().mx >= Quantity::Force.enough_across(), "{m}");
    }
}

/// A wave along a single row of elements is uniform across the row, so that one row suffices.
#[test]
fn one_row_of_elements_is_enough_across_a_line() {
    let grid = Grid::new(64, 1, LENGTH / 64.0, LENGTH).expect("a grid");
    let cos = |k: usize| (2.0 * PI / 64.0 * (k as f64 + 0.5)).cos();
    let h: Vec<f64> = (0..64).map(|k| AMPLITUDE * (1.0 - cos(k))).collect();
    let found =
        solve_to_accuracy(&scene(grid, &h), &Options::default(), &Accuracy::new(1e-2), None, None).expect("a scene");
    assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
    assert_eq!(found.solver.expect("a result").grid().my, 1);
}

/// The approach of flat plates is their distance, even if it is 0. Its error on each grid is that of the residual.
#[test]
fn the_approach_of_flat_plates_is_exact() {
    let grid = on(64);
    for height in [0.0, 0.3] {
        let h = vec![height; grid.len()];
        let scene = scene(grid, &h);
        let (stop, rows) = quantities(&scene, &Options::default(), &[Quantity::Force], 2, None).expect("rows");
        assert_eq!((stop, rows.len()), (Outcome::Converged, 3));
        for row in &rows {
            let value = row.value.expect("an approach");
            assert!((value - height).abs() <= 1e-12, "{row:?}");
            assert!(row.lack.is_none() && row.error.is_some_and(|error| error <= 1e-6 * height + 1e-15), "{row:?}");
        }
        let accuracy = Accuracy::new(1e-2);
        let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a scene");
        assert_eq!(found.stop, Outcome::Converged, "{height}: {}", found.reason);
        let wanted = (Quantity::Force, &[1e-2][..]);
        let (_, list) = cost_of_accuracy(&scene, &Options::default(), &accuracy, wanted, None, None).expect("a list");
        assert!(list[0].obstacle.is_none() && list[0].grid.is_some_and(|grid| grid.mx >= 6), "{height}: {list:?}");
    }
}
