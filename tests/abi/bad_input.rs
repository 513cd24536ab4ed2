//! The rows of bad input (rows.rs): each gets its status, a message that names the argument and its value, and outputs that are not written.

use std::ptr::null_mut;

use crate::call::{Call, Through};
use crate::rows::*;
use contact_normal::ffi::*;

pub fn refused(row: &Row, through: Through, handle: *mut contact_normal_solver) {
    let (words, status, change) = row;
    let mut call = Call::new();
    change(&mut call);
    let before = call.outputs();
    let (got, message) = call.run(through, handle);
    assert_eq!(got, *status, "{words:?} through {through:?}: {message}");
    for word in *words {
        assert!(message.contains(word), "{words:?} through {through:?}: \"{message}\" does not say {word}");
    }
    // A message must not contain Rust's debug format, which prints braces for structs and for some enumerators.
    assert!(!message.contains(['{', '}']), "{message}");
    assert!(call.outputs() == before, "{words:?} through {through:?}: outputs were written");
}

/// If a solve stagnates, the message names round-off if that is the reason, and does not if the method has stalled.
#[test]
fn a_stagnation_says_what_limits() {
    let mut call = Call::new();
    call.h.iter_mut().for_each(|h| *h += 1e9);
    // With a given force the approach is near 1e9, and has its round-off.
    (call.scene.known.load, call.scene.known.force) = (CONTACT_NORMAL_PRESCRIBED_FORCE, 100.0);
    call.options.known.tolerance = 1e-12;
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_STAGNATED, "{message}");
    assert!(message.contains("round-off of distances of order 1e9"), "{message}");
}

/// All elements in contact but one are at their limit. Displacements are 1e-12 of the heights, so that the height of the only free element decides
/// what the message says.
#[test]
fn beside_elements_at_their_limit_a_stagnation_names_round_off() {
    let mut call = Call::new();
    call.h.iter_mut().enumerate().for_each(|(i, h)| *h = 0.1 + 0.7031 * i as f64);
    let scene = &mut call.scene.known;
    (scene.load, scene.force) =
        (CONTACT_NORMAL_PRESCRIBED_FORCE, 10.37 * scene.dx * scene.dy * 1e-9 * scene.shear_modulus[0]);
    let limit = 1e-9 * scene.shear_modulus[0];
    call.use_limit().limit = limit;
    call.options.known.tolerance = 1e-12;
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_STAGNATED, "{message}");
    assert!(message.contains("round-off of distances of order"), "{message}");
}

/// With a smoother that diverges the result is p = 0. The message must not name round-off as the reason.
#[test]
fn a_diverging_smoother_is_not_blamed_on_round_off() {
    let mut call = Call::new();
    call.options.known.method = CONTACT_NORMAL_METHOD_MULTIGRID;
    let cycle = call.use_cycle();
    (cycle.smoother, cycle.relaxation, cycle.coarsest) = (CONTACT_NORMAL_SMOOTHER_JACOBI, 1.99, 1);
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_STAGNATED, "{message}");
    assert!(message.contains("p = 0") && !message.contains("round-off"), "{message}");
}

/// If the tolerance is below the round-off of numbers near 1, the message names the tolerance, not the offset of the distances.
#[test]
fn a_tolerance_below_round_off_is_named() {
    let mut call = Call::new();
    call.options.known.tolerance = 1e-30;
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_STAGNATED, "{message}");
    assert!(message.contains("round-off of double precision") && !message.contains("nearer"), "{message}");
}

/// A fixed contact area may carry a tensile force, also on a handle whose set-up had a compressive one.
#[test]
fn a_fixed_contact_area_may_be_pulled() {
    let handle = Call::new().new_handle();
    for through in [Through::Solve, Through::SolverNew, Through::SolverSolve, Through::SolverSolveBatch] {
        let mut call = Call::new();
        (call.scene.known.load, call.scene.known.force) = (CONTACT_NORMAL_PRESCRIBED_FORCE, -5.0);
        call.fix_contact();
        let (status, message) = call.run(through, handle);
        assert_eq!(status, CONTACT_NORMAL_OK, "{through:?}: {message}");
        if through != Through::SolverNew {
            assert!(
                (call.report.known.normal.force + 5.0).abs() <= 1e-9,
                "{through:?}: {}",
                call.report.known.normal.force
            );
        }
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}

#[test]
fn a_valid_call_writes_every_output() {
    let mut call = Call::new();
    let before = call.outputs();
    assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
    call.assert_all_written();
    assert!(call.outputs() != before);
}

#[test]
fn every_bad_scene_and_option_is_refused() {
    let handle = Call::new().new_handle();
    for row in SET_UP {
        // The set-up of a handle needs no surface.
        let has_surface = row.0 != ["undeformed_distance"];
        for through in [Through::Solve, Through::SolverNew, Through::SolverSolve, Through::SolverSolveBatch] {
            if has_surface || through != Through::SolverNew {
                refused(row, through, handle);
            }
        }
        // A search for an accuracy refuses all coefficients of the caller.
        if !row.0.iter().any(|word| ["influence", "coefficients", "row_tables"].contains(word)) {
            refused(row, Through::ToAccuracy, null_mut());
        }
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}

#[test]
fn every_bad_guess_and_output_is_refused() {
    let handle = Call::new().new_handle();
    for row in SOLVES {
        for through in [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch] {
            refused(row, through, handle);
        }
    }
    // The handle can still solve after all refusals.
    for through in [Through::SolverSolve, Through::SolverSolveBatch] {
        let mut call = Call::new();
        assert_eq!(call.run(through, handle).0, CONTACT_NORMAL_OK);
        call.assert_all_written();
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}
