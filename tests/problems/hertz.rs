//! The library's exact Hertz solution is compared with printed values, and the numerical solution converges to it.

use crate::paper as case;

use contact_normal::analytic::{hertz, hertz_by_force};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Options, Outcome};

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!((value / exact - 1.0).abs() <= tolerance, "{value} for {exact}");
}

#[test]
fn the_exact_solution_of_the_papers_case_has_all_digits() {
    let compliance = Bodies::same(case::SHEAR_MODULUS, case::POISSON_RATIO).compliance();
    // The expected values: complete elliptic integrals in double precision, computed independently.
    for exact in [
        hertz(case::CURVATURE.0, case::CURVATURE.1, case::APPROACH, compliance).unwrap(),
        hertz_by_force(case::CURVATURE.0, case::CURVATURE.1, 81986.77696838684, compliance).unwrap(),
    ] {
        close(exact.semi_axis_x, 5.998982547003128, 1e-13);
        close(exact.semi_axis_y, 3.9998029373914865, 1e-13);
        close(exact.max_pressure, 1631.4321136895812, 1e-13);
        close(exact.force, 81986.77696838684, 1e-13);
        close(exact.area, 75.38172408194987, 1e-13);
        close(exact.approach, case::APPROACH, 1e-13);
    }
}

#[test]
fn a_sphere_is_johnsons_formula() {
    // Johnson eq. 4.22-4.24: a = (3 F R/(4 E*))^(1/3), p0 = (6 F E*^2/(pi^3 R^2))^(1/3), with E* = 5, R = 4, F = 7
    let (modulus, radius, force) = (5.0f64, 4.0f64, 7.0f64);
    let exact = hertz_by_force(0.5 / radius, 0.5 / radius, force, 1.0 / modulus).unwrap();
    close(exact.semi_axis_x, 1.6134286460245437, 1e-14);
    close(exact.semi_axis_y, 1.6134286460245437, 1e-14);
    close(exact.approach, 0.6507879989531481, 1e-14);
    close(exact.max_pressure, 1.2839257217043503, 1e-14);
    // Limits: nearly a sphere, and nearly a cylinder with the axes exchanged.
    let near = hertz(0.125, 0.125 * (1.0 + 1e-9), 0.65, 0.2).unwrap();
    close(near.force, hertz(0.125, 0.125, 0.65, 0.2).unwrap().force, 1e-8);
    let (a, b) = (hertz(1.0, 1e4, 1e-3, 1.0).unwrap(), hertz(1e4, 1.0, 1e-3, 1.0).unwrap());
    assert_eq!((a.semi_axis_x, a.semi_axis_y, a.force), (b.semi_axis_y, b.semi_axis_x, b.force));
    assert!(a.semi_axis_x / a.semi_axis_y > 100.0);
}

#[test]
fn the_numerical_solution_converges_to_the_exact_one() {
    let exact = hertz(
        case::CURVATURE.0,
        case::CURVATURE.1,
        case::APPROACH,
        Bodies::same(case::SHEAR_MODULUS, case::POISSON_RATIO).compliance(),
    )
    .unwrap();
    let mut last = f64::INFINITY;
    for m in [16, 64, 256] {
        let h = case::undeformed_distance(m);
        let (_, stop, report) = solve(&case::scene(m, &h), &Options::default()).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let error = (report.measures.force / exact.force - 1.0).abs();
        // The elements shrink by 4 from grid to grid, so that a first-order error falls by 4. The error of the force falls faster.
        assert!(error <= last / 4.0, "{m} x {m}: force off by {error}, before {last}");
        last = error;
    }
    assert!(last < 1e-4);
}

#[test]
fn prescribing_the_force_finds_the_approach_and_the_reverse() {
    let m = 96;
    let h = case::undeformed_distance(m);
    let tight = Options { tolerance: 1e-10, ..Options::default() };
    let (by_approach, _, report) = solve(&case::scene(m, &h), &tight).unwrap();
    let scene = Scene { load: Load::Force(report.measures.force), ..case::scene(m, &h) };
    let (by_force, stop, again) = solve(&scene, &tight).unwrap();
    assert_eq!(stop, Outcome::Converged);
    // The relative residual is 1e-10. The relative errors of approach and force are small multiples of it.
    close(again.measures.approach, case::APPROACH, 1e-9);
    close(again.measures.force, report.measures.force, 1e-12);
    assert_eq!(by_approach.state().contact, by_force.state().contact);
}
