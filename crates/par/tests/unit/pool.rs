//! The pool of a process, also of one that was forked at the worst moment.

use super::*;

#[test]
#[cfg(target_os = "linux")]
fn a_child_that_is_forked_while_a_pool_is_made_makes_its_own() {
    let before = Pool::of(2).expect("threads");
    // As if another thread were making one.
    let held = crew();
    // SAFETY: the child makes a pool, works with it, and ends without any of its parent's exit handlers.
    let child = unsafe { libc::fork() };
    if child == 0 {
        // The alarm ends the child if it waits for a lock that nobody releases.
        // SAFETY: both end this process only.
        unsafe { libc::alarm(60) };
        let mut items = [0; 1];
        let pool = before.here().expect("threads");
        pool.beside(&mut items, &|item| *item += 1, || ());
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
