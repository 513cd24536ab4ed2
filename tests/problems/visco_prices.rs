//! Prices of a step of bodies that relax.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Branches, Load, Scene, Visco};
use contact_normal::solver::{
    cost_of_accuracy, solve, solve_to_accuracy, Accuracy, Obstacle, Options, Outcome, Quantity,
};

use crate::visco::{G, MODULI, TIMES};

/// What the forms RELAXATION and CREEP of a step of dt from rest differ by, relative to the first: in contact A p is h - approach over the compliance of
/// the form, on any grid, so this is what compliances differ by. Those of `1/(G_inf + sum of G_k g_k)` and of `J_0 + sum of J_k (1 - g_k)`,
/// `g = (1 - exp(-x))/x`, x the step over the relaxation or creep time; creep times are the zeros of `G_inf + sum of G_k s t_k/(1 + s t_k)`.
fn by_hand(dt: f64) -> f64 {
    let g = |x: f64| -(-x).exp_m1() / x;
    let rest = G - MODULI.iter().sum::<f64>();
    let branches = || MODULI.into_iter().zip(TIMES);
    let stiffness = rest + branches().map(|(modulus, t)| modulus * g(dt / t)).sum::<f64>();
    let of = |s: f64| rest + branches().map(|(modulus, t)| modulus * s * t / (1.0 + s * t)).sum::<f64>();
    let slope = |s: f64| branches().map(|(modulus, t)| modulus * t / (1.0 + s * t).powi(2)).sum::<f64>();
    let mut rates: Vec<f64> = TIMES.iter().map(|t| 1.0 / t).collect();
    rates.sort_by(f64::total_cmp);
    let mut compliance = 1.0 / G;
    for k in 0..rates.len() {
        // A zero between two poles of -s, where it falls from + to - infinity; below the first from the modulus at rest.
        let (mut low, mut high) = (if k == 0 { 0.0 } else { rates[k - 1] }, rates[k]);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if of(-middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let time = 1.0 / low;
        compliance += time / slope(-low) * (1.0 - g(dt / time));
    }
    (compliance * stiffness - 1.0).abs()
}

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
    // Gaps in contact are left to the tolerance, relative to h - approach.
    let tolerance = 10.0 * Options::default().tolerance;
    let exact = by_hand(0.4);
    assert!((error(&scene) / exact - 1.0).abs() <= tolerance, "{} {exact}", error(&scene));
    let targets = [4.0 * exact, 0.25 * exact];
    let accuracy = Accuracy::new(targets[0]);
    let priced = (Quantity::Force, &targets[..]);
    let (stop, prices) = cost_of_accuracy(&scene, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert_eq!(stop, Outcome::Converged);
    println!("{exact} {prices:?}");
    for price in &prices {
        assert!((price.time_error / exact - 1.0).abs() <= tolerance, "{} {exact}", price.time_error);
        assert!(price.grid.is_some());
    }
    assert_eq!(prices[0].obstacle, None);
    assert_eq!(prices[1].obstacle, Some(Obstacle::Step));
    // Half the step from rest.
    let half = Scene { visco: Some(Visco { time_step: 0.2, ..step }), ..scene.clone() };
    assert!((error(&half) / by_hand(0.2) - 1.0).abs() <= tolerance, "{} {}", error(&half), by_hand(0.2));
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).unwrap();
    assert_eq!(found.stop, Outcome::Converged);
    assert!((found.report.visco.unwrap().time_error / exact - 1.0).abs() <= tolerance);
    let elastic = Scene { visco: None, ..scene };
    let (_, prices) = cost_of_accuracy(&elastic, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert!(prices.iter().all(|price| price.time_error == 0.0 && price.obstacle != Some(Obstacle::Step)));
}
