//! Errors estimated from the values on several grids, for sequences with known limits.

use super::Sequence;

fn of(doublings: &[i32], value: impl Fn(f64) -> f64) -> Sequence {
    let mut sequence = Sequence::default();
    for &k in doublings {
        sequence.add(k, value(0.5_f64.powi(k)), 0.0);
    }
    sequence
}

#[test]
fn errors_of_first_and_second_order_are_covered_and_carried_on() {
    for doublings in [&[0, 1, 2][..], &[-2, -1, 0], &[0, 1, 4], &[0, 2, 3], &[0, 1, 2, 3]] {
        for (order, most) in [(1, 1.01), (2, 2.01)] {
            let value = |h: f64| 3.0 + 0.7 * h.powi(order);
            let last = *doublings.last().expect("a grid");
            let falling = of(doublings, value).error().expect("an error");
            for more in 0..3 {
                let truth = 0.7 * 0.5_f64.powi(order * (last + more));
                let estimated = falling.after(more);
                assert!(
                    (0.99 * truth..=most * truth).contains(&estimated),
                    "{doublings:?} {order} {more}: {estimated} of {truth}"
                );
            }
        }
    }
}

#[test]
fn two_grids_count_as_first_order() {
    let falling = of(&[0, 1], |h| 1.0 + h).error().expect("an error");
    assert_eq!((falling.by_two, falling.by_four), (0.5, 0.0));
    assert!(of(&[0], |h| h).error().is_none());
}

#[test]
fn what_grows_without_an_end_has_no_error() {
    // Values that grow like stresses at the tip of a cone, and like pressures at the edge of a punch.
    assert!(of(&[0, 1, 2], |h| -h.ln()).error().is_none());
    assert!(of(&[0, 1, 2, 3], |h| h.powf(-0.5)).error().is_none());
}

#[test]
fn what_jumps_is_covered_by_the_change_before() {
    let mut sequence = Sequence::default();
    for (k, value) in [1.3, 1.1, 1.1].into_iter().enumerate() {
        sequence.add(k as i32, value, 1e-6);
    }
    let falling = sequence.error().expect("an error");
    assert!(falling.now() >= 0.03, "{falling:?}");
    assert_eq!(falling.hidden, 1e-6);
}

/// Forces of steady rolling of unlike bodies, which tend to 1.83. The last change is small by chance.
#[test]
fn a_small_change_is_no_second_order_where_the_order_is_the_first() {
    let mut sequence = Sequence::default();
    for (k, value) in [1.54, 1.67, 1.65].into_iter().enumerate() {
        sequence.add(k as i32, value, 0.0);
    }
    // The error of first order is half of the last change but one, because the last change is smaller.
    let first = sequence.error_of_first_order().expect("an error");
    assert!((first.now() - 0.065).abs() < 1e-12 && first.by_four == 0.0, "{first:?}");
    assert!(sequence.error().expect("an error").now() < 0.03);
}

/// A value with the error `h^.5`: its changes fall by the square root of 2, to .71 of the one before, less than the allowed factor 0.75.
#[test]
fn what_converges_slowly_is_covered() {
    for last in [1, 2, 5] {
        let sequence = of(&(0..=last).collect::<Vec<_>>(), |h| 1.0 - h.sqrt());
        let (falling, truth) = (sequence.error_if_slow(0.75).expect("an error"), 0.5f64.powi(last).sqrt());
        let least = if last == 1 { 0.4 } else { 0.99 };
        assert!((least * truth..1.01 * truth).contains(&falling.now()), "{last}: {falling:?} of {truth}");
    }
    // Between grids that are several doublings apart the ratio is that from the middle of a change to the middle of the next.
    for doublings in [&[0, 2, 4][..], &[0, 2, 3], &[0, 1, 3], &[0, 3, 4]] {
        let found = of(doublings, |h| 1.0 - h.sqrt()).error_if_slow(0.75).expect("an error").now();
        let truth = 0.5f64.powi(*doublings.last().expect("a grid")).sqrt();
        assert!((0.9 * truth..1.1 * truth).contains(&found), "{doublings:?}: {found} of {truth}");
    }
    // If changes do not fall, the error by the factor 0.75 is three times the last change.
    let grows = of(&[0, 1, 2], |h| -h.log2());
    assert!(grows.error().is_none());
    assert!((grows.error_if_slow(0.75).expect("an error").now() - 3.0).abs() < 1e-12);
    assert!(of(&[0], |h| h).error_if_slow(0.75).is_none());
}
