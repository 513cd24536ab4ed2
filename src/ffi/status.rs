//! The status of a call, its text, the message of the last call, and versions.

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString};

use libc::c_char;

use crate::error::Error;
use crate::solver::Outcome;

/// The outcome of a call. 0: OK; > 0: stopped early, outputs hold the best iterate; < 0: refused, outputs untouched.
pub type contact_normal_status = i32;

/// Solved: the certificate holds to the tolerance.
pub const CONTACT_NORMAL_OK: i32 = 0;
/// `max_cycles`, `max_seconds` or a limit of `contact_normal_accuracy` was reached; outputs hold the best iterate.
pub const CONTACT_NORMAL_ITERATION_LIMIT: i32 = 1;
/// A callback or `options->stop` cancelled the call; outputs hold the best iterate.
pub const CONTACT_NORMAL_CANCELLED: i32 = 2;
/// The iteration made no further progress; outputs hold the best iterate.
pub const CONTACT_NORMAL_STAGNATED: i32 = 3;
/// A pointer is NULL that must not be NULL.
pub const CONTACT_NORMAL_NULL_POINTER: i32 = -1;
/// An argument breaks a rule; the message names it, its value and the rule.
pub const CONTACT_NORMAL_INVALID_ARGUMENT: i32 = -2;
/// An input is NaN, or infinite where it must be finite.
pub const CONTACT_NORMAL_NOT_FINITE: i32 = -3;
/// A struct has a struct_size that no version of this struct has; call its `_init`.
pub const CONTACT_NORMAL_STRUCT_SIZE: i32 = -4;
/// The request is valid, but this version of the library does not carry it out.
pub const CONTACT_NORMAL_UNSUPPORTED: i32 = -5;
/// The prescribed force cannot be carried, or the approach goes beyond full contact in a scene with two periods.
pub const CONTACT_NORMAL_INFEASIBLE: i32 = -6;
/// The influence coefficients do not belong to a positive definite operator.
pub const CONTACT_NORMAL_NOT_POSITIVE_DEFINITE: i32 = -7;
/// Memory could not be allocated, or a thread could not be started.
pub const CONTACT_NORMAL_OUT_OF_MEMORY: i32 = -8;
/// The influence coefficients differ from those of the solver handle, which only `contact_normal_solver_set_influence` changes.
pub const CONTACT_NORMAL_INFLUENCE_CHANGED: i32 = -9;
/// An error of the library itself; please report it.
pub const CONTACT_NORMAL_INTERNAL: i32 = -99;

/// The first number of the version of this header: 0.2.0 has MAJOR 0, MINOR 2, PATCH 0. `contact_normal_version` is that of the library.
pub const CONTACT_NORMAL_VERSION_MAJOR: i32 = 0;
/// The second number of the version of this header.
pub const CONTACT_NORMAL_VERSION_MINOR: i32 = 2;
/// The third number of the version of this header.
pub const CONTACT_NORMAL_VERSION_PATCH: i32 = 0;

/// The version of the ABI. It grows with every release that adds to the ABI.
pub const CONTACT_NORMAL_ABI_VERSION: i32 = 2;

/// The status and the message with which a call is refused.
#[derive(Clone, Debug)]
pub(super) struct Refusal {
    pub status: contact_normal_status,
    pub message: String,
}

impl Refusal {
    pub fn new(status: contact_normal_status, message: String) -> Refusal {
        Refusal { status, message }
    }

    pub fn null(name: &str) -> Refusal {
        Refusal::new(CONTACT_NORMAL_NULL_POINTER, format!("{name} is NULL; it must point to something"))
    }

    pub fn struct_size(message: String) -> Refusal {
        Refusal::new(CONTACT_NORMAL_STRUCT_SIZE, message)
    }

