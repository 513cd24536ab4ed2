//! The transfer function of a bonded layer, and its Hankel integral F, which is a function of the distance from the load (`coating` has the
//! formulas).

use std::f64::consts::PI;

/// The number of nodes of a panel of the table, for an accuracy of 1e-13. On a panel `asinh(rho/2)` changes by at most 1/2.
const NODES: usize = 14;

/// The numerators N of the transfer functions for pressures (upper sign) and for tractions along a wave (lower sign), and the denominator D of both:
///
/// ```text
/// N = 1 +- 4 s kappa e - lambda kappa e^2,    D = 1 - (lambda + kappa + 4 kappa s^2) e + lambda kappa e^2,    e = exp(-2 s)
/// ```
///
/// For a soft layer (mu = G1/G2 < 1) they are computed from these formulas. For a stiff layer lambda and kappa are near 1, and N and D would cancel.
/// So they are written as sums of positive terms, with `lambda = 1 - p`, `kappa = 1 - q`, `sinh 2s - 2s` and `cosh 2s - 1 - 2 s^2`.
fn numerators_and_denominator(mu: f64, [nu1, nu2]: [f64; 2], s: f64) -> [f64; 3] {
    let (p, q) = (4.0 * (1.0 - nu1) / (1.0 + mu * (3.0 - 4.0 * nu2)), 4.0 * (1.0 - nu1) / (mu + 3.0 - 4.0 * nu1));
    let (lambda, kappa, e) = (1.0 - p, 1.0 - q, (-2.0 * s).exp());
    if mu < 1.0 {
        let d = 1.0 - (lambda + kappa + 4.0 * kappa * s * s) * e + lambda * kappa * e * e;
        let n = 1.0 - lambda * kappa * e * e;
        return [n + 4.0 * s * kappa * e, n - 4.0 * s * kappa * e, d];
    }
    let (faded, rest) = (-(-2.0 * s).exp_m1(), e * e * (p + q - p * q));
    let pressures = -(-4.0 * s).exp_m1() + rest + 4.0 * s * kappa * e;
    let tractions = 2.0 * e * series_rest(2.0 * s, 1) + 4.0 * s * q * e + rest;
    let d = p * q + p * kappa * e * faded + lambda * q * faded + 2.0 * kappa * e * series_rest(2.0 * s, 2);
    [pressures, tractions, d]
}

/// `sinh x - x` (order 1), or `cosh x - 1 - x^2/2` (order 2), without cancellation for small x.
fn series_rest(x: f64, order: u32) -> f64 {
    if x > 2.0 {
        return if order == 1 { x.sinh() - x } else { x.cosh() - 1.0 - 0.5 * x * x };
    }
    let (mut term, mut sum) = (if order == 1 { x * x * x / 6.0 } else { x.powi(4) / 24.0 }, 0.0);
    let mut k = f64::from(order + 2);
    while term > 1e-18 * sum {
        sum += term;
        term *= x * x / ((k + 1.0) * (k + 2.0));
        k += 2.0;
    }
    sum
}

/// The transfer function B(s) for pressures, with mu = G1/G2 and nu = [nu1, nu2] of the layer and the body below.
pub fn transfer(mu: f64, nu: [f64; 2], s: f64) -> f64 {
    let [n, _, d] = numerators_and_denominator(mu, nu, s);
    n / d
}

/// The transfer functions for tractions along a wave (plane strain) and across it (antiplane strain): the displacements of the surface relative to
/// those of a half-space of the layer's material.
pub fn of_tractions(mu: f64, nu: [f64; 2], s: f64) -> [f64; 2] {
    let [_, n, d] = numerators_and_denominator(mu, nu, s);
    [n / d, (mu + s.tanh()) / (1.0 + mu * s.tanh())]
}

