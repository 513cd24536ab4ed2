//! Makes a product panic on demand, for tests of the C interface. Only libraries with the feature `test-panics` contain this module.

use std::sync::atomic::{AtomicI64, Ordering};

/// The number of blocks of columns that products still multiply before one panics. Below 0 there is no panic.
pub static BLOCKS: AtomicI64 = AtomicI64::new(-1);

/// Called for each block: decreases [`BLOCKS`] by one, and panics if it was 0.
pub fn at_a_block() {
    if BLOCKS.load(Ordering::Relaxed) >= 0 && BLOCKS.fetch_sub(1, Ordering::Relaxed) == 0 {
        panic!("on demand of a test");
    }
}
