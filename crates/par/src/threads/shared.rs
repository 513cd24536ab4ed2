//! Data that a process shares, and that a process forked meanwhile does not wait for.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};

/// Attempts to take a lock before it counts as held for long.
const LOCK_ATTEMPTS: usize = 1000;

/// Data behind a lock.
pub struct Shared<A> {
    data: Mutex<A>,
    /// The process in which the lock was held for long when it was last tried; 0: none.
    held_in: AtomicU32,
}

impl<A> Shared<A> {
    /// Shares data.
    pub const fn new(data: A) -> Shared<A> {
        Shared { data: Mutex::new(data), held_in: AtomicU32::new(0) }
    }

    /// Takes the lock. None if another thread holds it for long: a process that was forked while another thread held the lock would wait for ever.
    /// Such a process waits once.
    pub fn lock(&self) -> Option<MutexGuard<'_, A>> {
        for _ in 0..LOCK_ATTEMPTS {
            let held = match self.data.try_lock() {
                Ok(held) => held,
                Err(TryLockError::Poisoned(held)) => held.into_inner(),
                Err(TryLockError::WouldBlock) if self.held_in.load(Ordering::Relaxed) == std::process::id() => {
                    return None;
                }
                Err(TryLockError::WouldBlock) => {
                    std::thread::yield_now();
                    continue;
                }
            };
            self.held_in.store(0, Ordering::Relaxed);
            return Some(held);
        }
        self.held_in.store(std::process::id(), Ordering::Relaxed);
        None
    }
}

/// The value of a place, made by the first callers. They do not wait for each other, and the first value stays.
pub fn made_once<A>(place: &OnceLock<A>, make: impl FnOnce() -> A) -> &A {
    match place.get() {
        Some(made) => made,
        None => {
            let made = make();
            place.get_or_init(|| made)
        }
    }
}
