//! A plan without enough memory is an error. The FFT crate would end the process, so it is called only when there is room.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

use toeplitz::fft::row_transform::RowTransform;
use toeplitz::fft::{ColumnTransform, Real};
use toeplitz::plan;

/// The system's allocator, with at most `ROOM` bytes for each thread.
struct Limited;

thread_local! {
    static ROOM: Cell<usize> = const { Cell::new(usize::MAX) };
    static HELD: Cell<usize> = const { Cell::new(0) };
}

/// Smaller allocations, messages and short lists, never fail.
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

/// Makes plans with more and more room until there is enough. Returns the number of failures.
fn lacks<R>(n: usize, make: impl Fn() -> par::Result<R>) -> usize {
    for lacks in 0.. {
        plan::release();
        ROOM.set(HELD.get() + lacks * n * 4 + 2 * SMALL);
        let made = make();
        ROOM.set(usize::MAX);
        if made.is_ok() {
            return lacks;
        }
    }
    unreachable!()
}

fn of_any_length<T: Real>() {
    // Small prime factors, a large one, primes.
    for n in [6000, 27040, 65536, 100_004, 11_999, 20_789, 997] {
        assert!(lacks(n, || ColumnTransform::<T>::new(n)) > 3, "{n}");
        assert!(lacks(n, || RowTransform::<T>::new(n)) > 1, "{n}, a row");
    }
}

#[test]
fn plans_without_memory_are_refused() {
    of_any_length::<f64>();
    of_any_length::<f32>();
}

#[test]
fn products_without_memory_for_their_plans_are_refused() {
    let make = || toeplitz::Product::<f64>::new((3000, 1), (6000, 1), &par::threads::Threads::One);
    assert!(lacks(6000, make) > 3);
    let by_stages = || toeplitz::Product::<f64>::new((1000, 400), (2000, 800), &par::threads::Threads::One);
    assert!(lacks(2000, by_stages) > 3);
}
