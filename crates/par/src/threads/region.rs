//! A region: the work of one caller, of which workers may do a part.
//!
//! A region has a number of seats. Each worker takes one seat under the lock of the list of regions, and does the work of this seat. When the caller
//! has finished its own part, it removes the region from the list, so that no more seats are taken. It then waits for the workers that have a seat.
//! So the caller never waits for a worker that has not begun.

use std::any::Any;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The function `work(seat)`.
type Call = *const (dyn Fn(usize) + Sync);

/// The work of one caller, of which workers may do a part.
pub(super) struct Region {
    call: Call,
    /// The number of seats.
    seats: usize,
    /// The number of seats that workers have taken.
    taken: AtomicUsize,
    /// The number of seats whose work is done: the workers have left them.
    left: AtomicUsize,
    end: Mutex<End>,
    /// Wakes the caller when a worker leaves its seat.
    is_left: Condvar,
}

/// What the caller and the workers tell each other at the end of a region.
#[derive(Default)]
struct End {
    /// Whether the caller sleeps until all seats are left.
    is_awaited: bool,
    /// The payload of a worker's panic.
    panic: Option<Box<dyn Any + Send>>,
}

// SAFETY: the function behind `call` is Sync, so any thread may call it; who makes a region guarantees the lifetime of this function.
unsafe impl Send for Region {}
// SAFETY: as above; all else is atomic or locked.
unsafe impl Sync for Region {}

impl Region {
    /// A region with `seats` seats. The worker in a seat calls `work(seat)`.
    ///
    /// # Safety
    ///
    /// `work` lives until [`wait`](Self::wait) has returned, and no seat is taken after that.
    pub unsafe fn new(seats: usize, work: &(dyn Fn(usize) + Sync)) -> Region {
        // SAFETY: only the lifetime changes, which the caller of this function guarantees.
        let call = unsafe { std::mem::transmute::<&(dyn Fn(usize) + Sync), Call>(work) };
        let (taken, left) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Region { call, seats, taken, left, end: Mutex::default(), is_left: Condvar::new() }
    }

    /// Takes a seat, if one is free. The calling worker holds the lock of the list of regions.
    pub fn take_seat(&self) -> Option<usize> {
        let seat = self.taken.load(Ordering::Relaxed);
        (seat < self.seats).then(|| self.taken.fetch_add(1, Ordering::Relaxed))
    }

    /// Does the work of a seat, then leaves the seat. A panic is stored for the caller.
    pub fn work(&self, seat: usize) {
        // SAFETY: the seat was taken while the region was in the list, and is not left yet, so `work` lives.
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

    /// Waits until the workers have left all taken seats. The caller spins for the time `awake`. Then it sleeps, which frees its core for a worker
    /// that waits for a core.
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

    /// Takes the payload of a worker's panic, if there was one.
    pub fn panic(&self) -> Option<Box<dyn Any + Send>> {
        self.end.lock().unwrap_or_else(PoisonError::into_inner).panic.take()
    }
}
