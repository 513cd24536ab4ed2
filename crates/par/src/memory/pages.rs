//! The pages of large arrays: first touched by all threads, and given back.

use crate::threads::Threads;

/// Returns the pages within the capacity of an empty array to the system, which maps them again at the next touch.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
pub(super) fn give_pages_back<A>(values: &mut Vec<A>) {
    assert!(values.is_empty());
    let (room, bytes) = (values.as_mut_ptr(), values.capacity() * size_of::<A>());
    // SAFETY: sysconf reads a constant of the system.
    let Ok(page) = usize::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }) else { return };
    let before = (room as usize).next_multiple_of(page) - room as usize;
    let whole = bytes.saturating_sub(before) / page * page;
    if whole > 0 {
        // SAFETY: whole pages of the array's own capacity, which is borrowed mutably and holds no values.
        unsafe { libc::madvise(room.wrapping_byte_add(before).cast(), whole, libc::MADV_DONTNEED) };
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn give_pages_back<A>(_: &mut Vec<A>) {}

/// Least bytes that one thread touches.
const LEAST_TOUCHED: usize = 1 << 19;

/// Extends an array to n values within its capacity. The threads share the first writes: the system clears each page at its first touch,
/// which takes as long as several passes.
#[allow(unsafe_code)]
pub(super) fn lengthen<A: Copy + Send + Sync>(values: &mut Vec<A>, n: usize, mark: A, threads: &Threads) {
    let (known, piece) = (values.len(), LEAST_TOUCHED / size_of::<A>());
    if threads.count() == 1 || n <= known + piece {
        return values.resize(n, mark);
    }
    threads.for_each_plain_row(&mut values.spare_capacity_mut()[..n - known], piece, |_, new| {
        new.iter_mut().for_each(|value| {
            value.write(mark);
        });
    });
    // SAFETY: all values up to n have been written: the known ones before, the others, within the capacity, above.
    unsafe { values.set_len(n) };
}
