//! Surfaces that resemble measured ones: planes with a spike, line scans, light scattered contact, nearly full contact, all elements at their limit.
//! AUTO takes about as many iterations as on a smooth surface. The certificates are recomputed with the test's own product.

use crate::periodic_by_approach;
use crate::random::Random;
use crate::support::assert_conditions;
use crate::white_noise;
use contact_normal::contact::State;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome, Report, Solver};

const BOTH: Period = Period { x: true, y: true };

/// E* = 1.
pub fn bodies() -> Bodies {
    Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0; 2] }
}

/// A sum of cosines of random directions and phases, with wavelengths down to two elements, and amplitudes that fall as the wave number to the power
/// -(1 + `hurst`). The rms is 1, and the highest point is at 0.
pub fn rough(mx: usize, my: usize, hurst: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let waves: Vec<_> = (0..120)
        .map(|_| {
            let (number, direction) = (random.decades(0.05, 3.0), random.between(0.0, 6.3));
            let phase = random.between(0.0, 6.3);
            (number * direction.cos(), number * direction.sin(), phase, number.powf(-0.5 - hurst))
        })
        .collect();
    let height = |i: usize| {
        let (x, y) = ((i % mx) as f64, (i / mx) as f64);
        waves.iter().map(|(qx, qy, phase, a)| a * (qx * x + qy * y + phase).cos()).sum::<f64>()
    };
    let z: Vec<f64> = (0..mx * my).map(height).collect();
    let mean = z.iter().sum::<f64>() / z.len() as f64;
    let rms = (z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / z.len() as f64).sqrt();
    let highest = z.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    z.iter().map(|z| (highest - z) / rms).collect()
}

pub fn auto(scene: &Scene<'_>, what: &str) -> (Solver, Report) {
    let (solver, stop, report) = solve(scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged, "{what}: residual {:e}", report.measures.certificate.residual);
    (solver, report)
}

/// Asserts the contact conditions to the default tolerance, with the test's own product. The residual includes elements of C whose pressure is 0.
fn assert_conditions_of(state: &State, h: &[f64], what: &str) {
    let u = white_noise::displacements(state.grid.mx, &state.p);
    let (mut residual, mut distance, mut penetration, mut count) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..h.len() {
        assert!(state.p[i] >= 0.0 && (state.contact[i] || state.p[i] == 0.0), "{what}");
        let e = h[i] - state.approach + u[i];
        if state.contact[i] {
            residual += e * e;
            distance += (h[i] - state.approach).powi(2);
            count += 1.0;
        } else {
            penetration = f64::max(penetration, -e);
        }
    }
    // The tolerance of 1e-6, and 1 % of it for the round-off of two products, whose displacements are up to 1e4 times the roughness.
    assert!(residual.sqrt() <= 1.01e-6 * distance.sqrt(), "{what}: residual {}", (residual / distance).sqrt());
    assert!(penetration <= 1.01e-6 * (distance / count).sqrt(), "{what}: penetration {penetration}");
}

/// The numbers of iterations of certified solves: by a force, and by the approach that belongs to it.
pub fn iterations(m: usize, h: &[f64], force: f64, what: &str) -> [u64; 2] {
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let (solver, by_force) = auto(&Scene::new(grid, h, bodies(), Load::Force(force)), what);
    let state = solver.state();
    assert_conditions_of(state, h, what);
    let carried = state.p.iter().sum::<f64>();
    assert!((carried - force).abs() <= 1e-11 * force, "{what}: {carried}");
    let approach = state.approach;
    let (solver, by_approach) = auto(&Scene::new(grid, h, bodies(), Load::Approach(approach)), what);
    assert_conditions_of(solver.state(), h, what);
    [by_force.count.cycles, by_approach.count.cycles]
}

/// Measured: 8 to 12 iterations by force and 9 to 17 by approach, without a spike and with spikes of up to 10000 rms. After clipped steps the library
/// must not reuse search directions that carry a force.
#[test]
fn a_spike_costs_few_iterations() {
    let m = 112;
    for seed in [1, 2] {
        let z = rough(m, m, 0.3, seed);
        let plain = iterations(m, &z, 800.0, "no spike");
        for depth in [100.0, 700.0, 3000.0, 10000.0] {
            let mut h: Vec<f64> = z.iter().map(|z| z + depth).collect();
            h[m / 3 * m + m / 4] = 0.0;
            let what = format!("a spike of {depth} rms, seed {seed}");
            let found = iterations(m, &h, 800.0 + 2.0 * depth, &what);
            for (found, plain) in found.iter().zip(plain) {
                assert!(*found as f64 <= 1.5 * plain as f64 + 5.0, "{what}: {found} iterations, {plain} without");
            }
        }
    }
}

