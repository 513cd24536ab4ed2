//! The outputs of a call must not overlap with any of its other inputs and outputs. Each function refuses this.

use std::ptr::{null, null_mut};

use super::{assert_refused, Handle, SOLVES};
use crate::call::{initialised, last_error, Call, Through, MX, MY};
use contact_normal::ffi::*;

const INVALID: i32 = CONTACT_NORMAL_INVALID_ARGUMENT;
const N: usize = MX * MY;
const HALF: [f64; 4] = [1.0, 0.5, 0.5, 1.0];

/// The names in the message, and the change that makes two arrays overlap.
type Row = (&'static [&'static str], fn(&mut Call));

#[rustfmt::skip]
const ROWS: &[Row] = &[
    (&["pressure", "displacement"], |c| c.fields.known.displacement = c.fields.known.pressure),
    (&["pressure", "deformed_distance"], |c| c.fields.known.pressure = c.fields.known.deformed_distance),
    // Arrays that overlap by one element, at either end.
    (&["pressure", "displacement"], |c| c.fields.known.pressure = c.fields.known.displacement.wrapping_add(N - 1)),
    (&["pressure", "deformed_distance"], |c| {
        c.fields.known.pressure = c.fields.known.deformed_distance.wrapping_add(N - 1);
        c.fields.known.displacement = null_mut();
    }),
    (&["contact", "pressure"], |c| c.fields.known.contact = c.fields.known.pressure.cast::<i32>().wrapping_add(2 * N - 1)),
    (&["ledger", "pressure"], |c| c.fields.known.pressure = c.report.known.ledger.cast()),
    // An overlap with the last row of the ledger.
    (&["ledger", "contact"], |c| c.fields.known.contact = c.report.known.ledger.wrapping_add(4).cast::<i32>().wrapping_sub(1)),
    (&["report", "pressure"], |c| c.fields.known.pressure = (&raw mut c.report.known).cast()),
    (&["pressure", "undeformed_distance"], |c| c.fields.known.pressure = c.h.as_mut_ptr()),
    (&["deformed_distance", "undeformed_distance"], |c| c.fields.known.deformed_distance = c.h.as_mut_ptr()),
    (&["displacement", "limits"], |c| { c.set_limit(0, 1.0); c.fields.known.displacement = c.each.as_mut_ptr(); }),
    (&["displacement", "compliances"], |c| { c.set_compliance(0, 1.0); c.fields.known.displacement = c.each.as_mut_ptr(); }),
    (&["contact", "patches->patch"], |c| { c.use_patches(HALF); c.fields.known.contact = c.patch.as_mut_ptr(); }),
    (&["pressure", "factors"], |c| { c.use_patches(HALF); c.fields.known.pressure = c.factors.as_mut_ptr(); }),
    (&["pressure", "influence->coefficients"], |c| { c.use_table(); c.fields.known.pressure = c.table.as_mut_ptr(); }),
    (&["pressure", "row_tables->coefficients"], |c| { c.use_row_tables(); c.fields.known.pressure = c.tables.as_mut_ptr(); }),
    // A struct that is passed as const is never written, so that no output may overlap with it.
    (&["pressure", "scene"], |c| c.fields.known.pressure = (&raw mut c.scene.known).cast()),
    (&["pressure", "options"], |c| c.fields.known.pressure = (&raw mut c.options.known).cast()),
    (&["pressure", "fields"], |c| c.fields.known.pressure = (&raw mut c.fields.known).cast()),
    (&["pressure", "layer"], |c| c.fields.known.pressure = (c.use_layer() as *mut contact_normal_layer).cast()),
    (&["pressure", "period"], |c| { c.use_period(1, 0); c.fields.known.pressure = (&raw mut c.period.known).cast(); }),
];

#[test]
fn overlapping_arrays_are_refused_by_name() {
    let handle = Handle::of(&mut Call::new());
    for (words, change) in ROWS {
        for through in SOLVES {
            let mut call = Call::new();
            change(&mut call);
            let before = call.outputs();
            assert_refused(call.run(through, handle.0), INVALID, &[words, &["overlap"][..]].concat());
            assert!(call.outputs() == before, "{words:?} through {through:?}: outputs were written");
        }
    }
}

#[test]
fn what_is_only_read_may_overlap_and_neighbours_do_not() {
    let mut call = Call::new();
    call.set_limit(0, 1e9);
    call.use_layer().compliances = call.h.as_ptr();
    // The deformed distance and the displacement of a call lie side by side.
    assert_eq!(call.fields.known.displacement, call.fields.known.deformed_distance.wrapping_add(N));
    let handle = Handle::of(&mut call);
    for through in SOLVES {
        assert_eq!(call.run(through, handle.0), (CONTACT_NORMAL_OK, String::new()), "{through:?}");
    }
}

