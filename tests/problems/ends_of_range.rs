//! Scenes at the ends of the range of numbers: areas of elements, loads of stresses, tiny limits. Also solves of one cycle.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome, Solver};
use contact_normal::stress::{stress_at_points, subsurface_stress, Body, Loads, Wanted};
use contact_normal::threads::Threads;

const BODIES: Bodies = Bodies { shear_modulus: [1.0, 1.0], poisson_ratio: [0.3, 0.3] };

/// The caller's coefficients do not depend on the sizes of elements, which only enter forces. Without a check a force would be 0 or infinite here.
#[test]
fn areas_and_forces_beyond_the_range_of_numbers_are_refused() {
    let offset = |k: usize| ((k % 8) as f64 - 4.0).hypot((k / 8) as f64 - 4.0);
    let table: Vec<f64> = (0..64).map(|k| 1.0 / (0.3 + offset(k))).collect();
    let h: Vec<f64> = (0..16).map(|i| 0.01 * (i as f64 - 7.5).abs()).collect();
    for side in [1e-170, 1e-148, 1.0, 1e148, 1e170] {
        let grid = Grid::new(4, 4, side, side).expect("a grid");
        for load in [Load::Approach(0.1), Load::Force(1.0)] {
            let influence = Some(Table::new(4, 4, &table, &grid).expect("a table"));
            let scene = Scene { influence, ..Scene::new(grid, &h, BODIES, load) };
            match solve(&scene, &Options::default()) {
                Ok((_, outcome, report)) => {
                    assert!(side == 1.0 && outcome == Outcome::Converged, "{side} {load:?}: {outcome:?}");
                    assert!(report.measures.force > 0.0 && report.measures.force < 1e290);
                }
                Err(refusal) => {
                    assert!(side != 1.0 && matches!(refusal, Error::InvalidArgument(_)), "{side} {load:?}: {refusal}")
                }
            }
        }
    }
}

/// A single element with two periods has no displacement. Its area must still be in the range of numbers.
#[test]
fn the_area_of_a_single_element_with_two_periods_is_in_range() {
    for (side, is_refused) in [(1e-160, true), (1.0, false), (1e150, true)] {
        let grid = Grid::new(1, 1, side, side).expect("a grid");
        let (period, limit) = (Some(Period { x: true, y: true }), Some(PressureLimit(Each::Uniform(1e-3))));
        let scene = Scene { period, pressure_limit: limit, ..Scene::new(grid, &[0.0], BODIES, Load::Approach(0.3)) };
        assert_eq!(solve(&scene, &Options::default()).is_err(), is_refused, "{side}");
    }
}

/// A load whose stresses overflow is refused, so that no stress is infinite or NaN with status OK.
#[test]
fn loads_whose_stresses_overflow_are_refused() {
    let body = Body { grid: Grid::new(8, 8, 1.0, 1.0).expect("a grid"), poisson_ratio: 0.3, periodic: false };
    let wanted =
        Wanted { components: [true; 6], von_mises: true, maximum_shear: true, principal: true, directions: true };
    for (load, is_refused) in [(1e308, true), (9e303, false)] {
        let (p, q) = ([load; 64], [-load; 64]);
        let loads = Loads { pressure: Some(&p), traction_x: Some(&q), traction_y: Some(&p), patches: None };
        let mut finite = true;
        let done = subsurface_stress(&body, &loads, &[0.0, 0.3], &wanted, &Threads::One, None, |_, depth| {
            let each = depth.von_mises.iter().chain(&depth.maximum_shear).chain(depth.principal.iter().flatten());
            finite &= each.chain(depth.stress.iter().flatten()).all(|value| value.is_finite());
        });
        assert!(finite);
        assert_eq!(matches!(done, Err(Error::InvalidArgument(_))), is_refused);
        let mut out = [Default::default()];
        let at_point = stress_at_points(&body, &loads, &[[0.2, 0.3, 0.1]], &Threads::One, None, &mut out);
        assert_eq!(matches!(at_point, Err(Error::InvalidArgument(_))), is_refused);
    }
}

/// If a callback stops the stresses at the last depth or the last points, nothing is missing, and the outcome is that of a complete call.
#[test]
fn a_stop_with_the_last_depth_is_no_stop() {
    let body = Body { grid: Grid::new(4, 4, 1.0, 1.0).expect("a grid"), poisson_ratio: 0.3, periodic: false };
    let p = [1.0; 16];
    let (loads, wanted) = (Loads::pressure(&p), Wanted { components: [true; 6], ..Wanted::default() });
    for (depths, all) in [(&[0.5][..], true), (&[0.5, 0.7], false)] {
        let (mut count, mut stop) = (0, |_: &_| true);
        let done = subsurface_stress(&body, &loads, depths, &wanted, &Threads::One, Some(&mut stop), |_, _| count += 1);
        assert_eq!((done.expect("stresses"), count), (all, 1));
    }
    let mut out = [Default::default(); 3];
    let points = [[0.1, 0.2, 0.3]; 3];
    let done = stress_at_points(&body, &loads, &points, &Threads::One, Some(&mut |_: &_| true), &mut out);
    assert!(done.expect("stresses"));
}

