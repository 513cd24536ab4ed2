//! Steady rolling: Carter's cylinder, its conditions by direct sums in any direction, the limit of transient rolling.

use std::f64::consts::PI;

use contact_normal::friction::{Report, Solution};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::scenes::Ellipse;
use super::steady_scenes::{ellipse, Rolling, KNOWN, NU, RATIOS, SIZES};
use super::support::{residual, run, solver};

/// Carter's cylinder with `m` elements: half-width 1 mm, R = 500 mm, steel, mu = .3 (the input of CONTACT's example carter2d).
fn carter(m: usize) -> (Report, usize, f64) {
    let dx = 2.2 / m as f64;
    let grid = Grid::new(m, 1, dx, 200.0).unwrap();
    // The middle of the cylinder is not that of the grid.
    let h: Vec<f64> = (0..m).map(|i| 0.001 * (-1.07 + (i as f64 + 0.5) * dx).powi(2)).collect();
    let friction = Friction {
        motion: Motion::SteadyRolling,
        prescribed: [Prescribed::Creepage(-0.00024), Prescribed::Creepage(0.0)],
        ..Friction::new(0.3)
    };
    let steel = Bodies::same(82000.0, 0.28);
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, steel, Load::Force(35780.0)) };
    let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged);
    if m == 55 {
        assert!((report.measures.approach - 0.00649156).abs() <= 5e-9, "{}", report.measures.approach);
        assert!((report.measures.max_pressure - 113.8908).abs() <= 5e-5, "{}", report.measures.max_pressure);
    }
    let largest = solver.friction().unwrap().traction.iter().map(|q| q[1].abs()).fold(0.0, f64::max);
    (report.friction.unwrap(), report.measures.contact_count, largest)
}

#[test]
fn a_cylinder_rolls_as_carter_says() {
    let (found, in_contact, sideways) = carter(55);
    let part = |report: &Report| report.force[0] / (0.3 * 35780.0);
    // The printed digits of CONTACT.
    assert!((part(&found) - 0.6480).abs() <= 5e-5, "{}", part(&found));
    assert_eq!((in_contact, found.certificate.stick_count, found.certificate.slip_count), (50, 30, 20));
    assert_eq!(sideways, 0.0);
    let mut before = f64::INFINITY;
    for m in [110, 220, 440, 880, 1760] {
        let (found, ..) = carter(m);
        // Exact: 1 - (a'/a)^2 for a stick area of a' = .6 a. The error is of first order; one element is 2/m of the contact.
        let error = (part(&found) - 0.64).abs();
        assert!(error <= 0.8 / m as f64 && error < 0.9 * before, "{m}: {error} {before}");
        before = error;
    }
}

pub fn rolling(creepage: [f64; 2], spin: f64) -> Friction<'static> {
    Friction {
        motion: Motion::SteadyRolling,
        prescribed: creepage.map(Prescribed::Creepage),
        spin,
        ..Friction::new(1.0)
    }
}

/// Checks the conditions by direct sums.
fn check(grid: &Grid, g: &[f64], friction: &Friction<'_>, found: (&Report, &Solution)) {
    let left = residual((grid, NU), g, friction, &[], found);
    // The tolerance, and round-off of two products.
    assert!(left <= 1.001e-6 && (left - found.0.certificate.residual).abs() <= 1e-10, "{left} {:?}", found.0);
}

