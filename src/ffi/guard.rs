//! The one guard that every export goes through: floating-point environment, panics, status, message.

use std::any::Any;
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
    let _environment = DefaultEnvironment::enter();
    let nested = INSIDE.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        silence_our_panics();
        // For a status > 0 the body has set the message.
        body().unwrap_or_else(|refusal| {
            set_last_error(&refusal.message);
            refusal.status
        })
    }));
    let status = outcome.unwrap_or_else(|panic| {
        // A message that cannot be formed is left out.
        if let Err(another) = catch_unwind(AssertUnwindSafe(|| explain(&*panic))) {
            std::mem::forget(another);
        }
        // Dropping a foreign payload might panic again.
        std::mem::forget(panic);
        CONTACT_NORMAL_INTERNAL
    });
    INSIDE.set(nested);
    status
}

fn explain(panic: &(dyn Any + Send)) {
    set_last_error(&text_of(panic));
}

fn text_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    format!("internal error: {}; please report it", text.unwrap_or_default())
}

/// A panic that was caught before the guard.
pub(super) fn refusal_of_panic(panic: Box<dyn Any + Send>) -> Refusal {
    let refusal = Refusal::new(CONTACT_NORMAL_INTERNAL, text_of(&*panic));
    // Dropping the payload might panic again.
    std::mem::forget(panic);
    refusal
}

/// The library prints nothing, so a panic that the guard will catch must not be announced on stderr. Panics elsewhere in the
/// process go to whatever hook was there.
fn silence_our_panics() {
    // Nobody waits for the thread that does it: a process that is forked meanwhile does not have that thread.
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
