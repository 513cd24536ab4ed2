//! Effect `pressure_limit`: the conditions at both bounds by direct sums, no effect if the limit is not reached, forces that cannot be carried, and
//! all methods compared.

use super::dense;
use crate::support::run;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Each, Layer, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, InitialGuess, Method, Options, Outcome, Report, Solver};

fn ball(grid: &Grid) -> Vec<f64> {
    let (mx, my) = (grid.mx, grid.my);
    let at = |k: usize, m: usize| (2 * k + 1) as f64 / m as f64 - 1.0;
    (0..grid.len()).map(|i| 0.4 * at(i % mx, mx).powi(2) + 0.5 * at(i / mx, my).powi(2)).collect()
}

fn rough(grid: &Grid) -> Vec<f64> {
    let wave =
        |i: usize, j: usize, k: usize| ((i * (k % grid.mx) + j * (k / grid.mx)) as f64 * 0.37 + (i * j) as f64).sin();
    let waves = |k: usize| {
        (1..5)
            .flat_map(|i| (1..5).map(move |j| (i, j)))
            .map(|(i, j)| 0.05 * wave(i, j, k) / (i * j) as f64)
            .sum::<f64>()
    };
    ball(grid).iter().enumerate().map(|(k, h)| 0.2 * h + waves(k)).collect()
}

fn tight(method: Method) -> Options {
    Options { method, tolerance: 1e-9, ..Options::default() }
}

/// Asserts the mixed complementarity conditions, with u by direct sums. Returns the number of elements at the limit.
fn assert_holds(scene: &Scene<'_>, solver: &Solver, report: &Report, what: &str) -> usize {
    let (grid, state, limit) = (scene.grid, solver.state(), scene.pressure_limit.unwrap());
    let mut u = vec![0.0; grid.len()];
    let bodies = Scene { layer: None, ..scene.clone() }.coefficients().unwrap();
    dense::apply(&bodies, &grid, &state.p, &mut u);
    if let Some(Layer(Each::Uniform(c))) = scene.layer {
        u.iter_mut().zip(&state.p).for_each(|(u, p)| *u += c * p);
    }
    // The tolerance of 1e-9 is for the rms over some 1000 elements, of which one may have all of it: a factor of 32.
    let allowed = 32.0 * 1e-9 * u.iter().copied().fold(0.0, f64::max);
    let mut count = 0;
    for (i, u) in u.iter().enumerate() {
        let e = scene.undeformed_distance[i] - report.measures.approach + u;
        let (p, most) = (state.p[i], limit.0.at(i));
        let at_limit = state.at_limit.get(i).copied().unwrap_or(false);
        let holds = match (at_limit, state.contact[i]) {
            (true, false) => p == most && e <= allowed,
            (false, true) => p >= 0.0 && p <= most && e.abs() <= allowed,
            (false, false) => p == 0.0 && e >= -allowed,
            (true, true) => false,
        };
        assert!(holds, "{what}, element {i}: p = {p} of {most}, e = {e}, at the limit {at_limit}");
        count += usize::from(at_limit);
    }
    if let Load::Force(force) = scene.load {
        // The force is a sum of pressures, correct to round-off.
        assert!((report.measures.force / force - 1.0).abs() <= 1e-12, "{what}: {}", report.measures.force);
    }
    count
}

