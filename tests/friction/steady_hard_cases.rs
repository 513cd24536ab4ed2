//! Hard cases of steady rolling: extreme creepages and forces, gaps in the contact, a single row, many patches, and cancellation at any callback.

use std::f64::consts::PI;

use contact_normal::friction::Request;
use contact_normal::grid::Grid;
use contact_normal::scene::{Coefficient, Friction, Motion, Prescribed, Previous};
use contact_normal::solver::Outcome;

use super::conditions::disc;
use super::dense;
use super::steady::rolling;
use super::steady_scenes::{ellipse, NU};
use super::support::{residual, run, solver, tangential};

fn with_forces(parts: [f64; 2], spin: f64, g: &[f64], grid: &Grid) -> Friction<'static> {
    let carried = g.iter().sum::<f64>() * grid.element_area();
    Friction { prescribed: parts.map(|part| Prescribed::Force(part * carried)), ..rolling([0.0; 2], spin) }
}

#[test]
fn any_force_below_mu_n_is_reached_whatever_the_spin() {
    let (grid, g) = ellipse(1.0, 28);
    let carried = g.iter().sum::<f64>() * grid.element_area();
    for spin in [0.0, 1.5, 20.0] {
        for part in [0.0, 0.9, 0.99, 0.999, 0.99999] {
            let friction = with_forces([-0.8 * part, 0.6 * part], spin, &g, &grid);
            let found = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
            let slip_residual = residual((&grid, NU), &g, &friction, &[], (&found.0, &found.1));
            assert!(slip_residual <= 1.001e-6 || (part, spin) == (0.0, 0.0), "{spin} {part}: {slip_residual}");
            let apart = (found.0.force[0] + 0.8 * part * carried).hypot(found.0.force[1] - 0.6 * part * carried);
            assert!(apart <= 1e-6 * carried, "{spin} {part}: {:?}", found.0.force);
        }
        let all = with_forces([-1.0, 0.0], spin, &g, &grid);
        let request = Request { limit: 100, ..Request::new(&g, &all, 1e-6) };
        let refused = solver(&grid, NU).solve(&request, &mut |_, _| true).unwrap_err();
        assert!(refused.to_string().contains("it must be less than"), "{refused}");
    }
}

/// Creepages, spins and forces from 1e-12 to full slip and beyond, with names.
fn extremes(grid: &Grid, g: &[f64]) -> [(&'static str, Friction<'static>); 12] {
    [
        ("partial slip", rolling([-0.3, 0.2], 0.2)),
        ("creepages of 1e-12", rolling([1e-12, 0.0], 0.0)),
        ("creepages of 1e3", rolling([-1e3, 1e3], 0.0)),
        ("spin alone", rolling([0.0; 2], 0.7)),
        ("spin of 1e-12", rolling([0.0; 2], 1e-12)),
        ("spin of 1e3", rolling([0.0; 2], 1e3)),
        ("against the spin", rolling([0.5, -0.5], -1.0)),
        ("hardly any friction", Friction { coefficient: Coefficient::Uniform(1e-9), ..rolling([-0.3, 0.2], 0.1) }),
        ("mu 1e9", Friction { coefficient: Coefficient::Uniform(1e9), ..rolling([-0.3, 0.2], 0.1) }),
        ("forces", with_forces([0.6, -0.3], 0.1, g, grid)),
        ("small forces", with_forces([1e-4, 0.0], 0.0, g, grid)),
        (
            "one force",
            Friction {
                prescribed: [Prescribed::Creepage(0.1), with_forces([0.0, 0.5], 0.0, g, grid).prescribed[1]],
                ..rolling([0.0; 2], 0.2)
            },
        ),
    ]
}

