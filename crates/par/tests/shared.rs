//! Data that the threads of a process share: no thread waits for another one. In a forked child that other thread would not exist.

use std::sync::mpsc::channel;
use std::sync::OnceLock;
use std::thread::scope;

use par::threads::{made_once, Shared};

/// Another thread begins to make the value. It does not finish before this thread has made one.
#[test]
fn a_value_that_another_thread_makes_is_not_waited_for() {
    static PLACE: OnceLock<i32> = OnceLock::new();
    let (begun, has_begun) = channel();
    let (go_on, may_go_on) = channel::<()>();
    scope(|scope| {
        let other = scope.spawn(move || {
            *made_once(&PLACE, || {
                begun.send(()).expect("a receiver");
                may_go_on.recv().expect("a sender");
                2
            })
        });
        has_begun.recv().expect("a sender");
        assert_eq!(*made_once(&PLACE, || 1), 1);
        go_on.send(()).expect("a receiver");
        assert_eq!(other.join().expect("a value"), 1, "the first value stays");
    });
}

#[test]
fn a_lock_that_is_held_for_long_is_given_up_and_taken_later() {
    let shared = Shared::new(5);
    let held = shared.lock().expect("a free lock");
    for _ in 0..2 {
        assert!(shared.lock().is_none());
    }
    drop(held);
    assert_eq!(shared.lock().map(|held| *held), Some(5));
}