#[test]
fn the_conditions_hold_on_both_sides() {
    let grid = Grid::new(36, 30, 0.05, 0.05).unwrap();
    for (name, h) in [("ball", ball(&grid)), ("rough", rough(&grid))] {
        let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
        let elastic = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(lowest + 0.15));
        let (_, report) = run(&elastic, &Options::default());
        let (greatest, force) = (report.measures.max_pressure, report.measures.force);
        let uneven: Vec<f64> = (0..grid.len()).map(|i| greatest * (0.3 + 0.1 * (i % 5) as f64)).collect();
        for share in [0.9, 0.5, 0.2] {
            for limit in [PressureLimit(Each::Uniform(share * greatest)), PressureLimit(Each::PerElement(&uneven))] {
                for load in [elastic.load, Load::Force(0.5 * force)] {
                    for method in [Method::Auto, Method::Norm] {
                        let scene = Scene { pressure_limit: Some(limit), load, ..elastic.clone() };
                        let (solver, report) = run(&scene, &tight(method));
                        let what = format!("{name} {share} {load:?} {method:?}");
                        let count = assert_holds(&scene, &solver, &report, &what);
                        assert!(count > 0 || share > 0.8, "{what}");
                        let in_contact = solver.state().p.iter().filter(|p| **p > 0.0).count();
                        assert!(
                            report.measures.contact_count >= in_contact && report.measures.max_pressure <= greatest
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_limit_that_is_not_reached_changes_not_a_bit() {
    let grid = Grid::new(70, 80, 0.05, 0.05).unwrap();
    let h = rough(&grid);
    for load in [Load::Approach(0.05), Load::Force(0.3)] {
        let elastic = Scene::new(grid, &h, Bodies::same(1.0, 0.3), load);
        let (without, report) = run(&elastic, &Options::default());
        for limit in [f64::INFINITY, report.measures.max_pressure] {
            let (with, again) = run(
                &Scene { pressure_limit: Some(PressureLimit(Each::Uniform(limit))), ..elastic.clone() },
                &Options::default(),
            );
            let (a, b) = (without.state(), with.state());
            assert_eq!((&a.p, &a.u, &a.contact, a.approach), (&b.p, &b.u, &b.contact, b.approach));
            assert_eq!((report.count.matrix_products, report.bytes), (again.count.matrix_products, again.bytes));
            assert!(!b.at_limit.contains(&true));
        }
    }
}

#[test]
fn up_to_the_greatest_force_and_not_beyond() {
    let grid = Grid::new(16, 12, 0.5, 0.25).unwrap();
    let mut h = ball(&grid);
    h[5] = f64::INFINITY;
    let greatest = 2.0 * 191.0 * grid.element_area();
    let scene = |force: f64| Scene {
        pressure_limit: Some(PressureLimit(Each::Uniform(2.0))),
        ..Scene::new(grid, &h, Bodies::same(1e3, 0.3), Load::Force(force))
    };
    for share in [0.01, 0.3, 0.9, 0.999, 1.0] {
        let scene = scene(share * greatest);
        let (solver, report) = run(&scene, &tight(Method::Auto));
        assert_holds(&scene, &solver, &report, &format!("{share}"));
        let full = solver.state().p.iter().filter(|p| **p >= 2.0 * (1.0 - 1e-9)).count();
        assert!(share < 1.0 || full == 191, "{full}");
    }
    let Err(error) = solve(&scene(1.001 * greatest), &Options::default()) else { panic!("carried") };
    let message = error.to_string();
    assert!(message.contains("pressure_limit") && message.contains(&format!("{greatest}")), "{message}");
}

/// Limits as on a checkerboard: every second square of elements has a low one.
#[test]
fn checkerboards_of_limits_carry_nearly_the_greatest_force() {
    let grid = Grid::new(32, 32, 0.05, 0.05).unwrap();
    for (h, side) in [(ball(&grid), 1), (ball(&grid), 4), (rough(&grid), 1), (rough(&grid), 4)] {
        let dark = |i: usize| (i % 32 / side + i / 32 / side) % 2 == 0;
        let limits: Vec<f64> = (0..grid.len()).map(|i| if dark(i) { 0.05 } else { 1.0 }).collect();
        let force = 0.95 * limits.iter().sum::<f64>() * grid.element_area();
        let limit = Some(PressureLimit(Each::PerElement(&limits)));
        let scene = Scene { pressure_limit: limit, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(force)) };
        let (solver, report) = run(&scene, &tight(Method::Auto));
        let count = assert_holds(&scene, &solver, &report, &format!("squares of {side}"));
        assert!(count > 500, "{count}");
    }
}

/// Between flat planes any distribution of pressures carries the force with the same energy, but no element may be above its limit.
#[test]
fn flat_planes_do_not_end_above_a_limit() {
    let grid = Grid::new(8, 8, 1.0, 1.0).unwrap();
    let (h, mut limits) = (vec![0.25; 64], vec![10.0; 64]);
    limits[27] = 0.5;
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg] {
        let scene = Scene {
            pressure_limit: Some(PressureLimit(Each::PerElement(&limits))),
            period: Some(Period { x: true, y: true }),
            ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(64.0))
        };
        let (solver, stop, report) = solve(&scene, &Options { method, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged, "{method:?}");
        let p = &solver.state().p;
        assert!((0..64).all(|i| (0.0..=limits[i]).contains(&p[i])), "{method:?}: {p:?}");
        assert!(p[27] == 0.5 && (p.iter().sum::<f64>() / 64.0 - 1.0).abs() <= 1e-14, "{method:?}");
        assert!(report.measures.certificate.residual > 0.0, "{method:?}: others carry what element 27 does not");
    }
}

#[test]
fn with_a_layer_and_with_a_period() {
    let grid = Grid::new(32, 24, 0.05, 0.05).unwrap();
    let h = rough(&grid);
    let elastic = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.1));
    let limit = Some(PressureLimit(Each::Uniform(0.4 * run(&elastic, &Options::default()).1.measures.max_pressure)));
    let c = elastic.coefficients().unwrap().at(0, 0);
    for (layer, period) in [
        (Some(Layer(Each::Uniform(0.2 * c))), None),
        (None, Some(Period { x: true, y: false })),
        (None, Some(Period { x: true, y: true })),
        (Some(Layer(Each::Uniform(c))), Some(Period { x: true, y: true })),
    ] {
        let scene = Scene { pressure_limit: limit, layer, period, ..elastic.clone() };
        let (solver, report) = run(&scene, &tight(Method::Auto));
        assert_holds(&scene, &solver, &report, &format!("{layer:?} {period:?}"));
    }
}

/// Uniform random numbers in [0, 1): splitmix64.
fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| next()).collect()
}

