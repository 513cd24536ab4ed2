//! Large arrays. A failed allocation is an error and does not end the process. Released arrays are kept for reuse.
//!
//! *Kept arrays.* The system clears and maps each new page of memory on its first use. This takes as long as several passes over the page: a tenth to
//! a fifth of the time of a whole call. So the memory of an array that is not needed any more is [kept](keep), and a later array uses it. The process
//! keeps a limited number of bytes ([`keep_at_most`]). Beyond the limit, the array that has been kept longest returns to the system. [`release`]
//! returns all of them. Any thread may keep arrays and take them. No thread waits for the lock of the list: if another thread holds it, an array is
//! neither kept nor taken. The same holds in a child that was forked while another thread held the lock.
//!
//! *Resting arrays.* The arrays of one solve are not all needed at the same time. A large array that is not needed for a while [rests](rest): its
//! pages return to the system, but its addresses stay reserved. So it [wakes](wake) without an error.

mod pages;

use std::any::{Any, TypeId};
use std::collections::VecDeque;
use std::mem::{replace, take};
use std::ops::Deref;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;

use crate::error::{OutOfMemory, Result};
use crate::threads::Threads;
use pages::{give_pages_back, lengthen};

/// The default of the largest number of kept bytes. It is small enough for many processes on one node. Up to 768 x 768 elements, for which a call
/// keeps 46 MiB, calls that set up a new solver were measured to be as fast as with a limit of 512 MiB.
const MOST_KEPT: usize = 112 << 20;
/// The present limit of the kept bytes.
static ALLOWED: AtomicUsize = AtomicUsize::new(MOST_KEPT);
/// The least number of bytes of an array that is kept. The allocator itself reuses smaller blocks.
const LEAST_KEPT: usize = 1 << 13;
/// Before an array of more bytes than this is requested from the system, all kept arrays return to the system.
const RETURNED_ABOVE: usize = 96 << 20;
/// The default of the least number of values of an array that rests. From 4096 x 4096 elements on, memory is scarce, and mapping pages again takes
/// little time compared with a product.
const LEAST_AT_REST: usize = 1 << 23;
/// The present least number of values of an array that rests.
static RESTING: AtomicUsize = AtomicUsize::new(LEAST_AT_REST);

/// A kept array.
struct Kept {
    bytes: usize,
    /// The type of the `Vec`.
    type_id: TypeId,
    /// The capacity in values.
    room: usize,
    /// The `Vec`, with its last values.
    values: Box<dyn Any + Send>,
}

/// All kept arrays.
struct Shelf {
    /// The arrays; the one that has been kept longest comes first.
    blocks: VecDeque<Kept>,
    /// The bytes of all of them.
    bytes: usize,
}

static SHELF: Mutex<Shelf> = Mutex::new(Shelf { blocks: VecDeque::new(), bytes: 0 });

/// An array of n zeros. `what` names the array in messages.
pub fn zeros<A: Copy + Default + Send + 'static>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.resize(n, A::default());
    Ok(v)
}

/// Makes v n values long. The values are unspecified, so the caller writes each of them before it reads it. New memory is filled with `mark`, and so
/// are all values in debug builds: it reveals a value that was not written. The threads write to new pages in parallel. `what` names the array in
/// messages.
pub fn unwritten<A: Copy + Send + Sync + 'static>(
    v: &mut Vec<A>,
    n: usize,
    mark: A,
    what: &str,
    threads: &Threads,
) -> Result<()> {
    if v.capacity() < n {
        match find(n) {
            Some(kept) => keep_one(replace(v, kept)),
            None => {
                v.clear();
                allocate(v, n, what)?;
            }
        }
    }
    wake(v, n, mark, threads);
    if cfg!(debug_assertions) {
        v.fill(mark);
    }
    Ok(())
}

/// A new array of n values, which are unspecified as in [`unwritten`].
pub fn blank<A: Copy + Send + Sync + 'static>(n: usize, mark: A, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    unwritten(&mut v, n, mark, what, &Threads::One)?;
    Ok(v)
}

/// Reserves capacity for n values in v, which keeps its values. Pushing values later allocates nothing. `what` names the array in messages.
pub fn reserve<A: Copy + Send + 'static>(v: &mut Vec<A>, n: usize, what: &str) -> Result<()> {
    if n <= v.capacity() {
        return Ok(());
    }
    if let Some(mut kept) = find(n) {
        kept.clear();
        kept.append(v);
        keep_one(replace(v, kept));
        return Ok(());
    }
    allocate(v, n, what)
}

/// An empty array with capacity for n values, of which the caller may use only a few. Its memory comes from the system, not from the kept arrays:
/// pages that are not used take no memory.
pub fn sparse<A>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    allocate(&mut v, n, what)?;
    Ok(v)
}

/// Reserves capacity for n values, by memory from the system.
fn allocate<A>(v: &mut Vec<A>, n: usize, what: &str) -> Result<()> {
    if n.saturating_mul(size_of::<A>()) > RETURNED_ABOVE {
        release();
    }
    let refused = |_| OutOfMemory(format!("no memory for {n} values of {what}"));
    v.try_reserve_exact(n - v.len()).map_err(refused)
}

