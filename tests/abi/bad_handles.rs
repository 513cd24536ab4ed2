//! Input that calls with handles, batches and searches for an accuracy refuse, and their messages.

use std::ptr::{null, null_mut};

use crate::call::{last_error, Call, Through, CX, CY};
use crate::rows::*;
use contact_normal::ffi::*;

use crate::bad_input::refused;

#[test]
fn a_handle_is_for_its_own_grid_and_bodies() {
    #[rustfmt::skip]
    let rows: &[Row] = &[
        (&["solver"], NULL, |_| {}),
        (&["mx is 5", "set up for 6"], INVALID, |c| c.scene.known.mx = 5),
        (&["my is 4", "set up for 5"], INVALID, |c| c.scene.known.my = 4),
        (&["dx is 0.75", "set up for 0.5"], INVALID, |c| c.scene.known.dx = 0.75),
        (&["shear_modulus[1] is 80000", "set up for"], INVALID, |c| c.scene.known.shear_modulus[1] = 80000.0),
        (&["influence"], INVALID, |c| { c.use_table(); }),
        (&["row_tables", "without"], INVALID, |c| { c.use_row_tables(); }),
        (&["layer", "without"], INVALID, |c| c.use_layer().compliance = 1e-6),
        (&["period"], INVALID, |c| c.use_period(1, 0)),
        (&["patches", "without"], INVALID, |c| { c.use_patches(HALF); }),
        (&["smoother"], INVALID, |c| c.use_cycle().smoother = CONTACT_NORMAL_SMOOTHER_JACOBI),
        (&["threads is 2", "set up for 1"], INVALID, |c| c.options.known.threads = 2),
        (&["coarsest is 3", "set up for 4"], INVALID, |c| c.use_cycle().coarsest = 3),
    ];
    let handle = Call::new().new_handle();
    for through in [Through::SolverSolve, Through::SolverSolveBatch] {
        refused(&rows[0], through, null_mut());
        rows[1..].iter().for_each(|row| refused(row, through, handle));
    }
    // SAFETY: made above; NULL is ignored.
    unsafe {
        assert_eq!(contact_normal_solver_free(handle), CONTACT_NORMAL_OK);
        assert_eq!(contact_normal_solver_free(null_mut()), CONTACT_NORMAL_OK);
        let call = Call::new();
        let status = contact_normal_solver_new(&call.scene.known, null(), null_mut());
        assert_eq!((status, last_error().contains("solver")), (NULL, true));
    }
}

unsafe extern "C" fn incomplete(mx: i32, my: i32, _: f64, _: f64, h: *mut f64, _: *mut libc::c_void) -> i32 {
    // A callback that leaves the last element without a value.
    (0..(mx * my - 1) as usize).for_each(|i| unsafe { h.add(i).write(0.01 * i as f64) });
    0
}

unsafe extern "C" fn give_up(_: i32, _: i32, _: f64, _: f64, _: *mut f64, _: *mut libc::c_void) -> i32 {
    1
}

#[test]
fn what_only_an_accuracy_refuses() {
    #[rustfmt::skip]
    let rows: &[Row] = &[
        (&["accuracy"], NULL, |c| c.without = "accuracy"),
        (&["target", "0"], INVALID, |c| c.accuracy.known.target = 0.0),
        (&["target", "-0.001"], INVALID, |c| c.accuracy.known.target = -1e-3),
        (&["target", "1", "between 0 and 1"], INVALID, |c| c.accuracy.known.target = 1.0),
        (&["target", "3"], INVALID, |c| c.accuracy.known.target = 3.0),
        (&["max_pressure_target", "1"], INVALID, |c| c.accuracy.known.max_pressure_target = 1.0),
        (&["max_pressure_target", "NaN"], NOT_FINITE, |c| c.accuracy.known.max_pressure_target = NAN),
        (&["contact_area_target", "20"], INVALID, |c| c.accuracy.known.contact_area_target = 20.0),
        (&["target", "NaN"], NOT_FINITE, |c| c.accuracy.known.target = NAN),
        (&["target", "inf"], NOT_FINITE, |c| c.accuracy.known.target = INF),
        (&["max_seconds", "-1"], INVALID, |c| c.accuracy.known.max_seconds = -1.0),
        (&["max_seconds", "NaN"], NOT_FINITE, |c| c.accuracy.known.max_seconds = NAN),
        (&["max_seconds", "inf"], NOT_FINITE, |c| c.accuracy.known.max_seconds = INF),
        (&["max_bytes", "-5"], INVALID, |c| c.accuracy.known.max_bytes = -5),
        (&["max_elements", "-1"], INVALID, |c| c.accuracy.known.max_elements = -1),
        (&["max_elements", "2147483648"], INVALID, |c| c.accuracy.known.max_elements = 1 << 31),
        (&["surface", "undeformed_distance", "(5, 4)", "NaN"], NOT_FINITE, |c| c.accuracy.known.surface = Some(incomplete)),
        (&["influence"], CONTACT_NORMAL_UNSUPPORTED, |c| { c.use_table(); }),
        (&["row_tables"], CONTACT_NORMAL_UNSUPPORTED, |c| { c.use_row_tables(); }),
        (&["active_set", "FIXED"], CONTACT_NORMAL_UNSUPPORTED, |c| c.fix_contact()),
        (&["initial_guess"], INVALID, |c| c.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN),
        (&["initial_guess"], INVALID, |c| c.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS),
        (&["ledger", "ledger_capacity"], NULL, |c| c.report.known.ledger = null_mut()),
        (&["ledger_capacity", "-1"], INVALID, |c| c.report.known.ledger_capacity = -1),
    ];
    rows.iter().for_each(|row| refused(row, Through::ToAccuracy, null_mut()));
}

