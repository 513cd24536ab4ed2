//! Marks of the Fortran module, by which it tells the library of wrong arguments: the text of each, and which values are no marks.

use super::*;

fn mark(procedure: i64, kind: i64, about: i32) -> i64 {
    -(MARK << 48 | procedure << 40 | kind << 32 | i64::from(about as u32))
}

#[test]
fn a_mark_names_the_procedure_and_what_is_wrong() {
    for (procedure, kind, about, said) in [
        (8, WRONG_BODY, -3, "set_coating: body is -3; it must be 1 or 2"),
        (1, NOT_ASSOCIATED, 2, "set_undeformed_distance: h is not associated (or not allocated)"),
        (17, WRONG_SHAPE, 6, "solver_solve_batch: statuses has another shape than it must have"),
        (13, NOT_ASSOCIATED, 15, "set_friction_results: yield_limit is not associated (or not allocated)"),
        (21, WRONG_SHAPE, 3, "flash_temperature: temperature has another shape than it must have"),
        (22, WRONG_SHAPE, 9, "frictional_wear: coefficients has another shape than it must have"),
    ] {
        assert_eq!(read(mark(procedure, kind, about)), Some(format!("contact_normal_{said}")));
    }
}

#[test]
fn other_sizes_are_no_marks() {
    let wrong = [
        mark(0, 1, 1),
        mark(23, 1, 1),
        mark(1, 0, 1),
        mark(1, 4, 1),
        mark(1, NOT_ASSOCIATED, 0),
        mark(1, NOT_ASSOCIATED, 3),
    ];
    for declared in [0, 8, 168, -1, -168, i64::MAX, i64::MIN].into_iter().chain(wrong) {
        assert_eq!(read(declared), None, "{declared}");
    }
}
