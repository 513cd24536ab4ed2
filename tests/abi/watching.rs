//! Ways to end a call from outside, other than its callback: a time limit, and an integer that another thread may set. Also what handles and the
//! library report about themselves, and the memory that they keep.

use std::ffi::CString;
use std::ptr::null_mut;

use crate::call::{last_error, Call, Through};
use contact_normal::ffi::*;

const SOLVES: [Through; 3] = [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch];

/// A call that takes more than one cycle.
fn long() -> Call {
    let mut call = Call::new();
    (call.options.known.method, call.options.known.tolerance) = (CONTACT_NORMAL_METHOD_NORM, 1e-14);
    call
}

#[test]
fn a_limit_of_time_ends_a_call_with_the_best_iterate() {
    for through in SOLVES {
        let mut call = long();
        let handle = call.new_handle();
        // 1e-10 s is shorter than clocks can resolve.
        for limit in [1e-9, 1e-10, 1e-300] {
            call.options.known.max_seconds = limit;
            let (status, message) = call.run(through, handle);
            assert_eq!(status, CONTACT_NORMAL_ITERATION_LIMIT, "{through:?} {limit}: {message}");
            assert!(message.contains("max_seconds was reached"), "{through:?}: {message}");
            call.assert_all_written();
        }
        call.options.known.max_seconds = 1e9;
        assert_ne!(call.run(through, handle).0, CONTACT_NORMAL_ITERATION_LIMIT, "{through:?}");
        // SAFETY: made above.
        unsafe { contact_normal_solver_free(handle) };
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let mut call = Call::new();
        call.options.known.max_seconds = bad;
        let (status, message) = call.run(Through::Solve, null_mut());
        assert!(status < 0 && message.contains("max_seconds"), "{bad}: {status} {message}");
    }
}

#[test]
fn an_integer_that_is_set_ends_a_call() {
    for through in SOLVES {
        let mut call = long();
        let handle = call.new_handle();
        let mut stop = 1;
        call.options.known.stop = &raw const stop;
        let (status, message) = call.run(through, handle);
        assert_eq!(status, CONTACT_NORMAL_CANCELLED, "{through:?}: {message}");
        assert!(message.contains("options->stop"), "{through:?}: {message}");
        call.assert_all_written();
        stop = 0;
        call.options.known.stop = &raw const stop;
        assert_ne!(call.run(through, handle).0, CONTACT_NORMAL_CANCELLED, "{through:?}");
        // SAFETY: made above.
        unsafe { contact_normal_solver_free(handle) };
    }
}

/// Sets the integer that stops the call, as another thread would.
unsafe extern "C" fn set_stop(_: *const contact_normal_progress, user: *mut libc::c_void) -> i32 {
    // SAFETY: the test's own.
    unsafe { user.cast::<i32>().write(1) };
    0
}

/// The bill of effects that `neglect_below` computes before the solve calls `progress` and reads `stop`, too.
#[test]
fn the_bill_of_neglected_effects_calls_progress_and_reads_stop() {
    let told = |neglect_below: f64| {
        let mut grids = Vec::new();
        let mut call = Call::new();
        call.use_layer().compliance = 1e-15;
        call.options.known.neglect_below = neglect_below;
        call.options.known.progress = Some(note_grid);
        call.options.known.user = (&raw mut grids).cast();
        let (status, message) = call.run(Through::Solve, null_mut());
        assert_eq!(status, CONTACT_NORMAL_OK, "{message}");
        grids
    };
    let (with, without): (Vec<i32>, Vec<i32>) = (told(1e-3), told(0.0));
    assert!(!without.is_empty() && with.len() > without.len(), "{with:?} {without:?}");

    let (mut call, stop) = (Call::new(), 1);
    call.use_layer().compliance = 1e-15;
    call.options.known.neglect_below = 1e-3;
    call.options.known.stop = &raw const stop;
    let mut grids: Vec<i32> = Vec::new();
    call.options.known.progress = Some(note_grid);
    call.options.known.user = (&raw mut grids).cast();
    let (status, message) = call.run(Through::Solve, null_mut());
    assert!(status == CONTACT_NORMAL_CANCELLED && message.contains("options->stop"), "{status} {message}");
    // `stop` is read before the callback.
    assert!(grids.is_empty(), "{grids:?}");
}

/// A callback that records the number of columns of the grid of each cycle.
unsafe extern "C" fn note_grid(told: *const contact_normal_progress, user: *mut libc::c_void) -> i32 {
    // SAFETY: the library's struct and the test's own list.
    unsafe { (*user.cast::<Vec<i32>>()).push((*told).mx) };
    0
}

#[test]
fn the_stop_integer_is_read_after_each_cycle() {
    let (mut call, mut stop) = (long(), 0);
    call.options.known.user = (&raw mut stop).cast();
    call.options.known.stop = (&raw mut stop).cast_const();
    call.options.known.progress = Some(set_stop);
    let (status, message) = call.run(Through::Solve, null_mut());
    assert!(status == CONTACT_NORMAL_CANCELLED && message.contains("after 2 cycles"), "{status} {message}");
}