#[test]
fn hard_cases_of_steady_rolling_have_their_answers() {
    let rough = |x: usize, y: usize| ((13 * x + 7 * y) % 17) < 9 || (x / 4 + y / 5) % 2 == 0;
    let shapes: [(&str, (Grid, Vec<f64>)); 8] = [
        ("a ball", disc(24, |_, _| true)),
        ("one element", disc(24, |x, y| (x, y) == (9, 9))),
        ("two far apart", disc(40, |x, y| (x, y) == (8, 8) || (x, y) == (31, 30))),
        ("a row", disc(24, |_, y| y == 10)),
        ("a column", disc(24, |x, _| x == 10)),
        ("gaps inside rows", disc(24, |x, y| (x + 2 * y) % 3 != 0)),
        ("many patches", disc(30, |x, y| x % 5 != 0 && y % 4 != 0)),
        ("rough", disc(30, rough)),
    ];
    for (name, (grid, g)) in &shapes {
        let in_contact = g.iter().filter(|g| **g > 0.0).count();
        for (what, friction) in extremes(grid, g) {
            let directions =
                if *name == "a ball" { &[0.0, 180.0_f64, 90.0, 270.0, 37.0][..] } else { &[0.0, 37.0][..] };
            for &direction in directions {
                let friction = Friction { rolling_direction: direction.to_radians(), ..friction };
                let (report, solution) = run(&mut solver(grid, NU), g, &friction, 1e-6);
                let slip_residual = residual((grid, NU), g, &friction, &[], (&report, &solution));
                assert!(slip_residual <= 1.001e-6, "{name}, {what}, {direction}: {slip_residual}");
                assert_eq!(
                    report.certificate.stick_count + report.certificate.slip_count,
                    in_contact,
                    "{name}, {what}"
                );
                match what {
                    "mu 1e9" => assert_eq!(report.certificate.slip_count, 0, "{name}"),
                    "creepages of 1e3" | "hardly any friction" => {
                        assert_eq!(report.certificate.stick_count, 0, "{name}, {what}");
                    }
                    _ => {}
                }
            }
        }
        // Free rolling: without creepage or force there are no tractions.
        for friction in [rolling([0.0; 2], 0.0), with_forces([0.0; 2], 0.0, g, grid)] {
            let (report, solution) = run(&mut solver(grid, NU), g, &friction, 1e-6);
            assert!(solution.traction.iter().all(|q| *q == [0.0; 2]) && report.creepage == [0.0; 2], "{name}");
        }
    }
}

/// A creepage and a force are given. The slip by the creepage is smaller by many orders than the slip by the force.
#[test]
fn a_force_beside_a_creepage_of_another_order_is_met() {
    let (grid, g) = disc(12, |_, _| true);
    let carried = g.iter().sum::<f64>() * grid.element_area();
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        for creepage in [1e-6, 1e-11, 1e-20] {
            for part in [2e-3, 0.5, 0.9] {
                let prescribed = [Prescribed::Creepage(-creepage), Prescribed::Force(part * carried)];
                let friction = Friction { motion, prescribed, ..Friction::new(1.0) };
                let (report, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
                let slip_residual =
                    residual((&grid, NU), &g, &friction, &vec![[0.0; 2]; grid.len()], (&report, &solution));
                assert!(slip_residual <= 1.001e-6, "{motion:?}, {creepage}, {part}: {slip_residual}");
                assert!((report.force[1] - part * carried).abs() <= 1e-6 * carried, "{motion:?}, {creepage}, {part}");
            }
        }
    }
}

/// On a single element, a step along x does not couple the directions. The slip in x is that of the given creepage, however large the trial creepages
/// in y are in the search for the given force.
#[test]
fn a_given_creepage_is_as_it_is_beside_a_force() {
    let (grid, g) = disc(24, |x, y| (x, y) == (9, 9));
    let (bound, k) = (g[9 * 24 + 9], 9 * 24 + 9);
    for (creepage, part) in [(1e-13, 0.0), (1e-15, 0.5), (-1e-17, -0.2)] {
        let prescribed = [Prescribed::Creepage(creepage), Prescribed::Force(part * bound * grid.element_area())];
        for before in [[0.3, 0.2], [-0.1, 0.6]] {
            let [x, y] = before.map(|part| vec![part * bound; grid.len()]);
            let friction = Friction { prescribed, previous: Previous::Given([&x, &y]), ..rolling([0.0; 2], 0.0) };
            let (_, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-3);
            let (mut here, mut ahead) = (vec![[0.0; 2]; grid.len()], vec![[0.0; 2]; grid.len()]);
            dense::apply(&tangential(&grid, NU), &grid, (0.0, 0.0), &solution.traction, &mut here);
            dense::apply(&tangential(&grid, NU), &grid, (1.0, 0.0), &solution.traction, &mut ahead);
            let rigid = friction.distance(&grid) * creepage;
            let (displaced, slip) = (here[k][0] - ahead[k][0], solution.slip[k][0]);
            // The displacements are sums of one term, so that the only difference is round-off.
            let apart = (slip - (rigid + displaced)).abs();
            assert!(
                apart <= 1e-14 * rigid.abs().max(displaced.abs()),
                "{creepage:e}: {slip:e}, {rigid:e} + {displaced:e}"
            );
        }
    }
}

