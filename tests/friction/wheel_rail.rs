//! The shift of a wheel on a rail, against what CONTACT printed (data/friction/README.md).

use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Options, Report, Stop};

use super::wheel_on_rail::{shift, surface};

fn solved(k: usize, tolerance: f64) -> Report {
    let (grid, h) = surface(k);
    let steel = Bodies::same(82000.0, 0.28);
    let scene = Scene { friction: Some(shift(&grid)), ..Scene::new(grid, &h, steel, Load::Approach(0.02084)) };
    let (_, stop, report) = solve(&scene, &Options { tolerance, ..Options::default() }).unwrap();
    assert_eq!(stop, Stop::Converged);
    report
}

#[test]
fn a_shift_of_a_wheel_is_that_of_contact() {
    for (k, in_contact, slips, force) in [
        (1, 3148, 1730, [-0.2198834, 0.1580354]),
        (2, 12902, 7243, [-0.2197644, 0.1581319]),
        (4, 50796, 28260, [-0.2197680, 0.1581256]),
    ] {
        let report = solved(k, 1e-7);
        let found = report.friction.unwrap();
        assert_eq!(report.measures.contact_count, in_contact);
        assert_eq!(found.certificate.stick_count + found.certificate.slip_count, in_contact);
        assert!(found.certificate.slip_count.abs_diff(slips) <= 1, "{}", found.certificate.slip_count);
        for (found, force) in found.force.iter().zip(force) {
            let part = found / (0.3 * report.measures.force);
            // The digits printed, and what a residual of 1e-7 hides.
            assert!((part - force).abs() <= 2e-7, "{part} {force}");
        }
    }
}
