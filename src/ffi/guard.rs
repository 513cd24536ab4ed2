//! The one guard that every export goes through: floating-point environment, panics, status, message.

use std::any::Any;
use std::cell::Cell;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::Once;

use super::floating_point::DefaultEnvironment;
use super::status::{contact_normal_status, set_last_error, Refusal, CONTACT_NORMAL_INTERNAL};

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Runs `body` in the default floating-point environment; a refusal or a panic becomes a status and a message.
pub fn guard(body: impl FnOnce() -> Result<contact_normal_status, Refusal>) -> contact_normal_status {
    let _environment = DefaultEnvironment::enter();
    let nested = INSIDE.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        silence_our_panics();
        // A status > 0 has its message from the body.
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
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    set_last_error(&format!("internal error: {}; please report it", text.unwrap_or_default()));
}

/// The library prints nothing, so a panic that the guard will catch must not be announced on stderr. Panics elsewhere in the
/// process go to whatever hook was there.
fn silence_our_panics() {
    static ONCE: Once = Once::new();
    // A host that calls while it unwinds may not change the hook; its next call does.
    if std::thread::panicking() {
        return;
    }
    ONCE.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let thread = std::thread::current();
            let ours = thread.name().is_some_and(|name| name.starts_with(crate::threads::THREAD_NAME));
            if !INSIDE.get() && !ours {
                previous(info);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Set in the process that panics below.
    const CHILD: &str = "CONTACT_NORMAL_TEST_PANICS";

    #[test]
    fn a_panic_becomes_a_status_and_is_not_announced() {
        if std::env::var_os(CHILD).is_some() {
            assert_eq!(guard(|| panic!("on purpose")), CONTACT_NORMAL_INTERNAL);
            // SAFETY: the message is valid until the next call on this thread.
            let message = unsafe { std::ffi::CStr::from_ptr(super::super::contact_normal_last_error()) };
            assert_eq!(message.to_str(), Ok("internal error: on purpose; please report it"));
            return;
        }
        // The test harness catches what a test prints: only a process of its own shows what comes out on stderr.
        let itself = std::env::current_exe().expect("this test's path");
        let arguments = ["--exact", "ffi::guard::tests::a_panic_becomes_a_status_and_is_not_announced", "--nocapture"];
        let output = std::process::Command::new(itself).args(arguments).env(CHILD, "1").output().expect("a process");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"), "the child ran no test");
        assert!(said.trim().is_empty(), "{said}");
    }
}
