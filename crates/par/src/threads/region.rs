//! Work of one caller that workers may share.
//!
//! Each worker takes a seat, under the lock of the list of regions. When the caller has done its own part it takes the region off the list: then
//! no seat is taken any more, and it waits for those who have one. So it never waits for a worker that has not begun.

use std::any::Any;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A call of `work(seat)`.
type Call = *const (dyn Fn(usize) + Sync);

/// A piece of work with which workers may help.
pub(super) struct Region {
    call: Call,
    seats: usize,
    taken: AtomicUsize,
    left: AtomicUsize,
    end: Mutex<End>,
    is_left: Condvar,
}

/// How the seats were left.
#[derive(Default)]
struct End {
    /// The caller sleeps until they are.
    is_awaited: bool,
    /// The payload of a worker's panic.
    panic: Option<Box<dyn Any + Send>>,
}

// SAFETY: what `call` points to is Sync, so any thread may call it; who makes a region says how long it lives.
unsafe impl Send for Region {}
// SAFETY: as above; all else is atomic or locked.
unsafe impl Sync for Region {}

impl Region {
    /// So many seats, whose holders call `work(seat)`.
    ///
    /// # Safety
    ///
    /// `work` lives until [`wait`](Self::wait) has returned, and after that nobody takes a seat.
    pub unsafe fn new(seats: usize, work: &(dyn Fn(usize) + Sync)) -> Region {
        // SAFETY: only the lifetime is another one; the caller of this function sees to it.
        let call = unsafe { std::mem::transmute::<&(dyn Fn(usize) + Sync), Call>(work) };
        let (taken, left) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Region { call, seats, taken, left, end: Mutex::default(), is_left: Condvar::new() }
    }

    /// A seat, if there is one left. Only under the lock of the list.
    pub fn take_seat(&self) -> Option<usize> {
        let seat = self.taken.load(Ordering::Relaxed);
        (seat < self.seats).then(|| self.taken.fetch_add(1, Ordering::Relaxed))
    }

    /// Does the work of a seat, and leaves it.
    pub fn work(&self, seat: usize) {
        // SAFETY: the seat was taken while the region stood in the list, and it is not left: so the work lives.
        let result = catch_unwind(AssertUnwindSafe(|| unsafe { (*self.call)(seat) }));
        let mut end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
        if let Err(panic) = result {
            end.panic = Some(panic);
        }
        self.left.fetch_add(1, Ordering::Release);
        if end.is_awaited {
            self.is_left.notify_one();
        }
    }

    /// Waits until all seats that were taken are left: awake for a while, then asleep, which lends the core to a worker that has none.
    pub fn wait(&self, awake: Duration) {
        let (taken, began) = (self.taken.load(Ordering::Relaxed), Instant::now());
        let is_over = || self.left.load(Ordering::Acquire) == taken;
        while !is_over() && began.elapsed() < awake {
            std::hint::spin_loop();
        }
        if !is_over() {
            let mut end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
            end.is_awaited = true;
            while !is_over() {
                end = self.is_left.wait(end).unwrap_or_else(PoisonError::into_inner);
            }
        }
    }

    /// The payload of a worker's panic.
    pub fn panic(&self) -> Option<Box<dyn Any + Send>> {
        self.end.lock().unwrap_or_else(PoisonError::into_inner).panic.take()
    }
}