#[test]
fn an_accuracy_that_is_not_reached_says_the_best() {
    // The target is below round-off, so that the best result is that of the first grid.
    let mut call = Call::new();
    call.accuracy.known.target = 1e-15;
    let (status, message) = call.run(Through::ToAccuracy, null_mut());
    let accuracy = &call.accuracy.known;
    assert_eq!((status, accuracy.mx, accuracy.my, accuracy.dx), (CONTACT_NORMAL_STAGNATED, 6, 5, 0.5), "{message}");
    assert!(["target", "round-off", "best reached", "6 x 5"].iter().all(|word| message.contains(word)), "{message}");
    assert!(call.report.known.normal.force > 0.0 && accuracy.seconds > 0.0);

    // If the surface callback cancels before the first grid, there is no result, and the message says so.
    let mut call = Call::new();
    call.accuracy.known.surface = Some(give_up);
    call.scene.known.undeformed_distance = null();
    let (status, message) = call.run(Through::ToAccuracy, null_mut());
    let accuracy = &call.accuracy.known;
    assert_eq!((status, accuracy.mx, accuracy.reached), (CONTACT_NORMAL_CANCELLED, 0, -1.0), "{message}");
    assert!(message.contains("surface") && call.report.known.ledger_rows == 0, "{message}");
}

#[test]
fn fields_of_a_handle_are_those_of_its_last_solve() {
    let mut call = Call::new();
    let handle = call.new_handle();
    // SAFETY: a handle or NULL; fields with room for the grid.
    let copy = |handle, fields: *mut contact_normal_fields| unsafe { contact_normal_solver_fields(handle, fields) };
    let before = call.outputs();
    let fields = &raw mut call.fields.known;
    assert_eq!((copy(null_mut(), fields), last_error().contains("solver")), (NULL, true));
    assert_eq!((copy(handle, null_mut()), last_error().contains("fields")), (NULL, true));
    assert_eq!((copy(handle, fields), last_error().contains("no result")), (INVALID, true));
    assert!(call.outputs() == before);
    assert_eq!(call.run(Through::SolverSolve, handle).0, CONTACT_NORMAL_OK);
    let solved = call.outputs();
    call.pressure.fill(NAN);
    call.contact.fill(-1);
    let fields = &raw mut call.fields.known;
    assert_eq!(copy(handle, fields), CONTACT_NORMAL_OK);
    assert!(call.outputs() == solved);
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}

unsafe extern "C" fn go_on(_: *const contact_normal_progress, _: *mut libc::c_void) -> i32 {
    0
}