/// Two elements with two periods. Their displacements depend only on the difference of both pressures, so that the element with a tiny limit is at
/// its limit.
#[test]
fn limits_next_to_nothing_are_reached() {
    let grid = Grid::new(2, 1, 1.0, 1.0).expect("a grid");
    let period = Some(Period { x: true, y: true });
    for h in [[0.5, 0.2], [0.2, 0.5]] {
        for small in [1e-20, 1e-40, 1e-300] {
            let limits = if h[0] > h[1] { [small, 1e3] } else { [1e3, small] };
            let pressure_limit = Some(PressureLimit(Each::PerElement(&limits)));
            let scene = Scene { period, pressure_limit, ..Scene::new(grid, &h, BODIES, Load::Approach(0.43)) };
            // PROJECTED_CG alone stagnates if a limit is beyond the range of single precision.
            let alone = if small > 1e-38 { Method::ProjectedCg } else { Method::Auto };
            for method in [Method::Auto, alone, Method::Norm] {
                let (solver, outcome, _) = solve(&scene, &Options { method, ..Options::default() }).expect("a scene");
                let state = solver.state();
                let low = usize::from(h[0] < h[1]);
                // The element at its limit would penetrate without the limit: the approach .43 exceeds the mean of both distances.
                assert_eq!(outcome, Outcome::Converged, "{method:?} {small} {:?}", state.p);
                assert!(state.p[low] == small && state.at_limit[low], "{method:?} {small} {:?}", state.p);
            }
        }
    }
}

/// After the only cycle that is allowed, the whole contact is at its limit and the conditions hold: the status is OK, although the cycles are used
/// up.
#[test]
fn a_result_that_holds_is_ok_whatever_ended_the_cycles() {
    for (mx, my) in [(1, 1), (17, 5)] {
        let grid = Grid::new(mx, my, 0.1, 0.1).expect("a grid");
        let h: Vec<f64> = (0..grid.len()).map(|i| 0.01 * (i as f64 * 1.7).sin()).collect();
        for method in [Method::Auto, Method::Norm, Method::ProjectedCg] {
            let pressure_limit = Some(PressureLimit(Each::Uniform(1e-3)));
            let scene = Scene { pressure_limit, ..Scene::new(grid, &h, BODIES, Load::Approach(0.3)) };
            let options = Options { method, max_cycles: 1, ..Options::default() };
            let (solver, outcome, _) = solve(&scene, &options).expect("a scene");
            assert_eq!(outcome, Outcome::Converged, "{mx} {my} {method:?}");
            assert!(solver.state().p.iter().all(|p| *p == 1e-3));
        }
    }
}

/// If a single cycle is allowed, AUTO uses it for its first method.
#[test]
fn the_only_cycle_goes_to_the_first_method() {
    let grid = Grid::new(64, 64, 0.05, 0.05).expect("a grid");
    let at = |k: usize| (k as f64 - 31.5) * 0.05;
    let h: Vec<f64> = (0..grid.len()).map(|i| at(i % 64).powi(2) + at(i / 64).powi(2)).collect();
    let scene = Scene::new(grid, &h, BODIES, Load::Approach(0.5));
    let residual = |method: Method| {
        let (.., report) = solve(&scene, &Options { method, max_cycles: 1, ..Options::default() }).expect("a scene");
        report.measures.certificate.residual
    };
    assert_eq!(residual(Method::Auto), residual(Method::ProjectedCg));
}

/// Elements of a micrometre, given in metres, are solved in other units internally. A solve with a pressure limit must not change the next solve
/// without one.
#[test]
fn a_limit_of_the_solve_before_changes_not_a_bit() {
    let grid = Grid::new(64, 64, 1e-6, 1e-6).expect("a grid");
    let wave =
        |i: usize, j: usize, k: usize| ((i * (k % 64) + j * (k / 64)) as f64 * 0.098_174_77 + (i * j) as f64).sin();
    let waves = |k: usize| (1..20).map(|i| wave(i, (3 * i) % 11, k) / i as f64).sum::<f64>();
    let h: Vec<f64> = (0..grid.len()).map(|k| 1e-8 * waves(k)).collect();
    let mean = h.iter().sum::<f64>() / h.len() as f64;
    let bodies = Bodies { shear_modulus: [8e10; 2], poisson_ratio: [0.3; 2] };
    let period = Some(Period { x: true, y: true });
    let plain = Scene { period, ..Scene::new(grid, &h, bodies, Load::Approach(mean - 1e-9)) };
    let (fresh, outcome, report) = solve(&plain, &Options::default()).expect("a scene");
    assert_eq!(outcome, Outcome::Converged);
    let limit = 0.5 * report.measures.max_pressure;
    let limited = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(limit))), ..plain.clone() };
    let mut solver = Solver::new(&plain, &Options::default()).expect("a solver");
    let (_, first) = solver.solve(&limited, &Options::default(), None, None).expect("a scene");
    assert!(first.count.cycles > 0 && solver.state().at_limit.contains(&true));
    let (_, again) = solver.solve(&plain, &Options::default(), None, None).expect("a scene");
    assert_eq!(again.count.matrix_products, report.count.matrix_products);
    assert_eq!(solver.state().p, fresh.state().p);
}
