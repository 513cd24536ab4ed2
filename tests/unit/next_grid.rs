//! Unit tests of `solver/refinement/next_grid.rs`: the choice of the next grid in a search for an accuracy.

use super::*;

fn past(excess: Option<Falling>) -> Past {
    Past {
        grid: Grid::new(64, 32, 0.1, 0.2).expect("a grid"),
        refines: (true, true),
        across: (40, 33),
        enough: 32,
        excesses: vec![excess],
        is_believed: true,
        predicts_far: true,
        bytes: 100,
        seconds: 1.0,
        exponent: GROWTH,
        elapsed: 1.5,
    }
}

fn by_four(by_four: f64) -> Option<Falling> {
    Some(Falling { by_four, ..Falling::default() })
}

#[test]
fn as_many_doublings_as_the_estimates_ask_for() {
    let accuracy = Accuracy::new(1e-4);
    for (excess, doublings) in [(1.01, 1), (3.9, 1), (4.1, 2), (15.9, 2), (16.1, 3), (5e3, 3), (f64::MAX, 3)] {
        assert_eq!(accuracy.next(&past(by_four(excess))), Next::Refine(doublings), "{excess}");
    }
    assert_eq!(accuracy.next(&past(None)), Next::Refine(1));
    for (by_two, doublings) in [(1.9, 1), (2.1, 2), (4.1, 3)] {
        let excess = Some(Falling { by_two, ..Falling::default() });
        assert_eq!(accuracy.next(&past(excess)), Next::Refine(doublings), "{by_two}");
    }
    // Of several excesses (errors over their targets) the largest counts.
    let both = Past { excesses: vec![by_four(2.0), by_four(5.0)], ..past(None) };
    assert_eq!((accuracy.next(&both), both.worst()), (Next::Refine(2), Some(5.0)));
    let unknown = Past { excesses: vec![by_four(2.0), None], ..past(None) };
    assert_eq!(unknown.worst(), None);
}

#[test]
fn there_are_enough_elements_across_the_contact() {
    let accuracy = Accuracy::new(1e-4);
    for (across, doublings) in [((5, 64), 3), ((9, 9), 2), ((64, 16), 1), ((0, 0), 1)] {
        let past = Past { across, ..past(by_four(0.5)) };
        assert!(!past.is_resolved() && accuracy.end(&past, 0, 0).is_none(), "{across:?}");
        assert_eq!(accuracy.next(&past), Next::Refine(doublings), "{across:?}");
    }
    assert_eq!(accuracy.end(&past(by_four(0.9)), 0, 0).map(|end| end.0), Some(Outcome::Converged));
}

#[test]
fn quantities_of_several_grids_take_one_doubling_after_the_other() {
    let accuracy = Accuracy::new(1e-4);
    assert_eq!(accuracy.next(&past(by_four(100.0))), Next::Refine(3));
    assert_eq!(accuracy.next(&Past { predicts_far: false, ..past(by_four(100.0)) }), Next::Refine(1));
}

/// A single change may be small by chance. The next grid may follow from it, but it must not end the search.
#[test]
fn an_error_of_too_few_grids_ends_no_search() {
    let accuracy = Accuracy::new(1e-4);
    let past = Past { is_believed: false, ..past(by_four(0.5)) };
    assert!(accuracy.end(&past, 0, 0).is_none());
    assert_eq!(accuracy.next(&past), Next::Refine(1));
}

#[test]
fn limits_shorten_the_step_and_then_end_it() {
    let far = past(by_four(1e4));
    let limited = |change: fn(&mut Accuracy, u32)| {
        // The limits are such that they allow k doublings.
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
    // 1.5 s have passed, and k doublings are predicted to take 4^(1.1 k) s more: 4.59, 21.1 and 97.0 s. A single doubling is tried up to 1.2 times
    // the limit.
    let seconds = limited(|accuracy, k| accuracy.max_seconds = [5.05, 5.3, 24.5, 111.5][k as usize]);
    assert!(seconds.starts_with("max_seconds, 5.05 of the 6.095 predicted,"), "{seconds}");
}

#[test]
fn no_grid_is_larger_than_grids_can_be() {
    let mut huge = past(by_four(1e4));
    (huge.grid.mx, huge.grid.my) = (32768, 32768);
    let accuracy = Accuracy { max_elements: i32::MAX as u64, ..Accuracy::new(1e-4) };
    assert!(matches!(accuracy.next(&huge), Next::Limit(_)));
}
