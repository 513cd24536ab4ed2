//! Hard cases end with the right answer or a clear status, never with a NaN. Each file in families/ has one family of cases; each test here is of one
//! method or one option.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{
    solve, ActiveSet, Criterion, Guess, InitialGuess, Method, Options, Outcome, Precision, Solver,
};

use crate::families::case::{paraboloid, rigid_on};

pub const METHODS: [Method; 5] =
    [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg];

pub fn certified(scene: &Scene<'_>, options: &Options) -> Solver {
    let (solver, stop, report) = solve(scene, options).unwrap();
    assert_eq!(stop, Outcome::Converged, "{:?} {:?} on {:?}", options.method, scene.load, scene.grid);
    let certificate = report.measures.certificate;
    assert!(certificate.residual <= options.tolerance && certificate.min_pressure >= 0.0, "{certificate:?}");
    assert!(solver.state().p.iter().all(|p| p.is_finite()));
    solver
}

#[test]
fn one_element_is_solved_by_every_method() {
    let grid = Grid::new(1, 1, 0.5, 0.25).unwrap();
    let own = HalfSpace::new(0.5, 0.25, rigid_on(3.0).compliance()).at(0, 0);
    for method in METHODS {
        let options = Options { method, ..Options::default() };
        let solver = certified(&Scene::new(grid, &[0.1], rigid_on(3.0), Load::Approach(0.3)), &options);
        assert!((solver.state().p[0] - 0.2 / own).abs() <= 1e-6 * 0.2 / own);
        let solver = certified(&Scene::new(grid, &[0.1], rigid_on(3.0), Load::Force(7.0)), &options);
        assert!((solver.state().p[0] - 7.0 / 0.125).abs() <= 1e-12 * 56.0);
        assert!((solver.state().approach - (0.1 + 56.0 * own)).abs() <= 1e-6 * 56.0 * own);
    }
}

#[test]
fn no_contact_is_no_error() {
    let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
    let h = vec![1.0; 20];
    let nowhere = vec![f64::INFINITY; 20];
    for method in METHODS {
        let options = Options { method, ..Options::default() };
        for (h, load) in [(&h, Load::Approach(0.5)), (&h, Load::Force(0.0)), (&nowhere, Load::Approach(2.0))] {
            let solver = certified(&Scene::new(grid, h, rigid_on(1.0), load), &options);
            assert!(solver.state().p.iter().all(|p| *p == 0.0));
            assert_eq!(solver.state().contact_count(), 0);
        }
        let error = solve(&Scene::new(grid, &nowhere, rigid_on(1.0), Load::Force(1.0)), &options).err();
        assert!(matches!(error, Some(Error::Infeasible(_))));
    }
}

#[test]
fn lines_of_elements_and_ragged_grids_work_with_every_method() {
    for (mx, my) in [(1, 2), (2, 1), (1, 37), (64, 1), (3, 50), (17, 16), (33, 65)] {
        let grid = Grid::new(mx, my, 0.1, 0.1).unwrap();
        let h = paraboloid(&grid, 0.5);
        for load in [Load::Approach(0.05), Load::Force(0.01)] {
            let reference = certified(
                &Scene::new(grid, &h, rigid_on(1.0), load),
                &Options { method: Method::Norm, tolerance: 1e-9, ..Options::default() },
            );
            for method in METHODS {
                let options = Options { method, tolerance: 1e-9, ..Options::default() };
                let solver = certified(&Scene::new(grid, &h, rigid_on(1.0), load), &options);
                let size = reference.state().p.iter().copied().fold(0.0, f64::max);
                for (a, b) in solver.state().p.iter().zip(&reference.state().p) {
                    // Residuals of 1e-9, times the condition number of A on these small grids (below 30).
                    assert!((a - b).abs() <= 1e-7 * size, "{method:?} {load:?} {mx} x {my}: {a} for {b}");
                }
            }
        }
    }
}

