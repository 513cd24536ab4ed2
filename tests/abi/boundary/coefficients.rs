//! The caller's coefficients: their scale, another table for a handle, and tables that a handle refuses.

use std::ptr::{null, null_mut};

use super::{assert_refused, solved, Handle};
use crate::call::{last_error, Call, Through, CX, CY, MX, MY};
use contact_normal::ffi::*;

const INVALID: i32 = CONTACT_NORMAL_INVALID_ARGUMENT;
const HANDLES: [Through; 2] = [Through::SolverSolve, Through::SolverSolveBatch];

/// Gives the handle the table of the call.
fn set_influence(handle: &Handle, call: &Call) -> (i32, String) {
    // SAFETY: a handle, and a struct with its table.
    let status = unsafe { contact_normal_solver_set_influence(handle.0, &call.influence.known, null()) };
    (status, if status == CONTACT_NORMAL_OK { String::new() } else { last_error() })
}

/// A call with a table of the half-space times `factor`, changed by `skew` so that it is neither even nor symmetric.
fn with_table(factor: f64, skew: f64) -> Call {
    let mut call = Call::new();
    call.use_table();
    call.table.iter_mut().for_each(|value| *value *= factor);
    let at = CY * 2 * CX + CX;
    call.table[at + 1] *= 1.0 + skew;
    call
}

#[test]
fn a_scale_multiplies_every_coefficient() {
    for scale in [0.25, 3.7] {
        let mut scaled = with_table(1.0, 0.0);
        scaled.use_table().scale = scale;
        let mut multiplied = with_table(scale, 0.0);
        solved(&mut scaled);
        solved(&mut multiplied);
        assert_eq!(scaled.pressure, multiplied.pressure, "influence times {scale}");
        let mut scaled = Call::new();
        scaled.use_row_tables().scale = scale;
        let mut multiplied = Call::new();
        multiplied.use_row_tables();
        multiplied.tables.iter_mut().for_each(|value| *value *= scale);
        solved(&mut scaled);
        solved(&mut multiplied);
        assert_eq!(scaled.pressure, multiplied.pressure, "row_tables times {scale}");
        assert!(scaled.report.known.normal.force > 0.0);
    }
}

#[test]
fn a_scale_that_is_none_is_refused() {
    for (scale, status, value) in [
        (0.0, INVALID, "0"),
        (-2.0, INVALID, "-2"),
        (f64::NAN, CONTACT_NORMAL_NOT_FINITE, "NaN"),
        (f64::INFINITY, CONTACT_NORMAL_NOT_FINITE, "inf"),
    ] {
        let mut call = Call::new();
        call.use_table().scale = scale;
        assert_refused(call.run(Through::Solve, null_mut()), status, &["influence", "scale", value]);
        let mut call = Call::new();
        call.use_row_tables().scale = scale;
        assert_refused(call.run(Through::Solve, null_mut()), status, &["row_tables", "scale", value]);
    }
    // The product of coefficient and scale overflows.
    let mut call = Call::new();
    call.set_coefficient(1, 0, 1e300);
    call.use_table().scale = 1e300;
    assert_refused(call.run(Through::Solve, null_mut()), CONTACT_NORMAL_NOT_FINITE, &["coefficients", "(1, 0)", "inf"]);
}

#[test]
fn a_handle_with_another_table_solves_as_a_new_one() {
    for method in [0, 1, 2, 3] {
        let new = |factor, skew| {
            let mut call = with_table(factor, skew);
            call.options.known.method = method;
            call
        };
        let handle = Handle::of(&mut new(1.0, 0.0));
        for through in HANDLES {
            assert_eq!(new(1.0, 0.0).run(through, handle.0).0, CONTACT_NORMAL_OK);
        }
        for (factor, skew) in [(2.5, 0.0), (1.0, 0.1), (1.0, 0.0)] {
            let mut expected = new(factor, skew);
            solved(&mut expected);
            assert_eq!(set_influence(&handle, &new(factor, skew)), (CONTACT_NORMAL_OK, String::new()));
            for through in HANDLES {
                for names_it in [true, false] {
                    let mut call = new(factor, skew);
                    if !names_it {
                        call.scene.known.influence = null();
                    }
                    assert_eq!(call.run(through, handle.0), (CONTACT_NORMAL_OK, String::new()), "{factor} {skew}");
                    assert_eq!(call.pressure, expected.pressure, "method {method}, {factor} {skew}, {through:?}");
                }
            }
        }
    }
}

#[test]
fn a_layer_and_patches_stay_when_the_table_is_another() {
    let effects: [fn(&mut Call); 3] = [
        |c| c.use_layer().compliance = 1e-6,
        |c| {
            c.each.fill(1e-6);
            c.set_compliance(7, 3e-6);
        },
        |c| _ = c.use_patches([1.0, 0.5, 0.5, 1.0]),
    ];
    for (k, effect) in effects.into_iter().enumerate() {
        let new = |factor| {
            let mut call = with_table(factor, 0.0);
            effect(&mut call);
            call
        };
        let handle = Handle::of(&mut new(1.0));
        assert_eq!(set_influence(&handle, &new(2.0)).0, CONTACT_NORMAL_OK);
        let (mut call, mut expected) = (new(2.0), new(2.0));
        assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()));
        solved(&mut expected);
        assert_eq!(call.pressure, expected.pressure, "effect {k}");
    }
}

