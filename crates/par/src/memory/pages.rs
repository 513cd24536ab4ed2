//! The pages of large arrays: huge ones, first touched by all threads, and given back.

use crate::threads::Threads;

/// Smaller blocks gain nothing: measured with 512 x 512, 1024 x 1024 and 2048 x 2048 elements, a solve takes 4, 6 and 18 % less time.
#[cfg(target_os = "linux")]
const LARGE: usize = 1 << 20;
/// Linux's, or a part of one: advice for less than a page is advice for all of it.
#[cfg(target_os = "linux")]
const PAGE: usize = 1 << 12;

/// Advice that the system may ignore. The pages at both ends are asked for, too: neighbouring blocks then share huge pages.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
pub(super) fn ask_for_huge_pages(block: *mut libc::c_void, bytes: usize) {
    if bytes < LARGE {
        return;
    }
    let before = block as usize % PAGE;
    let start = block.wrapping_byte_sub(before);
    // SAFETY: the advice changes in which pages the range is held, not what it holds: it is right for any range of addresses.
    unsafe { libc::madvise(start, (before + bytes).next_multiple_of(PAGE), libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
pub(super) fn ask_for_huge_pages(_: *mut libc::c_void, _: usize) {}

/// Gives the pages within the room of an empty array back; they are entered again when they are touched.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
pub(super) fn give_pages_back<A>(values: &mut Vec<A>) {
    assert!(values.is_empty());
    let (room, bytes) = (values.as_mut_ptr(), values.capacity() * size_of::<A>());
    // SAFETY: it reads a constant of the system.
    let Ok(page) = usize::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }) else { return };
    let before = (room as usize).next_multiple_of(page) - room as usize;
    let whole = bytes.saturating_sub(before) / page * page;
    if whole > 0 {
        // SAFETY: whole pages of the array's own room, which is borrowed mutably and holds no values.
        unsafe { libc::madvise(room.wrapping_byte_add(before).cast(), whole, libc::MADV_DONTNEED) };
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn give_pages_back<A>(_: &mut Vec<A>) {}

/// Bytes that one thread touches first, at least: a huge page.
const TOUCHED: usize = 2 << 20;

/// Makes an array n values long, in the room that it has. The threads write many new ones together: the system clears each page at its first
/// touch, which takes as long as several passes.
#[allow(unsafe_code)]
pub(super) fn lengthen<A: Copy + Send + Sync>(values: &mut Vec<A>, n: usize, mark: A, threads: &Threads) {
    let (known, piece) = (values.len(), TOUCHED / size_of::<A>());
    if threads.count() == 1 || n <= known + piece {
        return values.resize(n, mark);
    }
    threads.for_each_plain_row(&mut values.spare_capacity_mut()[..n - known], piece, |_, new| {
        new.iter_mut().for_each(|value| {
            value.write(mark);
        });
    });
    // SAFETY: each of the values up to n has been written: the known ones before, and the others, within the room, above.
    unsafe { values.set_len(n) };
}
