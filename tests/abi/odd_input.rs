//! Unusual input that is allowed, and arrays that begin at odd addresses. Also elements at their limit, batches with friction, and fixed contact
//! areas.

use std::ptr::{null, null_mut};

use crate::call::{initialised, last_error, Call, Through, CX, CY};
use crate::rows::*;
use contact_normal::ffi::*;

#[test]
fn elements_at_the_limit_are_in_contact_with_2() {
    let mut call = Call::new();
    call.use_limit().limit = 1000.0;
    assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
    assert!(call.contact.contains(&2) && call.contact.contains(&0));
    for (p, contact) in call.pressure.iter().zip(&call.contact) {
        assert!((*contact == 2) == (*p == 1000.0) && (*contact == 0) == (*p == 0.0), "{p} {contact}");
    }
    assert_eq!(call.report.known.normal.max_pressure, 1000.0);
}

/// With a fixed area `contact` is only read, so that the codes of a host, such as 2 for slip, stay in it.
#[test]
fn codes_of_a_fixed_area_stay() {
    let mut call = Call::new();
    call.fix_contact();
    for (i, code) in call.contact.iter_mut().enumerate() {
        *code = [0, 1, 2, 7, -3][i % 5];
    }
    let codes = call.contact.clone();
    let handle = call.new_handle();
    for through in [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch] {
        assert_eq!(call.run(through, handle), (CONTACT_NORMAL_OK, String::new()));
        assert_eq!(call.contact, codes);
        assert!(call.pressure.iter().zip(&codes).all(|(p, code)| (*p == 0.0) == (*code == 0)));
    }
    // SAFETY: a handle, not used any more.
    unsafe { contact_normal_solver_free(handle) };
}

/// In packed structs an array may begin at any byte; such arrays are refused.
#[test]
fn an_array_between_two_doubles_is_refused_by_name() {
    let mut call = Call::new();
    let n = call.pressure.len();
    let mut bytes = vec![0u8; 8 * n + 16];
    let (start, pressure) = (bytes.as_mut_ptr(), call.fields.known.pressure);
    let shift = start.align_offset(8) + 4;
    call.fields.known.pressure = start.wrapping_add(shift).cast();
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(message.starts_with("pressure begins at 0x") && message.ends_with("multiple of 8 bytes"), "{message}");
    call.fields.known.pressure = pressure;
    call.scene.known.undeformed_distance = start.wrapping_add(shift).cast();
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(message.starts_with("undeformed_distance begins at 0x"), "{message}");
    // Such arrays are also refused if they are read first, and in calls without a scene.
    let mut solution = contact_normal_hertz_solution::default();
    let (odd, bodies) = (start.wrapping_add(shift).cast::<f64>(), [0.3; 2]);
    // SAFETY: arrays of two values, one of them at an odd place, which is not read.
    let status = unsafe {
        contact_normal_hertz(0.1, 0.1, odd, bodies.as_ptr(), CONTACT_NORMAL_PRESCRIBED_APPROACH, 1.0, &mut solution)
    };
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().starts_with("shear_modulus begins at 0x"), "{}", last_error());
}

/// In a batch only the problem with such an array is refused.
#[test]
fn a_problem_with_such_an_array_is_refused_by_its_number() {
    let mut call = Call::new();
    let handle = call.new_handle();
    let good = call.scene.known;
    let (mut bad, mut statuses) = (good, [9; 3]);
    let bytes = vec![0u8; 8 * call.h.len() + 16];
    bad.undeformed_distance = bytes.as_ptr().wrapping_add(bytes.as_ptr().align_offset(8) + 4).cast();
    let scenes = [good, bad, good];
    // SAFETY: three structs of one size with their arrays; the one at an odd place is not read.
    let status = unsafe {
        let (options, none) = (null(), null_mut());
        contact_normal_solver_solve_batch(handle, 3, scenes.as_ptr(), options, none, null_mut(), statuses.as_mut_ptr())
    };
    let bad = CONTACT_NORMAL_INVALID_ARGUMENT;
    assert_eq!((status, statuses), (bad, [CONTACT_NORMAL_OK, bad, CONTACT_NORMAL_OK]));
    assert!(last_error().starts_with("problem 1: undeformed_distance begins at 0x"), "{}", last_error());
    // SAFETY: a handle, not used any more.
    unsafe { contact_normal_solver_free(handle) };
}

