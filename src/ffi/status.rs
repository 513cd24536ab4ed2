//! Statuses, their texts, the last error message, versions.

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString};

use libc::c_char;

use crate::error::Error;
use crate::solver::Outcome;

/// The outcome of a call. 0: OK; > 0: stopped early, outputs hold the best iterate; < 0: refused, outputs untouched.
pub type contact_normal_status = i32;

/// Solved: the certificate holds to the tolerance.
pub const CONTACT_NORMAL_OK: i32 = 0;
/// `max_cycles`, `max_seconds` or a limit of an accuracy was reached; outputs hold the best iterate.
pub const CONTACT_NORMAL_ITERATION_LIMIT: i32 = 1;
/// A callback or `options->stop` cancelled; outputs hold the best iterate.
pub const CONTACT_NORMAL_CANCELLED: i32 = 2;
/// No further progress; outputs hold the best iterate.
pub const CONTACT_NORMAL_STAGNATED: i32 = 3;
/// A pointer that must not be NULL is.
pub const CONTACT_NORMAL_NULL_POINTER: i32 = -1;
/// An argument breaks a rule; the message names it, its value and the rule.
pub const CONTACT_NORMAL_INVALID_ARGUMENT: i32 = -2;
/// A NaN, or an infinity where none is allowed.
pub const CONTACT_NORMAL_NOT_FINITE: i32 = -3;
/// A struct_size that no version of the struct has; call its `_init`.
pub const CONTACT_NORMAL_STRUCT_SIZE: i32 = -4;
/// A valid request that this version does not carry out.
pub const CONTACT_NORMAL_UNSUPPORTED: i32 = -5;
/// The force cannot be carried.
pub const CONTACT_NORMAL_INFEASIBLE: i32 = -6;
/// The influence coefficients are not those of a positive definite operator.
pub const CONTACT_NORMAL_NOT_POSITIVE_DEFINITE: i32 = -7;
/// Memory (or a thread) could not be had.
pub const CONTACT_NORMAL_OUT_OF_MEMORY: i32 = -8;
/// The influence coefficients are not those that the solver has: `contact_normal_solver_set_influence` gives it others.
pub const CONTACT_NORMAL_INFLUENCE_CHANGED: i32 = -9;
/// A bug of ours, caught at the boundary.
pub const CONTACT_NORMAL_INTERNAL: i32 = -99;

/// The version of the header: 0.2.0 has MAJOR 0, MINOR 2, PATCH 0. `contact_normal_version` is that of the library.
pub const CONTACT_NORMAL_VERSION_MAJOR: i32 = 0;
/// The second number of the version.
pub const CONTACT_NORMAL_VERSION_MINOR: i32 = 2;
/// The third number of the version.
pub const CONTACT_NORMAL_VERSION_PATCH: i32 = 0;

/// Version of the ABI: grows with every release that adds to it.
pub const CONTACT_NORMAL_ABI_VERSION: i32 = 2;

/// A refusal at the boundary.
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
    fn from(stop: Outcome) -> contact_normal_status {
        match stop {
            Outcome::Converged => CONTACT_NORMAL_OK,
            Outcome::IterationLimit => CONTACT_NORMAL_ITERATION_LIMIT,
            Outcome::Cancelled => CONTACT_NORMAL_CANCELLED,
            Outcome::Stagnated => CONTACT_NORMAL_STAGNATED,
        }
    }
}

/// The text of the last message, if it needs memory.
struct Owned(RefCell<Option<CString>>);

impl Drop for Owned {
    fn drop(&mut self) {
        LAST_ERROR.set(c"".as_ptr());
    }
}

thread_local! {
    /// The last message. This cell has no destructor. So a call has its message even while a thread ends.
    static LAST_ERROR: Cell<*const c_char> = const { Cell::new(c"".as_ptr()) };
    static OWNED: Owned = const { Owned(RefCell::new(None)) };
}

pub(super) fn set_last_error(message: &str) {
    let text: Vec<u8> = message.bytes().filter(|&b| b != 0).collect();
    let message = CString::new(text).unwrap_or_default();
    let text = message.as_ptr();
    let mut message = Some(message);
    if OWNED.try_with(|owned| owned.0.replace(message.take())).is_err() {
        // This thread ends, and has lost the place of the text: it stays until the process ends.
        message.map(CString::into_raw);
    }
    LAST_ERROR.set(text);
}

/// Sets a text that needs no memory as the message of the last call.
pub(super) fn set_last_text(message: &'static CStr) {
    LAST_ERROR.set(message.as_ptr());
}

/// The message of the last call on this thread.
pub(super) fn last_error_text() -> String {
    // SAFETY: a text of the library, or the one that OWNED has.
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

/// A short text for a status; never NULL, static storage. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_status_text(status: contact_normal_status) -> *const c_char {
    text_of(status).as_ptr()
}

/// The message of the last call on this thread that did not return OK, or returned OK with `report->warnings`, or "". It names the argument, its value and the rule.
/// Never NULL; valid until the next call of this library on this thread. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_last_error() -> *const c_char {
    LAST_ERROR.get()
}

/// The version of the library, as "0.2.0"; static storage. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// `CONTACT_NORMAL_ABI_VERSION` of the library: at least that of the header it is used with. Since 0.1.
#[no_mangle]
pub extern "C" fn contact_normal_abi_version() -> i32 {
    CONTACT_NORMAL_ABI_VERSION
}
