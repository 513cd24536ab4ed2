//! The host's signals, which stay with the host's threads: a signal to a process goes to any thread that does not block it. A host that waits for
//! one blocks it in its own threads, and a handler may count on data of its thread.

/// Calls `start` while this thread blocks signals. The threads that it starts inherit the mask. Signals of faults and of profilers stay open: a
/// fault signals its own thread, and a profiler asks every thread.
#[cfg(unix)]
pub(super) fn blocked<R>(start: impl FnOnce() -> R) -> R {
    let _blocked = Blocked::new();
    start()
}

#[cfg(not(unix))]
pub(super) fn blocked<R>(start: impl FnOnce() -> R) -> R {
    start()
}

/// The mask before, which returns at the end.
#[cfg(unix)]
struct Blocked(Option<libc::sigset_t>);

#[cfg(unix)]
impl Blocked {
    fn new() -> Blocked {
        use libc::{SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGSEGV, SIGSYS, SIGTRAP};
        let (mut all, mut before) = (std::mem::MaybeUninit::uninit(), std::mem::MaybeUninit::uninit());
        // SAFETY: `sigfillset` writes the whole set before it is used; `before` is written if the call returns 0.
        unsafe {
            libc::sigfillset(all.as_mut_ptr());
            for signal in [SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGSEGV, SIGSYS, SIGTRAP] {
                libc::sigdelset(all.as_mut_ptr(), signal);
            }
            let status = libc::pthread_sigmask(libc::SIG_BLOCK, all.as_ptr(), before.as_mut_ptr());
            Blocked((status == 0).then(|| before.assume_init()))
        }
    }
}

#[cfg(unix)]
impl Drop for Blocked {
    fn drop(&mut self) {
        if let Some(before) = &self.0 {
            // SAFETY: the mask that this thread had.
            unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, before, std::ptr::null_mut()) };
        }
    }
}
