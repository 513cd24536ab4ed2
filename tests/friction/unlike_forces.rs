//! Unlike bodies with given tangential forces. Tractions change the pressures, and so the largest force that friction carries.

use contact_normal::effects::Coefficient;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome, Solver};

use super::case::{distance, grid};
use super::near_full_slip::ellipse;
use super::unlike::RIGID_ON_SOFT;

fn ball() -> (Grid, Vec<f64>) {
    let grid = grid(16, 16, 1.0, 1.0);
    (grid, distance(&grid, |x, y| (x * x + y * y) / 50.0))
}

/// The force that belongs to a given creepage must be accepted as a given force, and must give the creepage back. If mu differs between elements or
/// the approach is given, the pressures without tractions carry less than most of these forces.
#[test]
fn forces_beyond_what_the_first_pressures_carry_are_found() {
    let (grid, h) = ball();
    let mu: Vec<f64> = (0..256).map(|i| if i % 16 < 8 { 0.5 } else { 0.1 }).collect();
    let (varies, uniform) = (Coefficient::PerElement(&mu), Coefficient::Uniform(0.5));
    let (options, mut beyond) = (Options { tolerance: 1e-9, ..Options::default() }, 0);
    for (load, coefficient) in
        [(Load::Force(5.0), varies), (Load::Approach(0.5), varies), (Load::Approach(0.5), uniform)]
    {
        for motion in [Motion::Shift, Motion::SteadyRolling] {
            for creepage in [-0.05, -0.1, -0.2, -0.3, 0.1, 0.3] {
                let given = |x: Prescribed| {
                    let prescribed = [x, Prescribed::Creepage(0.0)];
                    let friction = Friction { coefficient, motion, prescribed, ..Friction::new(0.5) };
                    Scene { friction: Some(friction), ..Scene::new(grid, &h, RIGID_ON_SOFT, load) }
                };
                let of = |scene: &Scene<'_>| {
                    let (solver, outcome, _) = solve(scene, &options).unwrap();
                    assert_eq!(outcome, Outcome::Converged, "{load:?} {motion:?} {creepage}");
                    let carried: f64 = solver.state().p.iter().enumerate().map(|(i, p)| coefficient.at(i) * p).sum();
                    let force: f64 = solver.friction().map_or(0.0, |found| found.traction.iter().map(|q| q[0]).sum());
                    (force, carried)
                };
                let (force, carried) = of(&given(Prescribed::Creepage(creepage)));
                // In full slip any larger creepage has the same force, so that the force determines no creepage.
                if force.abs() > (1.0 - 1e-6) * carried {
                    continue;
                }
                let (_, plain) = of(&Scene::new(grid, &h, RIGID_ON_SOFT, load));
                beyond += usize::from(force.abs() > plain);
                let (again, _) = of(&given(Prescribed::Force(force)));
                // The tolerance of a given force is relative to mu N.
                assert!((again - force).abs() <= 1e-9 * carried, "{load:?} {motion:?} {creepage}: {again} {force}");
            }
        }
    }
    assert!(beyond > 5, "{beyond} beyond what the first pressures carry");
}

/// A force above the one that the pressures carry in full slip, which is known from a large creepage, is refused. The handle keeps its last result.
#[test]
fn forces_beyond_full_slip_are_refused() {
    let (grid, h) = ball();
    let mu: Vec<f64> = (0..256).map(|i| if i % 16 < 8 { 0.5 } else { 0.1 }).collect();
    for (load, sign) in [(Load::Force(5.0), 1.0), (Load::Force(5.0), -1.0), (Load::Approach(0.5), 1.0)] {
        let with = |x: Prescribed| {
            let prescribed = [x, Prescribed::Creepage(0.0)];
            let friction = Friction { coefficient: Coefficient::PerElement(&mu), prescribed, ..Friction::new(0.5) };
            Scene { friction: Some(friction), ..Scene::new(grid, &h, RIGID_ON_SOFT, load) }
        };
        let (slips, options) = (with(Prescribed::Creepage(1e3 * sign)), Options::default());
        let mut solver = Solver::new(&slips, &options).unwrap();
        assert_eq!(solver.solve(&slips, &options, None, None).unwrap().0, Outcome::Converged);
        let traction = solver.friction().unwrap().traction.clone();
        let most: f64 = traction.iter().map(|q| q[0]).sum();
        let refused = solver.solve(&with(Prescribed::Force(1.001 * most)), &options, None, None);
        let Err(Error::Infeasible(message)) = refused else { panic!("{refused:?}") };
        let least: f64 = message.rsplit(' ').next().unwrap().parse().unwrap();
        // Creepages just below full slip carry a little more than full slip, by 4.5e-4 with a given approach.
        let part = least / most.abs();
        assert!((1.0 - 1e-4..1.001).contains(&part), "{message}: {most}");
        assert!(solver.friction().unwrap().traction == traction, "the last result");
        let almost = solver.solve(&with(Prescribed::Force(0.999 * most)), &options, None, None).unwrap();
        assert_eq!(almost.0, Outcome::Converged);
    }
}