#[test]
fn the_last_result_is_a_start_for_another_table() {
    let handle = Handle::of(&mut with_table(1.0, 0.0));
    assert_eq!(with_table(1.0, 0.0).run(Through::SolverSolve, handle.0).0, CONTACT_NORMAL_OK);
    assert_eq!(set_influence(&handle, &with_table(1.3, 0.0)).0, CONTACT_NORMAL_OK);
    let mut call = with_table(1.3, 0.0);
    call.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
    assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()));
    // e = h - approach + A p by direct sums is 0 in contact, within the tolerance relative to its size.
    let (mut squares, mut scale) = (0.0, 0.0);
    for i in (0..MX * MY).filter(|&i| call.contact[i] == 1) {
        let u = (0..MX * MY).map(|j| {
            let (kx, ky) = (CX + i % MX - j % MX, CY + i / MX - j / MX);
            call.table[ky * 2 * CX + kx] * call.pressure[j]
        });
        let distance = call.h[i] - call.scene.known.approach;
        squares += (distance + u.sum::<f64>()).powi(2);
        scale += distance.powi(2);
    }
    // The tolerance of 1e-6, and the round-off of sums of 30 terms.
    assert!(scale > 0.0 && (squares / scale).sqrt() <= 1e-6 + 30.0 * f64::EPSILON, "{squares:e} {scale:e}");
}

/// The status, the words of the message, and the change that causes them.
type Change = (i32, &'static [&'static str], fn(&mut Call));

#[test]
fn what_cannot_be_another_table_is_refused_and_changes_nothing() {
    let plain = Handle::of(&mut Call::new());
    assert_refused(set_influence(&plain, &with_table(1.0, 0.0)), INVALID, &["influence", "without"]);
    let mut tables = Call::new();
    tables.use_row_tables();
    let of_rows = Handle::of(&mut tables);
    assert_refused(set_influence(&of_rows, &with_table(1.0, 0.0)), INVALID, &["influence", "without"]);

    let handle = Handle::of(&mut with_table(1.0, 0.0));
    let changes: [Change; 6] = [
        (INVALID, &["cx", "5", "mx = 6"], |c| c.influence.known.cx = 5),
        (INVALID, &["scale", "-1"], |c| c.influence.known.scale = -1.0),
        (CONTACT_NORMAL_NULL_POINTER, &["coefficients"], |c| c.influence.known.coefficients = null()),
        (CONTACT_NORMAL_NOT_FINITE, &["(0, 0)", "NaN"], |c| c.set_coefficient(0, 0, f64::NAN)),
        (CONTACT_NORMAL_NOT_POSITIVE_DEFINITE, &["(0, 0)"], |c| c.set_coefficient(0, 0, -1.0)),
        (CONTACT_NORMAL_STRUCT_SIZE, &["influence", "struct_size"], |c| c.influence.known.struct_size = 24),
    ];
    for (status, words, change) in changes {
        let mut call = with_table(2.0, 0.0);
        change(&mut call);
        assert_refused(set_influence(&handle, &call), status, words);
    }
    // SAFETY: NULL is refused.
    unsafe {
        let call = Call::new();
        let status = contact_normal_solver_set_influence(null_mut(), &call.influence.known, null());
        assert_refused((status, last_error()), CONTACT_NORMAL_NULL_POINTER, &["solver"]);
        let status = contact_normal_solver_set_influence(handle.0, null(), null());
        assert_refused((status, last_error()), CONTACT_NORMAL_NULL_POINTER, &["influence"]);
    }
    let (mut call, mut expected) = (with_table(1.0, 0.0), with_table(1.0, 0.0));
    assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()));
    solved(&mut expected);
    assert_eq!(call.pressure, expected.pressure);
}

#[test]
fn other_coefficients_than_those_of_the_handle_are_refused() {
    let handle = Handle::of(&mut with_table(1.0, 0.0));
    let mut tables = Call::new();
    tables.use_row_tables();
    let of_rows = Handle::of(&mut tables);
    for through in HANDLES {
        assert_eq!(with_table(1.0, 0.0).run(through, handle.0), (CONTACT_NORMAL_OK, String::new()));
        let mut other = with_table(1.0, 1e-12);
        assert_refused(
            other.run(through, handle.0),
            CONTACT_NORMAL_INFLUENCE_CHANGED,
            &["influence", "contact_normal_solver_set_influence"],
        );
        let mut scaled = with_table(1.0, 0.0);
        scaled.use_table().scale = 2.0;
        assert_refused(
            scaled.run(through, handle.0),
            CONTACT_NORMAL_INFLUENCE_CHANGED,
            &["influence", "contact_normal_solver_set_influence"],
        );

        let mut same = Call::new();
        same.use_row_tables();
        assert_eq!(same.run(through, of_rows.0), (CONTACT_NORMAL_OK, String::new()));
        let mut other = Call::new();
        other.set_in_row(2, 1, 3, 1e-7);
        assert_refused(other.run(through, of_rows.0), CONTACT_NORMAL_INFLUENCE_CHANGED, &["row_tables", "other"]);
        // The effects of a scene are also checked for a handle that has the caller's coefficients.
        let mut bad = with_table(1.0, 0.0);
        bad.use_limit().limit = f64::NAN;
        assert_refused(bad.run(through, handle.0), CONTACT_NORMAL_NOT_FINITE, &["limit", "NaN"]);
    }
}
