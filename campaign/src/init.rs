//! Structs of the C ABI with their defaults.

use std::mem::MaybeUninit;

/// A struct as its `_init` function fills it.
pub fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
    let mut value = MaybeUninit::uninit();
    // SAFETY: `_init` fills a whole struct.
    unsafe {
        init(value.as_mut_ptr());
        value.assume_init()
    }
}