    pub fn invalid(message: String) -> Refusal {
        Refusal::new(CONTACT_NORMAL_INVALID_ARGUMENT, message)
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Refusal {
        let status = match error {
            Error::InvalidArgument(_) => CONTACT_NORMAL_INVALID_ARGUMENT,
            Error::NotFinite(_) => CONTACT_NORMAL_NOT_FINITE,
            Error::Unsupported(_) => CONTACT_NORMAL_UNSUPPORTED,
            Error::Infeasible(_) => CONTACT_NORMAL_INFEASIBLE,
            Error::NotPositiveDefinite(_) => CONTACT_NORMAL_NOT_POSITIVE_DEFINITE,
            Error::InfluenceChanged(_) => CONTACT_NORMAL_INFLUENCE_CHANGED,
            Error::OutOfMemory(_) => CONTACT_NORMAL_OUT_OF_MEMORY,
        };
        Refusal::new(status, error.to_string())
    }
}

impl From<par::OutOfMemory> for Refusal {
    fn from(error: par::OutOfMemory) -> Refusal {
        Error::from(error).into()
    }
}

impl From<Outcome> for i32 {
    fn from(outcome: Outcome) -> contact_normal_status {
        match outcome {
            Outcome::Converged => CONTACT_NORMAL_OK,
            Outcome::IterationLimit => CONTACT_NORMAL_ITERATION_LIMIT,
            Outcome::Cancelled => CONTACT_NORMAL_CANCELLED,
            Outcome::Stagnated => CONTACT_NORMAL_STAGNATED,
        }
    }
}

/// The memory of the last message, unless the message is a static text.
struct Owned(RefCell<Option<CString>>);

impl Drop for Owned {
    fn drop(&mut self) {
        LAST_ERROR.set(c"".as_ptr());
    }
}

thread_local! {
    /// The last message of this thread. The cell has no destructor, so calls have a message even while the thread ends.
    static LAST_ERROR: Cell<*const c_char> = const { Cell::new(c"".as_ptr()) };
    static OWNED: Owned = const { Owned(RefCell::new(None)) };
}

/// Sets the message of the last call on this thread.
pub(super) fn set_last_error(message: &str) {
    let text: Vec<u8> = message.bytes().filter(|&b| b != 0).collect();
    let message = CString::new(text).unwrap_or_default();
    let text = message.as_ptr();
    let mut message = Some(message);
    if OWNED.try_with(|owned| owned.0.replace(message.take())).is_err() {
        // The thread ends and OWNED is gone. The text stays in memory until the process ends.
        message.map(CString::into_raw);
    }
    LAST_ERROR.set(text);
}

/// As [`set_last_error`], for a static text, which needs no memory.
pub(super) fn set_last_text(message: &'static CStr) {
    LAST_ERROR.set(message.as_ptr());
}

/// The message of the last call on this thread.
pub(super) fn last_error_text() -> String {
    // SAFETY: a static text, or the text in OWNED.
    unsafe { CStr::from_ptr(LAST_ERROR.get()) }.to_string_lossy().into_owned()
}

fn text_of(status: contact_normal_status) -> &'static CStr {
    match status {
        CONTACT_NORMAL_OK => c"solved",
        CONTACT_NORMAL_ITERATION_LIMIT => c"stopped at a limit",
        CONTACT_NORMAL_CANCELLED => c"cancelled by a callback or by options->stop",
        CONTACT_NORMAL_STAGNATED => c"no further progress",
        CONTACT_NORMAL_NULL_POINTER => c"a null pointer",
        CONTACT_NORMAL_INVALID_ARGUMENT => c"an invalid argument",
        CONTACT_NORMAL_NOT_FINITE => c"a value that is not finite",
        CONTACT_NORMAL_STRUCT_SIZE => c"an unknown struct size",
        CONTACT_NORMAL_UNSUPPORTED => c"not supported",
        CONTACT_NORMAL_INFEASIBLE => c"the force cannot be carried",
        CONTACT_NORMAL_NOT_POSITIVE_DEFINITE => c"influence coefficients that are not positive definite",
        CONTACT_NORMAL_OUT_OF_MEMORY => c"out of memory",
        CONTACT_NORMAL_INFLUENCE_CHANGED => c"influence coefficients changed",
        CONTACT_NORMAL_INTERNAL => c"internal error, please report",
        _ => c"an unknown status",
    }
}

/// Returns a short text for a status: never NULL, in static storage. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_status_text(status: contact_normal_status) -> *const c_char {
    text_of(status).as_ptr()
}

/// Returns the message of the last call on this thread that did not return OK, or that returned OK with `report->warnings`; "" if there was none.
/// The message of a refused argument names the argument, its value and the rule. The pointer is never NULL, and valid until the next call of this
/// library on this thread. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_last_error() -> *const c_char {
    LAST_ERROR.get()
}

/// Returns the version of the library, as "0.2.0", in static storage. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Returns `CONTACT_NORMAL_ABI_VERSION` of the library, which should be at least that of the header. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_abi_version() -> i32 {
    CONTACT_NORMAL_ABI_VERSION
}
