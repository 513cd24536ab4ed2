//! Plans of transforms, which all threads of the process share: a second product of the same period costs no planning.
//!
//! A plan depends on its length only, so that no bit of a result depends on what was planned before. The least recently used plans go first
//! when they are more than the process may keep; those in use live on with who uses them.

use std::any::{Any, TypeId};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use par::{threads, Result};

/// Names its memory in messages.
pub(crate) const PLAN: &str = "the plans of transforms";

/// Bytes of plans that are kept at most, unless the caller says how many: those of periods up to 4096 x 4096 take less than 2 MiB.
const MOST_KEPT: usize = 16 << 20;
/// As many as the caller allows.
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

/// The least recently used first.
static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());

/// The plan of a length, which is made if nobody has.
pub(crate) fn shared<P: Plan>(length: usize, make: impl FnOnce() -> Result<P>) -> Result<Arc<P>> {
    if let Some(known) = find(length) {
        return Ok(known);
    }
    // The others do not wait for it. Two threads may make the same.
    let plan = Arc::new(make()?);
    let bytes = plan.bytes();
    if let Some(mut known) = threads::lock(&KNOWN) {
        known.push(Known { kind: TypeId::of::<P>(), length, bytes, plan: plan.clone() });
        shrink(&mut known);
    }
    Ok(plan)
}

/// Forgets the least recently used plans beyond the bound.
fn shrink(known: &mut Vec<Known>) {
    let (mut all, most) = (known.iter().map(|known| known.bytes).sum::<usize>(), ALLOWED.load(Ordering::Relaxed));
    let mut old = 0;
    while all > most && old < known.len() {
        all -= known[old].bytes;
        old += 1;
    }
    known.drain(..old);
}

/// Keeps no more than so many bytes of plans from here on.
pub fn keep_at_most(bytes: usize) {
    ALLOWED.store(bytes, Ordering::Relaxed);
    if let Some(mut known) = threads::lock(&KNOWN) {
        shrink(&mut known);
    }
}

/// The plan of a length if it is known.
pub(crate) fn find<P: Plan>(length: usize) -> Option<Arc<P>> {
    let mut known = threads::lock(&KNOWN)?;
    let i = known.iter().position(|known| known.length == length && known.kind == TypeId::of::<P>())?;
    known[i..].rotate_left(1);
    known.last()?.plan.clone().downcast().ok()
}

/// Forgets all plans. Those in use live on with who uses them.
pub fn release() {
    if let Some(mut known) = threads::lock(&KNOWN) {
        *known = Vec::new();
    }
}

/// Bytes of the plans that are kept.
pub fn kept() -> usize {
    threads::lock(&KNOWN).map_or(0, |known| known.iter().map(|known| known.bytes).sum())
}

#[cfg(test)]
#[path = "../tests/unit/plan.rs"]
mod tests;
