//! A callback may write into the caller's arrays during a solve, because the solve has copied what it needs.

use std::ptr::null_mut;

use crate::call::{Call, Through};
use contact_normal::ffi::*;

/// Arrays that a callback overwrites.
struct Arrays {
    numbers: Vec<(*mut f64, usize)>,
    calls: u32,
}

unsafe extern "C" fn spoil(_: *const contact_normal_progress, user: *mut libc::c_void) -> i32 {
    // SAFETY: the arrays of the call, which nothing else reads now.
    unsafe {
        let arrays = &mut *user.cast::<Arrays>();
        for &(start, n) in &arrays.numbers {
            (0..n).for_each(|i| start.add(i).write(f64::NAN));
        }
        arrays.calls += 1;
    }
    0
}

#[test]
fn nan_written_into_the_arrays_meanwhile_changes_nothing() {
    for with_table in [false, true] {
        for method in 0..=4 {
            for guess in [CONTACT_NORMAL_INITIAL_GUESS_NONE, CONTACT_NORMAL_INITIAL_GUESS_GIVEN] {
                let new = || {
                    let mut call = Call::new();
                    (call.options.known.method, call.options.known.initial_guess) = (method, guess);
                    call.pressure.fill(3.0);
                    call.contact.fill(1);
                    if with_table {
                        call.use_table();
                    }
                    call
                };
                let mut undisturbed = new();
                assert_eq!(undisturbed.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
                let mut call = new();
                let spoilt = [&mut call.h, &mut call.table, &mut call.pressure];
                let numbers = spoilt.into_iter().map(|array| (array.as_mut_ptr(), array.len())).collect();
                let mut arrays = Arrays { numbers, calls: 0 };
                call.options.known.progress = Some(spoil);
                call.options.known.user = (&raw mut arrays).cast();
                assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
                assert!(arrays.calls > 0, "method {method}: not called");
                assert_eq!(call.pressure, undisturbed.pressure, "method {method}, guess {guess}, table {with_table}");
                assert_eq!(call.report.known.normal.approach, undisturbed.report.known.normal.approach);
            }
        }
    }
}