/// With a given approach only the high points touch on the coarse grids, so that C is found on the finest grid. Measured: 11 to 20 iterations by
/// force, and 9 to 29 by approach.
#[test]
fn high_points_that_hide_the_others_cost_few_iterations() {
    let m = 80;
    for seed in 1..=6 {
        let mut random = Random::new(seed);
        let z = rough(m, m, 0.2 + 0.1 * seed as f64, seed);
        let plain = iterations(m, &z, 400.0, "no spike");
        for points in [1, 15] {
            let depth = random.decades(100.0, 3e3);
            let mut h: Vec<f64> = z.iter().map(|z| z + depth).collect();
            for _ in 0..points {
                let height = if points == 1 { 0.0 } else { random.between(0.0, depth) };
                h[random.integer(5, m - 6) * m + random.integer(5, m - 6)] = height;
            }
            let what = format!("{points} points of {depth} rms, seed {seed}");
            let found = iterations(m, &h, 400.0 + 2.0 * points as f64 * depth, &what);
            for (found, plain) in found.iter().zip(plain) {
                assert!(*found as f64 <= 1.5 * plain as f64 + 10.0, "{what}: {found} iterations, {plain} without");
            }
        }
    }
}

/// The same kind of surface with a pressure limit that the spike does not reach.
#[test]
fn a_limit_that_is_not_reached_costs_few_iterations() {
    let m = 96;
    let mut h: Vec<f64> = rough(m, m, 0.3, 3).iter().map(|z| z + 2000.0).collect();
    h[20 * m + 30] = 0.0;
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    for load in [Load::Force(5000.0), Load::Approach(2003.0)] {
        let scene = Scene::new(grid, &h, bodies(), load);
        let limited = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(1e6))), ..scene.clone() };
        let (plain, with_limit) = (auto(&scene, "no limit").1, auto(&limited, "a limit").1);
        let (plain, found) = (plain.count.cycles, with_limit.count.cycles);
        assert!(found as f64 <= 1.5 * plain as f64 + 5.0, "{load:?}: {found} iterations, {plain} without a limit");
    }
}

/// Elements outside the window enter the contact when the residual is still 1e-2, so that the iteration need not start again from a small residual.
#[test]
fn light_contact_does_not_begin_anew() {
    let m = 256;
    let h: Vec<f64> = rough(m, m, 0.8, 11);
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    for force in [2.0, 10.0] {
        let scene = Scene::new(grid, &h, bodies(), Load::Force(force));
        let mut residuals = Vec::new();
        let mut told = |progress: &contact_normal::progress::Progress| {
            if progress.mx == m {
                residuals.push(progress.residual);
            }
            false
        };
        let mut solver = Solver::new(&scene, &Options::default()).unwrap();
        let (stop, _) = solver.solve(&scene, &Options::default(), None, Some(&mut told)).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let (mut least, mut worst) = (f64::INFINITY, 0.0);
        for residual in &residuals {
            worst = f64::max(worst, residual / f64::min(least, 1e-2));
            least = f64::min(least, *residual);
        }
        assert!(worst <= 10.0, "force {force}: {residuals:?}");
    }
}

/// With two periods the mean of p causes no displacement. The results are certified by direct sums.
#[test]
fn approaches_near_full_contact_are_solved() {
    for m in [25, 50, 64] {
        let h = periodic_by_approach::rough(m, 8, m as u64);
        let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
        let scene = Scene { period: Some(BOTH), ..Scene::new(grid, &h, bodies(), Load::Force(1e6)) };
        let (full, _) = auto(&scene, "full contact");
        let least = full.state().p.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = full.state().p.iter().sum::<f64>() - least * (m * m) as f64;
        for part in [0.5, 0.8, 0.9, 0.95, 0.98] {
            let what = format!("{m} x {m}, {part} of full contact");
            let (by_force, _) = auto(&Scene { load: Load::Force(part * greatest), ..scene.clone() }, &what);
            let approach = by_force.state().approach;
            let by_approach = Scene { load: Load::Approach(approach), ..scene.clone() };
            let (solver, _) = auto(&by_approach, &what);
            let p = &solver.state().p;
            assert_conditions(&h, approach, p, &periodic_by_approach::displacements(&by_approach, p), &what);
        }
    }
}

/// Two flat surfaces: p is the mean pressure, and there are no displacements. What remains of h - approach is round-off, relative to which no
/// residual is small.
#[test]
fn flat_on_flat_with_two_periods_ends() {
    let grids = [(13, 1), (22, 33), (25, 25), (60, 60), (100, 100), (120, 90), (311, 3), (997, 1)];
    for ((mx, my), height) in grids.into_iter().flat_map(|m| [0.0, 1.0 / 3.0, 0.001, -1e3].map(|height| (m, height))) {
        let (grid, h) = (Grid::new(mx, my, 1.0, 1.0).unwrap(), vec![height; mx * my]);
        for pressure in [1e-3, 0.00456, 0.7, 43.2, 1e3] {
            let load = Load::Force(pressure * (mx * my) as f64);
            let scene = Scene { period: Some(BOTH), ..Scene::new(grid, &h, bodies(), load) };
            // PROJECTED_CG alone may stagnate on a line, and any method alone on a plane at another height than 0.
            let all = [Method::Auto, Method::Norm, Method::ProjectedCg];
            let is_plain = height == 0.0 && my > 22 && [1e-3, 0.7, 1e3].contains(&pressure);
            for &method in if is_plain { &all[..] } else { &all[..1] } {
                let (solver, stop, report) = solve(&scene, &Options { method, ..Options::default() }).unwrap();
                let what = format!("{mx} x {my} at {height}, pressure {pressure}, {method:?}");
                assert_eq!(stop, Outcome::Converged, "{what}");
                let off = solver.state().p.iter().fold(0.0, |off: f64, p| off.max((p / pressure - 1.0).abs()));
                assert!(off <= 1e-10, "{what}: off by {off}");
                // Measured on 3000 such scenes with planes at other heights than 0: the median is 6, the 99th percentile 29, the largest 73
                // iterations.
                let most = if method == Method::Norm {
                    400.0
                } else if height == 0.0 {
                    20.0
                } else {
                    80.0
                };
                assert!(report.count.work_units <= most, "{what}: {} work units", report.count.work_units);
            }
        }
    }
}

