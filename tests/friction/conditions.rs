//! The conditions of friction, recomputed by direct sums, for random ellipses with creepages and with forces. Hard cases with known answers. Forces
//! and slips that are refused.

use contact_normal::error::Error;
use contact_normal::friction::Request;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::dense;
use super::scenes::Ellipse;
use super::support::{residual, run, solver, tangential};

#[test]
fn random_motions_and_forces_meet_the_conditions() {
    for seed in 0..40 {
        for forces in [false, true] {
            let case = Ellipse::random(seed, 24, forces);
            let mut solver = solver(&case.grid, case.nu);
            let (report, solution) = run(&mut solver, &case.bound, &case.friction, 1e-6);
            let none = vec![[0.0; 2]; case.grid.len()];
            let found = (&report, &solution);
            let slip_residual = residual((&case.grid, case.nu), &case.bound, &case.friction, &none, found);
            // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
            assert!(
                slip_residual <= 1.001e-6,
                "{seed} {forces}: {slip_residual}, reported {}",
                report.certificate.residual
            );
            assert!((slip_residual - report.certificate.residual).abs() <= 1e-10);
            let carried = case.bound.iter().sum::<f64>() * case.grid.element_area();
            for k in 0..2 {
                let sum: f64 = solution.traction.iter().map(|q| q[k]).sum::<f64>() * case.grid.element_area();
                assert!((sum - report.force[k]).abs() <= 1e-12 * carried);
                if let Prescribed::Force(force) = case.friction.prescribed[k] {
                    assert!((sum - force).abs() <= 1e-6 * carried, "{seed}: {sum} {force}");
                }
            }
        }
    }
}

/// The pressures of a ball on m x m elements. Those of elements that are not `inside` are 0.
pub fn disc(m: usize, inside: impl Fn(usize, usize) -> bool) -> (Grid, Vec<f64>) {
    let grid = Grid::new(m, m, 2.2 / m as f64, 2.2 / m as f64).unwrap();
    let centre = 0.5 * (m as f64 - 1.0);
    let g = (0..grid.len())
        .map(|i| {
            let (x, y) = (((i % m) as f64 - centre) * grid.dx, ((i / m) as f64 - centre) * grid.dy);
            if inside(i % m, i / m) {
                (1.0 - x * x - y * y).max(0.0).sqrt()
            } else {
                0.0
            }
        })
        .collect();
    (grid, g)
}

#[test]
fn the_gap_bounds_the_error_of_loose_tractions() {
    for seed in 0..20 {
        let case = Ellipse::random(seed, 24, false);
        let solved = |tolerance: f64| run(&mut solver(&case.grid, case.nu), &case.bound, &case.friction, tolerance);
        let ((report, loose), (_, tight)) = (solved(3e-2), solved(1e-10));
        let n = case.grid.len();
        let difference: Vec<[f64; 2]> =
            loose.traction.iter().zip(&tight.traction).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect();
        let mut u = vec![[0.0; 2]; n];
        dense::apply(&tangential(&case.grid, case.nu), &case.grid, (0.0, 0.0), &difference, &mut u);
        let energy: f64 = difference.iter().zip(&u).map(|(q, u)| q[0] * u[0] + q[1] * u[1]).sum();
        let rigid = (0..n).map(|i| case.friction.rigid_slip_at(&case.grid, i));
        let work: f64 = case.bound.iter().zip(rigid).map(|(g, w)| g * w[0].hypot(w[1])).sum();
        let numerator = report.certificate.gap * work;
        // The tight solution stands for the exact one. Its own error is 1e-8 of the numerator.
        assert!(energy <= 1.000001 * numerator, "{seed}: {energy:e} {numerator:e}");
    }
}

