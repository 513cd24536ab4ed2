//! Plans of transforms, shared by all threads of the process: a second product of the same period costs no planning.
//!
//! A plan depends on its length only, so that no bit of a result depends on earlier plans. Beyond the bound of kept plans the least recently used
//! are dropped first; plans in use live until their last user drops them.

use std::any::{Any, TypeId};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

use par::threads::Shared;
use par::Result;

/// The name of this memory in messages.
pub(crate) const PLAN: &str = "the plans of transforms";

/// Default bound on the bytes of kept plans: those of periods up to 4096 x 4096 take less than 2 MiB.
const MOST_KEPT: usize = 16 << 20;
/// The caller's bound on the bytes of kept plans.
static ALLOWED: AtomicUsize = AtomicUsize::new(MOST_KEPT);

/// Tables of a length, computed once.
pub(crate) trait Plan: Any + Send + Sync {
    /// Bytes held.
    fn bytes(&self) -> usize;
}

/// A plan and its bytes.
struct Known {
    kind: TypeId,
    length: usize,
    bytes: usize,
    plan: Arc<dyn Any + Send + Sync>,
}

/// The kept plans, least recently used first.
static KNOWN: Shared<Vec<Known>> = Shared::new(Vec::new());

/// The plan of a length, made at the first call.
pub(crate) fn shared<P: Plan>(length: usize, make: impl FnOnce() -> Result<P>) -> Result<Arc<P>> {
    if let Some(known) = find(length) {
        return Ok(known);
    }
    // Made without the lock, so that other threads do not wait. Two threads may make the same plan.
    let plan = Arc::new(make()?);
    let bytes = plan.bytes();
    if let Some(mut known) = KNOWN.lock() {
        known.push(Known { kind: TypeId::of::<P>(), length, bytes, plan: plan.clone() });
        shrink(&mut known);
    }
    Ok(plan)
}

/// Drops the least recently used plans beyond the bound.
fn shrink(known: &mut Vec<Known>) {
    let (mut all, most) = (known.iter().map(|known| known.bytes).sum::<usize>(), ALLOWED.load(Ordering::Relaxed));
    let mut old = 0;
    while all > most && old < known.len() {
        all -= known[old].bytes;
        old += 1;
    }
    known.drain(..old);
}

/// Sets the bound on the bytes of kept plans.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Some(mut known) = KNOWN.lock() {
        shrink(&mut known);
    }
}

/// The kept plan of a length, if any.
pub(crate) fn find<P: Plan>(length: usize) -> Option<Arc<P>> {
    let mut known = KNOWN.lock()?;
    let i = known.iter().position(|known| known.length == length && known.kind == TypeId::of::<P>())?;
    known[i..].rotate_left(1);
    known.last()?.plan.clone().downcast().ok()
}

/// Drops all plans. Plans in use live until their last user drops them.
pub fn release() {
    if let Some(mut known) = KNOWN.lock() {
        *known = Vec::new();
    }
}

/// Bytes of the kept plans.
pub fn kept() -> usize {
    KNOWN.lock().map_or(0, |known| known.iter().map(|known| known.bytes).sum())
}

#[cfg(test)]
#[path = "../tests/unit/plan.rs"]
mod tests;
