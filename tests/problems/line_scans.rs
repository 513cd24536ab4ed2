//! Line scans in plane strain. A piece of the contact area that moves as a flat punch converges slowly. With two periods and a given approach, the
//! library finds the force that belongs to the approach.

use crate::measured_surfaces::{auto, bodies, rough};
use contact_normal::grid::Grid;
use contact_normal::scene::{Load, Period, Scene};
use contact_normal::solver::{Options, Outcome, Solver};

/// Measured: 14 to 50 iterations by force and 15 to 40 by approach; with two periods by approach 43 to 80.
#[test]
fn line_scans_with_periods_end() {
    let m = 9600;
    let grid = Grid::new(m, 1, 1.0, 1.0).unwrap();
    for (hurst, seed) in [(0.3, 5), (0.8, 6)] {
        let h = rough(m, 1, hurst, seed);
        for period in [Period { x: false, y: true }, Period { x: true, y: true }] {
            for force in [100.0, 1000.0] {
                let what = format!("Hurst {hurst}, {period:?}, force {force}");
                let scene = Scene { period: Some(period), ..Scene::new(grid, &h, bodies(), Load::Force(force)) };
                let (solver, by_force) = auto(&scene, &what);
                let approach = solver.state().approach;
                let (_, by_approach) = auto(&Scene { load: Load::Approach(approach), ..scene }, &what);
                let most = if period.x { 90 } else { 60 };
                for (cycles, most) in [(by_force.count.cycles, 60), (by_approach.count.cycles, most)] {
                    assert!(cycles <= most, "{what}: {cycles} iterations");
                }
            }
        }
    }
}

/// With two periods contact becomes full at a finite force, and the mean gap tends to 0 as the approach tends to the mean of h.
#[test]
fn lines_near_full_contact_end() {
    let m = 4000;
    let grid = Grid::new(m, 1, 1.0, 1.0).unwrap();
    for (hurst, seed) in [(0.3, 5), (0.5, 7), (0.8, 6)] {
        let h = rough(m, 1, hurst, seed);
        let mean = h.iter().sum::<f64>() / m as f64;
        let rms = (h.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / m as f64).sqrt();
        for (gap, tolerance) in [(1e-2, 1e-8), (1e-4, 1e-6), (1e-5, 1e-8)] {
            let what = format!("Hurst {hurst}, a mean gap of {gap:e} of the rms height, {tolerance:e}");
            let period = Some(Period { x: true, y: true });
            let load = Load::Approach(mean - gap * rms);
            let scene = Scene { period, ..Scene::new(grid, &h, bodies(), load) };
            let options = Options { tolerance, ..Options::default() };
            let mut solver = Solver::new(&scene, &options).unwrap();
            let (stop, report) = solver.solve(&scene, &options, None, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{what}");
            let cycles = report.count.cycles;
            // Near full contact the number of iterations depends on the last bits of the coefficients: on 126 such lines it is 62 in the mean, and
            // 114 at most.
            assert!(cycles <= 120, "{what}: {cycles} iterations");
        }
    }
}

/// Lines along y, and lines with long elements without a period, are in plane strain, too: A falls only as a logarithm of the distance.
#[test]
fn lines_of_long_elements_end() {
    let m = 4096;
    let h = rough(m, 1, 0.5, 7);
    let along_x = Grid::new(m, 1, 1.0, 1e5).unwrap();
    let along_y = Grid::new(1, m, 1.0, 1.0).unwrap();
    let periods = [None, Some(Period { x: true, y: false })];
    for (grid, period, unit) in [(along_x, periods[0], 1e5), (along_y, periods[1], 1.0)] {
        for force in [5.0, 50.0, 200.0] {
            let what = format!("{grid:?}, force {force}");
            let scene = Scene { period, ..Scene::new(grid, &h, bodies(), Load::Force(force * unit)) };
            let (solver, by_force) = auto(&scene, &what);
            let approach = solver.state().approach;
            let (_, by_approach) = auto(&Scene { load: Load::Approach(approach), ..scene }, &what);
            for cycles in [by_force.count.cycles, by_approach.count.cycles] {
                assert!(cycles <= 100, "{what}: {cycles} iterations");
            }
        }
    }
}
