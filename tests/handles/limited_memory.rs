//! The system's allocator, with limits for each thread by which a test lets allocations fail.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

use contact_normal::ffi::{contact_normal_release, CONTACT_NORMAL_OK, CONTACT_NORMAL_OUT_OF_MEMORY};

struct Limited;

thread_local! {
    /// An allocation counts against the limits if it has at least this many bytes.
    static LARGE: Cell<usize> = const { Cell::new(usize::MAX) };
    /// How many more allocations of `LARGE` bytes or more succeed.
    static ALLOWED: Cell<u64> = const { Cell::new(u64::MAX) };
    /// The bytes that the thread may hold after an allocation of `LARGE` bytes or more.
    static ROOM: Cell<i64> = const { Cell::new(i64::MAX) };
    /// The bytes that the thread holds.
    static HELD: Cell<i64> = const { Cell::new(0) };
}

fn may_have(bytes: usize) -> bool {
    if bytes >= LARGE.get() {
        let allowed = ALLOWED.get();
        ALLOWED.set(allowed.saturating_sub(1));
        if allowed == 0 || HELD.get() + bytes as i64 > ROOM.get() {
            return false;
        }
    }
    HELD.set(HELD.get() + bytes as i64);
    true
}

// SAFETY: memory is that of the system's allocator, or null.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if may_have(layout.size()) {
            // SAFETY: by the caller.
            unsafe { System.alloc(layout) }
        } else {
            null_mut()
        }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if may_have(layout.size()) {
            // SAFETY: by the caller.
            unsafe { System.alloc_zeroed(layout) }
        } else {
            null_mut()
        }
    }
    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if may_have(size) {
            HELD.set(HELD.get() - layout.size() as i64);
            // SAFETY: by the caller.
            unsafe { System.realloc(old, layout, size) }
        } else {
            null_mut()
        }
    }
    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        HELD.set(HELD.get() - layout.size() as i64);
        // SAFETY: by the caller.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static LIMITED: Limited = Limited;

/// Calls `run` with `allowed` successful allocations of `large` bytes or more. All later ones of this size fail.
pub fn with<R>(large: usize, allowed: u64, run: impl FnOnce() -> R) -> R {
    ALLOWED.set(allowed);
    LARGE.set(large);
    let result = run();
    LARGE.set(usize::MAX);
    ALLOWED.set(u64::MAX);
    result
}

/// Frees the memory that earlier solves kept, which calls would use instead of allocations.
pub fn release() {
    contact_normal_release();
}

/// Attempts a call with 0, 1, 2, ... allowed large allocations until it succeeds, beyond 24 in growing steps. Asserts that each failure is
/// OUT_OF_MEMORY. Returns the number allowed.
pub fn until_enough(what: &str, mut attempt: impl FnMut(u64) -> i32) -> u64 {
    let mut allowed = 0;
    loop {
        release();
        let status = attempt(allowed);
        if status == CONTACT_NORMAL_OK {
            assert!(allowed > 0, "{what}: nothing was allocated");
            return allowed;
        }
        assert_eq!(status, CONTACT_NORMAL_OUT_OF_MEMORY, "{what}, {allowed} allocations");
        allowed += 1 + allowed / 24;
    }
}

/// Calls `run` with room for `bytes` more bytes. Allocations of `large` bytes or more beyond this room fail.
#[allow(dead_code)] // Only tests/handles uses it.
pub fn within<R>(large: usize, bytes: i64, run: impl FnOnce() -> R) -> R {
    ROOM.set(HELD.get() + bytes);
    let result = with(large, u64::MAX, run);
    ROOM.set(i64::MAX);
    result
}

/// The bytes that this thread has allocated and not freed.
#[allow(dead_code)] // Only tests/memory.rs uses it.
pub fn held() -> i64 {
    HELD.get()
}
