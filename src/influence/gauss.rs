//! Gauss-Legendre quadrature over an interval.

use std::array::from_fn;
use std::f64::consts::PI;
use std::sync::OnceLock;

use crate::threads::made_once;

/// The largest number of points of a rule.
const MOST_POINTS: usize = 40;

/// The nodes and weights `(x, w)` of the n-point rule on [0, 1]. They are computed once.
pub(crate) fn rule(n: usize) -> &'static [(f64, f64)] {
    static KNOWN: [OnceLock<Vec<(f64, f64)>>; MOST_POINTS + 1] = [const { OnceLock::new() }; MOST_POINTS + 1];
    made_once(&KNOWN[n], || gauss_legendre(n)).as_slice()
}

/// Computes the rule: the nodes are the zeros of the Legendre polynomial, by Newton's method.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            // Legendre polynomials of degrees j - 1 and j, by their recursion.
            let (mut previous, mut p) = (1.0, x);
            for j in 2..=n {
                let j = j as f64;
                (previous, p) = (p, ((2.0 * j - 1.0) * x * p - (j - 1.0) * previous) / j);
            }
            slope = n as f64 * (x * p - previous) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// The integral of `f` over an interval of length `d` about `centre`, by nine points.
pub(crate) fn gauss(centre: f64, d: f64, f: impl Fn(f64) -> f64) -> f64 {
    let [integral] = gauss_each(centre, d, |x| [f(x)]);
    integral
}

/// The integrals of N functions over an interval of length `d` about `centre`. The nine points are evaluated in pairs symmetric about the centre.
pub(crate) fn gauss_each<const N: usize>(centre: f64, d: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (rule, mut pairs) = (rule(9), [0.0; N]);
    for &(node, weight) in &rule[..4] {
        let offset = d * (0.5 - node);
        let (right, left) = (f(centre + offset), f(centre - offset));
        pairs = from_fn(|k| pairs[k] + weight * (right[k] + left[k]));
    }
    let middle = f(centre);
    from_fn(|k| d * (pairs[k] + rule[4].1 * middle[k]))
}
