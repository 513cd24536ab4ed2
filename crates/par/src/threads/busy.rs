//! Detects whether other programs use the cores. If they do, the system may preempt a worker or the caller in the middle of its work for a few
//! milliseconds, while the other threads wait. Then two threads take two to four times as long as one.
//!
//! After such a loss of time the caller works alone for a while, then tries to share work again. After each further loss it works alone for longer.
//! All tries together take less than a tenth of the time.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The shortest delay that counts as a loss. An interrupt by the system is shorter, a wait for a core is longer.
pub(super) const LEAST_LOSS: Duration = Duration::from_micros(500);

/// How long the caller works alone after the first loss, in nanoseconds. A try to share work loses one time slice of the scheduler, about 3 ms.
const FIRST_ALONE: u64 = 30_000_000;
/// The longest time that the caller works alone, in nanoseconds.
const LONGEST_ALONE: u64 = 960_000_000;

/// Whether the caller works alone because other programs use the cores, and until when.
#[derive(Default)]
pub(super) struct Busy {
    /// The time of the first call of [`now`](Self::now).
    began: OnceLock<Instant>,
    /// The time at which work is shared again, in nanoseconds since `began`.
    until: AtomicU64,
    /// How long the caller worked alone after the last loss, in nanoseconds. 0 if there was none lately.
    alone: AtomicU64,
}

impl Busy {
    /// The time in nanoseconds since the first call.
    pub fn now(&self) -> u64 {
        u64::try_from(self.began.get_or_init(Instant::now).elapsed().as_nanos()).unwrap_or(u64::MAX)
    }

    /// Whether the time in which the caller works alone is over.
    pub fn is_over(&self, now: u64) -> bool {
        now >= self.until.load(Ordering::Relaxed)
    }

    /// Records whether shared work lost time, at the time `now`.
    pub fn note(&self, now: u64, is_lost: bool) {
        let (until, alone) = (self.until.load(Ordering::Relaxed), self.alone.load(Ordering::Relaxed));
        if is_lost {
            let alone = (2 * alone).clamp(FIRST_ALONE, LONGEST_ALONE);
            self.alone.store(alone, Ordering::Relaxed);
            self.until.store(now + alone, Ordering::Relaxed);
        } else if alone > 0 && now - until.min(now) > alone {
            // Work has been shared without loss for longer than the caller worked alone before. So the next loss counts as the first.
            self.alone.store(0, Ordering::Relaxed);
        }
    }
}

/// The processor time that this thread has used. None if the system does not tell it.
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
