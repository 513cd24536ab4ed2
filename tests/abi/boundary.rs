//! What the header promises at the boundary of the library: sizes of structs, overlaps, callbacks, the caller's coefficients, and outputs.

mod callbacks;
mod coefficients;
mod outputs;
mod overlaps;
mod structs;

use std::ptr::null_mut;

use crate::call::{Call, Through};
use contact_normal::ffi::*;

/// The functions of the C ABI that solve a scene.
const SOLVES: [Through; 3] = [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch];

/// A handle that is freed at the end of its test.
struct Handle(*mut contact_normal_solver);

impl Handle {
    fn of(call: &mut Call) -> Handle {
        Handle(call.new_handle())
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: made by a call, freed once.
        unsafe { contact_normal_solver_free(self.0) };
    }
}

/// Solves without a handle, and asserts the status OK.
fn solved(call: &mut Call) {
    assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_OK, String::new()));
}

/// Asserts that a call was refused with this status and a message with these words.
fn assert_refused(outcome: (i32, String), status: i32, words: &[&str]) {
    let (got, message) = outcome;
    assert_eq!(got, status, "{words:?}: {message}");
    words.iter().for_each(|word| assert!(message.contains(word), "\"{message}\" does not say {word}"));
}