/// Which problems a worker of a batch solves is not defined, so that no problem may continue from the last tractions. On the handle itself steps
/// continue.
#[test]
fn a_batch_refuses_friction_that_continues() {
    let mut call = Call::new();
    call.use_friction();
    let handle = call.new_handle();
    for through in [Through::SolverSolve, Through::SolverSolveBatch] {
        assert_eq!(call.run(through, handle), (CONTACT_NORMAL_OK, String::new()));
    }
    call.use_friction().continues = 1;
    let before = call.outputs();
    let (status, message) = call.run(Through::SolverSolveBatch, handle);
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(["problem 0", "friction->continues is 1", "batch"].iter().all(|word| message.contains(word)), "{message}");
    assert!(call.outputs() == before, "outputs were written");
    assert_eq!(call.run(Through::SolverSolve, handle), (CONTACT_NORMAL_OK, String::new()));
    // SAFETY: a handle, not used any more.
    unsafe { contact_normal_solver_free(handle) };
}

/// A name, and a change of a valid call.
type Change = (&'static str, fn(&mut Call));

/// Changes that make unusual but valid input.
#[rustfmt::skip]
const ACCEPTED: &[Change] = &[
    ("default options", |c| c.without = "options"),
    ("no report", |c| c.without = "report"),
    ("no fields", |c| c.without = "fields"),
    ("no fields wanted", |c| c.fields.known = initialised(contact_normal_fields_init)),
    ("no ledger", |c| (c.report.known.ledger, c.report.known.ledger_capacity) = (null_mut(), 0)),
    ("an element without surface", |c| c.h[3] = INF),
    ("one rigid body", |c| c.scene.known.shear_modulus[1] = INF),
    ("incompressible", |c| c.scene.known.poisson_ratio = [0.5; 2]),
    ("a force that is not the load", |c| c.scene.known.force = NAN),
    ("an approach that is not the load", |c| (c.scene.known.load, c.scene.known.approach) = (FORCE, NAN)),
    ("a table larger than the grid", |c| { c.use_table(); }),
    ("a layer of nothing", |c| { c.use_layer(); }),
    ("a layer, and a uniform one that is not read", |c| { c.set_compliance(0, 0.0); c.layer.known.compliance = NAN; }),
    ("no limit", |c| { c.use_limit(); }),
    ("a period", |c| c.use_period(0, 1)),
    ("patches", |c| { c.use_patches(HALF); }),
    ("row tables", |c| { c.use_row_tables(); }),
    ("elastic constants beside row tables", |c| { c.use_row_tables(); c.scene.known.shear_modulus = [NAN; 2]; }),
    ("garbage in column -cx of row tables", |c| c.set_in_row(2, 1, -(CX as i64), NAN)),
    ("elastic constants beside a table", |c| { c.use_table(); c.scene.known.shear_modulus = [NAN; 2]; }),
    ("garbage in row -cy and column -cx", |c| {
        (-(CX as i64)..CX as i64).for_each(|kx| c.set_coefficient(kx, -(CY as i64), NAN));
        (-(CY as i64)..CY as i64).for_each(|ky| c.set_coefficient(-(CX as i64), ky, INF));
    }),
];

#[test]
fn what_is_allowed_is_solved() {
    for (name, change) in ACCEPTED {
        let mut call = Call::new();
        change(&mut call);
        assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()), "{name}");
        // Without fields, or without an array for pressures, no output is written.
        if call.without == "fields" || call.fields.known.pressure.is_null() {
            assert!(call.contact.iter().all(|&c| c == -77), "{name}: written, though not wanted");
        } else {
            assert!(call.pressure.iter().all(|&p| p.is_finite() && p >= 0.0), "{name}: {:?}", call.pressure);
            assert!(call.contact.iter().all(|&c| c == 0 || c == 1), "{name}: {:?}", call.contact);
            assert!(call.contact.contains(&1), "{name}: no contact");
        }
    }
}