/// Takes the smallest kept array with room for n values, if there is one with room for at most a quarter more.
fn find<A: Copy + Send + 'static>(n: usize) -> Option<Vec<A>> {
    if n.saturating_mul(size_of::<A>()) < LEAST_KEPT {
        return None;
    }
    let mut shelf = SHELF.try_lock().ok()?;
    let fits = |kept: &Kept| kept.type_id == TypeId::of::<Vec<A>>() && (n..=n + n / 4).contains(&kept.room);
    let fitting = shelf.blocks.iter().enumerate().filter(|(_, kept)| fits(kept));
    let (_, i) = fitting.map(|(i, kept)| (kept.room, i)).min()?;
    let kept = shelf.blocks.remove(i)?;
    shelf.bytes -= kept.bytes;
    drop(shelf);
    kept.values.downcast().ok().map(|values| *values)
}

/// Whether an array of n values is so large that it rests while it is not needed.
pub fn rests(n: usize) -> bool {
    n >= RESTING.load(Ordering::Relaxed)
}

/// Sets the least number of values of an array that rests. No result depends on this number.
pub fn rest_from(n: usize) {
    RESTING.store(n, Ordering::Relaxed);
}

/// Reserves capacity for n values. A large array rests until it is first needed. A small one is made n values long, as by [`unwritten`].
pub fn asleep<A: Copy + Send + Sync + 'static>(
    v: &mut Vec<A>,
    n: usize,
    mark: A,
    what: &str,
    threads: &Threads,
) -> Result<()> {
    if rests(n) {
        reserve(v, n, what)
    } else {
        unwritten(v, n, mark, what, threads)
    }
}

/// Lets an array rest that is not needed for a while. A large array is then empty; a small one does not change.
pub fn rest<A>(values: &mut Vec<A>) {
    if rests(values.capacity()) {
        values.clear();
        give_pages_back(values);
    }
}

/// Makes an array that may have rested n values long, within its capacity. Its values are unspecified if it rested.
pub fn wake<A: Copy + Send + Sync>(values: &mut Vec<A>, n: usize, mark: A, threads: &Threads) {
    debug_assert!(n <= values.capacity(), "room for {n} values");
    lengthen(values, n, mark, threads);
}

/// Keeps the memory of arrays that are not needed any more, for later arrays of the same type. The arrays are then empty.
pub fn keep<A: Copy + Send + 'static, const K: usize>(arrays: [&mut Vec<A>; K]) {
    arrays.into_iter().for_each(|values| keep_one(take(values)));
}

/// Keeps the memory of one array, if it is neither too small nor larger than the limit. Otherwise the memory returns to the allocator.
fn keep_one<A: Copy + Send + 'static>(values: Vec<A>) {
    let bytes = values.capacity() * size_of::<A>();
    let most = ALLOWED.load(Ordering::Relaxed);
    if bytes < LEAST_KEPT || bytes > most {
        return;
    }
    let Ok(mut shelf) = SHELF.try_lock() else { return };
    shelf.bytes += bytes;
    let (type_id, room) = (TypeId::of::<Vec<A>>(), values.capacity());
    shelf.blocks.push_back(Kept { bytes, type_id, room, values: Box::new(values) });
    shelf.shrink_to(most);
}

impl Shelf {
    /// Frees the arrays that have been kept longest, until the others have at most `most` bytes.
    fn shrink_to(&mut self, most: usize) {
        while self.bytes > most {
            let Some(oldest) = self.blocks.pop_front() else { return };
            self.bytes -= oldest.bytes;
        }
    }
}

/// An array whose memory is kept when it is dropped. Several owners may share it in an `Arc`.
#[derive(Debug, PartialEq)]
pub struct Held(Vec<f64>);

impl From<Vec<f64>> for Held {
    fn from(values: Vec<f64>) -> Held {
        Held(values)
    }
}

impl Deref for Held {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        keep([&mut self.0]);
    }
}

/// Returns all kept arrays to the system.
pub fn release() {
    if let Ok(mut shelf) = SHELF.try_lock() {
        (shelf.blocks, shelf.bytes) = (VecDeque::new(), 0);
    }
}

/// Sets the largest number of kept bytes. Arrays beyond it return to the system.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Ok(mut shelf) = SHELF.try_lock() {
        shelf.shrink_to(bytes);
    }
}

/// The number of bytes that are kept now.
pub fn kept() -> usize {
    SHELF.try_lock().map_or(0, |shelf| shelf.bytes)
}

/// Collects computed values of any type in a new array, whose memory comes from the system. `what` names the array in messages.
pub fn collected<A>(values: impl ExactSizeIterator<Item = A>, what: &str) -> Result<Vec<A>> {
    let mut collected = Vec::new();
    allocate(&mut collected, values.len(), what)?;
    collected.extend(values);
    Ok(collected)
}

/// Collects computed values in an array.
pub fn computed<A: Copy + Send + 'static>(values: impl ExactSizeIterator<Item = A>, what: &str) -> Result<Vec<A>> {
    let mut computed = Vec::new();
    reserve(&mut computed, values.len(), what)?;
    computed.extend(values);
    Ok(computed)
}

/// A copy of values, in kept memory if there is some.
pub fn copied<A: Copy + Send + 'static>(values: &[A], what: &str) -> Result<Vec<A>> {
    computed(values.iter().copied(), what)
}

#[cfg(test)]
#[path = "../../tests/unit/memory.rs"]
mod tests;
