//! The workers of a process: callers never wait for a worker that has not begun. The tests count the threads of the process, so they run one after
//! the other.

use std::sync::mpsc::channel;
use std::sync::{Barrier, Mutex, MutexGuard, PoisonError};

use par::threads::{kept, release, Threads, THREAD_NAME};

/// Waits until no other test uses workers.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Shares work among the threads, and checks the result.
fn work_with(threads: &Threads) {
    let mut values = vec![0.0; 4096];
    threads.for_each_plain_row(&mut values, 8, |row, values| values.fill(row as f64));
    assert!(values.iter().enumerate().all(|(i, value)| *value == (i / 8) as f64));
}

/// The number of threads of this process with the name of a worker.
#[cfg(target_os = "linux")]
fn workers() -> usize {
    let tasks = std::fs::read_dir("/proc/self/task").expect("the threads").flatten();
    // The system cuts names off after 15 characters.
    let name = |task: std::fs::DirEntry| std::fs::read_to_string(task.path().join("comm")).unwrap_or_default();
    tasks.map(name).filter(|name| name.starts_with(&THREAD_NAME[..THREAD_NAME.len().min(15)])).count()
}

#[test]
fn a_caller_does_not_wait_for_a_worker_that_has_not_begun() {
    let _one = alone();
    let threads = Threads::new(2).expect("threads");
    let (both, (begun, has_begun), (end, may_end)) = (Barrier::new(2), channel(), channel::<()>());
    std::thread::scope(|scope| {
        let (threads, both, may_end) = (&threads, &both, Mutex::new(may_end));
        scope.spawn(move || {
            let in_batch = |_: &mut i32| {
                both.wait();
                begun.send(()).unwrap();
                let _ended = may_end.lock().unwrap().recv();
            };
            // The only worker and the caller of this batch have both begun their items.
            let own = |_: &mut i32| {
                both.wait();
            };
            threads.for_each_beside(&mut [0, 1], own, in_batch);
        });
        has_begun.recv().unwrap();
        // Another caller's work ends while the batch still waits.
        work_with(threads);
        drop(end);
    });
}

#[test]
#[cfg(target_os = "linux")]
fn one_pool_grows_to_the_largest_count_asked_for() {
    let _one = alone();
    let all: Vec<Threads> = [2, 3, 5, 8, 4, 2].map(|count| Threads::new(count).expect("threads")).into();
    all.iter().for_each(work_with);
    assert_eq!(kept(), 7);
    // A thread gets its name a moment after it begins.
    while workers() < 7 {
        std::thread::yield_now();
    }
    drop(Threads::new(8).expect("threads"));
    assert_eq!(workers(), 7);
}

#[test]
#[cfg(target_os = "linux")]
fn released_threads_end_when_nobody_holds_them() {
    let _one = alone();
    let threads = Threads::new(4).expect("threads");
    release();
    assert_eq!(kept(), 0);
    work_with(&threads);
    drop(threads);
    while workers() > 0 {
        std::thread::yield_now();
    }
}

#[test]
fn a_panic_of_a_worker_is_one_of_its_caller() {
    let _one = alone();
    let threads = Threads::new(2).expect("threads");
    let (begun, has_begun) = channel();
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        threads.for_each_beside(
            &mut [0, 1],
            |_| has_begun.recv().unwrap(),
            move |_| {
                begun.send(()).unwrap();
                panic!("of a worker");
            },
        );
    }));
    assert_eq!(caught.unwrap_err().downcast_ref(), Some(&"of a worker"));
    work_with(&threads);
}