#[test]
fn a_handle_says_what_it_is() {
    let mut call = Call::new();
    let handle = call.new_handle();
    let mut info = contact_normal_solver_info::default();
    // SAFETY (all): a handle and a struct, or NULL.
    unsafe {
        assert_eq!(contact_normal_solver_query(handle, &mut info), CONTACT_NORMAL_OK);
        assert_eq!((info.mx, info.my, info.dx, info.dy), (6, 5, 0.5, 0.25));
        assert_eq!((info.threads, info.has_result), (1, 0));
        assert_eq!(call.run(Through::SolverSolve, handle).0, CONTACT_NORMAL_OK);
        assert_eq!(contact_normal_solver_query(handle, &mut info), CONTACT_NORMAL_OK);
        assert!(info.has_result == 1 && info.bytes > 0 && info.bytes == call.report.known.statistics.bytes);
        assert_eq!(contact_normal_solver_query(handle, null_mut()), CONTACT_NORMAL_NULL_POINTER);
        assert_eq!(contact_normal_solver_query(null_mut(), &mut info), CONTACT_NORMAL_NULL_POINTER);
        info.struct_size = 0;
        assert_eq!(contact_normal_solver_query(handle, &mut info), CONTACT_NORMAL_STRUCT_SIZE);
        contact_normal_solver_free(handle);
    }
}

#[test]
fn what_is_known_by_name() {
    let has = |name: &str| {
        let name = CString::new(name).expect("no zeros");
        // SAFETY: a text.
        unsafe { contact_normal_has(name.as_ptr()) }
    };
    assert_eq!(["friction", "adhesion", "max_seconds", "stop", "warnings"].map(has), [1; 5]);
    // Names of members and of functions.
    assert_eq!(["neglect_below", "error_ratio", "branch", "previous_coefficient"].map(has), [1; 4]);
    assert_eq!(["quantities", "effects_bill", "coating_compliance"].map(has), [1; 3]);
    assert_eq!(["", "Friction", "friction ", "wear", "magnetism"].map(has), [0; 5]);
    // SAFETY: NULL is no name.
    assert_eq!(unsafe { contact_normal_has(std::ptr::null()) }, 0);
}

/// Other tests of this process keep memory and threads at the same time, so that only bounds can be asserted.
#[test]
fn what_is_kept_is_released() {
    let kept = || {
        let (mut bytes, mut threads) = (-1, -1);
        // SAFETY: room for both.
        assert_eq!(unsafe { contact_normal_kept(&mut bytes, &mut threads) }, CONTACT_NORMAL_OK);
        assert!(bytes >= 0 && threads >= 0);
        (bytes, threads)
    };
    let mut call = Call::new();
    call.options.known.threads = 7;
    assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    assert!(kept().1 >= 6, "the pool of 7 threads is kept");
    assert_eq!(contact_normal_release(), CONTACT_NORMAL_OK);
    assert!(kept().1 < 6, "it is released");
    // The next solve makes the pool again.
    assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    assert_eq!(contact_normal_keep(-1), CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().contains("bytes is -1"), "{}", last_error());
    assert_eq!(contact_normal_keep(0), CONTACT_NORMAL_OK);
    assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    assert_eq!(kept().0, 0, "nothing is kept any more");
    assert_eq!(contact_normal_keep(512 << 20), CONTACT_NORMAL_OK);
    // SAFETY: NULL: not wanted.
    assert_eq!(unsafe { contact_normal_kept(null_mut(), null_mut()) }, CONTACT_NORMAL_OK);
}

/// A price list solves on small grids. A time limit and the integer end these solves, too.
#[test]
fn a_price_list_ends_at_its_limit_of_time_and_by_the_integer() {
    let (mut call, stop) = (Call::new(), 1);
    let prices = |call: &Call| {
        let (targets, mut row) = ([1e-2], contact_normal_price::default());
        let (scene, options) = (&raw const call.scene.known, &raw const call.options.known);
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe {
            let at = targets.as_ptr();
            contact_normal_cost_of_accuracy(scene, options, std::ptr::null(), 0, 1, at, &mut row)
        };
        (status, last_error(), row.target)
    };
    assert_eq!(prices(&call).0, CONTACT_NORMAL_OK);
    call.options.known.max_seconds = 1e-9;
    let (status, message, target) = prices(&call);
    assert_eq!((status, &*message, target), (CONTACT_NORMAL_ITERATION_LIMIT, "max_seconds was reached", 1e-2));
    call.options.known.max_seconds = 1e9;
    assert_eq!(prices(&call).0, CONTACT_NORMAL_OK);
    call.options.known.stop = &raw const stop;
    let (status, message, _) = prices(&call);
    assert_eq!((status, &*message), (CONTACT_NORMAL_CANCELLED, "options->stop asked for it"));
}
