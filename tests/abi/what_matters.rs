//! Quantities, the bill of effects, and neglected effects, at the C ABI: rows of the caller's size, refusals with messages that name the argument,
//! and no write beyond the caller's memory.

use std::ptr::{null, null_mut};

use crate::call::{last_error, Call, Through};
use contact_normal::ffi::*;

const WANTED: [i32; 2] = [CONTACT_NORMAL_QUANTITY_FORCE, CONTACT_NORMAL_QUANTITY_STIFFNESS];

/// A row of a newer header, with a member that this library does not know.
#[repr(C)]
#[derive(Clone, Copy)]
struct Longer<T> {
    row: T,
    unknown: i64,
}

fn of_layer() -> Call {
    let mut call = Call::new();
    call.layer.known.compliance = 1e-7;
    call.scene.known.layer = &raw const call.layer.known;
    call
}

fn quantities(call: &Call, n: i32, wanted: *const i32, coarser: i32) -> (i32, Vec<contact_normal_quantity_row>, i32) {
    let struct_size = size_of::<Longer<contact_normal_quantity_row>>() as i64;
    let row = contact_normal_quantity_row { struct_size, ..Default::default() };
    // There must be room for n rows for each of up to 13 grids, in memory without inputs.
    let mut rows = vec![Longer { row, unknown: -7 }; 26];
    // Unknown members of the first row must be 0.
    rows[0].unknown = 0;
    let mut written = -1;
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe {
        let (scene, options) = (&raw const call.scene.known, &raw const call.options.known);
        contact_normal_quantities(scene, options, n, wanted, coarser, rows.as_mut_ptr().cast(), &mut written)
    };
    if status == CONTACT_NORMAL_OK {
        let (known, beyond) = rows.split_at(written as usize);
        assert!(known.iter().all(|row| row.unknown == 0), "what is not known is 0");
        assert!(beyond.iter().all(|row| row.unknown == -7), "no row beyond is written");
    }
    (status, rows.iter().map(|row| row.row).collect(), written)
}

fn bill(call: &Call, target: f64, pairs: i32, capacity: i32) -> (i32, Vec<contact_normal_effects_row>, i32) {
    let (mut rows, mut count) = ([contact_normal_effects_row::default(); 8], -1);
    let (n, wanted) = (WANTED.len() as i32, WANTED.as_ptr());
    let to = if capacity == 0 { null_mut() } else { rows.as_mut_ptr() };
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe {
        let (scene, options) = (&raw const call.scene.known, &raw const call.options.known);
        contact_normal_effects_bill(scene, options, target, pairs, n, wanted, capacity, to, &mut count)
    };
    (status, rows.to_vec(), count)
}

#[test]
fn rows_of_quantities_have_the_callers_size() {
    let (status, rows, written) = quantities(&Call::new(), 2, WANTED.as_ptr(), 1);
    // Grids of 6 x 5 and 3 x 3 elements (5/2, rounded up).
    assert_eq!((status, written), (CONTACT_NORMAL_OK, 4), "{}", last_error());
    assert_eq!(rows[..4].iter().map(|row| (row.mx, row.my)).collect::<Vec<_>>(), [(3, 3), (3, 3), (6, 5), (6, 5)]);
    assert!(rows[..4]
        .iter()
        .zip(WANTED.iter().cycle())
        .all(|(row, wanted)| row.quantity == *wanted && row.value > 0.0));
    assert_eq!((rows[1].error, rows[1].lack), (-1.0, CONTACT_NORMAL_LACK_ONE_GRID));
    assert!(rows[3].error > 0.0 && rows[3].lack == CONTACT_NORMAL_LACK_NONE);
    // There are fewer grids than asked for.
    assert_eq!(quantities(&Call::new(), 2, WANTED.as_ptr(), 3).2, 8);
    assert_eq!(quantities(&Call::new(), 1, WANTED.as_ptr(), 12).0, CONTACT_NORMAL_OK, "{}", last_error());
}

