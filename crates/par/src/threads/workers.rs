//! The worker threads of a process, and the list of regions of work that callers offer to these workers ([`region`](super::region)). rayon starts the
//! threads.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::busy::Busy;
use super::region::Region;
use super::signals;
use crate::error::{OutOfMemory, Result};

/// The prefix of the names of the worker threads.
pub const THREAD_NAME: &str = "contact-normal-";

thread_local! {
    static IS_WORKER: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is a worker. The answer is right even while the thread ends, when it has no name any more.
pub fn is_worker() -> bool {
    IS_WORKER.get()
}

/// How long a worker spins for more work before it sleeps, and a caller for the end of the workers' pieces. A solve has hundreds of passes of 10 to
/// 1000 us, with serial work between them. Waking a sleeping thread takes about 50 us.
const AWAKE: Duration = Duration::from_micros(150);

/// The bytes of a worker's stack. The environment variable RUST_MIN_STACK does not change them.
const STACK: usize = 2 << 20;

/// The worker threads of one process. A forked child has this record, but not the threads.
pub(super) struct Workers {
    /// The id of the process that started the workers.
    pub process: u32,
    shared: Arc<Shared>,
    /// The threads. Each call that needed more of them has added a pool of rayon.
    pools: Mutex<Vec<rayon::ThreadPool>>,
    /// Whether other programs use the cores.
    pub busy: Busy,
}

/// The state that workers share with callers.
#[derive(Default)]
struct Shared {
    regions: Mutex<Regions>,
    /// The number of regions that have been offered so far. Spinning workers watch it.
    offered: AtomicUsize,
    /// The number of workers that spin.
    awake: AtomicUsize,
    /// Wakes sleeping workers: there is a region, or the workers shall end.
    is_offered: Condvar,
    /// Whether the workers shall end.
    is_over: AtomicBool,
}

/// The regions that are offered. One lock protects the list while a worker takes a seat, and while a caller closes a region.
#[derive(Default)]
struct Regions {
    open: Vec<Arc<Region>>,
    /// The number of workers that sleep.
    asleep: usize,
}

/// Locks a mutex, also after a panic of another thread that held it.
fn lock<A>(shared: &Mutex<A>) -> MutexGuard<'_, A> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Workers {
    /// The record of this process, without threads.
    pub fn new() -> Workers {
        let process = std::process::id();
        Workers { process, shared: Arc::default(), pools: Mutex::default(), busy: Busy::default() }
    }

    /// The number of worker threads.
    pub fn len(&self) -> usize {
        lock(&self.pools).iter().map(|pool| pool.current_num_threads()).sum()
    }

    /// Starts more worker threads, if there are fewer than `count`.
    pub fn grow_to(&self, count: usize) -> Result<()> {
        let mut pools = lock(&self.pools);
        let present = pools.iter().map(|pool| pool.current_num_threads()).sum::<usize>();
        if present >= count {
            return Ok(());
        }
        let refused = |e| OutOfMemory(format!("threads is {}; the threads could not be started: {e}", count + 1));
        let builder = rayon::ThreadPoolBuilder::new().num_threads(count - present).stack_size(STACK);
        let name = move |i| format!("{THREAD_NAME}{}", present + i);
        let builder = builder.thread_name(name).start_handler(|_| IS_WORKER.set(true));
        let more = signals::blocked(|| builder.build()).map_err(refused)?;
        let shared = self.shared.clone();
        more.spawn_broadcast(move |_| shared.work());
        pools.push(more);
        Ok(())
    }

    /// Calls `own` on the calling thread. Meanwhile free workers take the seats 0, 1, ... `seats - 1`, one worker a seat, and call `work(seat)`.
    /// Seats that no worker has taken when `own` returns stay empty. Returns the result of `own`, and the time that the caller waited for workers
    /// after `own`.
    pub fn run_beside<R>(&self, seats: usize, work: &(dyn Fn(usize) + Sync), own: impl FnOnce() -> R) -> (R, Duration) {
        // SAFETY: `close` removes the region from the list in any case, and waits for its workers.
        let region = Arc::new(unsafe { Region::new(seats, work) });
        self.shared.open(&region, seats);
        let close = Close(&self.shared, &region);
        let result = own();
        let began = Instant::now();
        drop(close);
        let waited = began.elapsed();
        if let Some(panic) = region.panic() {
            std::panic::resume_unwind(panic);
        }
        (result, waited)
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        if self.process != std::process::id() {
            // The threads exist in the parent process only. It may have held any lock at the fork, so the pools are left as they are.
            return std::mem::forget(std::mem::take(
                &mut *self.pools.get_mut().unwrap_or_else(PoisonError::into_inner),
            ));
        }
        self.shared.is_over.store(true, Ordering::Release);
        drop(lock(&self.shared.regions));
        self.shared.is_offered.notify_all();
    }
}

impl Shared {
    /// Offers a region to the workers that spin. If they are fewer than its seats, wakes workers that sleep.
    fn open(&self, region: &Arc<Region>, seats: usize) {
        let mut regions = lock(&self.regions);
        regions.open.push(region.clone());
        let to_wake = seats.saturating_sub(self.awake.load(Ordering::Relaxed)).min(regions.asleep);
        drop(regions);
        self.offered.fetch_add(1, Ordering::Release);
        (0..to_wake).for_each(|_| self.is_offered.notify_one());
    }

    /// The loop of a worker: it waits for a region with a free seat, takes the seat and does its work, until the workers shall end.
    fn work(&self) {
        let mut seen = 0;
        while !self.is_over.load(Ordering::Acquire) {
            self.spin(seen);
            let mut regions = lock(&self.regions);
            let (region, seat) = loop {
                seen = self.offered.load(Ordering::Acquire);
                if self.is_over.load(Ordering::Acquire) {
                    return;
                }
                let seat = |region: &Arc<Region>| region.take_seat().map(|seat| (region.clone(), seat));
                if let Some(found) = regions.open.iter().find_map(seat) {
                    break found;
                }
                regions.asleep += 1;
                regions = self.is_offered.wait(regions).unwrap_or_else(PoisonError::into_inner);
                regions.asleep -= 1;
            };
            drop(regions);
            region.work(seat);
        }
    }

    /// Spins until more regions than `seen` have been offered, at most for [`AWAKE`].
    fn spin(&self, seen: usize) {
        self.awake.fetch_add(1, Ordering::Relaxed);
        let began = Instant::now();
        let is_new = || self.offered.load(Ordering::Acquire) != seen;
        while !is_new() && began.elapsed() < AWAKE {
            std::hint::spin_loop();
        }
        self.awake.fetch_sub(1, Ordering::Relaxed);
    }
}

/// When dropped, removes a region from the list and waits for the workers that have taken a seat. This also happens if the caller's own part panics.
struct Close<'a>(&'a Shared, &'a Arc<Region>);

impl Drop for Close<'_> {
    fn drop(&mut self) {
        let Close(shared, region) = self;
        lock(&shared.regions).open.retain(|other| !Arc::ptr_eq(other, region));
        region.wait(AWAKE);
    }
}
