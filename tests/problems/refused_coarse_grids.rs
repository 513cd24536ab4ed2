//! A coarser grid may be refused although the scene's grid is not. Quantities, searches, price lists and bills then begin without it.
//!
//! The surface consists of columns of one element each, four elements apart. On the grid with half the elements in each direction an element contains
//! at most one column, too little to count as a surface, so that no element can carry the force there.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Friction, Layer, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{
    cost_of_accuracy, effects_bill, quantities, solve, solve_to_accuracy, Accuracy, BillOptions, Lack, Options,
    Outcome, Quantity,
};

use super::dense;

const M: usize = 64;
const FORCE: f64 = 1.0;
const BODIES: Bodies = Bodies { shear_modulus: [0.5, 0.5], poisson_ratio: [0.3, 0.3] };

fn columns() -> (Grid, Vec<f64>) {
    let grid = Grid::new(M, M, 0.1, 0.1).expect("a grid");
    let is_column = |i: usize| i % M % 4 == 1 && i / M % 4 == 1;
    (grid, (0..M * M).map(|i| if is_column(i) { 0.0 } else { f64::INFINITY }).collect())
}

#[test]
fn the_grid_of_half_the_elements_is_refused() {
    let (grid, _) = columns();
    let half = Grid::new(M / 2, M / 2, 2.0 * grid.dx, 2.0 * grid.dy).expect("a grid");
    let h = vec![f64::INFINITY; half.len()];
    let refused = solve(&Scene::new(half, &h, BODIES, Load::Force(FORCE)), &Options::default()).map(|_| ());
    assert!(refused.is_err(), "{refused:?}");
}

#[test]
fn quantities_have_the_rows_of_the_scene() {
    let (grid, h) = columns();
    let scene = Scene::new(grid, &h, BODIES, Load::Force(FORCE));
    let wanted = [Quantity::Force, Quantity::MaxPressure];
    let (stop, rows) = quantities(&scene, &Options::default(), &wanted, 1, None).expect("rows");
    assert_eq!((stop, rows.len()), (Outcome::Converged, 4));
    assert!(rows[..2].iter().all(|row| row.value.is_none() && row.lack == Some(Lack::Unsolved)), "{rows:?}");

    let (solver, _, report) = solve(&scene, &Options::default()).expect("a solvable scene");
    assert_eq!(rows[2].value, Some(report.measures.approach));
    // All columns touch, so that their displacements equal the approach: by direct sums, to the tolerance of 1e-6.
    let mut u = vec![0.0; grid.len()];
    dense::apply(solver.influence(), &grid, &solver.state().p, &mut u);
    for i in (0..grid.len()).filter(|i| h[*i] == 0.0) {
        assert!((u[i] / report.measures.approach - 1.0).abs() < 1e-5, "{i}");
    }
}

#[test]
fn searches_and_price_lists_begin_with_the_grid_of_the_scene() {
    let (grid, h) = columns();
    let scene = Scene::new(grid, &h, BODIES, Load::Force(FORCE));
    // The error of the stiffness is estimated from coarser grids.
    let quantity = Quantity::Stiffness;
    let accuracy = Accuracy { max_elements: 4 * grid.len() as u64, ..Accuracy::new(0.5).with(quantity, 0.5) };
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene");
    let solver = found.solver.expect("a result");
    assert!(solver.grid().mx >= M && found.report.measures.contact_count > 0, "{}", found.reason);

    let (stop, list) =
        cost_of_accuracy(&scene, &Options::default(), &accuracy, (quantity, &[0.5]), None, None).expect("a list");
    assert_eq!((stop, list.len()), (Outcome::Converged, 1));
}

#[test]
fn a_bill_is_that_of_the_grid_of_the_scene() {
    let (grid, h) = columns();
    let plain = Scene::new(grid, &h, BODIES, Load::Force(FORCE));
    let scene = Scene { layer: Some(Layer(Each::Uniform(0.01))), ..plain };
    let (stop, rows) =
        effects_bill(&scene, &Options::default(), &BillOptions::new(1e-2), &[Quantity::Force], None).expect("a bill");
    assert_eq!(stop, Outcome::Converged);
    assert!(rows[0].value.is_some_and(|value| value > 0.0), "{rows:?}");
}

/// Arrays that only a friction law reads fit one grid only. Without a law they are not read, so that several grids can be solved.
#[test]
fn what_a_law_would_read_is_not_in_the_way_without_one() {
    let grid = Grid::new(16, 16, 0.1, 0.1).expect("a grid");
    let at = |k: usize| (k as f64 - 7.5) * 0.1;
    let h: Vec<f64> = (0..256).map(|i| at(i % 16).powi(2) + at(i / 16).powi(2)).collect();
    let before = vec![0.3; grid.len()];
    let friction = Friction {
        motion: Motion::TransientRolling,
        prescribed: [Prescribed::Creepage(-0.01), Prescribed::Creepage(0.0)],
        coefficients_before: Some(&before),
        yield_limits: Some(&before),
        ..Friction::new(0.3)
    };
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, BODIES, Load::Approach(0.1)) };
    let (stop, rows) = quantities(&scene, &Options::default(), &[Quantity::TangentialForce], 1, None).expect("rows");
    assert_eq!(stop, Outcome::Converged);
    assert!(rows.iter().all(|row| row.value.is_some()), "{rows:?}");
    let found = solve_to_accuracy(&scene, &Options::default(), &Accuracy::new(1e-3), None, None).expect("a search");
    assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
}

/// The price list reaches the scene's grid, however much time the refused coarser grids take.
#[test]
fn a_price_list_comes_to_the_grid_of_the_scene_on_a_slow_machine() {
    let scene_grid = Grid::new(M, M, 0.05, 0.05).expect("a grid");
    let scene = Scene::new(scene_grid, &[], BODIES, Load::Force(0.1));
    let mut surface = |grid: &Grid, h: &mut [f64]| {
        let at = |k: usize| (k as f64 - 0.5 * (grid.mx as f64 - 1.0)) * grid.dx;
        std::thread::sleep(std::time::Duration::from_millis(40));
        h.iter_mut().enumerate().for_each(|(i, h)| {
            *h = if grid.mx < M { f64::INFINITY } else { 0.5 * (at(i % grid.mx).powi(2) + at(i / grid.mx).powi(2)) };
        });
        false
    };
    let accuracy = Accuracy::new(1e-2);
    let wanted = (Quantity::Force, &[1e-2][..]);
    let (stop, list) =
        cost_of_accuracy(&scene, &Options::default(), &accuracy, wanted, Some(&mut surface), None).expect("a list");
    assert!(stop == Outcome::Converged && list[0].grid.is_some(), "{list:?}");
}