/// Elements are four times as long as wide, and a step is a quarter of an element. The preconditioner is then far from the operator, which is hardly
/// positive definite at the first Poisson ratio and indefinite at the second.
#[test]
fn short_steps_on_long_elements_are_solved() {
    for (nu, creepage) in [(0.2, [3e-2, -2e-2]), (0.3, [3e-2, -2e-2]), (0.2, [0.2, 0.1])] {
        let grid = Grid::new(13, 10, 3.0 / 13.0, 1.0).unwrap();
        let g: Vec<f64> = (0..grid.len())
            .map(|i| {
                let (x, y) = ((i % 13) as f64 / 6.5 - 12.0 / 13.0, (i / 13) as f64 / 5.0 - 0.9);
                (1.1 - x * x - y * y).max(0.0).sqrt()
            })
            .collect();
        let (rolling_distance, rolling_direction) = (0.25, PI / 2.0);
        let friction = Friction { rolling_distance, rolling_direction, ..rolling(creepage, 0.0) };
        // One of the cases takes more than the 1000 products that are allowed by default.
        let request = Request { limit: 20_000, ..Request::new(&g, &friction, 1e-6) };
        let mut solver = solver(&grid, nu);
        let (end, report) = solver.solve(&request, &mut |_, _| true).unwrap();
        assert_eq!(end, Outcome::Converged, "{nu} {creepage:?} {report:?}");
        let found = (report, solver.solution().unwrap().clone());
        let slip_residual = residual((&grid, nu), &g, &friction, &[], (&found.0, &found.1));
        assert!(slip_residual <= 1.001e-6, "{nu} {creepage:?}: {slip_residual}");
    }
}

#[test]
fn one_element_rolls_in_any_direction_with_any_creepage() {
    // If the element slips, a Newton step has one unknown. The first search direction solves for it to round-off, and there must be no further
    // direction.
    let grid = Grid::new(1, 1, 7e-4, 7e-4).unwrap();
    for (nu, g) in [(0.0, 3.1e-6), (0.1, 3.1e-6), (0.28, 3e-4), (0.47, 3.1e-6)] {
        for k in 0..200 {
            let angle = 0.5 * PI * f64::from(k % 4);
            let (xi, eta) = (2e-5 * (0.7 * f64::from(k)).cos(), 2e-5 * (0.7 * f64::from(k)).sin());
            let step = Friction { rolling_direction: angle, ..rolling([xi, eta], 1e-3) };
            let (report, found) = run(&mut solver(&grid, nu), &[g], &step, 1e-6);
            let slip_residual = residual((&grid, nu), &[g], &step, &[], (&report, &found));
            assert!(slip_residual <= 1.001e-6, "{nu} {k}: {slip_residual} {:?}", found.traction);
        }
    }
}

#[test]
fn any_start_leads_to_the_same_solution() {
    let (grid, g) = disc(24, |_, _| true);
    let friction = rolling([-0.4, 0.1], 0.3);
    let (_, expected) = run(&mut solver(&grid, NU), &g, &friction, 1e-9);
    let n = grid.len();
    let wild = |k: usize| (0..n).map(|i| 1e3 * ((7919 * i * k) as f64 % 13.0 - 6.0)).collect::<Vec<f64>>();
    let opposite = |k: usize| expected.traction.iter().map(|q| -q[k]).collect::<Vec<f64>>();
    for [x, y] in [[wild(1), wild(3)], [opposite(0), opposite(1)], [vec![1e300; n], vec![-1e-300; n]]] {
        let from = Friction { previous: Previous::Given([&x, &y]), ..friction };
        let (_, found) = run(&mut solver(&grid, NU), &g, &from, 1e-9);
        let apart = found.traction.iter().zip(&expected.traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        // Both solves have a residual of 1e-9, which is about the relative error of q (docs/friction.md) in the rms; a single element may have a much
        // larger error.
        assert!(apart.fold(0.0, f64::max) <= 1e-7);
    }
}

#[test]
fn steady_rolling_cancelled_at_any_callback_leaves_feasible_tractions() {
    let (grid, g) = ellipse(1.0, 40);
    for friction in [rolling([-0.4, 0.1], 0.3), with_forces([0.6, 0.2], 0.3, &g, &grid)] {
        assert_eq!(friction.motion, Motion::SteadyRolling);
        let request = Request::new(&g, &friction, 1e-8);
        let mut calls = 0;
        for cancel in 0.. {
            let mut solver = solver(&grid, NU);
            calls = 0;
            let (end, report) = solver
                .solve(&request, &mut |_, _| {
                    calls += 1;
                    calls <= cancel
                })
                .unwrap();
            let solution = solver.solution().unwrap();
            assert!(solution.traction.iter().zip(&g).all(|(q, g)| q[0].hypot(q[1]) <= *g), "{cancel}");
            let slip_residual = residual((&grid, NU), &g, &friction, &[], (&report, solution));
            assert!(
                (slip_residual - report.certificate.residual).abs() <= 1e-9 * (1.0 + slip_residual),
                "{cancel}: {slip_residual} {report:?}"
            );
            if end == Outcome::Converged {
                break;
            }
            assert_eq!((end, calls), (Outcome::Cancelled, cancel + 1));
        }
        assert!(calls > 10);
    }
}
