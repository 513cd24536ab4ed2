//! Large arrays: asked for, so that a lack of memory is an error and not the end of the process; and kept.
//!
//! *Kept.* A page that the system gives is cleared and entered first, which takes as long as several passes over it: a tenth to a fifth of
//! a whole call. So the next solver takes the arrays of one that is gone. The process keeps a number of bytes ([`keep_at_most`]); beyond it the array that was
//! kept longest goes back to the system. [`release`] gives all of them back. Any thread may keep and take. A process
//! forked while another thread did keeps nothing of its own: nobody waits for the lock.
//!
//! *At rest.* The arrays of one solve are not all needed at the same time. A large one that nobody needs for a while [rests](rest): its
//! room stays reserved, so that it [wakes](wake) without an error, and the system has its pages.

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

/// Bytes that are kept in the process, at most, unless the caller says how many: of many processes on a node, too. Measured with calls
/// that set up anew: up to 768 x 768 elements, which keep 46 MiB, nothing is lost beside 512 MiB.
const MOST_KEPT: usize = 112 << 20;
/// As many as the caller allows.
static ALLOWED: AtomicUsize = AtomicUsize::new(MOST_KEPT);
/// Smaller blocks the allocator keeps by itself.
const LEAST_KEPT: usize = 1 << 13;
/// Who asks for more at once has no use for what is kept.
const TOO_LARGE_TO_KEEP: usize = 96 << 20;
/// Arrays of so many values rest: from 4096 x 4096 elements on memory is scarce, and pages that are entered again cost little beside a
/// product.
const RESTS: usize = 1 << 23;
/// Of as many as the caller says.
static RESTING: AtomicUsize = AtomicUsize::new(RESTS);

/// A `Vec` of some type, and what it held last.
struct Kept {
    bytes: usize,
    /// Its type, and for how many values it has room.
    kind: TypeId,
    room: usize,
    values: Box<dyn Any + Send>,
}

/// Kept memory, the longest first, and its bytes.
struct Shelf {
    blocks: VecDeque<Kept>,
    bytes: usize,
}

static SHELF: Mutex<Shelf> = Mutex::new(Shelf { blocks: VecDeque::new(), bytes: 0 });

/// n zeros. `what` they are says the message.
pub fn zeros<A: Copy + Default + Send + 'static>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.resize(n, A::default());
    Ok(v)
}

/// Makes v n values long that are all written before they are read: it may hold anything, where it can a `mark`, which shows if they
/// are not. The threads first touch its pages together.
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
        // Whatever a block held: what is read before it is written shows.
        v.fill(mark);
    }
    Ok(())
}

/// A new array of n values that are all written before they are read.
pub fn blank<A: Copy + Send + Sync + 'static>(n: usize, mark: A, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    unwritten(&mut v, n, mark, what, &Threads::One)?;
    Ok(v)
}

/// Room for n values: what is put there later allocates nothing.
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

/// The same where few of them may be put there: not of what is kept, so that the others take no memory.
pub fn sparse<A>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    allocate(&mut v, n, what)?;
    Ok(v)
}

/// Room for n values from the system.
fn allocate<A>(v: &mut Vec<A>, n: usize, what: &str) -> Result<()> {
    if n.saturating_mul(size_of::<A>()) > TOO_LARGE_TO_KEEP {
        release();
    }
    let refused = |_| OutOfMemory(format!("no memory for {n} values of {what}"));
    v.try_reserve_exact(n - v.len()).map_err(refused)
}

/// The smallest block that is kept for `n` values, and is not far too large for them.
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

/// Arrays of n values and more may rest from here on. No result depends on it.
pub fn rest_from(n: usize) {
    RESTING.store(n, Ordering::Relaxed);
}

/// Makes room for n values that wake when they are first needed, and are all written before they are read. Small arrays are awake.
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

/// An array that is not needed for a while: a large one is empty then.
pub fn rest<A>(values: &mut Vec<A>) {
    if rests(values.capacity()) {
        values.clear();
        give_pages_back(values);
    }
}

/// Makes an array that may rest n values long, in the room that it has. Its values are new where it did.
pub fn wake<A: Copy + Send + Sync>(values: &mut Vec<A>, n: usize, mark: A, threads: &Threads) {
    debug_assert!(n <= values.capacity(), "room for {n} values");
    lengthen(values, n, mark, threads);
}

/// Keeps the memory of arrays that nobody needs any more: they are empty then.
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
    /// Drops what was kept first.
    fn shrink_to(&mut self, most: usize) {
        while self.bytes > most {
            let Some(oldest) = self.blocks.pop_front() else { return };
            self.bytes -= oldest.bytes;
        }
    }
}

/// Values that several hold: when the last of them is gone, their memory is kept.
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

/// Gives all that is kept back to the system.
pub fn release() {
    if let Ok(mut shelf) = SHELF.try_lock() {
        (shelf.blocks, shelf.bytes) = (VecDeque::new(), 0);
    }
}

/// Keeps no more than so many bytes from here on.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Ok(mut shelf) = SHELF.try_lock() {
        shelf.shrink_to(bytes);
    }
}

/// Bytes that are kept.
pub fn kept() -> usize {
    SHELF.try_lock().map_or(0, |shelf| shelf.bytes)
}

/// Values that are computed, of any type: their memory is not kept.
pub fn collected<A>(values: impl ExactSizeIterator<Item = A>, what: &str) -> Result<Vec<A>> {
    let mut collected = Vec::new();
    allocate(&mut collected, values.len(), what)?;
    collected.extend(values);
    Ok(collected)
}

/// An array that is computed.
pub fn computed<A: Copy + Send + 'static>(values: impl ExactSizeIterator<Item = A>, what: &str) -> Result<Vec<A>> {
    let mut computed = Vec::new();
    reserve(&mut computed, values.len(), what)?;
    computed.extend(values);
    Ok(computed)
}

#[cfg(test)]
#[path = "../../tests/unit/memory.rs"]
mod tests;
