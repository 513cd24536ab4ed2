//! Kept memory is reused, within its limit, without its old values. The tests share one list of kept arrays, so each uses a separate type.

use super::*;

#[test]
fn a_kept_block_serves_the_next_request_of_its_type_and_size() {
    #[derive(Clone, Copy, Default, PartialEq, Debug)]
    struct Own([u64; 2]);
    let n = LEAST_KEPT;
    let mut first: Vec<Own> = zeros(n, "the test").unwrap();
    first.fill(Own([7; 2]));
    let address = first.as_ptr();
    keep_one(first);
    // The kept array does not serve requests for which it is too large by more than a quarter or too small, or of another type.
    let others = [zeros::<Own>(n * 4 / 5 - 1, "the test").unwrap(), zeros(n + 1, "the test").unwrap()];
    assert!(others.iter().all(|other| other.as_ptr() != address));
    let of_another_type: Vec<[u64; 2]> = zeros(n, "the test").unwrap();
    assert!(of_another_type.as_ptr().cast() != address);
    let second: Vec<Own> = zeros(n - 1, "the test").unwrap();
    assert_eq!(second.as_ptr(), address);
    assert!(second.len() == n - 1 && second.iter().all(|value| *value == Own::default()));
}

#[test]
fn what_a_longer_array_held_moves_with_it() {
    #[derive(Clone, Copy, Default, PartialEq, Debug)]
    struct Own(u64);
    let mut values: Vec<Own> = (0..4).map(Own).collect();
    keep_one(zeros::<Own>(2 * LEAST_KEPT, "the test").unwrap());
    reserve(&mut values, 2 * LEAST_KEPT, "the test").unwrap();
    assert_eq!(values, [0, 1, 2, 3].map(Own));
    assert!(values.capacity() >= 2 * LEAST_KEPT);
}

#[test]
fn no_more_is_kept_than_the_bound() {
    let blocks: Vec<Vec<u8>> = (0..6).map(|_| zeros(MOST_KEPT / 4, "the test").unwrap()).collect();
    blocks.into_iter().for_each(keep_one);
    keep_one(Vec::<u8>::with_capacity(MOST_KEPT + 1));
    let shelf = SHELF.lock().unwrap();
    assert!(shelf.bytes <= MOST_KEPT);
    assert_eq!(shelf.bytes, shelf.blocks.iter().map(|kept| kept.bytes).sum::<usize>());
    assert!(shelf.blocks.iter().all(|kept| kept.bytes >= LEAST_KEPT));
}

#[test]
fn what_rests_is_empty_and_has_its_room() {
    let n = 1 << 20;
    let mut values: Vec<f64> = zeros(n, "the test").unwrap();
    rest(&mut values);
    assert_eq!(values.len(), n);
    rest_from(1);
    rest(&mut values);
    rest_from(LEAST_AT_REST);
    assert!(values.is_empty() && values.capacity() >= n);
    let room = values.as_ptr();
    wake(&mut values, n, 1.0, &Threads::One);
    assert!(values.as_ptr() == room && values.iter().all(|value| *value == 1.0));
}

#[test]
fn what_threads_write_together_is_what_one_writes() {
    let threads = Threads::new(3).expect("threads");
    for (known, n) in [(0, 1 << 20), (5, 1 << 20), (12345, (1 << 20) + 77), (1 << 20, 1 << 19)] {
        let values = |threads: &Threads| {
            let mut values: Vec<f64> = Vec::with_capacity(known.max(n));
            values.extend((0..known).map(|i| i as f64));
            wake(&mut values, n, -1.0, threads);
            values
        };
        assert!(values(&threads) == values(&Threads::One), "{known} values and then {n}");
        assert_eq!(values(&threads).len(), n);
    }
}
