//! Meaningless input is refused by every call that takes it: invalid grids that were made without `Grid::new`, and tolerances and targets of 1 and
//! more. Callbacks get numbers, never NaN.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Scene};
use contact_normal::solver::{
    cost_of_accuracy, solve, solve_friction_batch, solve_tangential, solve_to_accuracy, Accuracy, ActiveSet, Criterion,
    Guess, Method, Options, Progress, Quantity, Solver,
};
use contact_normal::stress::{stress_at_points, subsurface_stress, Body, Loads, Wanted};
use contact_normal::threads::Threads;

const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };

fn ball(grid: &Grid) -> Vec<f64> {
    let place = |k: usize, m: usize| k as f64 - 0.5 * (m as f64 - 1.0);
    (0..grid.len())
        .map(|i| 0.01 * (place(i % grid.mx, grid.mx).powi(2) + place(i / grid.mx, grid.my).powi(2)))
        .collect()
}

fn names(refused: Result<(), Error>, words: &str) {
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains(words), "\"{refused}\" does not say {words}");
}

#[test]
fn grids_that_are_none_are_refused_everywhere() {
    let good = Grid::new(4, 3, 1.0, 1.0).unwrap();
    let (h, options) = (ball(&good), Options::default());
    let spoilt = [
        ("mx is 0", Grid { mx: 0, ..good }),
        ("my is 0", Grid { my: 0, ..good }),
        ("mx * my", Grid { mx: usize::MAX, my: usize::MAX, ..good }),
        ("mx * my", Grid { mx: 1 << 40, my: 1 << 40, ..good }),
        ("dx is -1", Grid { dx: -1.0, ..good }),
        ("dx is 0", Grid { dx: 0.0, ..good }),
        ("dy is NaN", Grid { dy: f64::NAN, ..good }),
        ("dy is inf", Grid { dy: f64::INFINITY, ..good }),
    ];
    let mut solver = Solver::new(&Scene::new(good, &h, BODIES, Load::Approach(0.05)), &options).unwrap();
    for (words, grid) in spoilt {
        let scene = Scene::new(grid, &h, BODIES, Load::Approach(0.05));
        let with_friction = Scene { friction: Some(Friction::new(0.3)), ..scene.clone() };
        names(solve(&scene, &options).map(drop), words);
        names(Solver::new(&scene, &options).map(drop), words);
        names(solver.solve(&scene, &options, None, None).map(drop), words);
        names(scene.coefficients().map(drop), words);
        names(solve_to_accuracy(&scene, &options, &Accuracy::new(0.1), None, None).map(drop), words);
        let mut surface = |_: &Grid, h: &mut [f64]| {
            h.fill(0.0);
            false
        };
        names(solve_to_accuracy(&scene, &options, &Accuracy::new(0.1), Some(&mut surface), None).map(drop), words);
        let wanted = (Quantity::Force, &[0.1][..]);
        names(cost_of_accuracy(&scene, &options, &Accuracy::new(0.1), wanted, None, None).map(drop), words);
        names(solve_tangential(&with_friction, &h, &options, None).map(drop), words);
        names(solve_friction_batch(&with_friction, Some(&h), &[], &options, None, |_, _, _| {}).map(drop), words);
        let body = Body { grid, poisson_ratio: 0.3, periodic: false };
        let (loads, one) = (Loads::pressure(&h), Threads::One);
        names(subsurface_stress(&body, &loads, &[1.0], &Wanted::default(), &one, None, |_, _| {}).map(drop), words);
        names(stress_at_points(&body, &loads, &[[0.5, 0.5, 1.0]], &one, None, &mut [[0.0; 6]]).map(drop), words);
    }
}

