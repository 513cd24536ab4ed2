//! A ball pushed sideways, compared with the exact solution of Cattaneo and Mindlin, and with the output of CONTACT.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::case::distance;
use super::scenes::Cattaneo;
use super::support::{run, solver};

#[test]
fn a_ball_pushed_sideways_has_cattaneos_tractions() {
    let mut before = f64::INFINITY;
    for (m, most) in [(32, 7.0e-3), (64, 2.6e-3), (128, 1.1e-3), (256, 3.9e-4)] {
        let case = Cattaneo::new(m, 0.5);
        let friction = Friction {
            prescribed: [Prescribed::Creepage(case.shift), Prescribed::Creepage(0.0)],
            ..Friction::new(1.0)
        };
        let (report, solution) = run(&mut solver(&case.grid, 0.0), &case.bound, &friction, 1e-6);
        let found = case.compare(&solution);
        // Theory gives the order of the error, not its size. The bounds are the measured errors, which an independent program has too (table in
        // docs/friction.md).
        assert!(found.error <= most, "{m}: {}", found.error);
        assert!(found.error < before);
        before = found.error;
        // The elements of C do not fill the disc exactly, so that the radius of the stick area is uncertain by half an element.
        assert!((found.stick_radius - 0.5).abs() <= 0.5 * case.grid.dx, "{m}: {}", found.stick_radius);
        let force = report.force[0] / case.carried();
        // The error is of first order at worst. Theory gives no factor: .02 is twice the factor that was measured on the coarsest grid
        // (docs/friction.md).
        assert!((force - 0.875).abs() <= 0.02 * case.grid.dx, "{m}: {force}");
    }
}

#[test]
fn contacts_cattaneo_is_met() {
    // CONTACT's example: R = 50 mm, G = 200 N/mm2, nu = 0.42, a = 1 mm, 19 x 19 elements of 2/15 mm, mu = 0.4, Fx = -.875 mu N.
    let d = 2.0 / 15.0;
    let grid = Grid::new(19, 19, d, d).unwrap();
    let h = distance(&grid, |x, y| (x * x + y * y) / 100.0);
    let force = 4.0 / 3.0 * (200.0 / 0.58) / 50.0;
    let mu = 0.4;
    let friction =
        Friction { prescribed: [Prescribed::Force(-0.875 * mu * force), Prescribed::Force(0.0)], ..Friction::new(mu) };
    let scene =
        Scene { friction: Some(friction), ..Scene::new(grid, &h, Bodies::same(200.0, 0.42), Load::Force(force)) };
    let (_, stop, report) = solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let found = report.friction.unwrap();
    // The output of CONTACT. The tolerances are half a unit of the last printed digit.
    assert!((report.measures.approach - 1.998e-2).abs() <= 5e-6, "{}", report.measures.approach);
    assert!((report.measures.max_pressure - 4.393).abs() <= 5e-4, "{}", report.measures.max_pressure);
    assert_eq!((report.measures.contact_count, found.certificate.stick_count), (177, 45));
    assert!((found.creepage[0] - 8.155e-3).abs() <= 5e-7, "{:?}", found.creepage);
    // An independent program in Python has 8.15489e-3. The tolerance is half a unit of its last digit, and 1e-8 for a residual of 1e-6.
    assert!((found.creepage[0] - 8.15489e-3).abs() <= 2e-8, "{:?}", found.creepage);
    assert!(found.creepage[1].abs() <= 1e-6 * found.creepage[0], "{:?}", found.creepage);
}