/// `load` need not be set if only one of approach and force is a number.
#[test]
fn the_load_is_the_one_that_is_set() {
    let pressures = |load: i32, approach: f64, force: f64| {
        let mut call = Call::new();
        (call.scene.known.load, call.scene.known.approach, call.scene.known.force) = (load, approach, force);
        assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
        call.pressure.clone()
    };
    let by_approach = pressures(CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.03, 100.0);
    let by_force = pressures(FORCE, 0.03, 100.0);
    assert!(by_approach != by_force);
    assert!(pressures(UNSET, 0.03, NAN) == by_approach && pressures(UNSET, NAN, 100.0) == by_force);
}

/// The set-up of a handle and the tangential problem of given pressures need no load.
#[test]
fn what_uses_no_load_needs_none() {
    let mut call = Call::new();
    (call.scene.known.load, call.scene.known.approach, call.scene.known.force) = (UNSET, NAN, NAN);
    let handle = call.new_handle();
    // SAFETY: a handle that nothing uses.
    assert_eq!(unsafe { contact_normal_solver_free(handle) }, CONTACT_NORMAL_OK);
    call.use_friction();
    let pressures = vec![1.0; call.h.len()];
    // SAFETY: structs that declare their size, and one pressure per element.
    let status = unsafe {
        let (scene, p) = (&raw const call.scene.known, pressures.as_ptr());
        contact_normal_solve_tangential(null_mut(), scene, p, null(), 1, null(), null_mut(), null_mut())
    };
    assert_eq!(status, CONTACT_NORMAL_OK);
}

#[test]
fn no_contact_is_no_error() {
    #[rustfmt::skip]
    let scenes: [Change; 4] = [
        ("bodies apart", |c| c.scene.known.approach = -0.5),
        ("no force", |c| (c.scene.known.load, c.scene.known.force) = (FORCE, 0.0)),
        ("no surface, approach prescribed", |c| c.h.fill(INF)),
        ("no surface, no force", |c| { c.h.fill(INF); (c.scene.known.load, c.scene.known.force) = (FORCE, 0.0); }),
    ];
    for (name, change) in scenes {
        for method in [CONTACT_NORMAL_METHOD_AUTO, CONTACT_NORMAL_METHOD_NORM, CONTACT_NORMAL_METHOD_MULTIGRID] {
            let mut call = Call::new();
            change(&mut call);
            call.options.known.method = method;
            assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()), "{name}");
            assert!(call.pressure.iter().all(|&p| p == 0.0) && call.contact.iter().all(|&c| c == 0), "{name}");
            let report = &call.report.known;
            assert_eq!(
                (report.normal.force, report.normal.contact_count, report.normal.contact_area, report.normal.residual),
                (0.0, 0, 0.0, 0.0)
            );
            assert!(
                report.normal.approach.is_finite() && report.normal.max_pressure == 0.0,
                "{name}: {}",
                report.normal.approach
            );
        }
    }
}

#[test]
fn a_fixed_area_comes_from_the_fields_whatever_the_guess() {
    // The first area has two elements, the second one two others, with the pressures of the first solve as the guess.
    let mut call = Call::new();
    call.fix_contact();
    let handle = call.new_handle();
    for (guess, elements) in
        [(CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS, [14, 15]), (CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS, [8, 9])]
    {
        call.options.known.initial_guess = guess;
        call.contact.fill(0);
        elements.iter().for_each(|&i| call.contact[i] = 1);
        assert_eq!(call.run(Through::SolverSolve, handle), (CONTACT_NORMAL_OK, String::new()));
        let found: Vec<usize> = (0..call.pressure.len()).filter(|&i| call.pressure[i] != 0.0).collect();
        assert_eq!(found, elements);
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}