#[test]
fn hard_cases_have_their_answers() {
    let shapes: [(&str, (Grid, Vec<f64>)); 6] = [
        ("a ball", disc(20, |_, _| true)),
        ("one element", disc(20, |x, y| (x, y) == (9, 9))),
        ("two far apart", disc(40, |x, y| (x, y) == (8, 8) || (x, y) == (31, 30))),
        ("a row", disc(20, |_, y| y == 10)),
        ("a column", disc(20, |x, _| x == 10)),
        ("gaps", disc(20, |x, y| (x + 2 * y) % 3 != 0)),
    ];
    let given = |x: f64, y: f64| [Prescribed::Creepage(x), Prescribed::Creepage(y)];
    for (name, (grid, g)) in &shapes {
        let none = vec![[0.0; 2]; grid.len()];
        let in_contact = g.iter().filter(|g| **g > 0.0).count();
        for (what, friction) in [
            ("partial slip", Friction { prescribed: given(-0.3, 0.2), spin: 0.2, ..Friction::new(1.0) }),
            ("tiny", Friction { prescribed: given(1e-12, 0.0), ..Friction::new(1.0) }),
            ("huge", Friction { prescribed: given(-1e3, 1e3), ..Friction::new(1.0) }),
            ("hardly any friction", Friction { prescribed: given(-0.3, 0.2), ..Friction::new(1e-9) }),
            ("mu 1e9", Friction { prescribed: given(-0.3, 0.2), ..Friction::new(1e9) }),
            ("spin alone", Friction { spin: 0.7, ..Friction::new(1.0) }),
        ] {
            let (report, solution) = run(&mut solver(grid, 0.3), g, &friction, 1e-6);
            let slip_residual = residual((grid, 0.3), g, &friction, &none, (&report, &solution));
            assert!(slip_residual <= 1.001e-6, "{name}, {what}: {slip_residual}");
            assert_eq!(report.certificate.stick_count + report.certificate.slip_count, in_contact, "{name}, {what}");
            match what {
                "mu 1e9" => assert_eq!(report.certificate.slip_count, 0, "{name}"),
                "huge" | "hardly any friction" => assert_eq!(report.certificate.stick_count, 0, "{name}, {what}"),
                _ => {}
            }
        }
        let nothing = run(&mut solver(grid, 0.3), g, &Friction::new(1.0), 1e-6).1;
        assert_eq!(nothing.traction, none, "{name}");
        let without = Friction { prescribed: given(-0.3, 0.2), ..Friction::new(0.0) };
        let (report, solution) = run(&mut solver(grid, 0.3), g, &without, 1e-6);
        assert_eq!(solution.traction, none, "{name}");
        assert_eq!(report.certificate.slip_count, in_contact, "{name}");
        let i = g.iter().position(|g| *g > 0.0).unwrap();
        assert_eq!(solution.slip[i], [-0.3, 0.2], "{name}");
    }
}

#[test]
fn forces_that_friction_cannot_carry_are_refused() {
    let (grid, g) = disc(20, |_, _| true);
    let carried = g.iter().sum::<f64>() * grid.element_area();
    let with = |part: f64| Friction {
        prescribed: [Prescribed::Force(part * carried), Prescribed::Force(0.0)],
        ..Friction::new(1.0)
    };
    let solve = |friction: &Friction<'_>| solver(&grid, 0.3).solve(&Request::new(&g, friction, 1e-6), &mut |_, _| true);
    for part in [1.0, -1.0, 1.5, 1e9] {
        let refused = solve(&with(part)).unwrap_err();
        assert!(refused.to_string().contains("must be less than"), "{refused}");
    }
    for part in [0.0, 1e-9, 0.5, 0.999] {
        let (end, report) = solve(&with(part)).unwrap();
        assert_eq!(end, Outcome::Converged, "{part}");
        assert!((report.force[0] - part * carried).abs() <= 1e-6 * carried);
    }
    // With a large spin the contact rotates about its centre, so that this force needs a large shift.
    let (end, report) = solve(&Friction { spin: 50.0, ..with(0.9) }).unwrap();
    assert_eq!(end, Outcome::Converged);
    assert!((report.force[0] - 0.9 * carried).abs() <= 1e-6 * carried && report.creepage[0] < -50.0 * 0.5);
}

/// Without friction, or if the bodies are apart, only a force of 0 can be carried, and it is met.
#[test]
fn a_force_of_zero_is_met_where_nothing_is_carried() {
    let (grid, g) = disc(20, |_, _| true);
    let apart = vec![0.0; grid.len()];
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        for (mu, pressure) in [(0.0, &g), (1.0, &apart)] {
            for other in [Prescribed::Force(0.0), Prescribed::Creepage(1e-3)] {
                let friction = Friction {
                    motion,
                    prescribed: [Prescribed::Force(0.0), other],
                    sensitivities: true,
                    ..Friction::new(mu)
                };
                let (report, solution) = run(&mut solver(&grid, 0.3), pressure, &friction, 1e-6);
                assert_eq!((report.force, report.creepage[0]), ([0.0; 2], 0.0), "{motion:?} {mu}");
                assert!(solution.traction.iter().all(|q| *q == [0.0; 2]));
                assert!(solution.slip.iter().flatten().all(|s| s.is_finite()));
                let little = Friction { prescribed: [Prescribed::Force(1e-9), other], ..friction };
                let refused = solver(&grid, 0.3).solve(&Request::new(pressure, &little, 1e-6), &mut |_, _| true);
                assert!(matches!(refused, Err(Error::Infeasible(_))), "{motion:?} {mu}");
            }
        }
    }
    // The normal and the tangential problem together, for bodies apart.
    let far = vec![1.0; grid.len()];
    for nu in [0.3, 0.2] {
        let bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3, nu] };
        let friction = Friction { prescribed: [Prescribed::Force(0.0); 2], ..Friction::new(0.3) };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &far, bodies, Load::Approach(0.5)) };
        let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
        assert_eq!((stop, report.friction.unwrap().force), (Outcome::Converged, [0.0; 2]), "{nu}");
    }
}

