//! Whether other programs use the cores. If so, a worker or the caller may be preempted in the middle of its work while the others wait, for
//! a few milliseconds at a time: two threads would take two to four times as long as one.
//!
//! After a loss of time the caller works alone for a while, then tries again, and works alone longer after each further loss: all tries
//! together cost less than a tenth.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Least loss: an interrupt by the system is shorter, a wait for a core longer.
pub(super) const LEAST_LOSS: Duration = Duration::from_micros(500);

/// Nanoseconds that the caller works alone: after the first loss, and at most. A try loses one turn of the scheduler, about 3 ms.
const FIRST_ALONE: u64 = 30_000_000;
const LONGEST_ALONE: u64 = 960_000_000;

/// The time at which work is shared again.
#[derive(Default)]
pub(super) struct Busy {
    began: OnceLock<Instant>,
    /// In nanoseconds since `began`.
    until: AtomicU64,
    alone: AtomicU64,
}

impl Busy {
    /// Nanoseconds since the first call.
    pub fn now(&self) -> u64 {
        u64::try_from(self.began.get_or_init(Instant::now).elapsed().as_nanos()).unwrap_or(u64::MAX)
    }

    /// Whether work is shared now.
    pub fn is_over(&self, now: u64) -> bool {
        now >= self.until.load(Ordering::Relaxed)
    }

    /// Notes whether shared work lost time.
    pub fn note(&self, now: u64, is_lost: bool) {
        let (until, alone) = (self.until.load(Ordering::Relaxed), self.alone.load(Ordering::Relaxed));
        if is_lost {
            let alone = (2 * alone).clamp(FIRST_ALONE, LONGEST_ALONE);
            self.alone.store(alone, Ordering::Relaxed);
            self.until.store(now + alone, Ordering::Relaxed);
        } else if alone > 0 && now - until.min(now) > alone {
            // There was no loss for longer than the last time alone.
            self.alone.store(0, Ordering::Relaxed);
        }
    }
}

/// The processor's time of this thread.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
pub(super) fn time_of_this_thread() -> Option<Duration> {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the call writes one value, to `time`.
    let status = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    let seconds = u64::try_from(time.tv_sec).ok()?;
    (status == 0).then(|| Duration::new(seconds, u32::try_from(time.tv_nsec).unwrap_or_default()))
}

#[cfg(not(target_os = "linux"))]
pub(super) fn time_of_this_thread() -> Option<Duration> {
    None
}

#[cfg(test)]
#[path = "../../tests/unit/busy.rs"]
mod tests;