#[test]
fn slender_elements_work() {
    for ratio in [1e-6, 1e-3, 0.02, 4.0, 50.0, 1e3] {
        let grid = Grid::new(24, 20, ratio, 1.0).unwrap();
        let h: Vec<f64> = (0..grid.len())
            .map(|i| ((i % 24) as f64 - 11.5).powi(2) / 144.0 + ((i / 24) as f64 - 9.5).powi(2) / 100.0)
            .collect();
        for load in [Load::Approach(0.4), Load::Force(3.0 * ratio)] {
            for method in [Method::Auto, Method::Norm] {
                let options = Options { method, max_cycles: 20_000, ..Options::default() };
                let solver = certified(&Scene::new(grid, &h, rigid_on(1.0), load), &options);
                assert!(solver.state().contact_count() > 0, "{ratio} {load:?} {method:?}");
            }
        }
    }
}

#[test]
fn elements_without_a_surface_stay_exterior() {
    let grid = Grid::new(40, 30, 0.1, 0.1).unwrap();
    let mut h = paraboloid(&grid, 0.3);
    let hole = |i: usize| (10..16).contains(&(i % 40)) || i / 40 == 14;
    (0..h.len()).filter(|&i| hole(i)).for_each(|i| h[i] = f64::INFINITY);
    for method in METHODS {
        for load in [Load::Approach(0.2), Load::Force(0.3)] {
            let options = Options { method, ..Options::default() };
            let solver = certified(&Scene::new(grid, &h, rigid_on(1.0), load), &options);
            let state = solver.state();
            assert!((0..h.len()).filter(|&i| hole(i)).all(|i| state.p[i] == 0.0 && !state.contact[i]));
            assert!(state.contact_count() > 50);
        }
    }
}

#[test]
fn a_flat_punch_and_full_contact_are_solved() {
    // Full contact of a flat face. The stiffness of a square punch of side 2a on a half-space is 2.2 E* a to about 3 % (Borodachev), between 2 E* a
    // of the inscribed circle and 2.83 E* a of the circumscribed one.
    let grid = Grid::new(64, 64, 1.0 / 32.0, 1.0 / 32.0).unwrap();
    let h = vec![0.0; grid.len()];
    for load in [Load::Approach(0.01), Load::Force(0.022)] {
        let solver = certified(&Scene::new(grid, &h, rigid_on(1.0), load), &Options::default());
        let state = solver.state();
        assert_eq!(state.contact_count(), grid.len());
        let stiffness = state.force() / state.approach;
        assert!((2.2..2.4).contains(&stiffness), "{stiffness}");
    }
}

#[test]
fn a_unit_of_length_or_pressure_changes_no_digit() {
    // Units that differ by powers of two give the same bits.
    let grid = Grid::new(50, 41, 0.11, 0.09).unwrap();
    let h = paraboloid(&grid, 0.2);
    for load in [Load::Approach(0.3), Load::Force(2.0)] {
        for method in METHODS {
            let options = Options { method, ..Options::default() };
            let here = certified(&Scene::new(grid, &h, rigid_on(1.0), load), &options);
            for (length, pressure) in [(2f64.powi(-10), 2f64.powi(20)), (2f64.powi(30), 2f64.powi(-37))] {
                let scaled = Grid { dx: grid.dx * length, dy: grid.dy * length, ..grid };
                let scaled_h: Vec<f64> = h.iter().map(|h| h * length).collect();
                let scaled_load = match load {
                    Load::Approach(approach) => Load::Approach(approach * length),
                    Load::Force(force) => Load::Force(force * length * length * pressure),
                };
                let there = certified(&Scene::new(scaled, &scaled_h, rigid_on(pressure), scaled_load), &options);
                for (a, b) in here.state().p.iter().zip(&there.state().p) {
                    assert_eq!((a * pressure).to_bits(), b.to_bits(), "{method:?}");
                }
            }
        }
    }
}

#[test]
fn units_out_of_range_are_refused() {
    for (size, modulus, load) in [
        (1e-160, 1.0, Load::Force(1.0)),
        (1.0, 1e-200, Load::Force(1e-300)),
        (1e150, 1e-200, Load::Approach(1.0)),
        (1e-160, 1e200, Load::Approach(1.0)),
    ] {
        for m in [1, 16] {
            let grid = Grid::new(m, m, size, size).unwrap();
            let scene_h = vec![0.0; grid.len()];
            let error = solve(&Scene::new(grid, &scene_h, rigid_on(modulus), load), &Options::default()).err();
            assert!(matches!(error, Some(Error::InvalidArgument(_))), "{size} {modulus} {load:?}: {error:?}");
        }
    }
}

