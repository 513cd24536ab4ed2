//! Friction bounds that no traction reaches, on all elements or on some: glued surfaces.

use contact_normal::friction::{Report, Request, Start, SLIP};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coefficient, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};

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

/// Elements with a huge bound stick, and carry far less than it. Elements with ordinary bounds beside them keep these bounds.
#[test]
fn glued_elements_beside_ordinary_ones_leave_no_slip() {
    let mut slipping = 0;
    for large in [1e9, 2.8e16, 9e16, 1e17, 1e40, 1e100] {
        for motion in MOTIONS {
            for prescribed in [
                [Prescribed::Creepage(-0.5), Prescribed::Creepage(0.1)],
                [Prescribed::Force(5.0), Prescribed::Creepage(0.0)],
            ] {
                let (grid, g) = pressures(12, |i| if i % 12 < 6 { large } else { 1.0 });
                let friction = Friction { motion, prescribed, ..Friction::new(0.1) };
                let (report, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-7);
                let slip_residual =
                    residual((&grid, NU), &g, &friction, &vec![[0.0; 2]; g.len()], (&report, &solution));
                // Ten times the tolerance: 9e-7 allow for the round-off of the test's sums of 144 terms.
                assert!(slip_residual <= 1e-6, "{large:e} {motion:?} {prescribed:?}: {slip_residual:e}");
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

/// A force far below mu N is met to the tolerance times the force itself, not times mu N.
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

/// The creepage of an initial guess is no motion that the caller prescribes. So a guess of 1e-70 must not be refused as a motion that is too small.
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

/// Forces are sums of weights times tractions. With small weights tractions are larger by the inverse of the weights.
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

/// Steady rolling has one solution, whatever the previous tractions. Large previous tractions must not raise the limit above which the library drops
/// the bounds of elements.
#[test]
fn tractions_before_steady_rolling_do_not_raise_the_reach_of_glued_elements() {
    let (grid, g) = pressures(12, |i| if i % 12 < 6 { 1.0 } else { 1e20 });
    let prescribed = [Prescribed::Force(0.5), Prescribed::Creepage(0.0)];
    let friction = Friction { motion: Motion::SteadyRolling, prescribed, ..Friction::new(0.3) };
    let (expected, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-8);
    for size in [1.0, 1e12, 1e18, 1e21] {
        let before = vec![size; g.len()];
        let friction = Friction { previous: Previous::Given([&before, &before]), ..friction };
        let (report, _) = run(&mut solver(&grid, NU), &g, &friction, 1e-8);
        let off = (report.creepage[0] - expected.creepage[0]).abs();
        assert!(off <= 1e-6 * expected.creepage[0].abs(), "{size:e}: {:?} {:?}", report.creepage, expected.creepage);
    }
}

/// The library drops bounds that no traction reaches. Without any motion all elements stick, with a dropped bound or without.
#[test]
fn elements_without_bound_beside_glued_ones_rest_where_nothing_moves() {
    let (grid, g) = pressures(12, |i| if i % 12 < 6 { 1.0 } else { 1e20 });
    let (_, solution) = run(&mut solver(&grid, NU), &g, &Friction::new(0.3), 1e-6);
    assert!(solution.stick_slip.iter().all(|state| *state != SLIP));
}

/// The report of a shift by 0.001 of a ball with a contact radius of 1, on m x m elements.
fn shifted_ball(m: usize, coefficient: impl Fn(f64) -> f64) -> Report {
    let d = 2.4 / m as f64;
    let grid = Grid::new(m, m, d, d).expect("a grid");
    let place = |k: usize| (k as f64 + 0.5) * d - 1.2;
    let h: Vec<f64> = (0..m * m).map(|i| (place(i % m).powi(2) + place(i / m).powi(2)) / 200.0).collect();
    let mu: Vec<f64> = (0..m * m).map(|i| coefficient(place(i % m))).collect();
    let prescribed = [Prescribed::Creepage(-1e-3), Prescribed::Creepage(0.0)];
    let friction = Friction { coefficient: Coefficient::PerElement(&mu), prescribed, ..Friction::new(0.3) };
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.0178)) };
    let options = Options { estimates: true, tolerance: 1e-7, ..Options::default() };
    let (_, outcome, report) = solve(&scene, &options).expect("a solvable scene");
    assert_eq!(outcome, Outcome::Converged);
    report.friction.expect("friction")
}

/// The estimated error is smaller than the force, also if no traction reaches mu p.
#[test]
fn the_error_of_glued_elements_is_a_part_of_the_force() {
    let of: [&dyn Fn(f64) -> f64; 4] =
        [&|_| 1e3, &|_| 1e9, &|x| if x > 0.0 { 1e9 } else { 0.3 }, &|x| if x > 0.0 { 0.01 } else { 1e9 }];
    for (k, of) in of.into_iter().enumerate() {
        let (found, finer) = (shifted_ball(24, of), shifted_ball(96, of));
        let (error, off) = (found.error[0].expect("an estimate"), (found.force[0] - finer.force[0]).abs());
        println!("{k}: {:e} {error:e} {off:e}", found.force[0]);
        assert!(error >= off && error <= 0.5 * found.force[0], "{k}: {found:?}");
    }
}