#[test]
fn slips_that_dwarf_what_tractions_displace_are_refused() {
    let (grid, g) = disc(20, |_, _| true);
    let shifted = |by: f64, mu: f64| {
        let friction =
            Friction { prescribed: [Prescribed::Creepage(by), Prescribed::Creepage(0.0)], ..Friction::new(mu) };
        let request = Request::new(&g, &friction, 1e-6);
        solver(&grid, 0.3).solve(&request, &mut |_, _| true)
    };
    // An element is displaced by some 0.1 times its traction, and tractions are of order mu. The rigid slip relative to this is out of range.
    for (by, mu) in [(1e32, 1.0), (1e-62, 1.0), (1.0, 1e62), (1.0, 1e-32), (2e40, 1.0), (5e-90, 1.0), (1e-300, 1.0)] {
        let refused = shifted(by, mu).unwrap_err().to_string();
        assert!(refused.contains("more than 1e30 times or less than 1e-60 times that"), "{refused}");
        let remedy = if by > mu { "choose a smaller motion" } else { "choose a larger motion or none" };
        assert!(refused.contains(remedy) && !refused.contains("of order 0e0"), "{by} {mu}: {refused}");
    }
    for (by, mu) in [(1e28, 1.0), (1e-57, 1.0), (1.0, 1e28), (1.0, 1e-28)] {
        let (end, report) = shifted(by, mu).unwrap();
        assert_eq!(end, Outcome::Converged, "{by} {mu}");
        let all = report.certificate.stick_count + report.certificate.slip_count;
        let expected = if by > mu { (0, all) } else { (all, 0) };
        assert_eq!((report.certificate.stick_count, report.certificate.slip_count), expected, "{by} {mu}");
    }
}

#[test]
fn previous_tractions_of_any_kind_are_taken() {
    // Previous tractions may exceed their bounds, or lie outside the contact. In the step they are released.
    let (grid, g) = disc(20, |x, _| x > 6);
    let garbage: Vec<f64> = (0..grid.len()).map(|i| 10.0 * ((i * 7919 % 101) as f64 / 50.0 - 1.0)).collect();
    let friction = Friction {
        prescribed: [Prescribed::Creepage(-0.3), Prescribed::Creepage(0.1)],
        previous: Previous::Given([&garbage, &garbage]),
        ..Friction::new(1.0)
    };
    let (report, solution) = run(&mut solver(&grid, 0.3), &g, &friction, 1e-6);
    let before: Vec<_> = garbage.iter().map(|q| [*q, *q]).collect();
    let slip_residual = residual((&grid, 0.3), &g, &friction, &before, (&report, &solution));
    assert!(slip_residual <= 1.001e-6, "{slip_residual}");
}

#[test]
fn a_callback_cancels_wherever_it_is_told() {
    let (grid, g) = disc(64, |_, _| true);
    let friction =
        Friction { prescribed: [Prescribed::Creepage(-0.3), Prescribed::Creepage(0.1)], ..Friction::new(1.0) };
    let request = Request::new(&g, &friction, 1e-6);
    let mut total = 0;
    solver(&grid, 0.3)
        .solve(&request, &mut |_, _| {
            total += 1;
            true
        })
        .unwrap();
    for last in 1..=total {
        let mut told = 0;
        let mut solver = solver(&grid, 0.3);
        let (end, _) = solver
            .solve(&request, &mut |_, _| {
                told += 1;
                told < last
            })
            .unwrap();
        assert_eq!((end, told), (Outcome::Cancelled, last));
        // The tractions of a cancelled solve are within their bounds.
        let solution = solver.solution().unwrap();
        assert!(solution.traction.iter().zip(&g).all(|(q, g)| q[0].hypot(q[1]) <= *g));
    }
}
