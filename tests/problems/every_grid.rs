//! Every small grid is solved by every method, with the half-space's coefficients and with a table of the same coefficients. Among them are grids
//! whose coarser grids have larger transforms than the finest one, single rows, and odd and prime numbers of elements.

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, Table};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome};

#[test]
fn every_small_grid_is_solved_by_every_method() {
    let bodies = Bodies::same(82000.0, 0.28);
    let half_space = HalfSpace::new(0.2, 0.25, bodies.compliance());
    for (mx, my) in (1..=20).flat_map(|mx| (1..=20).map(move |my| (mx, my))) {
        let grid = Grid::new(mx, my, 0.2, 0.25).expect("a grid");
        let centre = |i: usize, m: usize| i as f64 - 0.5 * m as f64;
        let h: Vec<f64> =
            (0..mx * my).map(|i| 0.01 * (centre(i % mx, mx).powi(2) + centre(i / mx, my).powi(2))).collect();
        let values: Vec<f64> = (0..4 * mx * my)
            .map(|i| half_space.at((i % (2 * mx)) as i64 - mx as i64, (i / (2 * mx)) as i64 - my as i64))
            .collect();
        let table = Table::new(mx, my, &values, &grid).expect("a table");
        let plain = Scene::new(grid, &h, bodies, Load::Approach(0.1));
        let own = Scene { influence: Some(table), ..plain.clone() };
        let methods = [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg];
        let mut forces = Vec::new();
        for (method, scene) in methods.into_iter().flat_map(|method| [(method, &plain), (method, &own)]) {
            let options = Options { method, ..Options::default() };
            let (_, stop, report) = solve(scene, &options).expect("a valid scene");
            assert_eq!(stop, Outcome::Converged, "{mx} x {my} by {method:?}");
            forces.push(report.measures.force);
        }
        // The error of the force is of the order of the residual, whose tolerance is 1e-6: by the energy norm it is relative to the square root of p
        // A p, and condition numbers are at most 20 here. Hence 2e-5.
        assert!(forces.iter().all(|force| (force / forces[0] - 1.0).abs() < 2e-5), "{mx} x {my}: {forces:?}");
    }
}
