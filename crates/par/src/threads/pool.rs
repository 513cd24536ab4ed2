//! The pool of a process: its workers are started when first asked for, as many as were ever asked for at once, and serve all solves.
//!
//! It is stamped with the process id: after a fork the child has no workers, so it makes a pool of its own instead of waiting for threads that are
//! not there; so does an operator that was set up before the fork. The child touches no lock of its parent, which another thread may have held.

use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::busy::{time_of_this_thread, LOSS};
use super::crew::Crew;
use crate::error::Result;

/// Some threads: the caller's own, and workers of the process.
#[derive(Clone)]
pub struct Pool {
    /// With the caller's own.
    count: usize,
    crew: Arc<Crew>,
}

/// The crew of a process, while it is kept.
struct Process {
    id: u32,
    crew: Mutex<Option<Arc<Crew>>>,
}

/// That of this process; after a fork, until it is asked for, that of the parent.
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
            // SAFETY: made above, and nobody has it: another thread was first.
            drop(unsafe { Box::from_raw(new) });
        }
    }
}

impl Pool {
    /// So many threads, the caller's own among them.
    pub fn of(count: usize) -> Result<Pool> {
        let mut kept = crew();
        let crew = kept.get_or_insert_with(|| Arc::new(Crew::new())).clone();
        crew.grow_to(count - 1)?;
        Ok(Pool { count, crew })
    }

    /// Ends the threads when no solver holds them.
    pub fn release() {
        drop(crew().take());
    }

    /// Threads that are kept in this process, beside those of the callers.
    pub fn kept() -> usize {
        crew().as_ref().map_or(0, |crew| crew.len())
    }

    /// This pool, or after a fork another one; none: it could not be made.
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

    /// Whether it may help: not while others use the cores.
    pub fn may_help(&self) -> bool {
        self.crew.busy.is_over(self.crew.busy.now())
    }

    /// Calls `work(item)` for items on workers that are free, and meanwhile `own` on the calling thread. What no worker has begun when that is
    /// done is left alone.
    pub fn beside<A: Send, R>(&self, items: &mut [A], work: &(dyn Fn(&mut A) + Sync), own: impl FnOnce() -> R) -> R {
        self.waiting(items, work, own).0
    }

    /// The same with small pieces of work, of which `own` returns how many it did: notes whether time was lost by it.
    pub fn share<A: Send>(&self, items: &mut [A], work: &(dyn Fn(&mut A) + Sync), own: impl FnOnce() -> u32) {
        let (began, time) = (Instant::now(), time_of_this_thread());
        let timed = || {
            let pieces = own();
            (pieces, began.elapsed(), time_of_this_thread())
        };
        let ((pieces, took, time_then), waited) = self.waiting(items, work, timed);
        let worked = time.zip(time_then).map_or(took, |(before, then)| then.saturating_sub(before));
        // A worker's last piece takes as long as one of the caller's, or twice as long.
        let is_lost = took.saturating_sub(worked) > LOSS || waited > 2 * took / pieces.max(1) + LOSS;
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
