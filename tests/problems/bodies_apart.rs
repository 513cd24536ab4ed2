//! Without contact some values are exactly 0: quantities, price lists and searches agree on this. Also price lists of scenes that are not solved.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Friction, Layer, Load, Scene};
use contact_normal::solver::{
    cost_of_accuracy, effects_bill, quantities, solve_to_accuracy, Accuracy, BillOptions, Lack, Method, Obstacle,
    Options, Outcome, Price, Quantity, Verdict,
};

const M: usize = 32;
const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
const NONE: [Quantity; 6] = [
    Quantity::Force,
    Quantity::MaxPressure,
    Quantity::ContactArea,
    Quantity::TangentialForce,
    Quantity::SpinMoment,
    Quantity::StickArea,
];

fn grid() -> Grid {
    Grid::new(M, M, 0.1, 0.1).expect("a grid")
}

fn ball() -> Vec<f64> {
    let at = |k: usize| (k as f64 - 0.5 * (M as f64 - 1.0)) * 0.1;
    (0..M * M).map(|i| (at(i % M).powi(2) + at(i / M).powi(2)) / 20.0).collect()
}

/// The ball is 0.1 above the plate.
fn apart(h: &[f64]) -> Scene<'_> {
    Scene { friction: Some(Friction::new(0.3)), ..Scene::new(grid(), h, BODIES, Load::Approach(-0.1)) }
}

fn prices(scene: &Scene<'_>, quantity: Quantity, options: &Options) -> (Outcome, Vec<Price>) {
    let wanted = (quantity, &[1e-2, 1e-4][..]);
    cost_of_accuracy(scene, options, &Accuracy::new(0.1), wanted, None, None).expect("a list")
}

#[test]
fn values_of_bodies_apart_are_exact() {
    let h = ball();
    let (stop, rows) = quantities(&apart(&h), &Options::default(), &NONE, 2, None).expect("rows");
    assert_eq!((stop, rows.len()), (Outcome::Converged, 3 * NONE.len()));
    for row in rows {
        assert_eq!((row.value, row.error, row.lack), (Some(0.0), Some(0.0), None), "{row:?}");
    }
    // The mean gap of bodies apart has an error, which follows from the differences between grids.
    let (_, rows) = quantities(&apart(&h), &Options::default(), &[Quantity::MeanGap], 1, None).expect("rows");
    assert_eq!((rows[0].error, rows[0].lack), (None, Some(Lack::OneGrid)));
    assert!(rows[1].error.is_some_and(|error| error > 0.0), "{rows:?}");
}

/// A surface whose only high point is one element, 0.1 above the rest.
fn spike() -> Vec<f64> {
    let mut h = vec![0.1; M * M];
    h[10 * M + 10] = 0.0;
    h
}

/// On the grid with half the elements in each direction the spike has a quarter of its depth and does not touch. There 0 is not the exact value.
#[test]
fn a_grid_that_misses_the_contact_has_no_error() {
    let h = spike();
    let scene = Scene::new(grid(), &h, BODIES, Load::Approach(0.01));
    let wanted = [Quantity::Force, Quantity::MaxPressure];
    let (stop, rows) = quantities(&scene, &Options::default(), &wanted, 1, None).expect("rows");
    assert_eq!((stop, rows.len()), (Outcome::Converged, 4));
    for row in &rows[..2] {
        assert_eq!((row.value, row.error, row.lack), (Some(0.0), None, Some(Lack::NoContact)), "{row:?}");
    }
    assert!(rows[2..].iter().all(|row| row.value.is_some_and(|value| value > 0.0)), "{rows:?}");
}

/// The bill of the spike is computed on the scene's grid, because coarser grids miss the contact. An element of side d displaces its centre by `u = 4
/// ln(1 + sqrt 2) p d/(pi E*)`, 0.0786 p; the layer adds 0.08 p.
#[test]
fn a_bill_counts_no_grid_that_misses_the_contact() {
    let h = spike();
    let scene =
        Scene { layer: Some(Layer(Each::Uniform(0.08))), ..Scene::new(grid(), &h, BODIES, Load::Approach(0.01)) };
    let asked = BillOptions { max_seconds: 1e3, ..BillOptions::new(1e-2) };
    let (stop, rows) = effects_bill(&scene, &Options::default(), &asked, &[Quantity::Force], None).expect("a bill");
    assert_eq!((stop, rows.len(), rows[0].verdict), (Outcome::Converged, 1, Verdict::Needed), "{rows:?}");
    let own = 4.0 * (1.0 + 2f64.sqrt()).ln() / std::f64::consts::PI * 0.1 * BODIES.compliance();
    let change = rows[0].change.expect("a change") / rows[0].value.expect("a force");
    assert!((change / (0.08 / own) - 1.0).abs() < 1e-3, "{change}");
}

/// A search finds no contact on three grids, and the list names the scene's grid.
#[test]
fn prices_of_bodies_apart_are_those_of_their_grid() {
    let h = ball();
    let scene = apart(&h);
    let found = solve_to_accuracy(&scene, &Options::default(), &Accuracy::new(1e-2), None, None).expect("a search");
    assert_eq!((found.stop, found.reached), (Outcome::Converged, Some(0.0)), "{}", found.reason);
    for quantity in NONE {
        let (stop, rows) = prices(&scene, quantity, &Options::default());
        assert_eq!((stop, rows.len()), (Outcome::Converged, 2));
        for row in rows {
            assert_eq!((row.obstacle, row.error, row.grid), (None, Some(0.0), Some(grid())), "{quantity:?}: {row:?}");
            assert!(row.seconds > Some(0.0) && row.bytes > 0, "{quantity:?}: {row:?}");
        }
    }
    // The caller's limits apply here, too, and a quantity without a value has an obstacle.
    let wanted = (Quantity::Force, &[1e-2][..]);
    let accuracy = Accuracy { max_elements: 100, ..Accuracy::new(0.1) };
    let (_, rows) = cost_of_accuracy(&scene, &Options::default(), &accuracy, wanted, None, None).expect("a list");
    assert_eq!(rows[0].obstacle, Some(Obstacle::Elements), "{rows:?}");
    let (_, rows) = prices(&scene, Quantity::Stiffness, &Options::default());
    assert_eq!((rows[0].obstacle, rows[0].grid), (Some(Obstacle::Singular), None), "{rows:?}");
}

/// If only one iteration is allowed, no grid of the price list is solved, and the list must say so.
#[test]
fn a_price_list_without_a_solved_grid_says_so() {
    let h = ball();
    let scene = Scene::new(grid(), &h, BODIES, Load::Force(0.1));
    let options = Options { max_cycles: 1, method: Method::Norm, ..Options::default() };
    let (stop, rows) = prices(&scene, Quantity::Force, &options);
    assert_eq!(stop, Outcome::IterationLimit);
    assert!(rows.iter().all(|row| row.obstacle == Some(Obstacle::Singular) && row.grid.is_none()), "{rows:?}");
}
