//! A thin elastic layer between the bodies: a compliance, uniform or one per element, in addition to the coefficients.

use contact_normal::grid::Grid;
use contact_normal::scene::{Coefficient, Friction, Motion, Prescribed, Previous};

use super::scenes::Ellipse;
use super::support::{residual, run, solver};

/// Compliances of elements from 0 to 2 `mean`, in a pattern without symmetry.
fn uneven(grid: &Grid, mean: f64) -> Vec<f64> {
    (0..grid.len())
        .map(|i| mean * (1.0 + (0.7 * (i % grid.mx) as f64).sin() * (0.4 * (i / grid.mx) as f64).cos()))
        .collect()
}

#[test]
fn one_element_sticks_by_both_compliances_together() {
    let grid = Grid::new(1, 1, 0.5, 0.4).unwrap();
    let own = solver(&grid, 0.0).tangential().at(0.0, 0.0)[0];
    for layer in [0.0, 0.1 * own, own, 1e4 * own] {
        let prescribed = [Prescribed::Creepage(-1e-3), Prescribed::Creepage(0.0)];
        let compliance = Coefficient::Uniform(layer);
        let friction = Friction { prescribed, compliance, ..Friction::new(1e3) };
        let (_, solution) = run(&mut solver(&grid, 0.0), &[1.0], &friction, 1e-12);
        let expected = 1e-3 / (own + layer);
        assert!(
            (solution.traction[0][0] - expected).abs() <= 1e-11 * expected,
            "{layer} {:?} {expected}",
            solution.traction
        );
    }
}

#[test]
fn all_motions_meet_the_conditions() {
    let mut most = 0.0f64;
    for seed in 0..8 {
        for (motion, step, direction) in [
            (Motion::Shift, 0.0, 0.0),
            (Motion::TransientRolling, 1.0, 0.0),
            (Motion::TransientRolling, 2.4, 0.6),
            (Motion::SteadyRolling, 1.0, 0.0),
            (Motion::SteadyRolling, 1.5, 0.0),
            (Motion::SteadyRolling, 1.0, 0.5),
        ] {
            for forces in [false, true] {
                let case = Ellipse::random(seed, 20, forces);
                let own = solver(&case.grid, case.nu).tangential().at(0.0, 0.0)[0];
                let uneven = uneven(&case.grid, own);
                for compliance in [Coefficient::Uniform(0.5 * own), Coefficient::PerElement(&uneven)] {
                    let (rolling_distance, rolling_direction) = (step * case.grid.dx, direction);
                    let friction =
                        Friction { motion, rolling_distance, rolling_direction, compliance, ..case.friction };
                    let mut solver = solver(&case.grid, case.nu);
                    let (report, solution) = run(&mut solver, &case.bound, &friction, 1e-6);
                    let none = vec![[0.0; 2]; case.grid.len()];
                    let (place, found) = ((&case.grid, case.nu), (&report, &solution));
                    let slip_residual = residual(place, &case.bound, &friction, &none, found);
                    // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
                    assert!(slip_residual <= 1.001e-6, "{seed} {motion:?} {step} {forces}: {slip_residual}");
                    most = most.max(report.products);
                    if motion == Motion::SteadyRolling {
                        continue;
                    }
                    // The next step continues from these tractions, with 80 % of the forces.
                    let prescribed = friction.prescribed.map(|prescribed| match prescribed {
                        Prescribed::Force(force) => Prescribed::Force(0.8 * force),
                        given => given,
                    });
                    let (previous, spin) = (Previous::Kept, 0.5 * friction.spin);
                    let next = Friction { previous, spin, prescribed, ..friction };
                    let (report, after) = run(&mut solver, &case.bound, &next, 1e-6);
                    let slip_residual = residual(place, &case.bound, &next, &solution.traction, (&report, &after));
                    assert!(
                        slip_residual <= 1.001e-6,
                        "{seed} {motion:?} {step} {forces}, the next step: {slip_residual}"
                    );
                }
            }
        }
    }
    // Without a layer the same cases take up to 60 products.
    assert!(most <= 80.0, "{most} products");
}

