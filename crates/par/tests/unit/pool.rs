//! Pools of threads after a fork at the worst moment: while another thread of the parent holds the lock of the workers.

use super::*;

#[test]
#[cfg(target_os = "linux")]
fn a_child_that_is_forked_while_a_pool_is_made_makes_its_own() {
    let before = Pool::of(2).expect("threads");
    // The lock is held, as if another thread were making a pool.
    let held = workers();
    // SAFETY: the child makes a pool, works with it, and ends without any of its parent's exit handlers.
    let child = unsafe { libc::fork() };
    if child == 0 {
        // The alarm ends the child if it waits for a lock that nobody releases.
        // SAFETY: both end this process only.
        unsafe { libc::alarm(60) };
        let mut items = [0; 1];
        let pool = before.in_this_process().expect("threads");
        pool.run_with_workers(&mut items, &|item| *item += 1, || ());
        release();
        drop((pool, before));
        // SAFETY: as above.
        unsafe { libc::_exit(i32::from(kept() != 0)) };
    }
    let mut status = 0;
    // SAFETY: the child of this test; the status is written.
    unsafe { libc::waitpid(child, &mut status, 0) };
    drop(held);
    assert_eq!(status, 0, "the child waited, or failed");
}
