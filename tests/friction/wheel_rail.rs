//! The shift and the steady rolling of a wheel on a rail, compared with the output of CONTACT (data/friction/README.md).

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Scene};
use contact_normal::solver::{solve, Options, Outcome, Report};

use super::wheel_on_rail::{rolling, rolling_with_forces, shift, surface};

fn solved(k: usize, tolerance: f64, friction: impl Fn(&Grid) -> Friction<'static>) -> Report {
    let (grid, h) = surface(k);
    let steel = Bodies::same(82000.0, 0.28);
    let scene = Scene { friction: Some(friction(&grid)), ..Scene::new(grid, &h, steel, Load::Approach(0.02084)) };
    let (_, stop, report) = solve(&scene, &Options { tolerance, ..Options::default() }).unwrap();
    assert_eq!(stop, Outcome::Converged);
    report
}

#[test]
fn a_shift_of_a_wheel_is_that_of_contact() {
    for (k, in_contact, slips, force, most) in [
        (1, 3148, 1730, [-0.2198834, 0.1580354], 20.0),
        (2, 12902, 7243, [-0.2197644, 0.1581319], 18.0),
        (4, 50796, 28260, [-0.2197680, 0.1581256], 22.0),
    ] {
        // The bounds are the products of the prototype in Python.
        let products = solved(k, 1e-6, shift).friction.unwrap().products;
        assert!(products <= most, "{k}: {products} products");
        let report = solved(k, 1e-7, shift);
        let found = report.friction.unwrap();
        assert_eq!(report.measures.contact_count, in_contact);
        assert_eq!(found.certificate.stick_count + found.certificate.slip_count, in_contact);
        assert!(found.certificate.slip_count.abs_diff(slips) <= 1, "{}", found.certificate.slip_count);
        for (found, force) in found.force.iter().zip(force) {
            let part = found / (0.3 * report.measures.force);
            // Half a unit of the last printed digit, and the error of a solve with a residual of 1e-7.
            assert!((part - force).abs() <= 2e-7, "{part} {force}");
        }
    }
}

#[test]
fn a_shift_of_a_wheel_on_the_finest_grid_is_that_of_contact() {
    let report = solved(8, 1e-8, shift);
    let found = report.friction.unwrap();
    assert_eq!(report.measures.contact_count, 200_980);
    assert!(found.certificate.slip_count.abs_diff(111_191) <= 1, "{}", found.certificate.slip_count);
    let products = solved(8, 1e-6, shift).friction.unwrap().products;
    assert!(products <= 24.0, "{products} products");
}

#[test]
fn steady_rolling_of_a_wheel_is_that_of_contact() {
    for (k, slips, force) in
        [(1, 1872, [-0.5729502, -0.3269461]), (2, 7735, [-0.5714346, -0.3258107]), (4, 30181, [-0.5709366, -0.3254764])]
    {
        let report = solved(k, 1e-9, rolling);
        let found = report.friction.unwrap();
        assert_eq!(found.certificate.slip_count, slips);
        for (found, force) in found.force.iter().zip(force) {
            let part = found / (0.3 * report.measures.force);
            // Half a unit of the last printed digit, and the error of a solve with a residual of 1e-9.
            assert!((part - force).abs() <= 5.1e-8, "{part} {force}");
        }
    }
}

#[test]
fn creepages_of_a_wheel_with_forces_are_those_of_contact() {
    for (k, slips, xi, eta) in
        [(1, 1872, 5.000884e-4, 8.310e-8), (2, 7757, 5.027396e-4, 1.92857e-6), (4, 30263, 5.0361e-4, f64::NAN)]
    {
        // The approach is given, so that the normal force is known from a first solve.
        let carried = 0.3 * solved(k, 1e-9, rolling).measures.force;
        let report = solved(k, 1e-8, |grid| rolling_with_forces(grid, carried));
        let found = report.friction.unwrap();
        assert_eq!(found.certificate.slip_count, slips);
        let printed = if eta.is_nan() { 5e-9 } else { 5e-11 };
        // Half a unit of the last printed digit, and the error of creepages of this size with a residual of 1e-8.
        assert!((found.creepage[0] - xi).abs() <= printed + 1e-10, "{:?}", found.creepage);
        assert!(eta.is_nan() || (found.creepage[1] - eta).abs() <= printed + 1e-10, "{:?}", found.creepage);
        for (found, part) in found.force.iter().zip([-0.573, -0.327]) {
            assert!((found / carried - part).abs() <= 1e-7, "{found}");
        }
    }
}