/// The bodies are so stiff that displacements by pressures at the limit are smaller than differences of height. So nearly all elements in contact are
/// at their limit.
#[test]
fn forces_on_white_noise_from_soft_to_nearly_rigid() {
    let grid = Grid::new(35, 48, 0.1, 0.4).unwrap();
    for seed in 0..6 {
        let (h, uneven) = (noise(grid.len(), seed), noise(grid.len(), seed + 100));
        let uneven: Vec<f64> = uneven.iter().map(|u| 0.5 + u).collect();
        for modulus in [10.0, 1e3, 1e5] {
            for (k, share) in [0.05, 0.3, 0.7, 0.95, 1.0].into_iter().enumerate() {
                let limits = if k % 2 == 0 {
                    PressureLimit(Each::Uniform(1.0))
                } else {
                    PressureLimit(Each::PerElement(&uneven))
                };
                let greatest = (0..grid.len()).map(|i| limits.0.at(i)).sum::<f64>() * grid.element_area();
                let plain = Scene::new(grid, &h, Bodies::same(modulus, 0.3), Load::Force(share * greatest));
                let scene = Scene { pressure_limit: Some(limits), ..plain };
                let (solver, stop, report) = solve(&scene, &tight(Method::Auto)).unwrap();
                let what = format!("seed {seed}, modulus {modulus}, {share} of the greatest force");
                assert_eq!(stop, Outcome::Converged, "{what}: {report:?}");
                let count = assert_holds(&scene, &solver, &report, &what);
                assert!(count > 0, "{what}");
            }
        }
    }
}

/// An uneven layer on a coated body, with up to ten thousand times the compliance of the coating. The diagonal of A is uneven, which the
/// preconditioner, a circulant, does not include. Multigrid does not support coatings.
#[test]
fn forces_on_an_uneven_layer() {
    let grid = Grid::new(6, 3, 0.6, 0.6).unwrap();
    let soft = CoatingLayer { thickness: 0.3, shear_modulus: 0.3, poisson_ratio: 0.3 };
    let coating = Some(Coating { layers: [Some(soft), None] });
    for seed in 0..300 {
        let h: Vec<f64> = noise(grid.len(), seed).iter().map(|u| 3e-4 * u).collect();
        let layers: Vec<f64> = noise(grid.len(), seed + 1000).iter().map(|u| 10f64.powf(5.0 * u) - 1.0).collect();
        let layer = Some(Layer(Each::PerElement(&layers)));
        let scene = Scene {
            layer,
            coating,
            pressure_limit: Some(PressureLimit(Each::Uniform(3e-4))),
            ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(1e-4))
        };
        let (_, stop, report) = solve(&scene, &Options { tolerance: 1e-6, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged, "seed {seed}: {report:?}");
    }
}