#[test]
fn what_is_no_request_for_quantities_is_refused_by_name() {
    let call = Call::new();
    for (n, wanted, coarser, names) in [
        (0, WANTED.as_ptr(), 1, "n is 0"),
        (2, null(), 1, "quantities"),
        (2, WANTED.as_ptr(), -1, "coarser is -1"),
        (2, WANTED.as_ptr(), 13, "coarser is 13"),
        (2, [0, 12].as_ptr(), 1, "quantities[1] is 12"),
    ] {
        let (status, _, written) = quantities(&call, n, wanted, coarser);
        assert!(status < 0 && written == -1 && last_error().contains(names), "{names}: {status} {}", last_error());
    }
    // SAFETY: no rows: refused.
    let status = unsafe {
        let scene = &raw const call.scene.known;
        contact_normal_quantities(scene, null(), 2, WANTED.as_ptr(), 1, null_mut(), null_mut())
    };
    assert_eq!(status, CONTACT_NORMAL_NULL_POINTER);
}

#[test]
fn a_bill_says_how_many_rows_it_has_and_writes_as_many_as_there_is_room_for() {
    let call = of_layer();
    assert_eq!(bill(&call, 1e-2, 1, 0).0, CONTACT_NORMAL_OK);
    assert_eq!(bill(&call, 1e-2, 1, 0).2, 2);
    let (status, rows, count) = bill(&call, 1e-2, 1, 1);
    assert_eq!((status, count), (CONTACT_NORMAL_OK, 2));
    assert_eq!((rows[0].omitted, rows[0].also_omitted), (CONTACT_NORMAL_OMIT_LAYER, CONTACT_NORMAL_OMIT_NONE));
    assert!(rows[0].change > 0.0 && rows[0].seconds > 0.0 && rows[0].bytes > 0.0);
    assert_eq!(rows[1].omitted, 0, "there was no room");
    assert_eq!(bill(&Call::new(), 1e-2, 1, 8).2, 0);
    for (target, pairs, names) in [(0.0, 1, "target"), (f64::NAN, 1, "target"), (1e-2, 2, "pairs is 2")] {
        let (status, _, _) = bill(&call, target, pairs, 8);
        assert!(status < 0 && last_error().contains(names), "{names}: {status} {}", last_error());
    }
}

#[test]
fn a_bill_ends_by_the_integer() {
    let (mut call, stop) = (of_layer(), 1);
    call.options.known.stop = &raw const stop;
    assert_eq!(bill(&call, 1e-2, 1, 8).0, CONTACT_NORMAL_CANCELLED);
    assert_eq!(last_error(), "options->stop asked for it");
}

#[test]
fn a_solve_leaves_out_what_is_negligible_and_says_so() {
    let mut call = of_layer();
    call.layer.known.compliance = 1e-12;
    let none = call.run(Through::Solve, null_mut());
    assert_eq!((none.0, call.report.known.accuracy.neglected), (CONTACT_NORMAL_OK, 0));
    call.options.known.neglect_below = 1e-2;
    assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    assert_eq!(call.report.known.accuracy.neglected, 1 << (CONTACT_NORMAL_OMIT_LAYER - 1));
    let error = call.report.known.accuracy.neglected_error;
    assert!(error > 0.0 && error < 1e-2, "{error:e}");
    // A layer as compliant as the bodies stays.
    call.layer.known.compliance = 1e-4;
    assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    assert_eq!(call.report.known.accuracy.neglected, 0);
}

#[test]
fn only_a_single_solve_neglects() {
    let mut call = Call::new();
    let handle = call.new_handle();
    call.options.known.neglect_below = 1e-2;
    for through in [Through::SolverNew, Through::SolverSolve, Through::SolverSolveBatch, Through::ToAccuracy] {
        let (status, message) = call.run(through, handle);
        assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT, "{through:?}: {message}");
        assert!(message.contains("neglect_below is 0.01"), "{through:?}: {message}");
    }
    for bad in [-1.0, 1.0, f64::NAN] {
        call.options.known.neglect_below = bad;
        let (status, message) = call.run(Through::Solve, null_mut());
        assert!(status < 0 && message.contains("neglect_below"), "{bad}: {status} {message}");
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}