#[test]
fn steady_rolling_in_any_direction_and_by_any_step_meets_the_conditions() {
    let (mut most, mut most_of_short): (f64, f64) = (0.0, 0.0);
    for b in [0.7, 3.0] {
        let (grid, g) = ellipse(b, 28);
        let carried = g.iter().sum::<f64>() * grid.element_area();
        for direction in [0.0, 90.0, 180.0, 270.0, 37.0, -120.0_f64] {
            for length in [0.3, 1.0, 3.0] {
                let turned = |x: f64, y: f64| {
                    let (sine, cosine) = direction.to_radians().sin_cos();
                    [cosine * x - sine * y, sine * x + cosine * y]
                };
                let of = |prescribed, spin| Friction {
                    prescribed,
                    rolling_distance: length * if [90.0, 270.0].contains(&direction) { grid.dy } else { grid.dx },
                    rolling_direction: direction / 180.0 * PI,
                    ..rolling([0.0; 2], spin)
                };
                for friction in [
                    of(turned(-0.3, 0.1).map(Prescribed::Creepage), 0.1),
                    of(turned(0.0, 0.0).map(Prescribed::Creepage), 1.5),
                    of(turned(0.6 * carried, 0.2 * carried).map(Prescribed::Force), 0.3),
                    of([Prescribed::Creepage(0.1), Prescribed::Force(0.5 * carried)], 0.3),
                ] {
                    let (report, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
                    check(&grid, &g, &friction, (&report, &solution));
                    let most = if length < 1.0 { &mut most_of_short } else { &mut most };
                    *most = most.max(report.products);
                }
            }
        }
    }
    // One and a half times the products of this case. Elements do not resolve shorter steps.
    assert!(most <= 60.0 && most_of_short <= 200.0, "{most} {most_of_short}");
}

#[test]
fn cases_of_other_programs_are_met() {
    let mut products = Vec::new();
    for (b, known) in RATIOS.into_iter().zip(KNOWN) {
        for (k, (found, _, tight)) in known.into_iter().enumerate() {
            let case = Rolling::new(b, k, SIZES[1]);
            let (report, solution) = run(&mut solver(&case.grid, NU), &case.bound, &case.friction, 1e-6);
            let of_finest = match case.friction.prescribed[0] {
                Prescribed::Creepage(_) => report.force.map(|force| force / case.carried()),
                Prescribed::Force(_) => report.creepage,
            };
            for (found, known) in of_finest.into_iter().zip(found) {
                // The known values are those of 256 elements across, 4 times as fine. Here an element is 3 % of the half-axis.
                assert!((found - known).abs() <= 0.02 * known.abs() + 0.004, "{b} {}: {found} {known}", case.name);
            }
            if k % 4 == 0 {
                check(&case.grid, &case.bound, &case.friction, (&report, &solution));
            }
            // One product more: the known numbers are rounded, without the certificate.
            let most = 1.1 * (f64::from(tight[1]) + 0.5) + 1.0;
            assert!(report.products <= most, "{b} {}: {}", case.name, report.products);
            products.push(report.products - 1.0);
        }
    }
    products.sort_by(f64::total_cmp);
    assert!(products[products.len() / 2] <= 22.0, "{products:?}");
}

#[test]
fn random_cases_of_steady_rolling_meet_the_conditions() {
    for seed in 0..30 {
        for forces in [false, true] {
            let case = Ellipse::random_rolling(seed, 24, forces);
            let (report, solution) = run(&mut solver(&case.grid, case.nu), &case.bound, &case.friction, 1e-6);
            let left = residual((&case.grid, case.nu), &case.bound, &case.friction, &[], (&report, &solution));
            assert!(left <= 1.001e-6, "{seed} {forces}: {left}");
        }
    }
}

#[test]
fn steps_of_transient_rolling_lead_to_steady_rolling() {
    let (grid, g) = ellipse(1.0, 24);
    let steady = rolling([-0.3, 0.1], 0.1);
    let (_, expected) = run(&mut solver(&grid, NU), &g, &steady, 1e-8);
    let mut stepping = solver(&grid, NU);
    let step = Friction { motion: Motion::TransientRolling, ..steady };
    let (_, mut last) = run(&mut stepping, &g, &step, 1e-8);
    let apart = |a: &Solution, b: &Solution| {
        a.traction.iter().zip(&b.traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
    };
    for _ in 0..200 {
        (_, last) = run(&mut stepping, &g, &Friction { previous: Previous::Kept, ..step }, 1e-9);
    }
    // The effect of the start is .4 after 20 steps, and falls by a factor of 5 in 20 further ones. Both residuals are below.
    assert!(apart(&last, &expected) <= 1e-6, "{}", apart(&last, &expected));
    // For steady rolling the last tractions are only a start.
    let (warm_report, warm) = run(&mut stepping, &g, &Friction { previous: Previous::Kept, ..steady }, 1e-8);
    assert!(apart(&warm, &expected) <= 1e-6, "{}", apart(&warm, &expected));
    assert!(warm_report.products <= 12.0, "{}", warm_report.products);
}

#[test]
fn unlike_cylinders_roll_as_contact_says() {
    // Bentall and Johnson (1967): aluminium on steel, CONTACT's example bentall, which prints creepages, stick and contact counts.
    let grid = Grid::new(216, 1, 0.001, 1000.0).unwrap();
    let h: Vec<f64> = (0..216).map(|i| 0.02 * ((i as f64 - 107.5) * 0.001).powi(2)).collect();
    let bodies = Bodies { shear_modulus: [23000.0, 82000.0], poisson_ratio: [0.31, 0.28] };
    for (mu, part, creepage, sticks, in_contact) in [
        (10.0, 0.0, 3.591e-4, 200, 200),
        (0.05, 0.0, 4.294e-4, 125, 200),
        (0.05, 0.75, 2.108e-4, 36, 200),
        (0.05, -0.75, 5.392e-4, 106, 201),
    ] {
        let friction = Friction {
            motion: Motion::SteadyRolling,
            rolling_direction: PI,
            prescribed: [Prescribed::Force(part * mu * 16201.9), Prescribed::Creepage(0.0)],
            ..Friction::new(mu)
        };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(16201.9)) };
        let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
        let found = report.friction.unwrap();
        assert_eq!(stop, Outcome::Converged);
        // The printed digits.
        assert!((found.creepage[0] - creepage).abs() <= 5e-8, "{mu} {part}: {:?}", found.creepage);
        assert_eq!((found.certificate.stick_count, report.measures.contact_count), (sticks, in_contact), "{mu} {part}");
        assert!((found.force[0] - part * mu * 16201.9).abs() <= 1e-6 * mu * 16201.9);
    }
}