/// The nodes and weights of Gauss's rule with n points on [0, 1]. Newton's method finds the roots of the Legendre polynomial.
pub fn gauss(n: usize) -> Vec<(f64, f64)> {
    let legendre = |x: f64| {
        let (mut before, mut p) = (1.0, x);
        for j in 2..=n {
            (before, p) = (p, ((2 * j - 1) as f64 * x * p - (j - 1) as f64 * before) / j as f64);
        }
        (p, n as f64 * (x * p - before) / (x * x - 1.0))
    };
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..9 {
            let (p, slope) = legendre(x);
            x -= p / slope;
        }
        let (_, slope) = legendre(x);
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// Gauss's rules over an element, for functions of `rho = r/t` that have singularities at rho = +-2i. The number of points depends on the distance
/// from the load:
///
/// - near the load, twelve points for each two thicknesses; the error is `(2 + sqrt 5)^-24 = 1e-15`;
/// - from 2.5 elements on, twelve points in all;
/// - from 24 elements on, four points: there F is at least as smooth as 1/rho.
pub struct Rules {
    rules: [Vec<(f64, f64)>; 3],
    /// The longer side of an element, in thicknesses.
    longer: f64,
}

impl Rules {
    /// The rules for elements whose longer side is `longer` thicknesses.
    pub fn new(longer: f64) -> Rules {
        let (near, far) = (gauss(12), gauss(4));
        let panels = (0.5 * longer).ceil().max(1.0);
        let panel = |k: u32| near.iter().map(move |(x, w)| ((x + f64::from(k)) / panels, w / panels));
        let beside = (0..panels as u32).flat_map(panel).collect();
        Rules { rules: [beside, near, far], longer }
    }

    /// The rule at a distance in thicknesses. It serves both directions.
    pub fn at(&self, distance: f64) -> &[(f64, f64)] {
        let elements = distance / self.longer;
        &self.rules[usize::from(elements > 2.5) + usize::from(elements > 24.0)]
    }
}

/// A table of F up to a distance, for interpolation by polynomials on panels in `v = asinh(rho/2)`.
pub struct Table {
    /// The width of a panel in v.
    width: f64,
    /// F at the nodes of each panel.
    panels: Vec<Vec<f64>>,
    /// The nodes of a panel, in [0, 1].
    nodes: Vec<f64>,
    /// The barycentric weights of the nodes.
    weights: Vec<f64>,
}

impl Table {
    /// The table of F for pressures, up to the distance `last` in thicknesses.
    pub fn new(mu: f64, nu: [f64; 2], last: f64) -> Table {
        Table::of(mu, &|s| transfer(mu, nu, s) - 1.0, libm::j0, last)
    }

    /// The table of `integral over s > 0 of faded(s) bessel(s rho)`, where `faded` decays with s like B(s) - 1 of a layer with mu = G1/G2.
    pub fn of(mu: f64, faded: &dyn Fn(f64) -> f64, bessel: fn(f64) -> f64, last: f64) -> Table {
        let count = ((0.5 * last).asinh() / 0.5).ceil().max(1.0);
        let width = 1.0001 * (0.5 * last).asinh() / count;
        // Chebyshev points of the second kind, and their barycentric weights.
        let nodes: Vec<f64> = (0..NODES).map(|i| 0.5 - 0.5 * (PI * i as f64 / (NODES - 1) as f64).cos()).collect();
        let weight = |i: usize| if i == 0 || i == NODES - 1 { 0.5 } else { 1.0 } * if i % 2 == 0 { 1.0 } else { -1.0 };
        let place = |panel: usize, node: f64| 2.0 * ((panel as f64 + node) * width).sinh();
        let panel = |panel: usize| {
            let rule = hankel(mu, faded, place(panel, 1.0));
            let f = |rho: f64| rule.iter().map(|(s, w)| w * bessel(s * rho)).sum::<f64>();
            nodes.iter().map(|&node| f(place(panel, node))).collect()
        };
        let panels = (0..count as usize).map(panel).collect();
        Table { width, panels, weights: (0..NODES).map(weight).collect(), nodes }
    }

    /// F at a distance in thicknesses.
    pub fn at(&self, rho: f64) -> f64 {
        let v = (0.5 * rho).asinh() / self.width;
        let panel = (v as usize).min(self.panels.len() - 1);
        let x = v - panel as f64;
        // The barycentric formula.
        let (mut numerator, mut denominator) = (0.0, 0.0);
        for ((node, weight), f) in self.nodes.iter().zip(&self.weights).zip(&self.panels[panel]) {
            if x == *node {
                return *f;
            }
            let part = weight / (x - node);
            (numerator, denominator) = (numerator + part * f, denominator + part);
        }
        numerator / denominator
    }
}

/// A rule for the Hankel integral up to the distance rho: the nodes s, and the weights times `faded(s)`. It has panels of ten points. On a panel `s
/// rho` changes by at most 8. The first panel has the scale of a stiff layer in s, and each panel is up to twice as long as the one before.
fn hankel(mu: f64, faded: &dyn Fn(f64) -> f64, rho: f64) -> Vec<(f64, f64)> {
    let (widest, rule) = (f64::min(0.5, 8.0 / rho), gauss(10));
    let (mut nodes, mut low, mut width) = (Vec::new(), 0.0, f64::min(widest, 0.02 / mu.max(1.0)));
    while low < 22.0 {
        nodes.extend(rule.iter().map(|(x, w)| {
            let s = low + width * x;
            (s, w * width * faded(s))
        }));
        low += width;
        width = f64::min(2.0 * width, widest);
    }
    nodes
}