#[test]
fn every_method_and_a_handle_find_the_same() {
    let grid = Grid::new(40, 40, 0.05, 0.05).unwrap();
    let h = ball(&grid);
    let limit = Some(PressureLimit(Each::Uniform(0.12)));
    let scene = Scene { pressure_limit: limit, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.1)) };
    let (first, report) = run(&scene, &tight(Method::Auto));
    assert!(assert_holds(&scene, &first, &report, "AUTO") > 20);
    let close = |a: &[f64]| a.iter().zip(&first.state().p).all(|(a, b)| (a - b).abs() <= 1e-6 * 0.12);
    for method in [Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg] {
        assert!(close(&run(&scene, &tight(method)).0.state().p), "{method:?}");
    }
    // The next solves of a handle, without and with a limit, without a guess and from the last result.
    let mut solver = Solver::new(&scene, &tight(Method::Auto)).unwrap();
    solver.solve(&scene, &tight(Method::Auto), None, None).unwrap();
    let plain = Scene { pressure_limit: None, ..scene.clone() };
    let previous = Options { initial_guess: InitialGuess::Previous, ..tight(Method::Auto) };
    let (stop, _) = solver.solve(&plain, &previous, None, None).unwrap();
    assert!(stop == Outcome::Converged && !solver.state().at_limit.contains(&true));
    assert!(solver.state().p.iter().copied().fold(0.0, f64::max) > 0.13);
    for options in [&previous, &tight(Method::Auto)] {
        let (stop, report) = solver.solve(&scene, options, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert_holds(&scene, &solver, &report, "handle");
        assert!(close(&solver.state().p));
    }
    // After an early stop pressures are within the limit, too.
    let (_, stop, _) = solve(&scene, &Options { max_cycles: 1, tolerance: 1e-13, ..Options::default() })
        .map(|(s, stop, r)| {
            assert!(s.state().p.iter().all(|p| (0.0..=0.12).contains(p)));
            (s, stop, r)
        })
        .unwrap();
    assert_eq!(stop, Outcome::IterationLimit);
}

#[test]
fn what_is_no_limit_is_refused_by_name() {
    let grid = Grid::new(8, 8, 1.0, 1.0).unwrap();
    let h = ball(&grid);
    let refuse = |limit: PressureLimit<'_>, load: Load, words: &[&str]| {
        let scene = Scene { pressure_limit: Some(limit), ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), load) };
        let Err(error) = solve(&scene, &Options::default()) else { panic!("{words:?}: solved") };
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
    };
    let mut limits = [1.0; 64];
    limits[9] = -3.0;
    for load in [Load::Force(0.1), Load::Approach(0.1)] {
        refuse(PressureLimit(Each::Uniform(0.0)), load, &["pressure_limit->limit", "0"]);
        refuse(PressureLimit(Each::Uniform(f64::NAN)), load, &["pressure_limit->limit", "NaN"]);
        refuse(PressureLimit(Each::PerElement(&limits)), load, &["pressure_limit->limits", "(1, 1)", "-3"]);
        refuse(PressureLimit(Each::PerElement(&limits[..63])), load, &["pressure_limit->limits", "63"]);
    }
    let scene = Scene {
        pressure_limit: Some(PressureLimit(Each::Uniform(1.0))),
        ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.1))
    };
    let mut solver = Solver::new(&scene, &Options::default()).unwrap();
    let fixed = Options { active_set: ActiveSet::Fixed, ..Options::default() };
    let guess = Guess { pressure: &[0.0; 64], contact: &[true; 64] };
    let error = solver.solve(&scene, &fixed, Some(guess), None).unwrap_err().to_string();
    assert!(error.contains("FIXED") && error.contains("pressure_limit"), "{error}");
}

/// The library treats a limit as a bound within the iteration. Measured: this takes 1.1 to 2.8 times the work units of the plain scene. One scene
/// takes 3.1 times, because its approach does not change in nine of 42 iterations. `examples/pressure_limits` prints the costs of limits on 140
/// scenes.
#[test]
fn a_limit_costs_at_most_three_times_the_plain_scene_but_for_one() {
    let mut beyond = 0;
    for m in [64, 128, 256, 512] {
        let grid = Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).unwrap();
        for h in [ball(&grid), rough(&grid)].into_iter().take(if m < 512 { 2 } else { 1 }) {
            let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.3));
            let (_, stop, found) = solve(&plain, &Options::default()).unwrap();
            assert_eq!(stop, Outcome::Converged);
            for load in [plain.load, Load::Force(found.measures.force)] {
                let scene = Scene { load, ..plain.clone() };
                let (_, _, alone) = solve(&scene, &Options::default()).unwrap();
                for share in [0.9, 0.75, 0.6] {
                    let limit = PressureLimit(Each::Uniform(share * found.measures.max_pressure));
                    let limited = Scene { pressure_limit: Some(limit), ..scene.clone() };
                    let (solver, stop, report) = solve(&limited, &Options::default()).unwrap();
                    let what =
                        format!("{m}, {load:?}, {share}: {} for {}", report.count.work_units, alone.count.work_units);
                    assert_eq!(stop, Outcome::Converged, "{what}");
                    assert!(solver.state().at_limit.contains(&true), "{what}: no limit is reached");
                    let ratio = report.count.work_units / alone.count.work_units;
                    assert!(ratio <= 3.2, "{what}");
                    beyond += usize::from(ratio > 3.0);
                }
            }
        }
    }
    assert!(beyond <= 1, "{beyond} scenes take more than three times the plain one");
}