#[test]
fn one_compliance_for_each_element_is_the_uniform_one() {
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        let case = Ellipse::random(3, 20, false);
        let same = vec![0.3; case.grid.len()];
        let solved = |compliance: Coefficient<'_>| {
            let friction = Friction { motion, compliance, ..case.friction };
            run(&mut solver(&case.grid, case.nu), &case.bound, &friction, 1e-10).1
        };
        let (uniform, each) = (solved(Coefficient::Uniform(0.3)), solved(Coefficient::PerElement(&same)));
        let largest = case.bound.iter().fold(0.0f64, |most, g| most.max(*g));
        for (a, b) in uniform.traction.iter().zip(&each.traction) {
            assert!((0..2).all(|k| (a[k] - b[k]).abs() <= 1e-8 * largest), "{motion:?} {a:?} {b:?}");
        }
    }
}

/// Compliances from 1 to 100 times `least`, in random order.
fn random_compliances(n: usize, least: f64, seed: u64) -> Vec<f64> {
    let mut random = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let next = |_| {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        least * 100f64.powf((random >> 11) as f64 / (1u64 << 53) as f64)
    };
    (0..n).map(next).collect()
}

#[test]
fn compliances_that_differ_by_a_hundred_times_take_few_products() {
    let (mut of_both, mut most) = ([0.0; 2], [0.0f64; 2]);
    let mut of_motion = [[0.0; 2]; 3];
    for seed in 0..100u64 {
        let motion = [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling][seed as usize % 3];
        let case = Ellipse::random(seed, 6 + seed as usize % 7, seed % 2 == 1);
        let own = solver(&case.grid, case.nu).tangential().at(0.0, 0.0)[0];
        let each = random_compliances(case.grid.len(), [0.01, 0.1, 1.0, 10.0][seed as usize % 4] * own, seed + 1);
        let mean = each.iter().sum::<f64>() / each.len() as f64;
        for (k, compliance) in [Coefficient::Uniform(mean), Coefficient::PerElement(&each)].into_iter().enumerate() {
            let friction = Friction { motion, compliance, ..case.friction };
            let (report, solution) = run(&mut solver(&case.grid, case.nu), &case.bound, &friction, 1e-6);
            let none = vec![[0.0; 2]; case.grid.len()];
            let slip_residual = residual((&case.grid, case.nu), &case.bound, &friction, &none, (&report, &solution));
            // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
            assert!(slip_residual <= 1.001e-6, "{seed} {motion:?}: {slip_residual}");
            of_both[k] += report.products;
            of_motion[seed as usize % 3][k] += report.products;
            most[k] = most[k].max(report.products);
        }
    }
    assert!(of_both[1] <= 2.0 * of_both[0], "{of_both:?} products, at most {most:?}, {of_motion:?}");
}

/// In a step of small creepage the tractions hardly change, so that the previous ones are large relative to the change. The residual must still be in
/// the units in which the tolerance is given.
#[test]
fn nearly_free_steps_beside_a_soft_layer_meet_the_tolerance() {
    for seed in 0..4 {
        let case = Ellipse::random(seed, 16, false);
        let own = solver(&case.grid, case.nu).tangential().at(0.0, 0.0)[0];
        for softer in [1e-3, 1.0, 1e3, 1e6] {
            let compliance = Coefficient::Uniform(softer * own);
            let motion = Motion::TransientRolling;
            let friction = Friction { motion, rolling_distance: case.grid.dx, compliance, ..case.friction };
            let mut solver = solver(&case.grid, case.nu);
            run(&mut solver, &case.bound, &friction, 1e-8);
            let traction = &solver.solution().expect("a solution").traction;
            let [x, y] = [0, 1].map(|k| traction.iter().map(|q| q[k]).collect::<Vec<f64>>());
            let previous = Previous::Given([&x, &y]);
            for creepage in [0.0, 1e-6, 1e-2] {
                let prescribed = [Prescribed::Creepage(-creepage * softer * own), Prescribed::Creepage(0.0)];
                for tolerance in [1e-2, 1e-4] {
                    run(&mut solver, &case.bound, &Friction { prescribed, spin: 0.0, previous, ..friction }, tolerance);
                }
            }
        }
    }
}
