//! Structs of the C ABI with their default values.

use std::mem::MaybeUninit;

/// A struct that its `_init` function has filled with the defaults.
pub fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
    let mut value = MaybeUninit::uninit();
    // SAFETY: `_init` fills a whole struct.
    unsafe {
        init(value.as_mut_ptr());
        value.assume_init()
    }
}
