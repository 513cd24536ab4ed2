//! Pools of threads for solves, and the record of a process's workers.
//!
//! The worker threads of a process start when a solve first needs them. More start if a later solve needs more. All solves of the process share them.
//!
//! [`Process`] and [`Workers`] record the id of the process. After a fork the child has no worker threads. It starts its own ones, also for operators
//! that were set up before the fork. The child takes no lock of its parent: another thread may have held the lock at the fork.

use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::busy::{time_of_this_thread, LEAST_LOSS};
use super::workers::Workers;
use crate::error::Result;

/// The caller's thread and `count - 1` workers of the process.
#[derive(Clone)]
pub struct Pool {
    /// The number of threads, including the caller's.
    count: usize,
    workers: Arc<Workers>,
}

/// The record of one process.
struct Process {
    id: u32,
    /// The workers. None before their first use, and after [`release`].
    workers: Mutex<Option<Arc<Workers>>>,
}

/// Points to the record of this process. In a forked child it points to the parent's record until the first use.
static PROCESS: AtomicPtr<Process> = AtomicPtr::new(std::ptr::null_mut());

/// Locks the workers of this process. Makes the record of the process, if there is none.
fn workers() -> MutexGuard<'static, Option<Arc<Workers>>> {
    let id = std::process::id();
    loop {
        let known = PROCESS.load(Ordering::Acquire);
        // SAFETY: NULL, or made below and never freed.
        if let Some(process) = unsafe { known.as_ref() }.filter(|process| process.id == id) {
            return process.workers.lock().unwrap_or_else(PoisonError::into_inner);
        }
        let new = Box::into_raw(Box::new(Process { id, workers: Mutex::new(None) }));
        if PROCESS.compare_exchange(known, new, Ordering::AcqRel, Ordering::Relaxed).is_err() {
            // SAFETY: made above and not shared: another thread was first.
            drop(unsafe { Box::from_raw(new) });
        }
    }
}

/// Ends the workers: at once if no solver uses them, otherwise when the last such solver is freed. Solvers that are made later start new workers.
pub fn release() {
    drop(workers().take());
}

/// The number of workers that the next solver can use. Callers' threads do not count, nor do workers that end after [`release`].
pub fn kept() -> usize {
    workers().as_ref().map_or(0, |workers| workers.len())
}

impl Pool {
    /// A pool of `count` threads, including the caller's. Starts workers if there are too few.
    pub fn of(count: usize) -> Result<Pool> {
        let mut known = workers();
        let workers = known.get_or_insert_with(|| Arc::new(Workers::new())).clone();
        workers.grow_to(count - 1)?;
        Ok(Pool { count, workers })
    }

    /// This pool; in a forked child, a new one. None if its threads cannot be started.
    pub fn in_this_process(&self) -> Option<Pool> {
        if self.workers.process == std::process::id() {
            return Some(self.clone());
        }
        Pool::of(self.count).ok()
    }

    /// The number of threads, including the caller's.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether sharing work may save time. It does not while other programs use the cores.
    pub fn may_help(&self) -> bool {
        let busy = &self.workers.busy;
        busy.is_over(busy.now())
    }

    /// Calls `own` on the calling thread. Meanwhile each free worker takes one item and calls `work(item)`. Items that no worker has taken when `own`
    /// returns are not processed. Returns the result of `own`.
    pub fn run_with_workers<A: Send, R>(
        &self,
        items: &mut [A],
        work: &(dyn Fn(&mut A) + Sync),
        own: impl FnOnce() -> R,
    ) -> R {
        let (result, _waited) = self.timed_run_with_workers(items, work, own);
        result
    }

    /// As [`run_with_workers`](Self::run_with_workers), where `own` returns the number of pieces of work that it did. Records whether sharing lost
    /// time.
    pub fn share<A: Send>(&self, items: &mut [A], work: &(dyn Fn(&mut A) + Sync), own: impl FnOnce() -> u32) {
        let (began, cpu_before) = (Instant::now(), time_of_this_thread());
        let timed = || {
            let pieces = own();
            (pieces, began.elapsed(), time_of_this_thread())
        };
        let ((pieces, wall, cpu_after), waited) = self.timed_run_with_workers(items, work, timed);
        let cpu = cpu_before.zip(cpu_after).map_or(wall, |(before, after)| after.saturating_sub(before));
        // Time is lost if the caller was preempted, so that its processor time is less than its time. It is also lost if the caller waited for
        // workers longer than their last pieces should take: at most twice as long as a piece of the caller.
        let is_lost = wall.saturating_sub(cpu) > LEAST_LOSS || waited > 2 * wall / pieces.max(1) + LEAST_LOSS;
        let busy = &self.workers.busy;
        busy.note(busy.now(), is_lost);
    }

    /// As [`run_with_workers`](Self::run_with_workers). Also returns the time that the caller waited for workers after `own`. The worker in seat k
    /// ([`region`](super::region)) processes item k.
    fn timed_run_with_workers<A: Send, R>(
        &self,
        items: &mut [A],
        work: &(dyn Fn(&mut A) + Sync),
        own: impl FnOnce() -> R,
    ) -> (R, Duration) {
        // Each item is taken once. The lock proves this to the compiler, for a function that all workers share.
        let items: Vec<_> = items.iter_mut().map(|item| Mutex::new(Some(item))).collect();
        let work_in_seat = |seat: usize| {
            let item = items[seat].lock().unwrap_or_else(PoisonError::into_inner).take();
            if let Some(item) = item {
                work(item);
            }
        };
        self.workers.run_beside(items.len(), &work_in_seat, own)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/pool.rs"]
mod tests;
