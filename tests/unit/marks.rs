//! Marks of the Fortran module: the text of each, and what is none.

use super::*;

fn mark(procedure: i64, kind: i64, about: i32) -> i64 {
    -(MARK << 48 | procedure << 40 | kind << 32 | i64::from(about as u32))
}

#[test]
fn a_mark_names_the_procedure_and_what_is_wrong() {
    let said = |procedure, kind, about| read(mark(procedure, kind, about)).expect("a mark");
    assert_eq!(said(8, WRONG_BODY, -3), "contact_normal_set_coating: body is -3; it must be 1 or 2");
    assert_eq!(
        said(1, NOT_ASSOCIATED, 2),
        "contact_normal_set_undeformed_distance: h is not associated (or not allocated)"
    );
    assert_eq!(
        said(17, WRONG_SHAPE, 6),
        "contact_normal_solver_solve_batch: statuses has another shape than it must have"
    );
    assert_eq!(
        said(13, NOT_ASSOCIATED, 15),
        "contact_normal_set_friction_results: yield_limit is not associated (or not allocated)"
    );
    assert_eq!(
        said(21, WRONG_SHAPE, 3),
        "contact_normal_flash_temperature: temperature has another shape than it must have"
    );
    assert_eq!(
        said(22, WRONG_SHAPE, 9),
        "contact_normal_frictional_wear: coefficients has another shape than it must have"
    );
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
