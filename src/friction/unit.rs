//! Units. They are powers of two, so that scaling is exact.

/// A power of two near a value.
pub fn unit_of(value: f64) -> f64 {
    if value.is_normal() {
        value.abs().log2().round().exp2()
    } else {
        1.0
    }
}