#[test]
fn problems_of_a_batch_share_nothing_that_is_written() {
    let mut calls = [Call::new(), Call::new()];
    let handle = Handle::of(&mut calls[0]);
    let mut statuses = [-77; 2];
    let batch = |calls: &[Call; 2], at: *mut i32| {
        let scenes = [calls[0].scene.known, calls[1].scene.known];
        let mut fields = [calls[0].fields.known, calls[1].fields.known];
        // SAFETY: structs with their arrays.
        let status = unsafe {
            contact_normal_solver_solve_batch(handle.0, 2, scenes.as_ptr(), null(), fields.as_mut_ptr(), null_mut(), at)
        };
        (status, last_error())
    };
    let statuses = statuses.as_mut_ptr();
    // Two scenes may share inputs.
    calls[1].scene.known.undeformed_distance = calls[0].h.as_ptr();
    assert_eq!(batch(&calls, statuses).0, CONTACT_NORMAL_OK);
    // Refused: an output of one problem is an input of the other.
    calls[1].scene.known.undeformed_distance = calls[0].fields.known.pressure;
    assert_refused(batch(&calls, statuses), INVALID, &["pressure of problem 0", "undeformed_distance of problem 1"]);
    calls[1].scene.known.undeformed_distance = calls[1].h.as_ptr();
    calls[0].fields.known.contact = calls[1].fields.known.contact.wrapping_add(N - 1);
    assert_refused(batch(&calls, statuses), INVALID, &["contact of problem 0", "contact of problem 1"]);
    calls[0].fields.known.contact = calls[0].contact.as_mut_ptr();
    let inside = calls[1].fields.known.contact;
    assert_refused(batch(&calls, inside), INVALID, &["statuses", "contact of problem 1"]);
}

#[test]
fn the_other_calls_refuse_overlaps_too() {
    // Refused: the accuracy struct lies within the first row of the ledger.
    let mut call = Call::new();
    let mut both = [0u64; 64];
    let row = both.as_mut_ptr().cast::<contact_normal_ledger_row>();
    (call.report.known.ledger, call.report.known.ledger_capacity) = (row, 1);
    // SAFETY: room for both, and the row's size comes before the accuracy.
    let status = unsafe {
        contact_normal_ledger_row_init(row);
        let accuracy = both.as_mut_ptr().add(9).cast();
        contact_normal_accuracy_init(accuracy);
        contact_normal_solve_to_accuracy(&call.scene.known, null(), accuracy, null_mut(), &mut call.report.known)
    };
    assert_refused((status, last_error()), INVALID, &["ledger", "accuracy", "overlap"]);
    let mut call = Call::new();
    // SAFETY: the pointer is refused before anything is written.
    let status = unsafe {
        let inside = (&raw mut call.scene.known.influence).cast();
        contact_normal_solver_new(&raw const call.scene.known, null(), inside)
    };
    assert_refused((status, last_error()), INVALID, &["solver", "scene", "overlap"]);

    let handle = Handle::of(&mut call);
    assert_eq!(call.run(Through::SolverSolve, handle.0).0, CONTACT_NORMAL_OK);
    let mut fields = initialised(contact_normal_fields_init);
    (fields.pressure, fields.displacement) = (call.pressure.as_mut_ptr(), call.pressure.as_mut_ptr());
    // SAFETY: a handle, and a struct with its arrays.
    let status = unsafe { contact_normal_solver_fields(handle.0, &mut fields) };
    assert_refused((status, last_error()), INVALID, &["pressure", "displacement", "overlap"]);
}

/// Every placement of four arrays in memory of 9 places of 8 bytes, compared with the definition of an overlap. The arrays are the distances (3
/// places, read), the factor of one patch (1 place, read), pressures (3 places, written) and the contact area (a place and a half, written).
#[test]
fn what_is_written_overlaps_with_nothing() {
    const PLACES: usize = 9;
    let patch = [0i32; 3];
    let mut refused = [0, 0];
    for k in 0..7 * PLACES * 7 * (PLACES - 1) {
        let (h, factor, pressure, contact) = (k % 7, k / 7 % PLACES, k / (7 * PLACES) % 7, k / (49 * PLACES));
        // Regions in halves of a place: start, end, and whether the array is written.
        let regions = [(h, 6, false), (factor, 2, false), (pressure, 6, true), (contact, 3, true)];
        let regions = regions.map(|(place, length, is_written)| (2 * place, 2 * place + length, is_written));
        let overlap = (0..4).any(|i| {
            let (a, b, first) = regions[i];
            regions[..i].iter().any(|&(c, d, second)| a < d && c < b && (first || second))
        });
        let mut places = [1.0; PLACES];
        let at = |place: usize, places: &mut [f64; PLACES]| places[place..].as_mut_ptr();
        let mut patches = initialised(contact_normal_patches_init);
        (patches.count, patches.patch, patches.factors) = (1, patch.as_ptr(), at(factor, &mut places));
        let mut scene = initialised(contact_normal_scene_init);
        (scene.mx, scene.my, scene.dx, scene.dy, scene.approach) = (3, 1, 1.0, 1.0, 0.0);
        (scene.shear_modulus, scene.undeformed_distance) = ([1.0; 2], at(h, &mut places));
        scene.patches = &patches;
        let mut fields = initialised(contact_normal_fields_init);
        (fields.pressure, fields.contact) = (at(pressure, &mut places), at(contact, &mut places).cast());
        // SAFETY: structs with their arrays.
        let status = unsafe { contact_normal_solve(&scene, null(), &mut fields, null_mut()) };
        assert_eq!(status, if overlap { INVALID } else { CONTACT_NORMAL_OK }, "{regions:?}: {}", last_error());
        refused[usize::from(overlap)] += 1;
    }
    assert!(refused.iter().all(|count| *count > 0), "{refused:?}");
}
