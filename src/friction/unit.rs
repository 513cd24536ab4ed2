//! Units are powers of two, so that scaling changes no bit of a mantissa.

/// The power of two that is nearest to the absolute value, on a logarithmic scale; 1 if the value is 0, subnormal or not finite.
pub fn unit_of(value: f64) -> f64 {
    if value.is_normal() {
        value.abs().log2().round().exp2()
    } else {
        1.0
    }
}
