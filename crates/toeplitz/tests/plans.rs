//! A plan without enough memory is an error. rustfft itself would end the process, so it is called only if there is enough.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

use toeplitz::fft::row_transform::RowTransform;
use toeplitz::fft::{ColumnTransform, Real};
use toeplitz::plan;

/// The system's allocator, which refuses an allocation if the thread would hold more than `ROOM` bytes.
struct Limited;

thread_local! {
    /// The largest number of bytes that this thread may hold.
    static ROOM: Cell<usize> = const { Cell::new(usize::MAX) };
    /// The number of bytes that this thread holds.
    static HELD: Cell<usize> = const { Cell::new(0) };
}

/// Allocations of at most this many bytes never fail. They are messages and short lists.
const SMALL: usize = 512;

// SAFETY: the system's allocator, or null.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.get() + layout.size();
        if layout.size() > SMALL && held > ROOM.get() {
            return null_mut();
        }
        HELD.set(held);
        // SAFETY: by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        HELD.set(HELD.get().saturating_sub(layout.size()));
        // SAFETY: by the caller.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static LIMITED: Limited = Limited;

/// Makes plans of length n with more and more memory, until there is enough. Returns the number of failures.
fn failures<R>(n: usize, make: impl Fn() -> par::Result<R>) -> usize {
    for failures in 0.. {
        plan::release();
        ROOM.set(HELD.get() + failures * n * 4 + 2 * SMALL);
        let made = make();
        ROOM.set(usize::MAX);
        if made.is_ok() {
            return failures;
        }
    }
    unreachable!()
}

/// Plans transforms of lengths with small prime factors, with a large one, and of primes.
fn plan_any_length<T: Real>() {
    for n in [6000, 27040, 65536, 100_004, 11_999, 20_789, 997] {
        assert!(failures(n, || ColumnTransform::<T>::new(n)) > 3, "{n}");
        assert!(failures(n, || RowTransform::<T>::new(n)) > 1, "{n}, a row");
    }
}

#[test]
fn plans_without_memory_are_refused() {
    plan_any_length::<f64>();
    plan_any_length::<f32>();
}

#[test]
fn products_without_memory_for_their_plans_are_refused() {
    let make = || toeplitz::Product::<f64>::new((3000, 1), (6000, 1), &par::threads::Threads::One);
    assert!(failures(6000, make) > 3);
    let by_stages = || toeplitz::Product::<f64>::new((1000, 400), (2000, 800), &par::threads::Threads::One);
    assert!(failures(2000, by_stages) > 3);
}
