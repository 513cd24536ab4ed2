//! Bisection of an interval.

/// Halves an interval until it is short enough, or 60 times: then it has 1e-18 of its first length. `is_below`: whether a number lies below the one
/// looked for.
pub fn bisect(
    (mut low, mut high): (f64, f64),
    is_enough: impl Fn(f64, f64) -> bool,
    is_below: impl Fn(f64) -> bool,
) -> (f64, f64) {
    for _ in 0..60 {
        if is_enough(low, high) {
            break;
        }
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, high)
}
