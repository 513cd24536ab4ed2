//! The pages of large arrays: all threads write to them first, and they return to the system while an array rests.

use crate::threads::Threads;

/// Returns the pages within the capacity of an empty array to the system. The system maps them again at the next access.
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
        // SAFETY: these are whole pages within the capacity of the array, which is borrowed mutably and holds no values.
        unsafe { libc::madvise(room.wrapping_byte_add(before).cast(), whole, libc::MADV_DONTNEED) };
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn give_pages_back<A>(_: &mut Vec<A>) {}

/// The least number of bytes that one thread writes in [`lengthen`].
const LEAST_TOUCHED: usize = 1 << 19;

/// Makes an array n values long, within its capacity; new values are `mark`. The threads share these first writes: the system clears each page at its
/// first access, which takes as long as several passes over the page.
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
    // SAFETY: all values up to n have been written: the first ones before this call, and the others, within the capacity, above.
    unsafe { values.set_len(n) };
}
