//! The memory of large arrays returns to the system while a solve does not need them (they rest). This changes no bit of a result. The test is a
//! separate program, because the size from which arrays rest is a setting of the process.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{Options, Outcome, Solver};
use par::memory::rest_from;

/// The bits of p and u of two solves on one solver, by approach and by force.
fn bits_of_solves(h: &[f64], m: usize) -> Vec<u64> {
    let grid = Grid::new(m, m, 1.0, 1.3).unwrap();
    let bodies = Bodies::same(82000.0, 0.28);
    let options = Options { threads: 1, ..Options::default() };
    let mut solver = Solver::new(&Scene::new(grid, h, bodies, Load::Approach(0.02)), &options).unwrap();
    let mut bits = Vec::new();
    for load in [Load::Approach(0.02), Load::Force(2e5)] {
        let (outcome, _) = solver.solve(&Scene::new(grid, h, bodies, load), &options, None, None).unwrap();
        assert_eq!(outcome, Outcome::Converged);
        bits.extend(solver.state().p.iter().chain(&solver.state().u).map(|value| value.to_bits()));
    }
    bits
}

#[test]
fn arrays_that_rest_between_their_uses_change_no_bit() {
    // The contact is solved on a window, and on the whole grid.
    for reach in [0.3, 1.2] {
        let m = 80;
        let from_centre = |i: usize| (i as f64 + 0.5) / (0.5 * m as f64) - 1.0;
        let r2 = |i: usize| from_centre(i % m).powi(2) + from_centre(i / m).powi(2);
        let h: Vec<f64> = (0..m * m).map(|i| 0.01 * r2(i) / (reach * reach)).collect();
        let awake = bits_of_solves(&h, m);
        rest_from(1);
        let resting = bits_of_solves(&h, m);
        rest_from(usize::MAX);
        assert!(awake == resting, "reach {reach}");
    }
}
