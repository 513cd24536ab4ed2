//! The guard that every export goes through: floating-point environment, panics, status, message.

use std::cell::Cell;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};

use super::floating_point::DefaultEnvironment;
use super::status::{contact_normal_status, set_last_error, Refusal, CONTACT_NORMAL_INTERNAL};
use crate::threads::is_worker;

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Runs `body` in the default floating-point environment; a refusal or a panic becomes a status and a message.
pub fn guard(body: impl FnOnce() -> Result<contact_normal_status, Refusal>) -> contact_normal_status {
    let _inside = Inside::enter();
    status_of(caught(body))
}

/// A call of the library on this thread, in the default floating-point environment, until it is dropped.
pub(super) struct Inside {
    _environment: DefaultEnvironment,
    /// Whether the call is made in a callback of another one.
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

/// The result of `work`; a panic becomes a refusal.
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

/// The status of a call. The message of a refusal becomes that of this thread; for a status > 0 the call has set it.
pub(super) fn status_of(ended: Result<contact_normal_status, Refusal>) -> contact_normal_status {
    let status = caught(|| {
        ended.or_else(|refusal| {
            set_last_error(&refusal.message);
            Ok(refusal.status)
        })
    });
    // A message that cannot be formed is left out.
    status.unwrap_or(CONTACT_NORMAL_INTERNAL)
}

/// The library prints nothing, so that a panic that the guard will catch must not be announced on stderr. The previous hook handles panics elsewhere
/// in the process.
fn silence_our_panics() {
    // No thread waits for the one that sets the hook: a process that is forked meanwhile does not have that thread.
    static IS_DONE: AtomicBool = AtomicBool::new(false);
    // The hook cannot be changed while this thread unwinds; the next call changes it.
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
