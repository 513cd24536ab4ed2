//! Memory and threads that the library keeps for later calls: how much it keeps, the largest amount, and their release.

use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use crate::{memory, threads};
use toeplitz::plan;

/// The plans of Fourier transforms may take one part in this many of the memory that the library keeps.
const PARTS_PER_PLANS: usize = 8;

/// Returns to the system what the library keeps for later calls: the memory of finished solves, and the worker threads. The threads end soon
/// after this call or, if a solver still uses them, when the last such solver is freed. Later calls start new threads. Since 0.2.
#[no_mangle]
pub extern "C" fn contact_normal_release() -> contact_normal_status {
    guard(|| {
        memory::release();
        plan::release();
        threads::release();
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Sets the largest number of bytes that the process keeps of finished solves; 0: none. The default, 128 MiB, is enough for solves on 1024 x 1024
/// elements. Larger solves without a handle are 20 to 30 % faster with more: up to 512 MiB for 2048 x 2048 elements. The memory that solver
/// handles hold does not count. Kept memory above the new limit is given back at once. Since 0.2.
#[no_mangle]
pub extern "C" fn contact_normal_keep(bytes: i64) -> contact_normal_status {
    guard(|| {
        let refuse = |_| Refusal::invalid(format!("bytes is {bytes}; it must not be negative"));
        let bytes = usize::try_from(bytes).map_err(refuse)?;
        plan::keep_at_most(bytes / PARTS_PER_PLANS);
        memory::keep_at_most(bytes - bytes / PARTS_PER_PLANS);
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Writes how many `bytes` and how many `threads` the library keeps now for later calls. NULL: not wanted. Since 0.2.
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
