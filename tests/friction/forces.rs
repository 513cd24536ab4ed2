//! Given tangential forces in nearly full slip, on few elements, or with large slips. The force grows with the creepage, so that each force below mu
//! N has a solution, which must be found.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::support::{residual, run, solver};

const TOLERANCE: f64 = 1e-6;

/// Solves the tangential problem of like bodies with given pressures. Checks the conditions by direct sums, and the given forces. Returns the
/// creepages.
fn meets(grid: &Grid, g: &[f64], friction: &Friction<'_>, before: &[[f64; 2]], what: &str) -> [f64; 2] {
    let (report, solution) = run(&mut solver(grid, 0.3), g, friction, TOLERANCE);
    let slip_residual = residual((grid, 0.3), g, friction, before, (&report, &solution));
    // 1 % of the tolerance allows for the round-off of the test's direct sums.
    assert!(slip_residual <= 1.01 * TOLERANCE, "{what}: {slip_residual:e}");
    let mu = friction.coefficient.at(0);
    let carried = mu * g.iter().sum::<f64>() * grid.element_area();
    for k in 0..2 {
        let force: f64 = solution.traction.iter().map(|q| q[k]).sum::<f64>() * grid.element_area();
        if let Prescribed::Force(given) = friction.prescribed[k] {
            assert!((force - given).abs() <= 1.01 * TOLERANCE * carried, "{what}: {force:e} of {given:e}");
        }
    }
    report.creepage
}

/// An aluminium roller on a steel one that rolls freely, with hardly any friction (Bentall and Johnson 1967). All elements slip, with a creepage of
/// 5.260e-4 (CONTACT's example bentall, case 2).
#[test]
fn rollers_with_little_friction_roll_freely() {
    let grid = Grid::new(216, 1, 1e-3, 1e3).unwrap();
    let h: Vec<f64> = (0..216).map(|i| 0.02 * ((f64::from(i) + 0.5) * 1e-3 - 0.108).powi(2)).collect();
    let bodies = Bodies { shear_modulus: [23e3, 82e3], poisson_ratio: [0.31, 0.28] };
    let force = 16201.9;
    for mu in [1e-2, 1e-3, 5e-4, 1e-4, 1e-5] {
        let friction = Friction {
            motion: Motion::SteadyRolling,
            rolling_direction: PI,
            prescribed: [Prescribed::Force(0.0), Prescribed::Creepage(0.0)],
            ..Friction::new(mu)
        };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(force)) };
        let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
        assert_eq!(stop, Outcome::Converged, "mu {mu}");
        let found = report.friction.unwrap();
        assert!(found.force[0].abs() <= TOLERANCE * mu * force, "mu {mu}: {:?}", found.force);
        if mu <= 5e-4 {
            // The creepage is that at which the only sticking element has no rigid slip. For its neighbours it would differ by half a per cent, hence
            // the tolerance.
            assert!((found.creepage[0] / 5.260e-4 - 1.0).abs() <= 5e-3, "mu {mu}: {:?}", found.creepage);
        }
    }
}

/// A line contact with a caller's rigid slip that is nearly uniform, so that one creepage balances nearly all elements at once.
#[test]
fn a_slip_of_the_callers_own_is_balanced() {
    for n in [5, 40, 200] {
        let grid = Grid::new(n, 1, 1e-3, 1e3).unwrap();
        let ellipse = |i: usize| (1.0 - (2.0 * (i as f64 + 0.5) / n as f64 - 1.0).powi(2)).sqrt();
        let pressure: Vec<f64> = (0..n).map(|i| 0.01 * ellipse(i)).collect();
        let slip: Vec<f64> = (0..n).map(|i| -5.75e-7 * ellipse(i)).collect();
        let noise: Vec<f64> = (0..n).map(|i| 4e-21 * ((i * 7919 % 13) as f64 - 6.0) / 6.0).collect();
        for mu in [1e-4, 1e-6] {
            let friction = Friction {
                motion: Motion::SteadyRolling,
                prescribed: [Prescribed::Force(0.0), Prescribed::Creepage(0.0)],
                rigid_slip: Some([&slip, &noise]),
                ..Friction::new(mu)
            };
            let [creepage, _] = meets(&grid, &pressure, &friction, &[], &format!("{n} elements, mu {mu}"));
            // The creepage times the element is a mean of the slips, which are up to 5.75e-7 on elements of 1e-3.
            assert!(creepage > 0.0 && creepage < 5.75e-4, "{n} elements, mu {mu}: {creepage:e}");
        }
    }
}

