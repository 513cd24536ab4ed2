//! Plans of transforms, which all threads of the process share. A second product of the same period needs no planning.
//!
//! A plan depends on its length only, so no bit of a result depends on earlier plans. If the kept plans exceed a number of bytes, the least recently
//! used plans are removed from the list. A plan that a product still uses is freed with the product.

use std::any::{Any, TypeId};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

use par::threads::Shared;
use par::Result;

/// The name of this memory in messages.
pub(crate) const PLAN: &str = "the plans of transforms";

/// The default of the largest number of bytes of kept plans. The plans of periods up to 4096 x 4096 take less than 2 MiB.
const MOST_KEPT: usize = 16 << 20;
/// The present largest number of bytes of kept plans.
static ALLOWED: AtomicUsize = AtomicUsize::new(MOST_KEPT);

/// The tables of a transform of one length.
pub(crate) trait Plan: Any + Send + Sync {
    /// The bytes of the tables.
    fn bytes(&self) -> usize;
}

/// A kept plan.
struct Known {
    /// The type of the plan.
    type_id: TypeId,
    /// The length of the transform.
    length: usize,
    bytes: usize,
    plan: Arc<dyn Any + Send + Sync>,
}

/// The kept plans, least recently used first.
static KNOWN: Shared<Vec<Known>> = Shared::new(Vec::new());

/// The plan of type P and this length. The first call makes it.
pub(crate) fn shared<P: Plan>(length: usize, make: impl FnOnce() -> Result<P>) -> Result<Arc<P>> {
    if let Some(known) = find(length) {
        return Ok(known);
    }
    // Made without the lock, so that other threads do not wait. Two threads may make the same plan.
    let plan = Arc::new(make()?);
    let bytes = plan.bytes();
    if let Some(mut known) = KNOWN.lock() {
        known.push(Known { type_id: TypeId::of::<P>(), length, bytes, plan: plan.clone() });
        shrink(&mut known);
    }
    Ok(plan)
}

/// Removes the least recently used plans until the others have at most [`ALLOWED`] bytes.
fn shrink(known: &mut Vec<Known>) {
    let (mut bytes, most) = (known.iter().map(|known| known.bytes).sum::<usize>(), ALLOWED.load(Ordering::Relaxed));
    let mut removed = 0;
    while bytes > most && removed < known.len() {
        bytes -= known[removed].bytes;
        removed += 1;
    }
    known.drain(..removed);
}

/// Sets the largest number of bytes of kept plans.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Some(mut known) = KNOWN.lock() {
        shrink(&mut known);
    }
}

/// The kept plan of type P and this length, if there is one.
pub(crate) fn find<P: Plan>(length: usize) -> Option<Arc<P>> {
    let mut known = KNOWN.lock()?;
    let i = known.iter().position(|known| known.length == length && known.type_id == TypeId::of::<P>())?;
    // The plan moves to the end of the list: it is the most recently used one.
    known[i..].rotate_left(1);
    known.last()?.plan.clone().downcast().ok()
}

/// Removes all kept plans. A plan that a product still uses is freed with the product.
pub fn release() {
    if let Some(mut known) = KNOWN.lock() {
        *known = Vec::new();
    }
}

/// The bytes of the kept plans.
pub fn kept() -> usize {
    KNOWN.lock().map_or(0, |known| known.iter().map(|known| known.bytes).sum())
}

#[cfg(test)]
#[path = "../tests/unit/plan.rs"]
mod tests;
