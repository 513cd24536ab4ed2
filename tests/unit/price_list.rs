//! Unit tests of `solver/refinement/price_list.rs`: the time that a price list may take for samples.

use super::*;

fn row(seconds: f64, obstacle: Option<Obstacle>) -> Price {
    Price {
        target: 1e-3,
        grid: None,
        tolerance: 1e-4,
        error: Some(1e-3),
        seconds: Some(seconds),
        seconds_one_thread: Some(seconds),
        work_units: 0.0,
        bytes: 0,
        obstacle,
        time_error: 0.0,
    }
}

/// The time for samples follows from the dearest row without an obstacle, by the least of its predictions so far, because samples of few elements may
/// predict too many seconds.
#[test]
fn the_dearest_row_pays_for_the_samples_at_its_least() {
    let mut budget = Budget::default();
    assert_eq!(budget.after(&[row(1e9, Some(Obstacle::Elements))]), SAMPLES_SECONDS);
    assert_eq!(budget.after(&[row(10.0, None), row(1e3, None), row(1e9, Some(Obstacle::Memory))]), SAMPLES_SHARE * 1e3);
    assert_eq!(budget.after(&[row(300.0, None)]), SAMPLES_SHARE * 300.0);
    assert_eq!(budget.after(&[row(2e3, None)]), SAMPLES_SHARE * 300.0);
    let unknown = Price { seconds: None, seconds_one_thread: None, ..row(0.0, Some(Obstacle::Singular)) };
    assert_eq!(budget.after(&[unknown]), SAMPLES_SHARE * 300.0);
    assert_eq!(budget.after(&[row(1.0, None)]), SAMPLES_SECONDS);
}
