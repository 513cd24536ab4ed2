//! Pools of workers: made when first asked for, and shared by all solves of a process.
//!
//! Each is stamped with the process id: after a fork the child has no workers, so it makes a pool of its own instead of waiting for threads
//! that are not there; so does an operator that was set up before the fork.
//!
//! *Between two passes* workers look for work for a while before they sleep: a solve has hundreds of passes of some 10 to 1000 us, with work of
//! one thread between them, and waking a thread that sleeps takes some 50. They do not yield their core meanwhile (docs/notes/2026-11-performance-targets.md).

use std::mem::take;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::error::{OutOfMemory, Result};

/// The workers beside a calling thread, and the process that has them.
#[derive(Clone)]
pub struct Pool {
    process: u32,
    /// Threads, the caller's own among them.
    count: usize,
    workers: Arc<rayon::ThreadPool>,
    /// Workers that look for work.
    awake: Arc<AtomicUsize>,
}

/// So long workers look for more work before they sleep, and a caller for the end of theirs.
const AWAKE: Duration = Duration::from_micros(150);

/// Prefix of the names of our threads.
pub const THREAD_NAME: &str = "contact-normal-";

static POOLS: Mutex<Vec<Pool>> = Mutex::new(Vec::new());

impl Pool {
    /// The pool of this process with so many threads, the caller's own among them.
    pub fn of(count: usize) -> Result<Pool> {
        let process = std::process::id();
        let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = pools.iter().find(|known| known.process == process && known.count == count) {
            return Ok(known.clone());
        }
        // Pools of a parent process have no workers here, and dropping one would wait for them: forget it.
        pools.retain_mut(|known| {
            let ours = known.process == process;
            if !ours {
                std::mem::forget(known.workers.clone());
            }
            ours
        });
        let workers = rayon::ThreadPoolBuilder::new()
            .num_threads(count - 1)
            .thread_name(|i| format!("{THREAD_NAME}{i}"))
            .build()
            .map_err(|e| OutOfMemory(format!("threads is {count}; the threads could not be started: {e}")))?;
        let pool = Pool { process, count, workers: Arc::new(workers), awake: Arc::default() };
        pools.push(pool.clone());
        Ok(pool)
    }

    /// Ends the threads that no solver holds; those of others end with them.
    pub fn release() {
        let process = std::process::id();
        for pool in take(&mut *POOLS.lock().unwrap_or_else(PoisonError::into_inner)) {
            // Those of a parent process have no workers here, and dropping one would wait for them.
            if pool.process != process {
                std::mem::forget(pool.workers);
            }
        }
    }

    /// Threads that are kept in this process, beside those of the callers.
    pub fn kept() -> usize {
        let process = std::process::id();
        let pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        pools.iter().filter(|pool| pool.process == process).map(|pool| pool.count - 1).sum()
    }

    /// This pool, or after a fork another one; none: it could not be made.
    pub fn here(&self) -> Option<Pool> {
        if self.process == std::process::id() {
            return Some(self.clone());
        }
        Pool::of(self.count).ok()
    }

    /// Number of threads, the caller's own among them.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Calls `work(item)` for each of some items on the workers, and meanwhile `own` on the calling thread.
    pub fn beside<A: Send>(&self, items: &mut [A], work: impl Fn(&mut A) + Sync, own: impl FnOnce()) {
        self.stay_awake();
        let (work, left) = (&work, &AtomicUsize::new(items.len()));
        self.workers.in_place_scope(|scope| {
            for item in items {
                scope.spawn(move |_| {
                    work(item);
                    left.fetch_sub(1, Ordering::Release);
                });
            }
            own();
            // The end of the scope would put this thread to sleep.
            let began = Instant::now();
            while left.load(Ordering::Acquire) > 0 && began.elapsed() < AWAKE {
                std::hint::spin_loop();
            }
        });
    }

    /// Workers look for work until there was none for a while.
    fn stay_awake(&self) {
        let all = self.count - 1;
        if self.awake.compare_exchange(0, all, Ordering::AcqRel, Ordering::Relaxed).is_err() {
            return;
        }
        let awake = self.awake.clone();
        self.workers.spawn_broadcast(move |_| {
            let mut last = Instant::now();
            while last.elapsed() < AWAKE {
                match rayon::yield_now() {
                    Some(rayon::Yield::Executed) => last = Instant::now(),
                    _ => std::hint::spin_loop(),
                }
            }
            awake.fetch_sub(1, Ordering::AcqRel);
        });
    }
}
