//! The sizes of structs that programs of version 0.2 pass, and calls from a thread that is ending.

use std::ptr::null_mut;

use crate::call::{last_error, Call, Through};
use contact_normal::ffi::*;

/// The size of each struct in version 0.2. These numbers never change.
const SIZES: [(&str, i64); 13] = [
    ("scene", 168),
    ("influence", 32),
    ("layer", 24),
    ("pressure_limit", 24),
    ("period", 16),
    ("patches", 32),
    ("row_tables", 32),
    ("friction", 248),
    ("options", 104),
    ("cycle", 32),
    ("fields", 80),
    ("report", 704),
    ("accuracy", 112),
];

/// The size that a struct of the call declares. The scene of the call then points to the struct.
fn declared<'a>(call: &'a mut Call, name: &str) -> &'a mut i64 {
    match name {
        "scene" => &mut call.scene.known.struct_size,
        "influence" => &mut call.use_table().struct_size,
        "layer" => &mut call.use_layer().struct_size,
        "pressure_limit" => &mut call.use_limit().struct_size,
        "period" => {
            call.use_period(1, 0);
            &mut call.period.known.struct_size
        }
        "patches" => &mut call.use_patches([1.0; 4]).struct_size,
        "row_tables" => &mut call.use_row_tables().struct_size,
        "friction" => &mut call.use_friction().struct_size,
        "options" => &mut call.options.known.struct_size,
        "cycle" => &mut call.use_cycle().struct_size,
        "fields" => &mut call.fields.known.struct_size,
        "report" => &mut call.report.known.struct_size,
        _ => &mut call.accuracy.known.struct_size,
    }
}

#[test]
fn a_struct_of_version_0_2_is_accepted_and_a_shorter_one_is_not() {
    for (name, size) in SIZES {
        let through = if name == "accuracy" { Through::ToAccuracy } else { Through::Solve };
        for (size, status) in
            [(size, CONTACT_NORMAL_OK), (size - 1, CONTACT_NORMAL_STRUCT_SIZE), (size - 8, CONTACT_NORMAL_STRUCT_SIZE)]
        {
            let mut call = Call::new();
            *declared(&mut call, name) = size;
            let (got, message) = call.run(through, null_mut());
            assert_eq!(got, status, "{name} of {size} bytes: {message}");
        }
    }
}

/// A value whose destructor calls the library when other data of its thread are already destroyed.
struct AtTheEnd;

impl Drop for AtTheEnd {
    fn drop(&mut self) {
        // SAFETY: NULL is refused.
        let status = unsafe { contact_normal_solve(null_mut(), null_mut(), null_mut(), null_mut()) };
        let says_why = last_error().contains("scene");
        let (solved, _) = Call::new().run(Through::Solve, null_mut());
        // A panic would not be reported here.
        if status != CONTACT_NORMAL_NULL_POINTER || !says_why || solved != CONTACT_NORMAL_OK {
            std::process::abort();
        }
    }
}

thread_local! {
    static AT_THE_END: AtTheEnd = const { AtTheEnd };
}

#[test]
fn a_thread_that_is_ending_may_still_call() {
    let thread = std::thread::spawn(|| {
        // Destructors run in the reverse order of first use, so that the library's data of the thread are destroyed first.
        AT_THE_END.with(|_| {});
        // SAFETY: NULL is refused.
        let status = unsafe { contact_normal_solve(null_mut(), null_mut(), null_mut(), null_mut()) };
        assert_eq!(status, CONTACT_NORMAL_NULL_POINTER);
        assert!(last_error().contains("scene"));
        assert_eq!(Call::new().run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
    });
    assert!(thread.join().is_ok());
}