#[test]
fn very_tight_tolerances_end() {
    let grid = Grid::new(48, 48, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.1);
    for method in METHODS {
        for tolerance in [1e-12, 1e-16, 1e-300] {
            let options = Options { method, tolerance, ..Options::default() };
            let (solver, stop, report) =
                solve(&Scene::new(grid, &h, rigid_on(1.0), Load::Approach(0.2)), &options).unwrap();
            let residual = report.measures.certificate.residual;
            assert!(solver.state().p.iter().all(|p| p.is_finite()));
            // The round-off of a product is about 1e-15 of u. A status OK must still be true.
            assert!(residual <= 1e-12, "{method:?} {tolerance}: {residual} after {stop:?}");
            assert_eq!(
                stop == Outcome::Converged,
                residual <= tolerance,
                "{method:?} {tolerance}: {residual} {stop:?}"
            );
        }
    }
}

#[test]
fn a_fixed_contact_area_is_solved_with_pressures_of_either_sign() {
    let grid = Grid::new(20, 20, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 1.0);
    // The fixed area is much larger than the contact area would be, so that its rim is in tension.
    let contact: Vec<bool> = h.iter().map(|h| *h <= 0.6).collect();
    let zero = vec![0.0; grid.len()];
    for load in [Load::Approach(0.1), Load::Force(0.05)] {
        let scene = Scene::new(grid, &h, rigid_on(1.0), load);
        let mut pressures: Vec<Vec<f64>> = Vec::new();
        for method in METHODS {
            let options = Options { method, active_set: ActiveSet::Fixed, tolerance: 1e-10, ..Options::default() };
            let mut solver = Solver::new(&scene, &options).unwrap();
            let guess = Guess { pressure: &zero, contact: &contact };
            let (stop, report) = solver.solve(&scene, &options, Some(guess), None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{method:?} {load:?}");
            assert!(report.measures.certificate.min_pressure < 0.0);
            assert_eq!(solver.state().contact, contact);
            pressures.push(solver.state().p.clone());
        }
        let size = pressures[0].iter().fold(0.0, |m: f64, p| m.max(p.abs()));
        for other in &pressures[1..] {
            for (a, b) in pressures[0].iter().zip(other) {
                assert!((a - b).abs() <= 1e-8 * size, "{load:?}: {a} and {b}");
            }
        }
    }
}

#[test]
fn a_solved_problem_is_a_good_guess_and_a_nonsense_guess_does_no_harm() {
    let grid = Grid::new(60, 44, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.1);
    for load in [Load::Approach(0.2), Load::Force(1.0)] {
        let scene = Scene::new(grid, &h, rigid_on(1.0), load);
        for method in METHODS {
            let cold = certified(&scene, &Options { method, tolerance: 1e-8, ..Options::default() });
            let given = Options { method, tolerance: 1e-6, initial_guess: InitialGuess::Given, ..Options::default() };
            let (p, contact) = (cold.state().p.clone(), cold.state().contact.clone());
            let mut solver = Solver::new(&scene, &given).unwrap();
            let guess = Guess { pressure: &p, contact: &contact };
            let (stop, report) = solver.solve(&scene, &given, Some(guess), None).unwrap();
            assert!(
                stop == Outcome::Converged && report.count.cycles <= 3,
                "{method:?} {load:?}: {} cycles",
                report.count.cycles
            );

            let nonsense: Vec<f64> = (0..grid.len()).map(|i| (i % 17) as f64 - 5.0).collect();
            let corner: Vec<bool> = (0..grid.len()).map(|i| i % 60 < 7).collect();
            let guess = Guess { pressure: &nonsense, contact: &corner };
            let (stop, _) = solver.solve(&scene, &given, Some(guess), None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{method:?} {load:?}");
            let size = p.iter().copied().fold(0.0, f64::max);
            for (a, b) in solver.state().p.iter().zip(&p) {
                // Residuals of 1e-6, times the condition number of A on the contact area (below 100).
                assert!((a - b).abs() <= 1e-4 * size, "{method:?} {load:?}: {a} for {b}");
            }
        }
    }
}

/// Each iteration takes one product. The start, the correction of truncations, the end of the iteration and the certificate take one each. If the
/// UPDATE criterion were confirmed by another iteration, it would take two more.
#[test]
fn the_update_criterion_costs_no_round_of_its_own_in_double_precision() {
    let grid = Grid::new(96, 64, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.1);
    for load in [Load::Approach(0.2), Load::Force(1.0)] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let options = Options {
                method: Method::ProjectedCg,
                precision: Precision::Double,
                criterion: Criterion::Update,
                tolerance,
                ..Options::default()
            };
            let (_, stop, report) = solve(&Scene::new(grid, &h, rigid_on(1.0), load), &options).unwrap();
            let (products, cycles) = (report.count.matrix_products, report.count.cycles);
            assert_eq!(stop, Outcome::Converged);
            assert!(products <= cycles + 4, "{load:?}, {tolerance:e}: {products} products for {cycles} iterations");
        }
    }
}

