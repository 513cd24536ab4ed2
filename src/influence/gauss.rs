//! Gauss-Legendre over an interval.

/// Nodes and weights of the 9-point Gauss-Legendre rule on [-1, 1], non-negative half (Abramowitz & Stegun 25.4).
pub(super) const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.330_239_355_001_259_8),
    (0.324_253_423_403_808_9, 0.312_347_077_040_002_84),
    (0.613_371_432_700_590_4, 0.260_610_696_402_935_46),
    (0.836_031_107_326_635_8, 0.180_648_160_694_857_4),
    (0.968_160_239_507_626_1, 0.081_274_388_361_574_41),
];

/// Integral of `f` over an interval of length `d` about `centre`.
pub(crate) fn gauss(centre: f64, d: f64, f: impl Fn(f64) -> f64) -> f64 {
    let [integral] = gauss_each(centre, d, |x| [f(x)]);
    integral
}

/// The same of several functions at once.
pub(crate) fn gauss_each<const N: usize>(centre: f64, d: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let mut pairs = [0.0; N];
    for &(node, weight) in &GAUSS[1..] {
        let (right, left) = (f(centre + 0.5 * d * node), f(centre - 0.5 * d * node));
        pairs = std::array::from_fn(|k| pairs[k] + weight * (right[k] + left[k]));
    }
    let middle = f(centre);
    std::array::from_fn(|k| 0.5 * d * (pairs[k] + GAUSS[0].1 * middle[k]))
}
