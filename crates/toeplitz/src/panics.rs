//! A panic in a product on demand, for tests of the C boundary. Libraries built without the feature do not contain it.

use std::sync::atomic::{AtomicI64, Ordering};

/// The number of blocks of columns that products still multiply before one panics. Below 0 there is no panic.
pub static BLOCKS: AtomicI64 = AtomicI64::new(-1);

/// Counts down one block, and panics if none is left.
pub fn at_a_block() {
    if BLOCKS.load(Ordering::Relaxed) >= 0 && BLOCKS.fetch_sub(1, Ordering::Relaxed) == 0 {
        panic!("on demand of a test");
    }
}
