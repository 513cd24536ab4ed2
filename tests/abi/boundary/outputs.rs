//! Unwanted outputs may be NULL, and the report has the tolerance that its result meets.

use std::ptr::{null, null_mut};

use super::{assert_refused, Handle};
use crate::call::{initialised, last_error, Call, Through};
use contact_normal::ffi::*;

#[test]
fn without_fields_the_report_is_the_same() {
    let mut call = Call::new();
    let handle = Handle::of(&mut call);
    for through in [Through::Solve, Through::SolverSolve] {
        let mut expected = Call::new();
        assert_eq!(expected.run(through, handle.0).0, CONTACT_NORMAL_OK);
        let mut call = Call::new();
        call.without = "fields";
        let before = call.pressure.clone();
        assert_eq!(call.run(through, handle.0), (CONTACT_NORMAL_OK, String::new()), "{through:?}");
        let (found, wanted) = (&call.report.known, &expected.report.known);
        assert_eq!(
            (found.normal.force, found.normal.residual, found.statistics.cycles),
            (wanted.normal.force, wanted.normal.residual, wanted.statistics.cycles)
        );
        assert!(found.normal.force > 0.0 && call.pressure == before);
    }
    // Arrays that the call has to read must not be NULL.
    for (name, change) in [
        ("fields->contact", (|c: &mut Call| c.fix_contact()) as fn(&mut Call)),
        ("fields->pressure", |c| c.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN),
    ] {
        let mut call = Call::new();
        change(&mut call);
        call.without = "fields";
        assert_refused(call.run(Through::Solve, null_mut()), CONTACT_NORMAL_NULL_POINTER, &[name]);
    }
    // SAFETY: a handle.
    let status = unsafe { contact_normal_solver_fields(handle.0, null_mut()) };
    assert_refused((status, last_error()), CONTACT_NORMAL_NULL_POINTER, &["fields"]);
}

#[test]
fn the_report_has_the_tolerance_that_was_met() {
    const M: usize = 64;
    let centre = |i: usize| (i as f64 + 0.5 - 0.5 * M as f64) / M as f64;
    let h: Vec<f64> = (0..M * M).map(|i| centre(i % M).powi(2) + centre(i / M).powi(2)).collect();
    let mut scene = initialised(contact_normal_scene_init);
    (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 1.0 / M as f64, 1.0 / M as f64);
    (scene.shear_modulus, scene.poisson_ratio) = ([1.0; 2], [0.3; 2]);
    (scene.approach, scene.undeformed_distance) = (0.1, h.as_ptr());
    let run = |method, error_ratio| {
        let mut options = initialised(contact_normal_options_init);
        (options.method, options.error_ratio, options.tolerance) = (method, error_ratio, 1e-9);
        let mut report = initialised(contact_normal_report_init);
        // SAFETY: structs with their arrays.
        let status = unsafe { contact_normal_solve(&scene, &options, null_mut(), &mut report) };
        assert_eq!(status, CONTACT_NORMAL_OK);
        report
    };
    for method in 0..=4 {
        let exact = run(method, 0.0);
        assert_eq!(exact.normal.tolerance, 1e-9, "method {method}");
        assert!(exact.normal.residual <= 1e-9);
        let early = run(method, 0.5);
        assert!(
            early.normal.residual <= early.normal.tolerance,
            "method {method}: {:e} {:e}",
            early.normal.residual,
            early.normal.tolerance
        );
        // Only methods that start on coarser grids know an error at which they can stop.
        let knows = ![CONTACT_NORMAL_METHOD_NORM, CONTACT_NORMAL_METHOD_MULTIGRID].contains(&method);
        assert_eq!(early.normal.tolerance > 1e-9, knows, "method {method}: {:e}", early.normal.tolerance);
    }

    let (mut accuracy, mut report) =
        (initialised(contact_normal_accuracy_init), initialised(contact_normal_report_init));
    accuracy.target = 0.01;
    // SAFETY: as above.
    let status = unsafe { contact_normal_solve_to_accuracy(&scene, null(), &mut accuracy, null_mut(), &mut report) };
    assert_eq!((status, report.normal.tolerance), (CONTACT_NORMAL_OK, 1e-6), "{}", last_error());
}
