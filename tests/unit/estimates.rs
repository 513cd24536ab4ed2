//! Unit tests of `solver/estimates.rs`.

use super::*;

#[test]
fn the_order_and_the_error_of_a_power_are_found() {
    for q in [0.7, 1.0, 1.5, 2.0, 3.0] {
        let value = |size: f64| 5.0 - 0.01 * size.powf(q);
        let (a, b) = (4.0, 16.0);
        let seen = order((value(b) - value(1.0)) / (value(a) - value(1.0)), a, b).unwrap();
        // 40 bisections of an interval of 4
        assert!((seen - q).abs() < 1e-9, "{seen} of {q}");
        let (error, taken) = richardson(value(1.0), (a, value(a)), Some((b, value(b))), q).unwrap();
        assert_eq!(taken, q);
        assert!((error + 0.01).abs() < 1e-12, "{error}");
    }
}

#[test]
fn values_that_do_not_converge_are_not_trusted() {
    // It grows with the logarithm of the size of the elements: order 0.
    let growing = |size: f64| 3.0 - size.ln();
    assert_eq!(richardson(growing(1.0), (4.0, growing(4.0)), Some((8.0, growing(8.0))), 2.0), None);
    // To and fro
    assert_eq!(richardson(1.0, (4.0, 1.1), Some((8.0, 0.9)), 2.0), None);
    assert_eq!(richardson(1.0, (4.0, f64::NAN), Some((8.0, 0.9)), 2.0), None);
    // Farther grids that do not differ more
    assert_eq!(richardson(1.0, (4.0, 1.2), Some((8.0, 1.1)), 2.0), None);
}