#[test]
fn what_only_a_batch_refuses() {
    #[rustfmt::skip]
    let rows: &[Row] = &[
        (&["initial_guess", "PREVIOUS"], INVALID, |c| c.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS),
        (&["progress"], CONTACT_NORMAL_UNSUPPORTED, |c| c.options.known.progress = Some(go_on)),
        (&["pressure of problem 0", "displacement of problem 0"], INVALID, |c| c.fields.known.displacement = c.pressure.as_mut_ptr()),
    ];
    let handle = Call::new().new_handle();
    rows.iter().for_each(|row| refused(row, Through::SolverSolveBatch, handle));
    // SAFETY: made above; no array is looked at when there are no, or fewer than no, problems.
    unsafe {
        let batch = |count| {
            let (fields, reports, statuses) = (null_mut(), null_mut(), null_mut());
            contact_normal_solver_solve_batch(handle, count, null(), null(), fields, reports, statuses)
        };
        assert_eq!((batch(-3), last_error().contains("count is -3")), (INVALID, true));
        assert_eq!((batch(2), last_error().contains("scenes")), (NULL, true));
        assert_eq!(batch(0), CONTACT_NORMAL_OK);
        contact_normal_solver_free(handle);
    }
}

#[test]
fn a_handle_with_a_table_needs_neither_the_table_again_nor_elastic_constants() {
    let mut call = Call::new();
    call.use_table();
    call.scene.known.shear_modulus = [NAN; 2];
    let handle = call.new_handle();
    for keep_table in [true, false] {
        if !keep_table {
            call.scene.known.influence = null();
        }
        for through in [Through::SolverSolve, Through::SolverSolveBatch] {
            assert_eq!(call.run(through, handle), (CONTACT_NORMAL_OK, String::new()), "{keep_table}");
        }
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}

#[test]
fn a_handle_with_row_tables_needs_neither_the_tables_again_nor_elastic_constants() {
    let mut call = Call::new();
    call.use_row_tables();
    call.scene.known.shear_modulus = [NAN; 2];
    let handle = call.new_handle();
    call.scene.known.row_tables = null();
    for through in [Through::SolverSolve, Through::SolverSolveBatch] {
        assert_eq!(call.run(through, handle), (CONTACT_NORMAL_OK, String::new()));
        let row: Row = (&["influence", "without"], INVALID, |c| {
            c.use_table();
        });
        refused(&row, through, handle);
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
}

#[test]
fn a_method_for_symmetric_coefficients_refuses_others() {
    let row: Row = (&["PROJECTED_CG", "symmetric"], CONTACT_NORMAL_UNSUPPORTED, |c| {
        c.set_coefficient(1, 0, 0.0);
        c.options.known.method = CONTACT_NORMAL_METHOD_PROJECTED_CG;
    });
    refused(&row, Through::Solve, null_mut());
}

#[test]
fn stopping_early_has_a_message() {
    let mut call = Call::new();
    (call.options.known.max_cycles, call.options.known.tolerance) = (1, 1e-14);
    call.options.known.method = CONTACT_NORMAL_METHOD_NORM;
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_ITERATION_LIMIT);
    assert!(message.contains("max_cycles") && message.contains('1'), "\"{message}\"");
    call.assert_all_written();
}

#[test]
fn closed_forms_refuse_bad_input() {
    let (g, nu) = ([82000.0; 2], [0.28; 2]);
    let hertz = |x, y, g: *const f64, nu: *const f64, load, amount, words: &[&str], expected: i32| {
        let untouched = contact_normal_hertz_solution { force: -77.0, ..Default::default() };
        let mut solution = untouched;
        // SAFETY: NULL or two values; room for a solution.
        let status = unsafe { contact_normal_hertz(x, y, g, nu, load, amount, &mut solution) };
        assert_eq!((status, solution.force), (expected, untouched.force), "{words:?}: {}", last_error());
        assert!(words.iter().all(|word| last_error().contains(word)), "{words:?}: {}", last_error());
    };
    let (g, nu) = (g.as_ptr(), nu.as_ptr());
    hertz(1.0, 2.0, null(), nu, APPROACH, 0.1, &["shear_modulus"], NULL);
    hertz(1.0, 2.0, g, null(), APPROACH, 0.1, &["poisson_ratio"], NULL);
    hertz(1.0, 2.0, [1.0, NAN].as_ptr(), nu, APPROACH, 0.1, &["shear_modulus[1]", "NaN"], NOT_FINITE);
    hertz(1.0, 2.0, [INF, INF].as_ptr(), nu, APPROACH, 0.1, &["shear_modulus"], INVALID);
    hertz(1.0, 2.0, g, [0.6, 0.3].as_ptr(), APPROACH, 0.1, &["poisson_ratio[0]", "0.6"], INVALID);
    hertz(0.0, 2.0, g, nu, APPROACH, 0.1, &["curvature_x", "0"], INVALID);
    hertz(1.0, -2.0, g, nu, APPROACH, 0.1, &["curvature_y", "-2"], INVALID);
    hertz(NAN, 2.0, g, nu, APPROACH, 0.1, &["curvature_x", "NaN"], NOT_FINITE);
    hertz(1.0, INF, g, nu, FORCE, 0.1, &["curvature_y", "inf"], NOT_FINITE);
    hertz(1.0, 2.0, g, nu, UNSET, 0.1, &["load", "0"], INVALID);
    hertz(1.0, 2.0, g, nu, APPROACH, -0.1, &["amount", "approach", "-0.1"], INVALID);
    hertz(1.0, 2.0, g, nu, FORCE, 0.0, &["amount", "force", "0"], INVALID);
    hertz(1.0, 2.0, g, nu, FORCE, NAN, &["amount", "force", "NaN"], NOT_FINITE);
    hertz(1e-300, 1e300, g, nu, FORCE, 1e300, &["curvature_x", "curvature_y", "range"], INVALID);
    // SAFETY: as above, and a NULL result.
    let status = unsafe { contact_normal_hertz(1.0, 2.0, g, nu, APPROACH, 0.1, null_mut()) };
    assert_eq!((status, last_error().contains("solution")), (NULL, true));

    let table = |cx, cy, dx, dy, g: *const f64, nu: *const f64, words: &[&str], expected: i32| {
        let mut values = vec![-77.0; 4 * CX * CY];
        // SAFETY: NULL or two values; room for the one valid size, which no row has.
        let status = unsafe { contact_normal_influence_half_space(cx, cy, dx, dy, g, nu, values.as_mut_ptr()) };
        assert_eq!(status, expected, "{words:?}: {}", last_error());
        assert!(words.iter().all(|word| last_error().contains(word)), "{words:?}: {}", last_error());
        assert!(values.iter().all(|&value| value == -77.0), "{words:?}: written");
    };
    table(0, 3, 1.0, 1.0, g, nu, &["cx", "0"], INVALID);
    table(3, -1, 1.0, 1.0, g, nu, &["cy", "-1"], INVALID);
    table(i32::MAX, i32::MAX, 1.0, 1.0, g, nu, &["cx * cy", "2147483647"], INVALID);
    table(3, 3, 0.0, 1.0, g, nu, &["dx", "0"], INVALID);
    table(3, 3, 1.0, -1.0, g, nu, &["dy", "-1"], INVALID);
    table(3, 3, 1.0, NAN, g, nu, &["dy", "NaN"], NOT_FINITE);
    table(3, 3, 1.0, 1.0, null(), nu, &["shear_modulus"], NULL);
    table(3, 3, 1.0, 1.0, g, null(), &["poisson_ratio"], NULL);
    table(3, 3, 1.0, 1.0, [0.0, 1.0].as_ptr(), nu, &["shear_modulus[0]", "0"], INVALID);
    let small = [1e-200; 2];
    table(3, 3, 1e140, 1e140, small.as_ptr(), nu, &["coefficient", "range"], NOT_FINITE);
    let large = [1e200; 2];
    table(3, 3, 1e-140, 1e-140, large.as_ptr(), nu, &["coefficient", "range"], INVALID);
    // SAFETY: a NULL result.
    let status = unsafe { contact_normal_influence_half_space(3, 3, 1.0, 1.0, g, nu, null_mut()) };
    assert_eq!((status, last_error().contains("coefficients")), (NULL, true));
}

#[test]
fn inits_ignore_null_and_levels_are_checked() {
    // SAFETY: NULL is allowed; no callback.
    unsafe {
        contact_normal_scene_init(null_mut());
        contact_normal_influence_init(null_mut());
        contact_normal_layer_init(null_mut());
        contact_normal_pressure_limit_init(null_mut());
        contact_normal_period_init(null_mut());
        contact_normal_patches_init(null_mut());
        contact_normal_row_tables_init(null_mut());
        contact_normal_options_init(null_mut());
        contact_normal_fields_init(null_mut());
        contact_normal_report_init(null_mut());
        contact_normal_accuracy_init(null_mut());
        contact_normal_friction_results_init(null_mut());
        let status = contact_normal_set_log(None, 9, null_mut());
        assert_eq!((status, last_error().contains("level is 9")), (INVALID, true));
        let text = std::ffi::CStr::from_ptr(contact_normal_status_text(12345)).to_str().expect("UTF-8");
        assert!(!text.is_empty());
    }
}
