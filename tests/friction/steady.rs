//! Steady rolling. Carter's cylinder and Bentall and Johnson's unlike cylinders are compared with the output of CONTACT, and ellipses with the
//! results of an earlier program. The conditions of friction are recomputed by direct sums, for any rolling direction. Transient rolling tends to
//! steady rolling.

use std::f64::consts::PI;

use contact_normal::friction::{Report, Solution};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{self, solve, Options, Outcome};

use super::scenes::Ellipse;
use super::steady_scenes::{ellipse, Rolling, KNOWN, NU, RATIOS, SIZES};
use super::support::{residual, run, solver};

/// The normal force on Carter's cylinder (N), which is 200 mm long.
const CARTER_FORCE: f64 = 35780.0;

/// Solves Carter's problem on `m` elements along the rolling direction: a contact of half-width 1 mm, R = 500 mm, steel, mu = .3
/// (the input of CONTACT's example carter2d). Returns the report, and the largest traction across the rolling direction.
fn carter(m: usize) -> (solver::Report, f64) {
    let dx = 2.2 / m as f64;
    let grid = Grid::new(m, 1, dx, 200.0).unwrap();
    // As in CONTACT's input, the centre of the cylinder lies 1.07 mm from the edge of the grid, which is 2.2 mm long.
    let h: Vec<f64> = (0..m).map(|i| 0.001 * (-1.07 + (i as f64 + 0.5) * dx).powi(2)).collect();
    let friction = Friction {
        motion: Motion::SteadyRolling,
        prescribed: [Prescribed::Creepage(-0.00024), Prescribed::Creepage(0.0)],
        ..Friction::new(0.3)
    };
    let steel = Bodies::same(82000.0, 0.28);
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, steel, Load::Force(CARTER_FORCE)) };
    let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let largest_across = solver.friction().unwrap().traction.iter().map(|q| q[1].abs()).fold(0.0, f64::max);
    (report, largest_across)
}

#[test]
fn a_cylinder_rolls_as_carter_says() {
    let part_of_bound = |report: &Report| report.force[0] / (0.3 * CARTER_FORCE);
    let (solver::Report { measures, friction, .. }, largest_across) = carter(55);
    let friction = friction.unwrap();
    // The output of CONTACT's carter2d, which has 55 elements. The tolerances are half a unit of the last printed digit.
    assert!((measures.approach - 0.00649156).abs() <= 5e-9, "{}", measures.approach);
    assert!((measures.max_pressure - 113.8908).abs() <= 5e-5, "{}", measures.max_pressure);
    assert!((part_of_bound(&friction) - 0.6480).abs() <= 5e-5, "{}", part_of_bound(&friction));
    let counts = (measures.contact_count, friction.certificate.stick_count, friction.certificate.slip_count);
    assert_eq!(counts, (50, 30, 20));
    assert_eq!(largest_across, 0.0);
    let mut before = f64::INFINITY;
    for m in [110, 220, 440, 880, 1760] {
        let (report, _) = carter(m);
        // Exact (Carter 1926; Johnson, Contact Mechanics, 8.3): F/(mu N) = 1 - (a'/a)^2. The creepage is mu (a - a')/R = .00024, so that a' = .6 a.
        // The error is of first order in the element, which is 2.2/m of the half-width. The bound .8/m is .36 of this.
        let error = (part_of_bound(&report.friction.unwrap()) - 0.64).abs();
        assert!(error <= 0.8 / m as f64 && error < 0.9 * before, "{m}: {error} {before}");
        before = error;
    }
}

/// Steady rolling along x with given creepages and spin; mu = 1.
pub fn rolling(creepage: [f64; 2], spin: f64) -> Friction<'static> {
    Friction {
        motion: Motion::SteadyRolling,
        prescribed: creepage.map(Prescribed::Creepage),
        spin,
        ..Friction::new(1.0)
    }
}

/// Checks the conditions of friction by direct sums, for a solve with a tolerance of 1e-6.
fn check(grid: &Grid, g: &[f64], friction: &Friction<'_>, found: (&Report, &Solution)) {
    let slip_residual = residual((grid, NU), g, friction, &[], found);
    // Direct sums and FFT products differ by round-off: 1e-9 beyond the tolerance of 1e-6, and 1e-10 beside the reported residual, are ample for it.
    assert!(
        slip_residual <= 1.001e-6 && (slip_residual - found.0.certificate.residual).abs() <= 1e-10,
        "{slip_residual} {:?}",
        found.0
    );
}

