//! Log messages for a callback of the calling program.

use std::cell::Cell;
use std::ffi::CString;

use libc::{c_char, c_void};
use log::{LevelFilter, Log, Metadata, Record};

use super::arguments::unknown;
use super::floating_point::in_host_environment;
use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK, CONTACT_NORMAL_UNSUPPORTED};
use crate::threads::{is_worker, Shared};

/// Log level: no messages.
pub const CONTACT_NORMAL_LOG_OFF: i32 = 0;
/// Log level: results that the caller should look at.
pub const CONTACT_NORMAL_LOG_WARNING: i32 = 1;
/// Log level: decisions of the library.
pub const CONTACT_NORMAL_LOG_INFO: i32 = 2;

/// A callback that receives log messages: a level, a message (valid during the call) and the user pointer. It is called on the thread that called
/// the library, in the floating-point environment of that thread, with no lock held. The callback must not use a handle that is solving: such calls
/// are refused.
pub type contact_normal_log_callback =
    Option<unsafe extern "C" fn(level: i32, message: *const c_char, user: *mut c_void)>;

/// The callback that receives the messages, and its pointer.
#[derive(Clone, Copy)]
struct Target {
    callback: contact_normal_log_callback,
    user: *mut c_void,
}

// SAFETY: the pointer is the caller's, who promises that the callback may be called from any thread that calls the library.
unsafe impl Send for Target {}

static TARGET: Shared<Target> = Shared::new(Target { callback: None, user: std::ptr::null_mut() });

thread_local! {
    /// Whether this thread solves problems of a batch.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Calls `work` without log messages.
pub(super) fn quietly<R>(work: impl FnOnce() -> R) -> R {
    struct Restored(bool);
    impl Drop for Restored {
        fn drop(&mut self) {
            QUIET.set(self.0);
        }
    }
    // Dropped at the end, even after a panic.
    let _restored = Restored(QUIET.replace(true));
    work()
}

/// The logger that calls the caller's callback.
struct Forward;

impl Log for Forward {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        // The callback runs on the thread that called the library, never on a worker, and not for the problems of a batch.
        if QUIET.get() || is_worker() {
            return;
        }
        // The target is copied, so that the lock is not held during the call.
        let Some(target) = TARGET.lock().map(|target| *target) else { return };
        let level =
            if record.level() <= log::Level::Warn { CONTACT_NORMAL_LOG_WARNING } else { CONTACT_NORMAL_LOG_INFO };
        if let (Some(callback), Ok(message)) = (target.callback, CString::new(record.args().to_string())) {
            // SAFETY: the caller's function with the caller's pointer.
            in_host_environment(|| unsafe { callback(level, message.as_ptr(), target.user) });
        }
    }

    fn flush(&self) {}
}

/// Sends the log messages of the whole process up to `level` (CONTACT_NORMAL_LOG_...) to `callback`. NULL, as at the start of the process: no
/// messages. UNSUPPORTED: a program in Rust has set a logger already, which receives the messages. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_set_log(
    callback: contact_normal_log_callback,
    level: i32,
    user: *mut c_void,
) -> contact_normal_status {
    static OURS: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    guard(|| {
        let filter = match level {
            CONTACT_NORMAL_LOG_OFF => LevelFilter::Off,
            CONTACT_NORMAL_LOG_WARNING => LevelFilter::Warn,
            CONTACT_NORMAL_LOG_INFO => LevelFilter::Info,
            other => return unknown("level", other, "OFF 0, WARNING 1 or INFO 2"),
        };
        if !OURS.get_or_init(|| log::set_logger(&Forward).is_ok()) {
            let message = "a logger is set already; it receives the messages".into();
            return Err(Refusal::new(CONTACT_NORMAL_UNSUPPORTED, message));
        }
        let Some(mut target) = TARGET.lock() else {
            let message =
                "this process was forked while another thread set the callback; its child cannot set one".into();
            return Err(Refusal::new(CONTACT_NORMAL_UNSUPPORTED, message));
        };
        *target = Target { callback, user };
        drop(target);
        log::set_max_level(if callback.is_some() { filter } else { LevelFilter::Off });
        Ok(CONTACT_NORMAL_OK)
    })
}
