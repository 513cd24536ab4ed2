//! Memory and threads that the library keeps for later calls: how much, how much at most, and their release.

use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use crate::{memory, threads};
use toeplitz::plan;

/// The kept memory over its part for the plans of transforms.
const OF_PLANS: usize = 8;

/// Returns to the system all that the library keeps for later calls: the memory of solves that are over, and the threads that no solver holds.
/// The threads end soon after the call returns. Later calls make them anew. Since 0.2.
#[no_mangle]
pub extern "C" fn contact_normal_release() -> contact_normal_status {
    guard(|| {
        memory::release();
        plan::release();
        threads::release();
        Ok(CONTACT_NORMAL_OK)
    })
}

/// How many bytes of solves that are over are kept at most, in the process; 0: none. At the start 128 MiB, which is
/// enough for solves on 1024 x 1024 elements: larger ones that each set up anew are 20 to 30 % faster with more, up to 512 MiB for 2048 x 2048.
/// Solver handles hold their own. More is given back at once. Since 0.2.
#[no_mangle]
pub extern "C" fn contact_normal_keep(bytes: i64) -> contact_normal_status {
    guard(|| {
        let refuse = |_| Refusal::invalid(format!("bytes is {bytes}; it must not be negative"));
        let bytes = usize::try_from(bytes).map_err(refuse)?;
        plan::keep_at_most(bytes / OF_PLANS);
        memory::keep_at_most(bytes - bytes / OF_PLANS);
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Writes how many `bytes` and how many `threads` are kept now (NULL: not wanted). Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_kept(bytes: *mut i64, threads: *mut i32) -> contact_normal_status {
    guard(|| {
        // SAFETY (both): NULL or room for one value, by the conventions of the ABI.
        unsafe {
            if let Some(bytes) = bytes.as_mut() {
                *bytes = i64::try_from(memory::kept() + plan::kept()).unwrap_or(i64::MAX);
            }
            if let Some(threads) = threads.as_mut() {
                *threads = i32::try_from(threads::kept()).unwrap_or(i32::MAX);
            }
        }
        Ok(CONTACT_NORMAL_OK)
    })
}