#[test]
fn steady_rolling_in_any_direction_and_by_any_step_meets_the_conditions() {
    let (mut most_products, mut most_of_short_steps): (f64, f64) = (0.0, 0.0);
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
                    of([Prescribed::Creepage(0.0); 2], 1.5),
                    of(turned(0.6 * carried, 0.2 * carried).map(Prescribed::Force), 0.3),
                    of([Prescribed::Creepage(0.1), Prescribed::Force(0.5 * carried)], 0.3),
                ] {
                    let (report, solution) = run(&mut solver(&grid, NU), &g, &friction, 1e-6);
                    check(&grid, &g, &friction, (&report, &solution));
                    let maximum = if length < 1.0 { &mut most_of_short_steps } else { &mut most_products };
                    *maximum = maximum.max(report.products);
                }
            }
        }
    }
    // The bounds are 1.5 times the largest numbers of products that were measured. Steps shorter than an element take more products, because the
    // elements do not resolve these steps.
    assert!(most_products <= 60.0 && most_of_short_steps <= 200.0, "{most_products} {most_of_short_steps}");
}

#[test]
fn cases_of_an_earlier_program_are_met() {
    let mut products = Vec::new();
    for (b, known) in RATIOS.into_iter().zip(KNOWN) {
        for (k, (known_values, _, known_products)) in known.into_iter().enumerate() {
            let case = Rolling::new(b, k, SIZES[1]);
            let (report, solution) = run(&mut solver(&case.grid, NU), &case.bound, &case.friction, 1e-6);
            let computed = match case.friction.prescribed[0] {
                Prescribed::Creepage(_) => report.force.map(|force| force / case.carried()),
                Prescribed::Force(_) => report.creepage,
            };
            for (value, known) in computed.into_iter().zip(known_values) {
                // The known values are those on 256 x 256 elements. Here there are 64 x 64, each 3 % of the half-axis, hence the tolerance of 2 %.
                // The .004 are for components near 0.
                assert!((value - known).abs() <= 0.02 * known.abs() + 0.004, "{b} {}: {value} {known}", case.name);
            }
            if k % 4 == 0 {
                check(&case.grid, &case.bound, &case.friction, (&report, &solution));
            }
            // At most 10 % more products than the earlier program took to 1e-6 on 64 x 64 elements. The known counts are rounded (+ 0.5), and leave
            // out the product of the certificate (+ 1).
            let most = 1.1 * (f64::from(known_products[1]) + 0.5) + 1.0;
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
            let slip_residual = residual((&case.grid, case.nu), &case.bound, &case.friction, &[], (&report, &solution));
            // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
            assert!(slip_residual <= 1.001e-6, "{seed} {forces}: {slip_residual}");
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
    // The difference that the start causes is .4 after 20 steps, and falls by a factor of 5 in each further 20: to 2e-7 after 200 steps. The
    // tolerances of the two solves, 1e-8 and 1e-9, are smaller.
    assert!(apart(&last, &expected) <= 1e-6, "{}", apart(&last, &expected));
    // In steady rolling `Previous::Kept` only supplies the initial guess, here a good one. Hence the same tractions, after few products.
    let (warm_report, warm) = run(&mut stepping, &g, &Friction { previous: Previous::Kept, ..steady }, 1e-8);
    assert!(apart(&warm, &expected) <= 1e-6, "{}", apart(&warm, &expected));
    assert!(warm_report.products <= 12.0, "{}", warm_report.products);
}

/// Bentall and Johnson's (1967) aluminium cylinder on a steel one: CONTACT's example bentall, whose output has the creepages and the numbers of
/// elements in stick and in contact.
#[test]
fn unlike_cylinders_roll_as_contact_says() {
    let normal_force = 16201.9;
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
            prescribed: [Prescribed::Force(part * mu * normal_force), Prescribed::Creepage(0.0)],
            ..Friction::new(mu)
        };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(normal_force)) };
        let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
        let found = report.friction.unwrap();
        assert_eq!(stop, Outcome::Converged);
        // The tolerance is half a unit of CONTACT's last printed digit.
        assert!((found.creepage[0] - creepage).abs() <= 5e-8, "{mu} {part}: {:?}", found.creepage);
        assert_eq!((found.certificate.stick_count, report.measures.contact_count), (sticks, in_contact), "{mu} {part}");
        assert!((found.force[0] - part * mu * normal_force).abs() <= 1e-6 * mu * normal_force);
    }
}