/// A tolerance below round-off cannot be met. The result is then the best iterate by its residual in double precision, not by that in single
/// precision.
#[test]
fn below_round_off_the_best_is_returned() {
    for (m, mu) in [(35, 1.3e-4), (34, 1.5e-2), (22, 8.9e-3), (16, 1.4e-4), (29, 3.2e-3)] {
        for shift in [0.0, 0.3] {
            let (grid, h) = ellipse(m, shift);
            let forces = [1.8 * mu, 0.21 * mu].map(Prescribed::Force);
            let friction = Friction { motion: Motion::SteadyRolling, prescribed: forces, ..Friction::new(mu) };
            for bodies in [Bodies { shear_modulus: [1.0, 5.0], poisson_ratio: [0.1, 0.3] }, Bodies::same(1.0, 0.3)] {
                let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(3.0)) };
                for tolerance in [1e-15, 1e-16, 1e-17] {
                    let (_, _, report) = solve(&scene, &Options { tolerance, ..Options::default() }).unwrap();
                    let found = report.friction.unwrap().certificate;
                    // Residuals are sums of some hundred terms, each with a rounding error of 1e-16.
                    assert!(found.residual <= 1e-14, "{m} {mu} {shift} {tolerance} {bodies:?}: {}", found.residual);
                }
            }
        }
    }
}

/// A flat soft punch on a rigid body carries up to 1 % more force just before full slip than in full slip. The force of any creepage must be
/// accepted. Close to the largest force a search takes some 2000 products.
#[test]
fn forces_between_full_slip_and_the_largest_are_found() {
    for (m, mu, motion) in [((11, 5), 1.0, Motion::SteadyRolling), ((11, 25), 2.0, Motion::Shift)] {
        let (grid, h) = (Grid::new(m.0, m.1, 1.0, 1.0).unwrap(), vec![0.0; m.0 * m.1]);
        let bodies = Bodies { shear_modulus: [1.0, f64::INFINITY], poisson_ratio: [0.0; 2] };
        let force = |x: Prescribed| {
            let friction = Friction { motion, prescribed: [x, Prescribed::Creepage(0.0)], ..Friction::new(mu) };
            let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Approach(0.2)) };
            let (solver, outcome, _) = solve(&scene, &Options { max_cycles: 4000, ..Options::default() })?;
            assert_eq!(outcome, Outcome::Converged, "{m:?} {x:?}");
            Ok::<f64, Error>(solver.friction().map_or(0.0, |found| found.traction.iter().map(|q| q[0]).sum()))
        };
        let of = |creepage: f64| force(Prescribed::Creepage(-creepage)).unwrap();
        let (full, largest) = (of(1e4), (0..30).map(|k| of(0.02 * 1.2f64.powi(k))).fold(0.0, f64::max));
        assert!(largest > 1.002 * full, "{m:?}: {largest} {full}");
        for part in [0.1, 0.5, 0.9] {
            let wanted = full + part * (largest - full);
            let found = force(Prescribed::Force(wanted)).unwrap_or_else(|error| panic!("{m:?} {part}: {error}"));
            assert!((found / wanted - 1.0).abs() <= 1e-6, "{m:?} {part}: {found} {wanted}");
        }
        // Between two of the thirty creepages the force may be some thousandths larger than at these. A search for a force out of reach ends.
        let Err(Error::Infeasible(message)) = force(Prescribed::Force(1.01 * largest)) else { panic!("{m:?}") };
        let most: f64 = message.rsplit(' ').next().unwrap().parse().unwrap();
        assert!((0.997..1.005).contains(&(most / largest)), "{message}: {largest}");
    }
}
