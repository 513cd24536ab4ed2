//! Weights of creepages, for surfaces that are inclined within the contact area. A creepage moves an element by the creepage times its weight. The
//! force in a direction is the sum of weights times tractions.

use contact_normal::error::Error;
use contact_normal::friction::Request;
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed, Previous};
use contact_normal::solver::Outcome;

use super::scenes::Ellipse;
use super::support::{residual, run, solver};

/// Weights: 1 in x, and in y the cosines of inclinations of up to about a right angle, or beyond it if `reversed`.
fn cosines(grid: &Grid, reversed: bool) -> [Vec<f64>; 2] {
    let most = if reversed { 2.0 } else { 1.2 };
    let angle = |i: usize| most * (2.0 * (i / grid.mx) as f64 / (grid.my - 1) as f64 - 1.0);
    [vec![1.0; grid.len()], (0..grid.len()).map(|i| angle(i).cos()).collect()]
}

#[test]
fn forces_are_sums_of_weighted_tractions() {
    for seed in 0..8 {
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            for part in [0.2, 0.6, 0.9] {
                let case = Ellipse::random(seed, 20, true);
                let weights = cosines(&case.grid, seed % 2 == 1);
                let views = weights.each_ref().map(|weights| &weights[..]);
                let area = case.grid.element_area();
                let along = [0.6f64, -0.8];
                let reach = |i: usize| (weights[0][i] * along[0]).hypot(weights[1][i] * along[1]);
                let most: f64 = (0..case.grid.len()).map(|i| case.bound[i] * reach(i) * area).sum();
                let force = along.map(|along| part * most * along);
                let prescribed = force.map(Prescribed::Force);
                let friction = Friction { motion, prescribed, weights: Some(views), spin: 0.0, ..case.friction };
                let mut solver = solver(&case.grid, case.nu);
                let (report, solution) = run(&mut solver, &case.bound, &friction, 1e-6);
                let none = vec![[0.0; 2]; case.grid.len()];
                let place = (&case.grid, case.nu);
                let slip_residual = residual(place, &case.bound, &friction, &none, (&report, &solution));
                // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
                assert!(slip_residual <= 1.001e-6, "{seed} {motion:?} {part}: {slip_residual}");
                let carried: f64 = case.bound.iter().sum::<f64>() * area;
                for k in 0..2 {
                    let terms = solution.traction.iter().zip(&weights[k]).map(|(q, weight)| weight * q[k]);
                    let sum = terms.sum::<f64>() * area;
                    assert!((sum - force[k]).abs() <= 1.001e-6 * carried, "{seed} {motion:?} {part}: {sum} {force:?}");
                }
                if motion == Motion::SteadyRolling {
                    continue;
                }
                // The next step, with 70 % of the force.
                let prescribed = force.map(|force| Prescribed::Force(0.7 * force));
                let next = Friction { previous: Previous::Kept, prescribed, ..friction };
                let (report, after) = run(&mut solver, &case.bound, &next, 1e-6);
                let slip_residual = residual(place, &case.bound, &next, &solution.traction, (&report, &after));
                assert!(slip_residual <= 1.001e-6, "{seed} {motion:?} {part}, the next step: {slip_residual}");
            }
        }
    }
}

#[test]
fn creepages_that_are_given_are_weighted_too() {
    let case = Ellipse::random(5, 20, false);
    let weights = cosines(&case.grid, false);
    let views = weights.each_ref().map(|weights| &weights[..]);
    let prescribed = [Prescribed::Creepage(-0.2), Prescribed::Creepage(0.3)];
    let weighted = Friction { prescribed, weights: Some(views), ..case.friction };
    // The result equals that of a caller's rigid slip with the same numbers.
    let slips = [0, 1].map(|k| weights[k].iter().map(|weight| weight * [-0.2, 0.3][k]).collect::<Vec<f64>>());
    let own = Some(slips.each_ref().map(|slip| &slip[..]));
    let rigid = Friction { prescribed: [Prescribed::Creepage(0.0); 2], rigid_slip: own, ..case.friction };
    let solved = |friction: &Friction<'_>| run(&mut solver(&case.grid, case.nu), &case.bound, friction, 1e-9).1;
    let (one, other) = (solved(&weighted), solved(&rigid));
    let largest = case.bound.iter().fold(0.0f64, |most, g| most.max(*g));
    for (a, b) in one.traction.iter().zip(&other.traction) {
        assert!((0..2).all(|k| (a[k] - b[k]).abs() <= 1e-7 * largest), "{a:?} {b:?}");
    }
}

#[test]
fn weights_of_one_are_none() {
    let case = Ellipse::random(2, 20, true);
    let ones = vec![1.0; case.grid.len()];
    let solved = |weights| {
        let friction = Friction { weights, ..case.friction };
        run(&mut solver(&case.grid, case.nu), &case.bound, &friction, 1e-8)
    };
    let ((plain, one), (weighted, other)) = (solved(None), solved(Some([&ones[..], &ones[..]])));
    assert_eq!((plain.creepage, plain.force), (weighted.creepage, weighted.force));
    assert_eq!(one.traction, other.traction);
}

