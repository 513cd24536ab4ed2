//! A step by force from the last solution that needs no iteration has a product of its own: u is not that of the step before, scaled.

use contact_normal::grid::Grid;
use contact_normal::operator::dense;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{InitialGuess, Method, Options, Outcome, Solver};

#[test]
fn loads_that_only_scale_are_certified_by_a_product() {
    let grid = Grid::new(24, 20, 1.0, 1.0).unwrap();
    // A flat punch: pressures are those of the step before, times a number.
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
        // What products by FFT are good for, on any number of steps.
        assert!(u.iter().zip(&state.u).all(|(a, b)| (a - b).abs() <= 4e-15 * largest), "{method:?}");
    }
}
