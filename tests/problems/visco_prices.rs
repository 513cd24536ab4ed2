//! Prices of a step of bodies that relax.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Branches, Load, Scene, Visco};
use contact_normal::solver::{
    cost_of_accuracy, solve, solve_to_accuracy, Accuracy, Obstacle, Options, Outcome, Quantity,
};

use crate::visco::{G, MODULI, TIMES};

/// A step from rest may be solved on any grid: its prices, and a solve to an accuracy, say what the length of the step leaves beside the grid.
#[test]
fn prices_of_a_step_from_rest_have_the_error_of_the_step() {
    let (m, side) = (48, 0.05);
    let grid = Grid::new(m, m, side, side).unwrap();
    let at = |k: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) * side;
    let h: Vec<f64> = (0..m * m).map(|i| 0.5 * (at(i % m).powi(2) + at(i / m).powi(2)) / 10.0).collect();
    let solid = Branches { modulus: &MODULI, time: &TIMES };
    let step = Visco { bodies: [solid, solid], time_step: 0.4, ..Visco::default() };
    let bodies = Bodies::same(G, 0.4);
    let scene = Scene { visco: Some(step), ..Scene::new(grid, &h, bodies, Load::Approach(0.06)) };
    let error = |scene: &Scene<'_>| solve(scene, &Options::default()).unwrap().2.visco.unwrap().time_error;
    let exact = error(&scene);
    assert!(exact > 1e-4 && exact < 0.1, "{exact}");
    let targets = [4.0 * exact, 0.25 * exact];
    let accuracy = Accuracy::new(targets[0]);
    let priced = (Quantity::Force, &targets[..]);
    let (stop, prices) = cost_of_accuracy(&scene, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert_eq!(stop, Outcome::Converged);
    println!("{exact} {prices:?}");
    for price in &prices {
        // Relative to h - approach in contact, which small grids resolve to some percent.
        assert!((price.time_error / exact - 1.0).abs() <= 0.1, "{} {exact}", price.time_error);
        assert!(price.grid.is_some());
    }
    assert_eq!(prices[0].obstacle, None);
    assert_eq!(prices[1].obstacle, Some(Obstacle::Step));
    // Half the step from rest: another load, but a quarter of the error, about.
    let half = Scene { visco: Some(Visco { time_step: 0.2, ..step }), ..scene.clone() };
    assert!((0.15..0.4).contains(&(error(&half) / exact)), "{} {exact}", error(&half));
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).unwrap();
    assert_eq!(found.stop, Outcome::Converged);
    assert!((found.report.visco.unwrap().time_error / exact - 1.0).abs() <= 0.1);
    let elastic = Scene { visco: None, ..scene };
    let (_, prices) = cost_of_accuracy(&elastic, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert!(prices.iter().all(|price| price.time_error == 0.0 && price.obstacle != Some(Obstacle::Step)));
}
