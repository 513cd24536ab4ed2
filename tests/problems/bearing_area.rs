//! Soft surfaces with a pressure limit: displacements by pressures at the limit are small relative to differences of height. So the heights decide
//! which elements are at their limit, as long as a method does not cycle between them. The certificates are recomputed by direct sums.

use crate::limits_that_differ::assert_conditions;
use crate::periodic_by_approach::rough;
use crate::random::Random;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome};

/// A rough square, a punch with flanks, or one with a spike and a pit.
fn surface(kind: usize, m: usize, random: &mut Random) -> Vec<f64> {
    if kind == 0 {
        return rough(m, 3, m as u64);
    }
    let flat = random.between(0.2, 0.8) * m as f64;
    let mut h: Vec<f64> = (0..m * m)
        .map(|i| {
            let (x, y) = ((i % m) as f64 - 0.5 * m as f64, (i / m) as f64 - 0.5 * m as f64);
            let flank = (x.hypot(y) - 0.5 * flat).max(0.0) / m as f64;
            30.0 * flank * flank + random.between(0.0, 1e-3)
        })
        .collect();
    if kind == 2 {
        (h[m * m / 3], h[m * m / 2]) = (-2.0, f64::INFINITY);
    }
    h
}

/// The solves take at most 15 products on average. On a nearly flat top the displacements decide which elements are at their limit, more often than
/// the initial guess from sorted heights does.
#[test]
fn soft_surfaces_are_solved_from_their_heights() {
    let (random, mut products) = (&mut Random::new(11), 0.0);
    for k in 0..60 {
        let m = random.integer(16, 48);
        let (dx, dy) = (random.between(0.3, 3.0), random.between(0.3, 3.0));
        let grid = Grid::new(m, m, dx, dy).unwrap();
        let h = surface(k % 3, m, random);
        // An element at its limit displaces itself by about 3 dx p.
        let limit = random.decades(1e-7, 1e-4) / dx;
        let limits: Vec<f64> =
            h.iter().map(|_| if k % 2 == 0 { limit } else { limit * random.decades(1.0, 5.0) }).collect();
        let carried =
            h.iter().zip(&limits).filter(|(h, _)| h.is_finite()).map(|(_, limit)| limit * dx * dy).sum::<f64>();
        let load = match k % 5 {
            0 => Load::Approach(random.between(0.1, 1.0)),
            _ => Load::Force(random.between(0.05, 0.95) * carried),
        };
        let period = Some(Period { x: k % 4 != 2, y: k % 4 != 3 }).filter(|_| k % 4 != 0);
        let pressure_limit = Some(PressureLimit(Each::PerElement(&limits)));
        let scene = Scene { period, pressure_limit, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), load) };
        let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
        let what = format!("{k}: {m} x {m}, limit {limit:.1e}, {load:?}, {period:?}: {:?}", report.count);
        assert_eq!(stop, Outcome::Converged, "{what}");
        assert_conditions(&solver, &scene, &limits, &what);
        products += report.count.work_units;
    }
    assert!(products <= 15.0 * 60.0, "{products}");
}

/// The number of elements along a side.
const M: usize = 32;

/// Heights with waves along x. Along y each element is higher than the one before by `last_bits` units of round-off.
fn waves(seed: usize, last_bits: f64) -> Vec<f64> {
    let height =
        |k: usize| (0.9 * (k % M) as f64 + seed as f64).sin() + 1.5 + last_bits * f64::EPSILON * (k / M) as f64;
    (0..M * M).map(height).collect()
}

/// The bodies are so stiff, or the limits so small, that all displacements are below the round-off of the distances. The contact area is then the
/// bearing area, which follows from the sorted distances (Abbott & Firestone 1933).
#[test]
fn the_lowest_elements_are_at_their_limit() {
    let grid = Grid::new(M, M, 1.0, 1.0).unwrap();
    for seed in 0..6 {
        for (k, last_bits) in (57..82).step_by(4).flat_map(|k| [(k, 0.0), (k, 1.0), (k, 2.0)]) {
            let limit = 0.5f64.powi(k);
            let h = waves(seed, last_bits);
            let scene = Scene {
                pressure_limit: Some(PressureLimit(Each::Uniform(limit))),
                ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(700.2 * limit))
            };
            let options = Options { method: Method::Auto, tolerance: 1e-8, ..Options::default() };
            let (solver, stop, report) = solve(&scene, &options).unwrap();
            let what = format!("seed {seed}, limit 2^-{k}, {last_bits} last bits");
            assert_eq!(stop, Outcome::Converged, "{what}: {report:?}");
            let mut sorted = h.clone();
            sorted.sort_by(f64::total_cmp);
            // `depth` is the distance of the element that carries the rest of the force. The certificate allows two rounding errors of the approach.
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
