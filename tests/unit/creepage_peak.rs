//! The largest force between creepages.

use super::Peak;

fn largest(force: impl Fn(f64) -> f64) -> (f64, usize) {
    let mut peak = Peak::default();
    let mut looked = vec![1.0, 1.3, 2.0, 4.0, 16.0, 1e3, 1e6, 0.5, 0.1];
    looked.iter().for_each(|&creepage| peak.add(creepage, force(creepage)));
    while let Some(next) = peak.next() {
        peak.add(next, force(next));
        looked.push(next);
    }
    (peak.largest().expect("a force"), looked.len())
}

#[test]
fn a_peak_before_full_slip_is_found() {
    for at in [0.02f64, 0.3, 1.1, 2.9, 9.0, 100.0] {
        let force =
            |creepage: f64| (1.0 + 0.01 / (1.0 + (creepage / at).ln().powi(2))) * (2.0 * creepage / at).min(1.0);
        let (found, looked) = largest(force);
        assert!(found > 1.01 - 1e-7 && looked <= 25, "{at}: {found} by {looked}");
    }
}

#[test]
fn full_slip_is_no_peak() {
    assert_eq!(largest(|creepage| 1.0 - 0.1 / creepage).1, 9);
    assert_eq!(largest(|creepage| 1.0 - 0.1 / creepage + 1e-9 * (3.0 * creepage).sin()).1, 9);
}
