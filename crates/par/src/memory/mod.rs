//! Large arrays. A failed allocation is an error and does not end the process. Released arrays are kept for reuse.
//!
//! *Kept.* The system clears and maps each new page on its first use. That takes as long as several passes over it: a tenth to a fifth of a whole
//! call. So the next solver reuses the arrays of one that was dropped. The process keeps a limited number of bytes ([`keep_at_most`]). Beyond it, the
//! array that was kept longest returns to the system. [`release`] returns all of them. Any thread may keep and take arrays. If a process was forked
//! while another thread held the lock, the child keeps nothing. No thread waits for the lock.
//!
//! *At rest.* The arrays of one solve are not all needed at the same time. A large array that is not needed for a while [rests](rest). Its
//! address range stays reserved, so that it [wakes](wake) without an error. Its pages return to the system.

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

/// The default of the largest number of bytes kept. It is small enough for many processes on one node. Measured with calls that set up
/// anew: up to 768 x 768 elements, which keep 46 MiB, calls are as fast as with 512 MiB.
const MOST_KEPT: usize = 112 << 20;
/// The current limit of the bytes kept.
static ALLOWED: AtomicUsize = AtomicUsize::new(MOST_KEPT);
/// The allocator itself keeps smaller blocks.
const LEAST_KEPT: usize = 1 << 13;
/// Before an array of more bytes is requested from the system, all kept arrays return to it.
const RETURNED_ABOVE: usize = 96 << 20;
/// The default of the least number of values of an array that rests. From 4096 x 4096 elements on memory is scarce, and mapping pages again is cheap
/// compared with a product.
const LEAST_AT_REST: usize = 1 << 23;
/// The current least number of values.
static RESTING: AtomicUsize = AtomicUsize::new(LEAST_AT_REST);

/// A `Vec` of some type, with its last values.
struct Kept {
    bytes: usize,
    /// Its type, and its capacity in values.
    kind: TypeId,
    room: usize,
    values: Box<dyn Any + Send>,
}

/// The kept arrays, oldest first, and their bytes.
struct Shelf {
    blocks: VecDeque<Kept>,
    bytes: usize,
}

static SHELF: Mutex<Shelf> = Mutex::new(Shelf { blocks: VecDeque::new(), bytes: 0 });

/// n zeros. `what` names them in messages.
pub fn zeros<A: Copy + Default + Send + 'static>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.resize(n, A::default());
    Ok(v)
}

/// Makes v n values long. The caller writes each value before it reads it, because the values are unspecified. Where possible they are `mark`, which
/// reveals a value that was not written. The threads touch new pages in parallel.
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
        // A value that is read before it is written is then visible.
        v.fill(mark);
    }
    Ok(())
}

/// A new array of n values. The caller writes each before it reads it.
pub fn blank<A: Copy + Send + Sync + 'static>(n: usize, mark: A, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    unwritten(&mut v, n, mark, what, &Threads::One)?;
    Ok(v)
}

/// Reserves capacity for n values. Pushing them later allocates nothing.
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

/// An array with capacity for n values, of which few may be used. It comes from the system, not from the kept arrays, so that unused pages take no
/// memory.
pub fn sparse<A>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    allocate(&mut v, n, what)?;
    Ok(v)
}

/// Capacity for n values from the system.
fn allocate<A>(v: &mut Vec<A>, n: usize, what: &str) -> Result<()> {
    if n.saturating_mul(size_of::<A>()) > RETURNED_ABOVE {
        release();
    }
    let refused = |_| OutOfMemory(format!("no memory for {n} values of {what}"));
    v.try_reserve_exact(n - v.len()).map_err(refused)
}

/// The smallest kept block for `n` values that is not far too large.
fn find<A: Copy + Send + 'static>(n: usize) -> Option<Vec<A>> {
    if n.saturating_mul(size_of::<A>()) < LEAST_KEPT {
        return None;
    }
    let mut shelf = SHELF.try_lock().ok()?;
    let fits = |kept: &Kept| kept.kind == TypeId::of::<Vec<A>>() && (n..=n + n / 4).contains(&kept.room);
    let fitting = shelf.blocks.iter().enumerate().filter(|(_, kept)| fits(kept));
    let (_, i) = fitting.map(|(i, kept)| (kept.room, i)).min()?;
    let kept = shelf.blocks.remove(i)?;
    shelf.bytes -= kept.bytes;
    drop(shelf);
    kept.values.downcast().ok().map(|values| *values)
}

/// Whether an array of n values rests.
pub fn rests(n: usize) -> bool {
    n >= RESTING.load(Ordering::Relaxed)
}

/// From now on arrays of at least n values may rest. No result depends on it.
pub fn rest_from(n: usize) {
    RESTING.store(n, Ordering::Relaxed);
}

/// Reserves capacity for n values. A large array rests until it is first needed; a small one is awake. The caller writes each value before it reads
/// it.
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

/// Lets an array rest that is not needed for a while. A large one is then empty.
pub fn rest<A>(values: &mut Vec<A>) {
    if rests(values.capacity()) {
        values.clear();
        give_pages_back(values);
    }
}

/// Makes an array that may rest n values long, within its capacity. Its values are unspecified if it did rest.
pub fn wake<A: Copy + Send + Sync>(values: &mut Vec<A>, n: usize, mark: A, threads: &Threads) {
    debug_assert!(n <= values.capacity(), "room for {n} values");
    lengthen(values, n, mark, threads);
}

/// Keeps the memory of arrays that are not needed any more. They are then empty.
pub fn keep<A: Copy + Send + 'static, const K: usize>(arrays: [&mut Vec<A>; K]) {
    arrays.into_iter().for_each(|values| keep_one(take(values)));
}

fn keep_one<A: Copy + Send + 'static>(values: Vec<A>) {
    let bytes = values.capacity() * size_of::<A>();
    let most = ALLOWED.load(Ordering::Relaxed);
    if bytes < LEAST_KEPT || bytes > most {
        return;
    }
    let Ok(mut shelf) = SHELF.try_lock() else { return };
    shelf.bytes += bytes;
    let (kind, room) = (TypeId::of::<Vec<A>>(), values.capacity());
    shelf.blocks.push_back(Kept { bytes, kind, room, values: Box::new(values) });
    shelf.shrink_to(most);
}

impl Shelf {
    /// Drops the oldest arrays until the rest has at most `most` bytes.
    fn shrink_to(&mut self, most: usize) {
        while self.bytes > most {
            let Some(oldest) = self.blocks.pop_front() else { return };
            self.bytes -= oldest.bytes;
        }
    }
}

/// Shared values. Their memory is kept when the last owner is dropped.
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

/// Sets the largest number of bytes kept from now on.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Ok(mut shelf) = SHELF.try_lock() {
        shelf.shrink_to(bytes);
    }
}

/// Bytes kept now.
pub fn kept() -> usize {
    SHELF.try_lock().map_or(0, |shelf| shelf.bytes)
}

/// Collects computed values of any type. Their memory is not kept later.
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