/// Forces of up to .999 mu N on grids of 1 to 25 elements, square and slender.
#[test]
fn few_elements_reach_any_force_below_mu_n() {
    for (mx, my, dy) in [(1, 1, 1.0), (1, 1, 0.1), (1, 2, 2.0), (2, 1, 0.5), (1, 5, 20.0), (5, 5, 1.0)] {
        let grid = Grid::new(mx, my, 1.0, dy).unwrap();
        let n = grid.len() as f64;
        let pressure = vec![1.0 / (n * grid.element_area()); grid.len()];
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            for part in [0.5, 0.9, 0.99, 0.999] {
                let friction = Friction {
                    motion,
                    prescribed: [Prescribed::Force(0.0), Prescribed::Force(0.3 * part)],
                    rolling_distance: f64::max(1.0, dy),
                    ..Friction::new(0.3)
                };
                let before = vec![[0.0; 2]; grid.len()];
                let what = format!("{mx} x {my} of 1 x {dy}, {motion:?}, {part} mu N");
                meets(&grid, &pressure, &friction, &before, &what);
            }
        }
    }
}

/// A force is given in one direction beside a large motion: a given creepage across it, or large previous tractions.
#[test]
fn a_force_beside_large_slips_and_tractions_is_met() {
    let m = 15;
    let grid = Grid::new(m, m, 0.1, 0.1).unwrap();
    let place = |i: usize| ((i % m) as f64 - 7.0).hypot((i / m) as f64 - 7.0);
    let pressure: Vec<f64> = (0..m * m).map(|i| 0.1 * (1.0 - (place(i) / 6.3).powi(2)).max(0.0).sqrt()).collect();
    let carried = 0.3 * pressure.iter().sum::<f64>() * grid.element_area();
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        for (size, part) in (0..9).step_by(2).flat_map(|k| [0.0, 0.3].map(|part| (10f64.powi(k), part))) {
            let what = format!("{motion:?}, {part} mu N beside {size:e}");
            let by = |creepage| [Prescribed::Force(part * carried), Prescribed::Creepage(creepage)];
            let friction = Friction { motion, prescribed: by(size), ..Friction::new(0.3) };
            let [creepage, _] = meets(&grid, &pressure, &friction, &vec![[0.0; 2]; m * m], &what);
            // The creepage along the force is 0 by symmetry.
            assert!(part > 0.0 || creepage.abs() <= 1e-6 * size, "{what}: {creepage:e}");
            if motion == Motion::SteadyRolling {
                continue;
            }
            let before: Vec<[f64; 2]> =
                (0..m * m).map(|i| [7.0, 11.0].map(|k| 0.03 * size * (k * i as f64).sin())).collect();
            let (x, y): (Vec<f64>, Vec<f64>) = before.iter().map(|q| (q[0], q[1])).unzip();
            let friction =
                Friction { motion, prescribed: by(0.0), previous: Previous::Given([&x, &y]), ..Friction::new(0.3) };
            meets(&grid, &pressure, &friction, &before, &format!("tractions before, {what}"));
        }
    }
}

/// Without a motion and with a force of 0 the creepages, the tractions and the residual are 0.
#[test]
fn what_does_not_move_carries_no_force() {
    let grid = Grid::new(1, 9, 1.0, 0.41).unwrap();
    let pressure: Vec<f64> =
        (0..9).map(|i| 1e-3 * (1.0 - ((f64::from(i) - 4.0) / 3.6).powi(2)).max(0.0).sqrt()).collect();
    for prescribed in [
        [Prescribed::Creepage(0.0), Prescribed::Force(0.0)],
        [Prescribed::Force(0.0), Prescribed::Creepage(0.0)],
        [Prescribed::Force(0.0), Prescribed::Force(-0.0)],
    ] {
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            let friction = Friction { motion, prescribed, rolling_direction: -0.5 * PI, ..Friction::new(0.07) };
            let (report, solution) = run(&mut solver(&grid, 0.3), &pressure, &friction, 1e-8);
            assert_eq!((report.creepage, report.certificate.residual), ([0.0; 2], 0.0), "{motion:?} {prescribed:?}");
            assert!(
                solution.traction.iter().chain(&solution.slip).all(|v| *v == [0.0; 2]),
                "{motion:?} {prescribed:?}"
            );
        }
    }
}

