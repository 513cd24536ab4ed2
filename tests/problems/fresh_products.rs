//! If a step by force from the last solution needs no iteration, its u is a product of its own, not the scaled u of the last step.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{InitialGuess, Method, Options, Outcome, Solver};

use super::dense;

#[test]
fn loads_that_only_scale_are_certified_by_a_product() {
    let grid = Grid::new(24, 20, 1.0, 1.0).unwrap();
    // A flat punch, whose pressures are those of the last step times a number.
    let mut h = vec![0.0; grid.len()];
    h[..3 * grid.mx].fill(f64::INFINITY);
    let scene = |force| Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(force));
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg, Method::Multigrid] {
        let options = Options { method, initial_guess: InitialGuess::Previous, ..Options::default() };
        let mut solver = Solver::new(&scene(1.0), &options).unwrap();
        let mut force = 1.0;
        for step in 0..300 {
            let (stop, report) = solver.solve(&scene(force), &options, None, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{method:?} step {step}");
            assert!(report.count.matrix_products >= 1, "{method:?} step {step}: no product");
            force *= if step % 3 == 0 { 0.83 } else { 1.07 };
        }
        let state = solver.state();
        let mut u = vec![0.0; h.len()];
        dense::apply(&scene(1.0).coefficients().unwrap(), &grid, &state.p, &mut u);
        let largest = u.iter().copied().fold(0.0, f64::max);
        // u has the accuracy of one FFT product, some units of round-off, after any number of steps.
        assert!(u.iter().zip(&state.u).all(|(a, b)| (a - b).abs() <= 4e-15 * largest), "{method:?}");
    }
}

/// 88 elements in contact are too many for the direct solve. p and u are extrapolated from the last two solutions, and need no iteration; u must
/// still be a product.
#[test]
fn loads_to_and_fro_are_certified_by_a_product() {
    let grid = Grid::new(25, 13, 1.0, 1.0).unwrap();
    let at = |i: usize| 0.02 * (((i % 25) as f64 - 12.5).powi(2) + ((i / 25) as f64 - 6.5).powi(2));
    let h: Vec<f64> = (0..grid.len()).map(at).collect();
    let scene = |force| Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(force));
    for (sway, tolerance) in [(0.02, 1e-9), (1e-3, 1e-6)] {
        let options = Options { initial_guess: InitialGuess::Previous, tolerance, ..Options::default() };
        let mut solver = Solver::new(&scene(10.0), &options).unwrap();
        for step in 0..60 {
            let force = 10.0 * (1.0 + sway * f64::from(step % 2));
            let (stop, report) = solver.solve(&scene(force), &options, None, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{sway} step {step}");
            assert!(report.count.matrix_products >= 1, "{sway} step {step}: no product");
        }
    }
}