/// A uniform p causes no displacement, so that the energy is linear in it. Pressures therefore go to the limit, which is the solution.
#[test]
fn flat_on_flat_within_limits_is_at_its_limits() {
    for (mx, my) in [(1, 1), (2, 4), (3, 11), (10, 23), (64, 64)] {
        for (height, depth, limit) in [(0.0, 1e-6, 1e-4), (-0.3, 0.01, 0.4), (0.7, 0.8, 1e-3)] {
            let (grid, h) = (Grid::new(mx, my, 0.7, 0.7).unwrap(), vec![height; mx * my]);
            let limits: Vec<f64> = (0..mx * my).map(|i| limit * (1.0 + 1e-9 * (i % 2) as f64)).collect();
            for limit in [PressureLimit(Each::Uniform(limit)), PressureLimit(Each::PerElement(&limits))] {
                let load = Load::Approach(height + depth);
                let scene =
                    Scene { period: Some(BOTH), pressure_limit: Some(limit), ..Scene::new(grid, &h, bodies(), load) };
                let (solver, report) = auto(&scene, &format!("{mx} x {my}, {depth}, {limit:?}"));
                assert!((0..mx * my).all(|i| solver.state().p[i] == limit.0.at(i)));
                assert!(report.measures.certificate.residual == 0.0);
            }
        }
    }
}

/// Forces are sums of many equal pressures. A plain sum of 160000 of them has an error of 1e-12, more than the library allows for a force.
#[test]
fn forces_that_nearly_all_elements_carry_at_their_limit() {
    for m in [129, 256, 400] {
        let wave = |k: usize| (std::f64::consts::TAU * 4.0 * (k as f64 + 0.5) / m as f64).cos();
        let h: Vec<f64> = (0..m * m).map(|i| 0.002 * m as f64 * (2.0 + wave(i % m) + wave(i / m))).collect();
        let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
        for (part, period) in [(0.99, None), (0.99, Some(BOTH)), (1.0, None), (1.0, Some(BOTH))] {
            let force = part * 0.1 * (m * m) as f64;
            let limit = Some(PressureLimit(Each::Uniform(0.1)));
            let scene = Scene { period, pressure_limit: limit, ..Scene::new(grid, &h, bodies(), Load::Force(force)) };
            let what = format!("{m} x {m}, {part} of the greatest force, {period:?}");
            let (solver, report) = auto(&scene, &what);
            assert!(report.count.cycles <= 40, "{what}: {} cycles", report.count.cycles);
            if part == 1.0 {
                assert!(solver.state().p.iter().all(|p| (p / 0.1 - 1.0).abs() <= 1e-12), "{what}");
            }
        }
    }
}

/// A ball beside a hole, with a large part of the contact area at its pressure limit. On the finest grid the contact grows beyond the window that the
/// coarser grid gives.
#[test]
fn a_limit_beside_a_hole_takes_few_iterations() {
    let (width, height) = (2.290208420965782, 2.9958029935958836);
    for (mx, my, limit, force, hole) in [
        (142, 145, 0.26418591367565086, 0.0915215957236174, 0.29523339264339915),
        (134, 144, 0.3386769406326888, 0.09590726443848098, 0.3172756509696756),
    ] {
        let grid = Grid::new(mx, my, width / mx as f64, height / my as f64).unwrap();
        let h: Vec<f64> = (0..mx * my)
            .map(|i| {
                let x = 0.04476424501826427 - 0.5 * width + ((i % mx) as f64 + 0.5) * grid.dx;
                let y = -0.031579716721700075 - 0.5 * height + ((i / mx) as f64 + 0.5) * grid.dy;
                if (x - 0.2).hypot(y) < hole {
                    f64::INFINITY
                } else {
                    0.5 * (x * x + y * y)
                }
            })
            .collect();
        let bodies = Bodies { shear_modulus: [1.0, f64::INFINITY], poisson_ratio: [0.3; 2] };
        let scene = Scene {
            pressure_limit: Some(PressureLimit(Each::Uniform(limit))),
            ..Scene::new(grid, &h, bodies, Load::Force(force))
        };
        let (_, report) = auto(&scene, &format!("{mx} x {my}"));
        assert!(report.count.cycles <= 40, "{mx} x {my}: {} iterations", report.count.cycles);
    }
}
