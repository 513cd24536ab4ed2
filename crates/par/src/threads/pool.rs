//! The pool of a process: workers start at the first request, as many as the largest request, and serve all solves.
//!
//! The pool carries the process id. After a fork the child has no workers, so it makes its own pool instead of waiting for absent
//! threads, also for operators set up before the fork. It touches no lock of its parent, which another thread may have held.

use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::busy::{time_of_this_thread, LEAST_LOSS};
use super::crew::Crew;
use crate::error::Result;

/// A number of threads: the caller's own and workers of the process.
#[derive(Clone)]
pub struct Pool {
    /// The number of threads, the caller's own among them.
    count: usize,
    crew: Arc<Crew>,
}

/// The crew of a process, until it is released.
struct Process {
    id: u32,
    crew: Mutex<Option<Arc<Crew>>>,
}

/// The record of this process; after a fork, until the first use, that of the parent.
static PROCESS: AtomicPtr<Process> = AtomicPtr::new(std::ptr::null_mut());

/// The crew of this process.
fn crew() -> MutexGuard<'static, Option<Arc<Crew>>> {
    let id = std::process::id();
    loop {
        let known = PROCESS.load(Ordering::Acquire);
        // SAFETY: NULL, or made below and never freed.
        if let Some(process) = unsafe { known.as_ref() }.filter(|process| process.id == id) {
            return process.crew.lock().unwrap_or_else(PoisonError::into_inner);
        }
        let new = Box::into_raw(Box::new(Process { id, crew: Mutex::new(None) }));
        if PROCESS.compare_exchange(known, new, Ordering::AcqRel, Ordering::Relaxed).is_err() {
            // SAFETY: made above and not shared: another thread was first.
            drop(unsafe { Box::from_raw(new) });
        }
    }
}

/// Ends the kept threads that no solver holds.
pub fn release() {
    drop(crew().take());
}

/// The number of kept threads, without the callers' threads.
pub fn kept() -> usize {
    crew().as_ref().map_or(0, |crew| crew.len())
}

impl Pool {
    /// A pool of `count` threads, the caller's own among them.
    pub fn of(count: usize) -> Result<Pool> {
        let mut kept = crew();
        let crew = kept.get_or_insert_with(|| Arc::new(Crew::new())).clone();
        crew.grow_to(count - 1)?;
        Ok(Pool { count, crew })
    }

    /// This pool, or a new one after a fork; none if that fails.
    pub fn here(&self) -> Option<Pool> {
        if self.crew.process == std::process::id() {
            return Some(self.clone());
        }
        Pool::of(self.count).ok()
    }

    /// Number of threads, the caller's own among them.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether sharing work may pay: not while other processes use the cores.
    pub fn may_help(&self) -> bool {
        self.crew.busy.is_over(self.crew.busy.now())
    }

    /// Calls `work(item)` for items on free workers, and meanwhile `own` on the calling thread. Items that no worker has begun by the end of
    /// `own` are left.
    pub fn beside<A: Send, R>(&self, items: &mut [A], work: &(dyn Fn(&mut A) + Sync), own: impl FnOnce() -> R) -> R {
        self.waiting(items, work, own).0
    }

    /// As [`beside`](Self::beside), for small pieces of work, of which `own` returns the number that it did. Notes whether sharing lost time.
    pub fn share<A: Send>(&self, items: &mut [A], work: &(dyn Fn(&mut A) + Sync), own: impl FnOnce() -> u32) {
        let (began, time) = (Instant::now(), time_of_this_thread());
        let timed = || {
            let pieces = own();
            (pieces, began.elapsed(), time_of_this_thread())
        };
        let ((pieces, took, time_then), waited) = self.waiting(items, work, timed);
        let worked = time.zip(time_then).map_or(took, |(before, then)| then.saturating_sub(before));
        // A worker's last piece takes as long as one of the caller's, or twice as long.
        let is_lost = took.saturating_sub(worked) > LEAST_LOSS || waited > 2 * took / pieces.max(1) + LEAST_LOSS;
        let busy = &self.crew.busy;
        busy.note(busy.now(), is_lost);
    }

    fn waiting<A: Send, R>(
        &self,
        items: &mut [A],
        work: &(dyn Fn(&mut A) + Sync),
        own: impl FnOnce() -> R,
    ) -> (R, Duration) {
        let items: Vec<_> = items.iter_mut().map(|item| Mutex::new(Some(item))).collect();
        let of_seat = |seat: usize| {
            let item = items[seat].lock().unwrap_or_else(PoisonError::into_inner).take();
            if let Some(item) = item {
                work(item);
            }
        };
        self.crew.beside(items.len(), &of_seat, own)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/pool.rs"]
mod tests;
