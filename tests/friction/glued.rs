//! Bounds that no traction reaches, on all elements or beside ordinary ones: as glued surfaces have them.

use contact_normal::friction::{Request, Start, SLIP};
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed};
use contact_normal::solver::Outcome;

use crate::support::{residual, run, solver};

const MOTIONS: [Motion; 3] = [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling];
const NU: f64 = 0.3;

/// Pressures of a ball on m x m elements of side 1, times a factor for each element.
fn pressures(m: usize, factor: impl Fn(usize) -> f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(m, m, 1.0, 1.0).expect("a grid");
    let off = |k: usize| (k as f64 + 0.5) / (0.5 * m as f64) - 1.0;
    let of = |i: usize| factor(i) * (1.0 - off(i % m).powi(2) - off(i / m).powi(2)).max(0.0).sqrt();
    (grid, (0..m * m).map(of).collect())
}

/// Elements that stick carry far less than such a bound. With bounds below 1e-17 of it taken for 0 forces were three times too large.
#[test]
fn glued_elements_beside_ordinary_ones_leave_no_slip() {
    let mut slipping = 0;
    for large in [1e9, 1e17, 1e40, 1e100] {
        for motion in MOTIONS {
            for prescribed in [
                [Prescribed::Creepage(-0.5), Prescribed::Creepage(0.1)],
                [Prescribed::Force(5.0), Prescribed::Creepage(0.0)],
            ] {
                let (grid, g) = pressures(12, |i| if i % 12 < 6 { large } else { 1.0 });
                let friction = Friction { motion, prescribed, ..Friction::new(0.1) };
                let (report, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-7);
                let left = residual((&grid, NU), &g, &friction, &vec![[0.0; 2]; g.len()], (&report, &solution));
                // Ten times the tolerance: the round-off of sums of 144 terms.
                assert!(left <= 1e-6, "{large:e} {motion:?} {prescribed:?}: {left:e}");
                if let Prescribed::Force(force) = prescribed[0] {
                    assert!(
                        (report.force[0] - force).abs() <= 1e-6 * force,
                        "{large:e} {motion:?}: {:?}",
                        report.force
                    );
                }
                slipping += solution.stick_slip.iter().filter(|state| **state == SLIP).count();
            }
        }
    }
    assert!(slipping > 100, "{slipping}");
}

/// A force far below mu N was met by no force at all, to the tolerance relative to mu N.
#[test]
fn a_small_force_is_carried_where_nothing_slips() {
    for m in [1, 2, 8, 20, 26] {
        for large in [1.0, 1e7] {
            for motion in MOTIONS {
                let (grid, g) = pressures(m, |_| large);
                let carried: f64 = 0.3 * g.iter().sum::<f64>();
                for force in [1e-9 * carried, 1e-14 * carried, 1e-24 * carried] {
                    let prescribed = [Prescribed::Force(force), Prescribed::Force(-0.5 * force)];
                    let friction = Friction { motion, prescribed, ..Friction::new(0.3) };
                    for start in [Start::Before, Start::Given([&vec![0.0; g.len()], &vec![0.0; g.len()]])] {
                        let mut solver = solver(&grid, NU);
                        let request = Request { start, ..Request::new(&g, &friction, 1e-6) };
                        let (outcome, report) = solver.solve(&request, &mut |_, _| true).expect("a solution");
                        assert_eq!(outcome, Outcome::Converged);
                        let off = (report.force[0] - force).hypot(report.force[1] + 0.5 * force);
                        assert!(off <= 1e-6 * force, "{m} {large:e} {motion:?}: {:?} for {force:e}", report.force);
                        assert!(report.products < 100.0, "{m} {large:e} {motion:?}: {} products", report.products);
                        assert!(report.creepage[0] * force < 0.0, "{m} {large:e} {motion:?}: {:?}", report.creepage);
                    }
                }
            }
        }
    }
}

/// The creepage of a start is no motion of the caller's: tractions of 1e-70 were refused as a motion that is too small.
#[test]
fn a_start_of_tiny_tractions_is_no_motion() {
    let (grid, g) = pressures(9, |_| 1.0);
    for motion in MOTIONS {
        let friction =
            Friction { motion, prescribed: [Prescribed::Force(0.01), Prescribed::Creepage(0.0)], ..Friction::new(0.3) };
        let (expected, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-9);
        for size in [1e-55, 1e-62, 1e-70, 1e-300] {
            let q = vec![size; g.len()];
            let request = Request { start: Start::Given([&q, &q]), ..Request::new(&g, &friction, 1e-9) };
            let (outcome, report) = solver(&grid, NU).solve(&request, &mut |_, _| true).expect("a solution");
            assert_eq!(outcome, Outcome::Converged, "{size:e}");
            let off = (report.creepage[0] - expected.creepage[0]).abs();
            assert!(
                off <= 1e-6 * expected.creepage[0].abs(),
                "{size:e}: {:?} {:?}",
                report.creepage,
                expected.creepage
            );
        }
    }
}

/// Forces are sums of weighted tractions: with small weights tractions are as much larger.
#[test]
fn weights_do_not_lower_the_reach_of_glued_elements() {
    for weight in [1e-2, 1e-6, 1e-8] {
        let (grid, g) = pressures(12, |i| if i % 12 < 6 { 1e20 } else { 1.0 });
        let weights = vec![weight; g.len()];
        let friction = Friction {
            prescribed: [Prescribed::Force(1.0), Prescribed::Creepage(0.0)],
            weights: Some([&weights, &weights]),
            ..Friction::new(0.3)
        };
        let (_, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
        let force: f64 = solution.traction.iter().map(|q| weight * q[0]).sum();
        assert!((force - 1.0).abs() <= 1e-5, "{weight:e}: {force}");
    }
}
