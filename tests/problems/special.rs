//! Special functions beside the tables of them.

use contact_normal::influence::special::{complementary_error_function, hurwitz_zeta};

#[test]
fn special_functions_have_the_digits_of_the_tables() {
    // Abramowitz & Stegun, tables 7.1 and 7.3, and zeta(3), zeta(5) less their first nine terms; more digits computed by mpmath.
    for (x, exact) in [
        (0.0, 1.0),
        (0.5, 0.479_500_122_186_953_5),
        (1.0, 0.157_299_207_050_285_13),
        (1.999, 0.004_698_443_348_629_488),
        (2.0, 0.004_677_734_981_047_266),
        (3.0, 2.209_049_699_858_544e-5),
        (6.0, 2.151_973_671_249_891_3e-17),
    ] {
        // 1 - erf: units of round-off of 1 below 2, of the value above
        let value = complementary_error_function(x);
        assert!((value - exact).abs() <= 8.0 * f64::EPSILON * if x < 2.0 { 1.0 } else { 8.0 * exact }, "{x}: {value}");
    }
    for (s, zeta) in [(3.0, 1.202_056_903_159_594_2), (5.0, 1.036_927_755_143_37)] {
        let exact = zeta - (1..10).map(|n| f64::from(n).powf(-s)).sum::<f64>();
        assert!((hurwitz_zeta(s, 10.0) - exact).abs() <= 4.0 * f64::EPSILON, "{s}");
    }
}