/// A shift of a line contact with spin takes few products. Gradient steps that are clipped at the bounds must become long again.
#[test]
fn a_shift_of_a_line_contact_takes_few_products() {
    for m in [30, 92, 200] {
        let grid = Grid::new(m, 1, 2.2 / m as f64, 100.0).unwrap();
        let place = |i: usize| (i as f64 + 0.5) * grid.dx - 1.1;
        let g: Vec<f64> = (0..m).map(|i| (1.0 - place(i).powi(2)).max(0.0).sqrt()).collect();
        let prescribed = [Prescribed::Creepage(-1.1), Prescribed::Creepage(0.0)];
        let friction = Friction { prescribed, spin: 0.03, ..Friction::new(1.0) };
        let (report, _) = run(&mut solver(&grid, 0.28), &g, &friction, TOLERANCE);
        assert!(report.products <= 25.0, "{m}: {} products", report.products);
        assert!(report.certificate.stick_count > m / 4 && report.certificate.slip_count > m / 10, "{report:?}");
    }
}

/// At one of two creepages of full slip the force is too large, at the other one too small. A fixed-point iteration leads from each of them to the
/// other, and halves the residual. The solution is between them: one element sticks.
#[test]
fn creepages_that_lead_to_each_other_are_left() {
    let grid = Grid::new(17, 1, 2.2 / 17.0, 26.83).unwrap();
    let h: Vec<f64> = (0..17).map(|i| 0.01 * ((f64::from(i) - 8.0) * grid.dx - 0.0071067).powi(2)).collect();
    let bodies = Bodies { shear_modulus: [1e4, 13854.3], poisson_ratio: [0.32794, 0.25354] };
    let (force, mu) = (9658.8, 10f64.powf(-3.5));
    for part in [0.3, -0.3, 0.29, 0.31] {
        let friction = Friction {
            motion: Motion::Shift,
            prescribed: [Prescribed::Force(part * mu * force), Prescribed::Creepage(0.0)],
            ..Friction::new(mu)
        };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(force)) };
        let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
        let found = report.friction.unwrap();
        assert_eq!(stop, Outcome::Converged, "{part}: {found:?}");
        assert!((found.force[0] - part * mu * force).abs() <= TOLERANCE * mu * force, "{part}: {:?}", found.force);
        assert_eq!(found.certificate.stick_count, 1, "{part}");
        assert!(found.products <= 200.0, "{part}: {} products", found.products);
    }
}

/// The rms residual over 1735 elements can be small although one of them has a large residual. The search for the creepage must not decide by such a
/// trial whether the force is too small or too large.
#[test]
fn forces_are_met_where_the_residual_hides_one_element() {
    let grid = Grid::new(2000, 1, 1.1e-3, 268.0051990031252).unwrap();
    let h: Vec<f64> =
        (0..2000).map(|i| 0.01 * ((f64::from(i) - 999.5) * grid.dx - 0.0006413204950350693).powi(2)).collect();
    let bodies =
        Bodies { shear_modulus: [1e4, 55154.930364037245], poisson_ratio: [0.33582673180342015, 0.2807889637012225] };
    let (force, mu) = (96481.87164112506, 10f64.powf(-2.5));
    let friction = Friction {
        motion: Motion::Shift,
        prescribed: [Prescribed::Force(0.99 * mu * force), Prescribed::Creepage(0.0)],
        ..Friction::new(mu)
    };
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(force)) };
    let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
    let found = report.friction.unwrap();
    assert_eq!(stop, Outcome::Converged, "{found:?}");
    assert!((found.force[0] / (mu * force) - 0.99).abs() <= TOLERANCE, "{:?}", found.force);
}
