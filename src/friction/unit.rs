//! Units: powers of two, by which no bit changes.

/// The power of two next to a value.
pub fn unit_of(value: f64) -> f64 {
    if value.is_normal() {
        value.abs().log2().round().exp2()
    } else {
        1.0
    }
}