#[test]
fn the_update_criterion_means_the_last_change_of_the_pressures() {
    let grid = Grid::new(40, 40, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.1);
    for method in METHODS {
        let options = Options { method, tolerance: 1e-5, criterion: Criterion::Update, ..Options::default() };
        let (solver, stop, report) =
            solve(&Scene::new(grid, &h, rigid_on(1.0), Load::Approach(0.2)), &options).unwrap();
        let state = solver.state();
        let rms = (state.p.iter().map(|p| p * p).sum::<f64>() / state.contact_count() as f64).sqrt();
        assert_eq!(stop, Outcome::Converged);
        assert!(report.count.update <= 1e-5 * rms, "{method:?}: {} of {rms}", report.count.update);
        // After a stop by the UPDATE criterion the error is about the update over (1 - convergence factor).
        assert!(report.measures.certificate.residual <= 1e-4);
    }
}

#[test]
fn an_error_ratio_stops_at_a_part_of_the_discretisation_error() {
    let grid = Grid::new(128, 128, 0.05, 0.05).unwrap();
    let h = paraboloid(&grid, 0.1);
    for load in [Load::Approach(0.2), Load::Force(1.0)] {
        let scene = Scene::new(grid, &h, rigid_on(1.0), load);
        for method in [Method::Auto, Method::FullMultigrid] {
            let run = |error_ratio| {
                let options = Options { method, tolerance: 1e-9, error_ratio, estimates: true, ..Options::default() };
                let (_, stop, report) = solve(&scene, &options).unwrap();
                assert_eq!(stop, Outcome::Converged);
                report
            };
            let (exact, enough) = (run(0.0), run(0.1));
            assert!(
                enough.count.cycles < exact.count.cycles,
                "{method:?}: {} and {} cycles",
                enough.count.cycles,
                exact.count.cycles
            );
            // The error of the result is less than its estimated discretisation error.
            let off = match load {
                Load::Approach(_) => enough.measures.force - exact.measures.force,
                Load::Force(_) => enough.measures.approach - exact.measures.approach,
            };
            let error = exact.error.force.expect("an estimate");
            assert!(off.abs() <= error, "{method:?} {load:?}: {off} of {error}");
        }
    }
}

#[test]
fn limits_and_cancellation_return_the_best_iterate() {
    let grid = Grid::new(64, 64, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.1);
    let scene = Scene::new(grid, &h, rigid_on(1.0), Load::Force(1.0));
    for method in METHODS {
        let options = Options { method, tolerance: 1e-10, max_cycles: 2, ..Options::default() };
        let (solver, stop, report) = solve(&scene, &options).unwrap();
        assert_eq!((stop, report.count.cycles), (Outcome::IterationLimit, 2), "{method:?}");
        assert!(solver.state().p.iter().all(|p| *p >= 0.0));

        for after in [1, 3, 8] {
            let options = Options { method, tolerance: 1e-12, ..Options::default() };
            let mut solver = Solver::new(&scene, &options).unwrap();
            let mut calls = 0;
            let mut cancel = |_: &_| {
                calls += 1;
                calls == after
            };
            let (stop, _) = solver.solve(&scene, &options, None, Some(&mut cancel)).unwrap();
            assert_eq!((stop, calls), (Outcome::Cancelled, after), "{method:?}");
            assert!(solver.state().p.iter().all(|p| *p >= 0.0));
            assert!(
                (solver.state().force() - 1.0).abs() <= 1e-12,
                "{method:?} after {after}: {}",
                solver.state().force()
            );
        }
    }
}

