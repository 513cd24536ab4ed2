//! The times at which work is shared again. The tests give the times; they do not read a clock.

use super::*;

#[test]
fn who_loses_time_works_alone_the_longer_the_more_often() {
    let busy = Busy::default();
    assert!(busy.is_over(0));
    let (mut now, mut alone) = (5, FIRST_ALONE);
    for _ in 0..10 {
        busy.note(now, true);
        assert!(!busy.is_over(now) && !busy.is_over(now + alone - 1) && busy.is_over(now + alone));
        now += alone;
        alone = (2 * alone).min(LONGEST_ALONE);
    }
}

#[test]
fn what_goes_well_for_as_long_is_forgotten() {
    let busy = Busy::default();
    busy.note(0, true);
    busy.note(FIRST_ALONE, true);
    // Work is shared for less time than the caller worked alone before: the next loss is a further one.
    let tried = 3 * FIRST_ALONE;
    busy.note(tried + FIRST_ALONE, false);
    busy.note(tried + FIRST_ALONE, true);
    assert!(!busy.is_over(tried + 5 * FIRST_ALONE - 1) && busy.is_over(tried + 5 * FIRST_ALONE));
    // Work is shared for longer than that: the next loss counts as the first.
    busy.note(tried + 10 * FIRST_ALONE, false);
    busy.note(tried + 10 * FIRST_ALONE, true);
    assert!(busy.is_over(tried + 11 * FIRST_ALONE));
}

#[test]
fn a_thread_that_waits_takes_no_time_of_the_processor() {
    let (Some(before), began) = (time_of_this_thread(), Instant::now()) else { return };
    std::thread::sleep(4 * LEAST_LOSS);
    let worked = time_of_this_thread().unwrap() - before;
    assert!(began.elapsed() - worked > LEAST_LOSS, "{worked:?} of {:?}", began.elapsed());
}
