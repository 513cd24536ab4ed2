//! For tests of the C boundary: a panic in the core, on demand. Not in any library that is built without the feature.

use std::sync::atomic::{AtomicI64, Ordering};

/// Blocks of columns that products multiply until one panics; below 0: none does.
pub static BLOCKS: AtomicI64 = AtomicI64::new(-1);

/// Panics when its time has come.
pub fn at_a_block() {
    if BLOCKS.load(Ordering::Relaxed) >= 0 && BLOCKS.fetch_sub(1, Ordering::Relaxed) == 0 {
        panic!("on demand of a test");
    }
}
