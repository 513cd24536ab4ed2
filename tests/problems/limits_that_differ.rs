//! Pressure limits that differ between elements by up to a factor of a thousand, in scenes with two periods: flat lines, gratings, rough squares.
//! Most elements are at their limit, and the set of these elements changes until late in a solve. The certificates are recomputed by direct sums.

use crate::periodic_by_approach::{displacements, rough};
use crate::random::Random;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome, Solver};

/// The tolerance of 1e-6, and 1 % of it for the different round-off of direct sums and FFT products.
const TOLERANCE: f64 = 1.01e-6;

/// Asserts the contact conditions with limits: e = 0 between the bounds, e >= 0 where p = 0, e <= 0 where p is at its limit.
pub fn assert_conditions(solver: &Solver, scene: &Scene<'_>, limits: &[f64], what: &str) {
    let (state, h) = (solver.state(), scene.undeformed_distance);
    let u = displacements(scene, &state.p);
    let (mut residual, mut distance, mut touching, mut counts, mut violation) = (0.0, 0.0, 0.0, (0.0, 0.0), 0.0);
    for i in 0..h.len() {
        let (p, e) = (state.p[i], h[i] - state.approach + u[i]);
        assert!((0.0..=limits[i]).contains(&p), "{what}: {p} of {}", limits[i]);
        let square = (h[i] - state.approach).powi(2);
        if p > 0.0 {
            touching += square;
            counts.1 += 1.0;
        }
        match (p > 0.0, p < limits[i]) {
            (true, true) => {
                residual += e * e;
                distance += square;
                counts.0 += 1.0;
            }
            (true, false) => violation = f64::max(violation, e),
            (false, _) => violation = f64::max(violation, -e),
        }
    }
    assert!(counts.1 > 0.01 * h.len() as f64, "{what}: hardly any contact");
    // If the whole surface is flat and no element is at its limit, h - approach is as small as the round-off of sums over all elements.
    let noise =
        f64::EPSILON * state.p.iter().sum::<f64>() * scene.coefficients().unwrap().at(0, 0) * f64::sqrt(counts.0);
    assert!(f64::sqrt(residual) <= TOLERANCE * f64::sqrt(distance) + noise, "{what}: {residual:e} of {distance:e}");
    assert!(violation <= TOLERANCE * f64::sqrt(touching / counts.1), "{what}: violation {violation}");
}

/// Solves a scene with random limits from `size` to `size` times `spread`, and checks the result. A force is given as a part of the sum of the
/// limits. Returns the number of cycles.
fn check(grid: Grid, h: &[f64], (size, spread): (f64, f64), load: Load, random: &mut Random) -> u64 {
    let limits: Vec<f64> = h.iter().map(|_| size * random.decades(1.0, spread)).collect();
    let load = match load {
        Load::Force(part) => Load::Force(part * limits.iter().sum::<f64>() * grid.element_area()),
        load => load,
    };
    let what = format!("{} x {}, limits {size:.1e} and {spread:.1} times that, {load:?}", grid.mx, grid.my);
    let scene = Scene {
        period: Some(Period { x: true, y: true }),
        pressure_limit: Some(PressureLimit(Each::PerElement(&limits))),
        ..Scene::new(grid, h, Bodies::same(1.0, 0.3), load)
    };
    let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged, "{what}: {} cycles", report.count.cycles);
    assert_conditions(&solver, &scene, &limits, &what);
    if let Load::Force(force) = load {
        assert!((solver.state().force() / force - 1.0).abs() <= 1e-12, "{what}");
    }
    report.count.cycles
}

/// Without the projected Newton method many of these solves would end early.
#[test]
fn lines_with_limits_that_differ_are_solved() {
    let random = &mut Random::new(3);
    let mut most = 0;
    for k in 0..24 {
        let (n, along) = (random.integer(300, 1800), k % 2 == 0);
        let (dx, dy) = (random.between(0.3, 2.0), random.between(0.3, 2.0));
        let grid = if along { Grid::new(n, 1, dx, dy) } else { Grid::new(1, n, dx, dy) }.unwrap();
        let (groove, part) = (random.integer(3, 60), random.between(0.2, 0.8));
        let depth = if k % 3 == 0 { 0.0 } else { random.between(0.01, 1.0) };
        let h: Vec<f64> =
            (0..n).map(|i| if ((i % groove) as f64) < part * groove as f64 { 0.0 } else { depth }).collect();
        let approach = random.decades(1e-2, 3.0) * depth.max(1e-3);
        let size = random.decades(0.05, 20.0) * approach / (3.0 * dx);
        let load = if k % 4 < 2 { Load::Approach(approach) } else { Load::Force(random.between(0.1, 0.95)) };
        let spread = random.decades(1.0, 1e3);
        most = most.max(check(grid, &h, (size, spread), load, random));
    }
    // The bound leaves a margin below the default limit of 1000 cycles.
    assert!(most <= 800, "{most} cycles");
}

#[test]
fn rough_squares_with_limits_that_differ_are_solved() {
    let random = &mut Random::new(5);
    for m in [24, 41, 60] {
        let h = rough(m, 4, m as u64);
        let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = h.iter().sum::<f64>() / h.len() as f64;
        let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
        let depth = mean - lowest;
        for (load, spread) in [
            (Load::Approach(lowest + 0.6 * depth), 5.0),
            (Load::Force(0.3), 5.0),
            (Load::Force(0.8), 100.0),
            (Load::Approach(lowest + 0.9 * depth), 100.0),
        ] {
            let cycles = check(grid, &h, (0.02 * depth, spread), load, random);
            assert!(cycles <= 200, "{m}, {load:?}, {spread}: {cycles} cycles");
        }
    }
}

/// Full contact with a few elements at their limit. The mean of p causes no displacement, so that only the elements at their limit determine it. It
/// is found by force and by approach.
#[test]
fn the_mean_is_found_where_a_few_elements_are_at_their_limit() {
    let random = &mut Random::new(7);
    for (m, few) in [(16, 1), (16, 2), (17, 5), (24, 1), (30, 3), (40, 1)] {
        let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
        let h: Vec<f64> = (0..m * m).map(|_| random.integer(0, 4) as f64).collect();
        let free = Scene {
            period: Some(Period { x: true, y: true }),
            ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(20.0 * (m * m) as f64))
        };
        let mut pressures = solve(&free, &Options::default()).unwrap().0.state().p.clone();
        assert!(pressures.iter().all(|p| *p > 0.0), "full contact");
        pressures.sort_by(f64::total_cmp);
        // The limit lies just below the `few` largest pressures.
        let last = pressures.len() - few;
        let limit = 0.5 * (pressures[last] + pressures[last - 1]);
        let limits = vec![limit; m * m];
        let limited = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(limit))), ..free.clone() };
        let (solver, stop, report) = solve(&limited, &Options::default()).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert_conditions(&solver, &limited, &limits, "by force");
        let by_approach = Scene { load: Load::Approach(report.measures.approach), ..limited };
        let (solver, stop, report) = solve(&by_approach, &Options::default()).unwrap();
        let what = format!("{m} x {m}, {few} at the limit: {} cycles", report.count.cycles);
        assert_eq!(stop, Outcome::Converged, "{what}");
        assert_conditions(&solver, &by_approach, &limits, &what);
        assert!(solver.state().has_limited(), "{what}");
        assert!(report.count.cycles <= 200, "{what}");
    }
}
