//! Derivatives of the forces by creepages and spin, compared with differences; and a series of scenes, each of which starts from the last solution.

use contact_normal::grid::Grid;
use contact_normal::scene::{Coefficient, Friction, Motion, Prescribed, Previous};

use super::steady::rolling;
use super::steady_scenes::{ellipse, NU};
use super::support::{run, solver, tangential};

#[test]
fn derivatives_are_those_of_differences() {
    let (grid, g) = ellipse(0.7, 40);
    for motion in [Motion::SteadyRolling, Motion::TransientRolling, Motion::Shift] {
        for (creepage, spin) in [([-0.02, 0.01], 0.0), ([-0.3, 0.2], 0.1), ([-0.8, 0.3], 0.6), ([0.0; 2], 2.0)] {
            let scale = if motion == Motion::TransientRolling { 5.0 } else { 1.0 };
            let at = |change: [f64; 3]| {
                let friction = Friction {
                    motion,
                    ..rolling(
                        [creepage[0] * scale + change[0], creepage[1] * scale + change[1]],
                        spin * scale + change[2],
                    )
                };
                let (report, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-10);
                [report.force[0], report.force[1], report.moment]
            };
            let friction = Friction {
                motion,
                sensitivities: true,
                ..rolling([creepage[0] * scale, creepage[1] * scale], spin * scale)
            };
            let (report, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-8);
            let found = report.sensitivities.unwrap();
            let largest = found.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            // The step of the difference is so small that hardly any element changes between stick and slip.
            let step = 1e-5;
            for by in 0..3 {
                let mut change = [0.0; 3];
                change[by] = step;
                let (up, down) = (at(change), at(change.map(|c| -c)));
                for k in 0..3 {
                    let difference = (up[k] - down[k]) / (2.0 * step);
                    // An element that changes between stick and slip changes a derivative by about 1e-3 of the largest.
                    assert!(
                        (found[k][by] - difference).abs() <= 3e-3 * largest,
                        "{motion:?} {creepage:?} {spin}: {k} by {by}: {} {difference} of {largest}",
                        found[k][by]
                    );
                }
            }
        }
    }
}

/// Derivatives are 0, not 0/0, for a coefficient of friction of 0, and for the spin about the centre of a single element.
#[test]
fn what_carries_nothing_or_moves_nothing_has_derivatives_of_zero() {
    let (disc, g) = ellipse(1.0, 16);
    let one = Grid::new(1, 1, 0.5, 0.5).unwrap();
    let own = tangential(&one, NU).at(0.0, 0.0);
    let ahead = tangential(&one, NU).at(1.0, 0.0);
    for motion in [Motion::SteadyRolling, Motion::TransientRolling, Motion::Shift] {
        let friction = Friction { motion, sensitivities: true, ..rolling([-1e-3, 1e-3], 0.0) };
        let without = Friction { coefficient: Coefficient::Uniform(0.0), ..friction };
        let (report, _) = run(&mut solver(&disc, NU), &g, &without, 1e-8);
        assert_eq!(report.sensitivities, Some([[0.0; 3]; 3]), "{motion:?}");
        // The element sticks: dq = -dw/A, with its influence A on itself. Without a spin offset the spin causes no slip at its centre.
        let centred = Friction { spin_offset: 0.0, ..friction };
        let (report, _) = run(&mut solver(&one, NU), &[1.0], &centred, 1e-8);
        let found = report.sensitivities.unwrap();
        for k in 0..3 {
            for by in 0..3 {
                let expected = match (k == by && k < 2, motion) {
                    (false, _) => 0.0,
                    (_, Motion::Shift) => -0.25 / own[k],
                    (_, Motion::TransientRolling) => -0.25 * 0.5 / own[k],
                    (_, Motion::SteadyRolling) => -0.25 * 0.5 / (own[k] - ahead[k]),
                };
                // The linear systems of derivatives are solved to 1e-5.
                assert!((found[k][by] - expected).abs() <= 1e-5 * expected.abs(), "{motion:?}: {found:?}");
            }
        }
    }
}

#[test]
fn a_series_goes_on_from_the_last_solution() {
    let (grid, g) = ellipse(1.0, 64);
    let carried = g.iter().sum::<f64>() * grid.element_area();
    for forces in [false, true] {
        let (mut warm, mut products, mut cold) = (solver(&grid, NU), 0.0, 0.0);
        for k in 0..12 {
            let part = 0.3 + 0.005 * f64::from(k);
            let prescribed = match forces {
                true => [Prescribed::Force(part * carried), Prescribed::Force(0.1 * carried)],
                false => [Prescribed::Creepage(-part), Prescribed::Creepage(0.1)],
            };
            let friction = Friction { prescribed, ..rolling([0.0; 2], 0.2) };
            let previous = if k == 0 { Previous::None } else { Previous::Kept };
            let (a, _) = run(&mut warm, &g, &Friction { previous, ..friction }, 1e-6);
            let (b, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
            (products, cold) = (products + a.products, cold + b.products);
            for i in 0..2 {
                // The tolerances are twice the errors that this residual leaves (docs/friction.md).
                assert!((a.force[i] - b.force[i]).abs() <= 1e-6 * carried, "{k}: {:?} {:?}", a.force, b.force);
                assert!((a.creepage[i] - b.creepage[i]).abs() <= 1e-5, "{k}: {:?} {:?}", a.creepage, b.creepage);
            }
        }
        // The last solution is a better start than that of nested iteration, and saves the products on coarse grids.
        assert!(products < 0.9 * cold, "{products} {cold}");
    }
}
