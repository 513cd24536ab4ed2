//! Unit tests of `solver/refinement/next_grid.rs`.

use super::*;

fn past(relative: Option<f64>) -> Past {
    Past {
        grid: Grid::new(64, 32, 0.1, 0.2).expect("a grid"),
        relative,
        falls_by: None,
        bytes: 100,
        seconds: 1.0,
        elapsed: 1.5,
    }
}

#[test]
fn as_many_doublings_as_the_estimate_asks_for() {
    let accuracy = Accuracy::new(1e-4);
    // In powers of four, rounded up beyond a quarter: 4^1.25 = 5.66, 4^2.25 = 22.6.
    for (relative, doublings) in
        [(1.01e-4, 1), (5.6e-4, 1), (5.7e-4, 2), (22e-4, 2), (23e-4, 3), (0.5, 3), (f64::MAX, 3)]
    {
        assert_eq!(accuracy.next(&past(Some(relative))), Next::Refine(doublings), "{relative}");
    }
    assert_eq!(accuracy.next(&past(None)), Next::Refine(1));
    // An order of 1, and one that is not believed: 2^2.25 = 4.76, 2^1.125 = 2.18.
    for (falls_by, relative, doublings) in [(2.0, 4.7e-4, 2), (2.0, 4.8e-4, 3), (1.0, 2.1e-4, 2), (1.0, 2.2e-4, 3)] {
        let past = Past { falls_by: Some(falls_by), ..past(Some(relative)) };
        assert_eq!(accuracy.next(&past), Next::Refine(doublings), "{past:?}");
    }
}

#[test]
fn limits_shorten_the_step_and_then_end_it() {
    let far = past(Some(1.0));
    let limited = |change: fn(&mut Accuracy, u32)| {
        // The last that is allowed for k doublings.
        (1..=3).for_each(|k| {
            let mut accuracy = Accuracy::new(1e-4);
            change(&mut accuracy, k);
            assert_eq!(accuracy.next(&far), Next::Refine(k), "{accuracy:?}");
        });
        let mut accuracy = Accuracy::new(1e-4);
        change(&mut accuracy, 0);
        match accuracy.next(&far) {
            Next::Limit(why) => why,
            next => panic!("{next:?} with {accuracy:?}"),
        }
    };
    let elements = limited(|accuracy, k| accuracy.max_elements = (64 * 32) << (2 * k));
    assert_eq!(elements, "max_elements, 2048, is in the way of 128 x 64 elements");
    let bytes = limited(|accuracy, k| accuracy.max_bytes = 100 + (100 << (2 * k)));
    assert!(bytes.starts_with("max_bytes, 200 of the 500 predicted,"), "{bytes}");
    // 1.5 s so far, and 4^(1.13 k) more: 4.79, 22.9 and 110.
    let seconds = limited(|accuracy, k| accuracy.max_seconds = [6.2, 6.4, 24.5, 111.5][k as usize]);
    assert!(seconds.starts_with("max_seconds, 6.2 of the 6.290 predicted,"), "{seconds}");
}

#[test]
fn no_grid_is_larger_than_grids_can_be() {
    let mut huge = past(Some(1.0));
    (huge.grid.mx, huge.grid.my) = (32768, 32768);
    let accuracy = Accuracy { max_elements: i32::MAX as u64, ..Accuracy::new(1e-4) };
    assert!(matches!(accuracy.next(&huge), Next::Limit(_)));
}
