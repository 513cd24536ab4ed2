//! A panic in the core comes back as INTERNAL, with its text, untouched outputs and nothing on stderr; the next call works.

#[path = "bad_input/call.rs"]
#[allow(dead_code)] // of the bad input, the call
mod call;

use std::ptr::null_mut;
use std::sync::atomic::Ordering;

use call::{Call, Through};
use contact_normal::ffi::*;
use contact_normal::panics::BLOCKS;

/// A call whose product panics after so many blocks; true when it came to that.
fn panics_at(block: i64, call: &mut Call, through: Through, handle: *mut contact_normal_solver) -> bool {
    BLOCKS.store(block, Ordering::Relaxed);
    let before = call.outputs();
    let (status, message) = call.run(through, handle);
    if BLOCKS.swap(-1, Ordering::Relaxed) >= 0 {
        assert_eq!(status, CONTACT_NORMAL_OK, "{through:?}, block {block}: {message}");
        return false;
    }
    assert_eq!(status, CONTACT_NORMAL_INTERNAL, "{through:?}, block {block}: {message}");
    assert!(message.contains("on demand of a test") && message.contains("report"), "\"{message}\"");
    assert!(call.outputs() == before, "{through:?}, block {block}: outputs were written");
    true
}

/// One test: the demand for a panic is one for the process.
#[test]
fn a_panic_anywhere_is_a_status_and_the_next_call_works() {
    let methods = [
        CONTACT_NORMAL_METHOD_AUTO,
        CONTACT_NORMAL_METHOD_NORM,
        CONTACT_NORMAL_METHOD_MULTIGRID,
        CONTACT_NORMAL_METHOD_FULL_MULTIGRID,
    ];
    for threads in [1, 2] {
        for method in methods {
            let new = || {
                let mut call = Call::new();
                (call.options.known.method, call.options.known.threads) = (method, threads);
                call
            };
            let handle = new().new_handle();
            let mut expected = new();
            assert_eq!(expected.run(Through::SolverSolve, handle).0, CONTACT_NORMAL_OK);
            let mut panics = 0;
            for through in [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch] {
                for block in 0.. {
                    let panicked = panics_at(block, &mut new(), through, handle);
                    panics += u32::from(panicked);
                    let mut next = new();
                    assert_eq!(next.run(through, handle), (CONTACT_NORMAL_OK, String::new()), "block {block}");
                    assert_eq!(next.pressure, expected.pressure, "{through:?}, block {block}: another result");
                    if !panicked {
                        break;
                    }
                }
            }
            assert!(panics > 10, "method {method}: {panics} panics");
            // SAFETY: made above.
            unsafe { contact_normal_solver_free(handle) };
        }
    }
    let handle: *mut contact_normal_solver = null_mut();
    // SAFETY: NULL is ignored.
    unsafe { contact_normal_solver_free(handle) };
}
