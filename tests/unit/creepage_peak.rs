//! The search for the largest force between two creepages.

use super::Peak;

/// The largest force found in a search for the force `wanted`, and the number of creepages tried after the first ones.
fn largest(wanted: f64, force: impl Fn(f64) -> f64) -> (f64, usize) {
    let (mut peak, mut tried) = (Peak::default(), 0);
    let first = [1.0, 1.3, 2.0, 4.0, 16.0, 1e3, 1e6, 0.5, 0.1];
    first.iter().for_each(|&creepage| peak.add(creepage, force(creepage) - wanted));
    while let Some(next) = peak.next() {
        peak.add(next, force(next) - wanted);
        tried += 1;
    }
    (peak.largest().expect("a force") + wanted, tried)
}

#[test]
fn a_peak_before_full_slip_is_found() {
    for at in [0.02f64, 0.3, 1.1, 2.9, 9.0, 100.0] {
        let force =
            |creepage: f64| (1.0 + 0.01 / (1.0 + (creepage / at).ln().powi(2))) * (2.0 * creepage / at).min(1.0);
        let (found, tried) = largest(1.01, force);
        assert!(found > 1.01 - 1e-7 && tried <= 16, "{at}: {found} by {tried}");
    }
}

#[test]
fn a_force_beyond_the_peak_is_soon_known_to_be_out_of_reach() {
    for at in [0.3f64, 1.1, 2.9, 9.0, 100.0] {
        let force = |creepage: f64| 1.0 + 0.01 / (1.0 + (creepage / at).ln().powi(2));
        let (found, tried) = largest(1.011, force);
        assert!(tried <= 9, "{at}: {found} by {tried}");
    }
}

#[test]
fn where_no_creepage_has_a_force_there_is_none_to_try() {
    assert_eq!(largest(1.0, |_| f64::NEG_INFINITY).1, 0);
    // The force is unknown for creepages on one side of the peak.
    let (found, tried) =
        largest(1.02, |creepage: f64| if creepage < 0.9 { f64::NEG_INFINITY } else { 1.0 + 0.01 / creepage });
    assert!(found > 1.01 && tried <= 16, "{found} by {tried}");
}

#[test]
fn full_slip_is_no_peak() {
    assert_eq!(largest(1.001, |creepage| 1.0 - 0.1 / creepage).1, 0);
    assert_eq!(largest(1.001, |creepage| 1.0 - 0.1 / creepage + 1e-9 * (3.0 * creepage).sin()).1, 0);
}
