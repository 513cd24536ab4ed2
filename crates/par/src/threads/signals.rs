//! Keeps the signals of the host program away from the library's threads.
//!
//! The system delivers a signal to any thread of the process that does not block it. A host that waits for a signal blocks it in its own threads
//! only. Its handler may need data of the host's thread. So the workers must block all such signals.

/// Calls `start` while this thread blocks signals. The threads that `start` starts inherit the mask of blocked signals. Signals of faults and of
/// profilers are not blocked: a fault signals the thread that caused it, and a profiler signals every thread.
#[cfg(unix)]
pub(super) fn blocked<R>(start: impl FnOnce() -> R) -> R {
    let _blocked = Blocked::new();
    start()
}

#[cfg(not(unix))]
pub(super) fn blocked<R>(start: impl FnOnce() -> R) -> R {
    start()
}

/// The mask that this thread had before. It is restored when this value is dropped. None if the mask could not be changed.
#[cfg(unix)]
struct Blocked(Option<libc::sigset_t>);

#[cfg(unix)]
impl Blocked {
    /// Blocks the signals in this thread.
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
            // SAFETY: `before` is the mask that this thread had.
            unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, before, std::ptr::null_mut()) };
        }
    }
}
