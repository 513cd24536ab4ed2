//! Bodies so stiff, or limits so small, that the rounding of the distances hides all displacements: the contact area is the bearing area, which sorted
//! distances give (Abbott & Firestone 1933).

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome};

const M: usize = 32;

/// Columns of equal heights, apart from so many last bits in y.
fn waves(seed: usize, last_bits: f64) -> Vec<f64> {
    let height =
        |k: usize| (0.9 * (k % M) as f64 + seed as f64).sin() + 1.5 + last_bits * f64::EPSILON * (k / M) as f64;
    (0..M * M).map(height).collect()
}

#[test]
fn the_lowest_elements_are_at_their_limit() {
    let grid = Grid::new(M, M, 1.0, 1.0).unwrap();
    for seed in 0..6 {
        for (k, last_bits) in (57..82).step_by(4).flat_map(|k| [(k, 0.0), (k, 1.0), (k, 2.0)]) {
            let limit = 0.5f64.powi(k);
            let h = waves(seed, last_bits);
            let scene = Scene {
                pressure_limit: Some(PressureLimit::Uniform(limit)),
                ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(700.2 * limit))
            };
            let options = Options { method: Method::Auto, tolerance: 1e-8, ..Options::default() };
            let (solver, stop, report) = solve(&scene, &options).unwrap();
            let what = format!("seed {seed}, limit 2^-{k}, {last_bits} last bits");
            assert_eq!(stop, Outcome::Converged, "{what}: {report:?}");
            let mut sorted = h.clone();
            sorted.sort_by(f64::total_cmp);
            // The element that carries what is left; the certificate allows for two roundings of the approach.
            let (depth, rounding) = (sorted[700], 4.0 * f64::EPSILON * sorted[700]);
            for (h, p) in h.iter().zip(&solver.state().p) {
                let holds = if *h < depth - rounding {
                    *p == limit
                } else if *h > depth + rounding {
                    *p == 0.0
                } else {
                    (0.0..=limit).contains(p)
                };
                assert!(holds, "{what}: p = {p} of {limit} at {h}, depth {depth}");
            }
            let carried = solver.state().p.iter().sum::<f64>() / (700.2 * limit);
            assert!((carried - 1.0).abs() <= 1e-12, "{what}: {carried}");
        }
    }
}
