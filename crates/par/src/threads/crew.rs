//! The workers of a process, and the list of regions that they share. rayon lends the threads.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::busy::Busy;
use super::region::Region;
use super::signals;
use crate::error::{OutOfMemory, Result};

/// Prefix of the names of our threads.
pub const THREAD_NAME: &str = "contact-normal-";

thread_local! {
    static IS_WORKER: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is one of the pool. A thread may ask even while it ends, when its name is gone.
pub fn is_worker() -> bool {
    IS_WORKER.get()
}

/// How long workers spin for more work before they sleep, and a caller for the end of the workers. A solve has hundreds of passes of 10 to
/// 1000 us, with serial work between them, and waking a sleeping thread takes about 50 us.
const AWAKE: Duration = Duration::from_micros(150);

/// Bytes of a worker's stack, whatever RUST_MIN_STACK says.
const STACK: usize = 2 << 20;

/// The workers of one process. In a forked child they do not exist.
pub(super) struct Crew {
    pub process: u32,
    shared: Arc<Shared>,
    lent: Mutex<Vec<rayon::ThreadPool>>,
    pub busy: Busy,
}

/// The state that workers share with callers.
#[derive(Default)]
struct Shared {
    regions: Mutex<Regions>,
    /// The number of regions ever offered, which spinning workers watch.
    offered: AtomicUsize,
    /// Workers that spin.
    awake: AtomicUsize,
    is_offered: Condvar,
    is_over: AtomicBool,
}

/// The open regions, under one lock for taking seats and closing.
#[derive(Default)]
struct Regions {
    open: Vec<Arc<Region>>,
    /// Workers that sleep.
    asleep: usize,
}

fn lock<A>(shared: &Mutex<A>) -> MutexGuard<'_, A> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Crew {
    /// A crew without workers.
    pub fn new() -> Crew {
        let process = std::process::id();
        Crew { process, shared: Arc::default(), lent: Mutex::default(), busy: Busy::default() }
    }

    /// The number of workers.
    pub fn len(&self) -> usize {
        lock(&self.lent).iter().map(|lent| lent.current_num_threads()).sum()
    }

    /// Starts workers up to this number.
    pub fn grow_to(&self, workers: usize) -> Result<()> {
        let mut lent = lock(&self.lent);
        let known = lent.iter().map(|lent| lent.current_num_threads()).sum::<usize>();
        if known >= workers {
            return Ok(());
        }
        let refused = |e| OutOfMemory(format!("threads is {}; the threads could not be started: {e}", workers + 1));
        let builder = rayon::ThreadPoolBuilder::new().num_threads(workers - known).stack_size(STACK);
        let builder =
            builder.thread_name(move |i| format!("{THREAD_NAME}{}", known + i)).start_handler(|_| IS_WORKER.set(true));
        let more = signals::blocked(|| builder.build()).map_err(refused)?;
        let shared = self.shared.clone();
        more.spawn_broadcast(move |_| shared.work());
        lent.push(more);
        Ok(())
    }

    /// Calls `own` on the calling thread. Meanwhile free workers take the seats 0, 1, .. and call `work(seat)`, one worker a seat. Seats that
    /// are free when `own` returns stay empty. Returns the result of `own`, and the time that the caller then waited.
    pub fn beside<R>(&self, seats: usize, work: &(dyn Fn(usize) + Sync), own: impl FnOnce() -> R) -> (R, Duration) {
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

impl Drop for Crew {
    fn drop(&mut self) {
        if self.process != std::process::id() {
            // The threads belong to another process, which may have held any lock: they are not signalled.
            return std::mem::forget(std::mem::take(&mut *self.lent.get_mut().unwrap_or_else(PoisonError::into_inner)));
        }
        self.shared.is_over.store(true, Ordering::Release);
        drop(lock(&self.shared.regions));
        self.shared.is_offered.notify_all();
    }
}

impl Shared {
    /// Offers a region to the spinning workers, and wakes others if these are too few.
    fn open(&self, region: &Arc<Region>, seats: usize) {
        let mut regions = lock(&self.regions);
        regions.open.push(region.clone());
        let to_wake = seats.saturating_sub(self.awake.load(Ordering::Relaxed)).min(regions.asleep);
        drop(regions);
        self.offered.fetch_add(1, Ordering::Release);
        (0..to_wake).for_each(|_| self.is_offered.notify_one());
    }

    /// The loop of a worker.
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

    /// Spins until a new region is offered, at most for [`AWAKE`].
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

/// Removes a region from the list, and waits for workers that have begun, also when the caller's own part panics.
struct Close<'a>(&'a Shared, &'a Arc<Region>);

impl Drop for Close<'_> {
    fn drop(&mut self) {
        let Close(shared, region) = self;
        lock(&shared.regions).open.retain(|other| !Arc::ptr_eq(other, region));
        region.wait(AWAKE);
    }
}
