//! The chosen lengths of transforms have the least work, and have plans.

use super::*;

/// The exponents of 2, 3 and 5, if there are no other factors.
fn factors(mut n: usize) -> Option<[u32; 3]> {
    let exponents = [2, 3, 5].map(|prime| {
        let mut exponent = 0;
        while n % prime == 0 {
            (n, exponent) = (n / prime, exponent + 1);
        }
        exponent
    });
    (n == 1).then_some(exponents)
}

#[test]
fn a_length_for_stages_has_the_least_work_of_all() {
    let work = |length: usize| factors(length).map(|[a, b, c]| length as f64 * f64::from(10 + a + 2 * b + 3 * c));
    for n in 1..1500usize {
        let longer = (n.max(2)..=n.max(2).next_power_of_two()).filter(|length| length % 2 == 0);
        let least = longer.filter_map(work).fold(f64::INFINITY, f64::min);
        let length = length_for_stages(n);
        assert!(length >= n && length % 2 == 0 && work(length) == Some(least), "{n}: {length}");
        let length = good_length(n);
        assert!(length >= n && length % 2 == 0 && factors(length).is_some(), "{n}: {length}");
    }
}

#[test]
fn what_is_said_to_have_stages_has_plans() {
    use crate::fft::{even_plan::EvenPlan, row_plan::RowPlan};
    let has_plan = |length: usize| length > 5 && EvenPlan::<f64>::shared(length).unwrap().is_some();
    for length in 1..1500usize {
        let in_x = length > 11 && RowPlan::<f64>::shared(length).unwrap().is_some();
        assert_eq!(have_stages((length, 32)), in_x, "{length} in x");
        assert_eq!(have_stages((32, length)), has_plan(length), "{length} in y");
    }
}