#[test]
fn precision_is_of_the_inner_work_only() {
    let grid = Grid::new(90, 70, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.05);
    let scene = Scene::new(grid, &h, rigid_on(1.0), Load::Approach(0.2));
    let run = |precision| certified(&scene, &Options { precision, tolerance: 1e-11, ..Options::default() });
    let (mixed, double) = (run(Precision::Mixed), run(Precision::Double));
    let size = double.state().p.iter().copied().fold(0.0, f64::max);
    for (a, b) in mixed.state().p.iter().zip(&double.state().p) {
        assert!((a - b).abs() <= 1e-9 * size);
    }
    assert_eq!(mixed.state().contact, double.state().contact);
}

#[test]
fn few_elements_are_solved_directly() {
    let grid = Grid::new(11, 9, 0.5, 0.25).unwrap();
    let h = paraboloid(&grid, 0.1);
    let options = Options { tolerance: 1e-2, ..Options::default() };
    for load in [Load::Approach(0.06), Load::Force(0.1)] {
        let (solver, stop, report) = solve(&Scene::new(grid, &h, rigid_on(3.0), load), &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert!(solver.state().contact_count() > 1);
        // The direct solve reaches the round-off of the residual; iterations would stop at the tolerance.
        let residual = report.measures.certificate.residual;
        assert!(residual <= 1e-13 && report.measures.certificate.violation == 0.0, "{load:?}: {residual:e}");
    }
}

/// If the approach is given, the library removes the uniform part of the residual along the last change of the solution. So a step takes about as
/// many iterations as the step under the force that it leads to.
#[test]
fn time_steps_by_approach_take_as_many_iterations_as_by_force() {
    let grid = Grid::new(120, 130, 0.5, 0.25).unwrap();
    let h = paraboloid(&grid, 0.01);
    let next = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
    let bodies = || rigid_on(3.0);
    let mut by_approach = Solver::new(&Scene::new(grid, &h, bodies(), Load::Approach(1.5)), &next).unwrap();
    let mut by_force = Solver::new(&Scene::new(grid, &h, bodies(), Load::Approach(1.5)), &next).unwrap();
    let mut iterations = [0, 0];
    for step in 0..16i32 {
        let approach = 1.5 * 1.01f64.powi(8 - (step - 8).abs());
        let scene = Scene::new(grid, &h, bodies(), Load::Approach(approach));
        let (stop, report) = by_approach.solve(&scene, &next, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let scene = Scene::new(grid, &h, bodies(), Load::Force(report.measures.force));
        let (stop, beside) = by_force.solve(&scene, &next, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert!((beside.measures.approach / approach - 1.0).abs() < 1e-5);
        if step >= 2 {
            iterations[0] += report.count.cycles;
            iterations[1] += beside.count.cycles;
        }
    }
    let [by_approach, by_force] = iterations.map(|count| count as f64);
    assert!(by_approach <= 1.15 * by_force, "{by_approach} iterations by approach, {by_force} by force");
}

/// If C shrinks, a step takes three products besides its iterations: those of the truncated prediction, of the elements of the last change that leave
/// C, and of one certificate. Because each iteration also minimises along the last change, the first certificate holds.
#[test]
fn a_step_in_time_needs_one_certificate() {
    let grid = Grid::new(1024, 1024, 20.0 / 1024.0, 12.0 / 1024.0).unwrap();
    let place = |k: usize, d: f64| (k as f64 - 511.5) * d;
    let height = |i: usize| (place(i % 1024, grid.dx).powi(2), place(i / 1024, grid.dy).powi(2));
    let h: Vec<f64> = (0..grid.len()).map(height).map(|(x2, y2)| 0.0016681 * x2 + 0.0030671 * y2).collect();
    let bodies = || Bodies::same(82000.0, 0.28);
    let next = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
    let at = |step: i32| Scene::new(grid, &h, bodies(), Load::Approach(0.1091 * 1.01f64.powi(12 - step)));
    let mut solver = Solver::new(&at(0), &next).unwrap();
    for step in 0..8 {
        let (stop, report) = solver.solve(&at(step), &next, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let others = report.count.matrix_products - report.count.cycles;
        assert!(step < 2 || others <= 3, "step {step}: {others} products beside {} iterations", report.count.cycles);
    }
}

#[test]
fn time_steps_begin_with_what_the_last_ones_changed() {
    let grid = Grid::new(120, 130, 0.5, 0.25).unwrap();
    let h = paraboloid(&grid, 0.01);
    let cold = Options::default();
    let next = Options { initial_guess: InitialGuess::Previous, ..cold };
    for by_force in [false, true] {
        let load = |step: i32| {
            let factor = 1.01f64.powi(step);
            if by_force {
                Load::Force(200.0 * factor)
            } else {
                Load::Approach(1.5 * factor)
            }
        };
        let mut solver = Solver::new(&Scene::new(grid, &h, rigid_on(3.0), load(0)), &next).unwrap();
        for step in 0..5 {
            let scene = Scene::new(grid, &h, rigid_on(3.0), load(step));
            let (stop, report) = solver.solve(&scene, &next, None, None).unwrap();
            assert_eq!(stop, Outcome::Converged);
            let (from_nothing, _, reference) = solve(&scene, &cold).unwrap();
            let scale = reference.measures.max_pressure;
            let pairs = solver.state().p.iter().zip(&from_nothing.state().p);
            let difference = pairs.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
            // Two solutions with residuals of 1e-6 may differ by 1e-3 of the largest pressure at the rim.
            assert!(difference <= 1e-3 * scale, "step {step}: {difference} of {scale}");
            if step >= 2 {
                let (warm, cold) = (report.count.work_units, reference.count.work_units);
                assert!(warm < 0.8 * cold, "step {step}: {warm} work units, {cold} from nothing");
            }
        }
        // With the same load again nothing is left to do. By approach this takes no product. By force it takes one, unless the sum of p is the force
        // to the last digit.
        let scene = Scene::new(grid, &h, rigid_on(3.0), load(4));
        let (stop, report) = solver.solve(&scene, &next, None, None).unwrap();
        assert_eq!((stop, report.count.cycles), (Outcome::Converged, 0));
        assert!(report.count.matrix_products <= u64::from(by_force), "{} products", report.count.matrix_products);
        assert!(report.measures.certificate.residual <= 1e-6);
    }
}

/// A flat punch is displaced by less than the round-off of its distance. Its pressures cannot be certified in general, and the status is OK only if
/// they are.
#[test]
fn displacements_below_the_round_off_of_distances_are_not_called_solved() {
    let grid = Grid::new(24, 24, 1.0, 1.0).unwrap();
    let solved = |offset: f64| {
        let h = vec![offset; grid.len()];
        let scene = Scene::new(grid, &h, rigid_on(1e5), Load::Force(2.4e-11));
        let (solver, outcome, _) = solve(&scene, &Options::default()).unwrap();
        (solver.state().p.clone(), outcome)
    };
    let (right, outcome) = solved(0.0);
    assert_eq!(outcome, Outcome::Converged);
    let largest = right.iter().copied().fold(0.0, f64::max);
    for offset in [1.0, 1e3, 1e9] {
        let (p, outcome) = solved(offset);
        let off = p.iter().zip(&right).fold(0.0, |off: f64, (p, right)| off.max((p - right).abs()));
        println!("offset {offset}: {outcome:?}, off by {:.1e}", off / largest);
        assert!(outcome != Outcome::Converged || off <= 1e-2 * largest, "{offset}: {off}");
    }
}

/// One element carries a given force, even if its displacement is below the round-off of its distance.
#[test]
fn one_element_carries_a_force_whose_displacement_is_below_round_off() {
    let point = (Grid::new(1, 1, 1.0, 1.0).unwrap(), vec![1.0]);
    let cone = (
        Grid::new(5, 5, 1.0, 1.0).unwrap(),
        (0..25).map(|i| 1e6 + f64::from(i % 5 - 2).hypot(f64::from(i / 5 - 2))).collect(),
    );
    for (grid, h) in [point, cone] {
        let scene = Scene::new(grid, &h, rigid_on(1.0), Load::Force(1e-17));
        let (solver, outcome, _) = solve(&scene, &Options::default()).unwrap();
        assert_eq!(outcome, Outcome::Converged);
        assert!((solver.state().force() / 1e-17 - 1.0).abs() < 1e-9, "{}", solver.state().force());
    }
}
