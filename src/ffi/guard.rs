//! The guard in which every exported function runs. It sets the floating-point environment, catches panics, and makes the status and the message.

use std::cell::Cell;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};

use super::floating_point::DefaultEnvironment;
use super::status::{contact_normal_status, set_last_error, Refusal, CONTACT_NORMAL_INTERNAL};
use crate::threads::is_worker;

thread_local! {
    /// Whether this thread is in a call of the library.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Calls `body` in the default floating-point environment. A refusal or a panic becomes a status and a message.
pub fn guard(body: impl FnOnce() -> Result<contact_normal_status, Refusal>) -> contact_normal_status {
    let _inside = Inside::enter();
    status_of(caught(body))
}

/// While this value lives, its thread is in a call of the library, and has the default floating-point environment.
pub(super) struct Inside {
    _environment: DefaultEnvironment,
    /// Whether the call is made in a callback of another call.
    nested: bool,
}

impl Inside {
    /// Begins a call.
    pub fn enter() -> Inside {
        Inside { _environment: DefaultEnvironment::enter(), nested: INSIDE.replace(true) }
    }
}

impl Drop for Inside {
    fn drop(&mut self) {
        INSIDE.set(self.nested);
    }
}

/// Calls `work` and returns its result. A panic becomes a refusal.
pub(super) fn caught<T>(work: impl FnOnce() -> Result<T, Refusal>) -> Result<T, Refusal> {
    let ended = catch_unwind(AssertUnwindSafe(|| {
        silence_our_panics();
        work()
    }));
    ended.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
        let message = format!("internal error: {}; please report it", text.unwrap_or_default());
        // Dropping the payload might panic again.
        std::mem::forget(panic);
        Err(Refusal::new(CONTACT_NORMAL_INTERNAL, message))
    })
}

/// The status of a call. The message of a refusal becomes that of this thread. For a status > 0 the call itself has set the message.
pub(super) fn status_of(ended: Result<contact_normal_status, Refusal>) -> contact_normal_status {
    let status = caught(|| {
        ended.or_else(|refusal| {
            set_last_error(&refusal.message);
            Ok(refusal.status)
        })
    });
    // If setting the message panics, the status has no message.
    status.unwrap_or(CONTACT_NORMAL_INTERNAL)
}

/// Sets a panic hook that prints nothing for panics in the library: the guard catches these, and the library never writes to stderr. The previous
/// hook handles panics elsewhere in the process.
fn silence_our_panics() {
    // No lock: a process that is forked while another thread sets the hook would wait for a thread that it does not have.
    static IS_DONE: AtomicBool = AtomicBool::new(false);
    // A thread that unwinds cannot set the hook. The next call sets it.
    if std::thread::panicking() || IS_DONE.load(Ordering::Relaxed) || IS_DONE.swap(true, Ordering::Relaxed) {
        return;
    }
    let previous = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !INSIDE.get() && !is_worker() {
            previous(info);
        }
    }));
}