#[test]
fn forces_that_weights_cannot_carry_are_refused() {
    let case = Ellipse::random(1, 20, true);
    let (none, half) = (vec![0.0; case.grid.len()], vec![0.5; case.grid.len()]);
    let area = case.grid.element_area();
    let most: f64 = case.bound.iter().sum::<f64>() * area;
    let solved = |x: f64, y: f64| {
        let prescribed = [Prescribed::Force(x), Prescribed::Force(y)];
        let friction = Friction { prescribed, weights: Some([&none, &half]), spin: 0.0, ..case.friction };
        let request = Request::new(&case.bound, &friction, 1e-6);
        solver(&case.grid, case.nu).solve(&request, &mut |_, _| true).map(|(end, report)| (end, report.creepage))
    };
    assert!(matches!(solved(0.1 * most, 0.1 * most), Err(Error::Infeasible(_))));
    assert!(matches!(solved(0.0, 0.6 * most), Err(Error::Infeasible(_))));
    // With weights of 0 a force of 0 needs no creepage, up to round-off.
    let (end, creepage) = solved(0.0, 0.3 * most).unwrap();
    assert!(end == Outcome::Converged && creepage[0].abs() < 1e-15 && creepage[1] < -0.1, "{end:?} {creepage:?}");
}

/// The largest multiple of a force that the elements can carry. For each of 20000 directions of creepage the tractions of full slip give a half-plane
/// that contains all forces that can be carried; the multiple is the least over the half-planes.
fn reach(force: [f64; 2], bound: &[f64], weights: &[Vec<f64>; 2], area: f64) -> f64 {
    let part = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / 20000.0;
        let d = [angle.cos(), angle.sin()];
        let length: f64 = (0..bound.len()).map(|i| bound[i] * (weights[0][i] * d[0]).hypot(weights[1][i] * d[1])).sum();
        let along = force[0] * d[0] + force[1] * d[1];
        if along > 0.0 {
            length * area / along
        } else {
            f64::INFINITY
        }
    };
    (0..20000).map(part).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_can_be_carried_is_solved_and_what_cannot_be_is_refused() {
    let mut random = 1u64;
    let mut next = || {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 11) as f64 / (1u64 << 53) as f64
    };
    for (mx, my) in [(1, 1), (1, 2), (2, 1), (2, 2), (3, 2), (4, 3)] {
        for trial in 0..12 {
            let grid = Grid::new(mx, my, 1.0, 0.7).unwrap();
            let bound: Vec<f64> = (0..grid.len()).map(|_| 0.2 + next()).collect();
            let sign = if trial % 3 == 0 { -1.0 } else { 1.0 };
            let weights = [0, 1].map(|_| {
                (0..grid.len())
                    .map(|_| (1.0 - 0.95 * next()) * if next() < 0.2 { sign } else { 1.0 })
                    .collect::<Vec<f64>>()
            });
            let views = weights.each_ref().map(|weights| &weights[..]);
            let angle = std::f64::consts::TAU * next();
            let along = [angle.cos(), angle.sin()];
            let most = reach(along, &bound, &weights, grid.element_area());
            for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
                for (part, can_be) in [(0.5, true), (0.9, true), (0.98, true), (1.0 + 1e-6, false), (1.1, false)] {
                    let prescribed = along.map(|along| Prescribed::Force(part * most * along));
                    let friction = Friction { motion, prescribed, weights: Some(views), ..Friction::new(1.0) };
                    let request = Request::new(&bound, &friction, 1e-6);
                    let mut solver = solver(&grid, 0.3);
                    let found = solver.solve(&request, &mut |_, _| true);
                    let what = format!("{mx} x {my}, trial {trial}, {motion:?}, {part} of {most}: {found:?}");
                    match found {
                        Ok((end, _)) => assert!(can_be && end == Outcome::Converged, "{what}"),
                        Err(error) => assert!(!can_be && matches!(error, Error::Infeasible(_)), "{what}"),
                    }
                }
            }
        }
    }
}

/// If the weights of one direction are 0, a force of 0 in the other direction is met.
#[test]
fn a_force_of_zero_is_met_beside_one_without_weights() {
    let case = Ellipse::random(3, 20, false);
    let (ones, zeros) = (vec![1.0; case.grid.len()], vec![0.0; case.grid.len()]);
    let area = case.grid.element_area();
    let carried: f64 = case.bound.iter().sum::<f64>() * area;
    for motion in [Motion::Shift, Motion::SteadyRolling] {
        for k in 0..2 {
            for (other, force) in [(Prescribed::Creepage(0.0), 0.0), (Prescribed::Force(0.0), 0.0)] {
                let mut prescribed = [other; 2];
                prescribed[k] = Prescribed::Force(force);
                let mut weights = [&zeros[..]; 2];
                weights[k] = &ones;
                // A spin about a place off the centre causes a force, which a creepage has to balance.
                let friction = Friction {
                    motion,
                    prescribed,
                    weights: Some(weights),
                    spin: 0.01,
                    spin_centre: [0.3, 0.1],
                    ..case.friction
                };
                let (report, solution) = run(&mut solver(&case.grid, case.nu), &case.bound, &friction, 1e-6);
                let sum = solution.traction.iter().map(|q| q[k]).sum::<f64>() * area;
                assert!((sum - force).abs() <= 1.001e-6 * carried, "{motion:?} {k} {other:?}: {sum:e} {report:?}");
                assert!(report.creepage[k] != 0.0, "{motion:?} {k} {other:?}");
            }
        }
    }
}
