//! Data that the threads of a process share. A child that is forked while a thread holds the lock of the data does not wait for this lock.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};

/// The number of attempts to take a lock before it counts as held for long.
const LOCK_ATTEMPTS: usize = 1000;

/// Data behind a lock that nobody waits for.
pub struct Shared<A> {
    data: Mutex<A>,
    /// The id of the process in which the last attempt to take the lock failed. 0 if it succeeded.
    held_in: AtomicU32,
}

impl<A> Shared<A> {
    /// Puts data behind a lock.
    pub const fn new(data: A) -> Shared<A> {
        Shared { data: Mutex::new(data), held_in: AtomicU32::new(0) }
    }

    /// Takes the lock. Returns None if another thread holds it for long. A child that was forked while another thread held the lock would otherwise
    /// wait for ever. A process makes many attempts once; later calls return None at once, as long as the lock is held.
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

/// The value of a cell. If the cell is empty, makes a value and stores it. Several threads may make a value at the same time, without waiting for
/// each other. The first value that is stored stays, and all get this value.
pub fn made_once<A>(cell: &OnceLock<A>, make: impl FnOnce() -> A) -> &A {
    match cell.get() {
        Some(made) => made,
        None => {
            let made = make();
            cell.get_or_init(|| made)
        }
    }
}