#[test]
fn tolerances_and_targets_lie_below_1() {
    let grid = Grid::new(12, 12, 1.0, 1.0).unwrap();
    let h = ball(&grid);
    let scene = Scene::new(grid, &h, BODIES, Load::Approach(0.2));
    let with_friction = Scene { friction: Some(Friction::new(0.3)), ..scene.clone() };
    let mut solver = Solver::new(&scene, &Options::default()).unwrap();
    for tolerance in [1.0, 1.0 + 1e-15, 3.0, 1e300, f64::INFINITY, f64::NAN, 0.0, -1e-3] {
        for criterion in [Criterion::Residual, Criterion::Update] {
            let (options, words) = (
                Options { tolerance, criterion, ..Options::default() },
                format!("tolerance is {}", if tolerance == 1e300 { "1e300".into() } else { tolerance.to_string() }),
            );
            for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg] {
                names(solve(&scene, &Options { method, ..options }).map(drop), &words);
            }
            names(solver.solve(&scene, &options, None, None).map(drop), &words);
            names(solver.solve_batch(&[], &options, |_, _, _| ()).map(drop), &words);
            names(solve(&with_friction, &options).map(drop), &words);
            names(solve_tangential(&with_friction, &h, &options, None).map(drop), &words);
            names(solve_friction_batch(&with_friction, None, &[], &options, None, |_, _, _| {}).map(drop), &words);
            names(solve_to_accuracy(&scene, &options, &Accuracy::new(0.1), None, None).map(drop), &words);
        }
    }
    for target in [1.0, 2.0, f64::NAN, f64::INFINITY, 0.0] {
        let words = format!("target is {target}");
        names(solve_to_accuracy(&scene, &Options::default(), &Accuracy::new(target), None, None).map(drop), &words);
        let wanted = (Quantity::MaxPressure, &[0.1, target][..]);
        names(cost_of_accuracy(&scene, &Options::default(), &Accuracy::new(0.1), wanted, None, None).map(drop), &words);
    }
    let high = Accuracy::new(0.1).with(Quantity::MaxPressure, 1.0);
    names(solve_to_accuracy(&scene, &Options::default(), &high, None, None).map(drop), "max_pressure_target is 1");
    let high = Accuracy::new(0.1).with(Quantity::ContactArea, 5.0);
    names(solve_to_accuracy(&scene, &Options::default(), &high, None, None).map(drop), "contact_area_target is 5");
    // The largest valid tolerance, just below 1, is accepted.
    assert!(solve(&scene, &Options { tolerance: 1.0f64.next_down(), ..Options::default() }).is_ok());
}

#[test]
fn sweeps_that_overflow_are_refused() {
    let mut options = Options::default();
    (options.cycle.pre_sweeps, options.cycle.post_sweeps) = (usize::MAX, 1);
    names(options.check(), "pre_sweeps is 18446744073709551615");
    (options.cycle.pre_sweeps, options.cycle.post_sweeps) = (0, 0);
    names(options.check(), "both 0");
}

/// If h equals the approach on all of C, residuals are relative to 0. The callback must still get numbers.
#[test]
fn a_callback_is_told_numbers() {
    let grid = Grid::new(9, 7, 1.0, 1.0).unwrap();
    let (flat, all) = (vec![0.3; grid.len()], vec![true; grid.len()]);
    let mut one = vec![0.5; grid.len()];
    one[31] = 0.3;
    let guess = Some(Guess { pressure: &all.iter().map(|_| 0.1).collect::<Vec<f64>>(), contact: &all });
    for h in [&flat, &one] {
        for load in [Load::Approach(0.3), Load::Force(1e-3)] {
            let scene = Scene::new(grid, h, BODIES, load);
            for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg] {
                for active_set in [ActiveSet::Free, ActiveSet::Fixed] {
                    let options = Options { method, active_set, ..Options::default() };
                    let mut solver = Solver::new(&scene, &options).unwrap();
                    let mut told = |told: &Progress| {
                        let values = [told.residual, told.update, told.work_units, told.seconds];
                        assert!(
                            !values.iter().any(|value| value.is_nan()),
                            "{method:?} {active_set:?} {load:?}: {told:?}"
                        );
                        false
                    };
                    let (_, report) = solver.solve(&scene, &options, guess, Some(&mut told)).unwrap();
                    assert!(!report.measures.certificate.residual.is_nan());
                }
            }
        }
    }
}
