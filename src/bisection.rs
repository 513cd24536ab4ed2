//! Bisection of an interval.

/// Bisects the interval `(low, high)` around a wanted number and returns the last interval. `is_below(x)` tells whether x is less than the wanted
/// number. The bisection ends when `is_enough(low, high)`, or after 60 halvings, which leave 1e-18 of the first length.
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
