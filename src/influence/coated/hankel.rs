//! The radial functions by quadrature of their Hankel integrals. The tables of [`Radial`](super::Radial) are made from them.
//!
//! The functions are stored as polynomials on panels of `v = asinh(rho/2)`, through the values at 16 Chebyshev nodes. Singularities at `Im v =
//! pi/2` are 6.3 half-widths away, so the error is `(6.3 + sqrt(6.3^2 - 1))^-16 = 3e-18`. The values come from Gauss-Legendre quadrature in s for
//! small rho, and from Ogata's rule for large rho.

use super::polynomial::{chebyshev, clenshaw, node};
use super::quadrature::hankel_rule;
use super::response::Response;
use crate::influence::gauss;

/// The number of nodes of a panel.
const N: usize = 16;
/// The largest width of a panel in v.
const PANEL: f64 = 0.5;
/// The s beyond which B - 1 is negligible for layers up to 1e4 times stiffer than the substrate: `4 s^2 exp(-2 s)` is 1.5e-16 there.
const S_MAX: f64 = 22.0;

/// The radial function F on panels in v, as Chebyshev coefficients.
pub struct Hankel {
    /// The width of a panel.
    width: f64,
    /// The coefficients of `F_1 sqrt(1 + rho^2/4)`, on the panels of small rho.
    layer: Vec<[f64; N]>,
    /// The coefficients of `F_B0 rho`, on all panels.
    substrate: Vec<[f64; N]>,
}

impl Hankel {
    /// Computes F up to the distance `last`. `pole` is L, with 1/L the distance of the nearest pole of B from s = 0.
    pub fn new(transfer: &dyn Response, pole: f64, last: f64) -> Hankel {
        let v_max = (0.5 * last).asinh();
        let count = (v_max / PANEL).ceil();
        let width = v_max / count;
        let near = 12.0 * f64::max(1.0, transfer.substrate().cbrt());
        let one_minus_substrate = 1.0 - transfer.substrate();
        let mut hankel = Hankel { width, layer: Vec::new(), substrate: Vec::new() };
        for panel in 0..count as usize {
            let rho = |x: f64| 2.0 * ((panel as f64 + 0.5 + 0.5 * x) * width).sinh();
            let nodes: [f64; N] = std::array::from_fn(|i| rho(node(i, N)));
            if rho(-1.0) < near {
                let rule = near_rule(transfer, pole, rho(1.0));
                let f = nodes.map(|rho| rule.iter().map(|(s, value)| value * libm::j0(s * rho)).sum::<f64>());
                hankel
                    .layer
                    .push(chebyshev(&std::array::from_fn(|i| f[i] * (1.0 + 0.25 * nodes[i] * nodes[i]).sqrt())));
                hankel.substrate.push(chebyshev(&std::array::from_fn(|i| f[i] * nodes[i] + one_minus_substrate)));
            } else {
                hankel.substrate.push(chebyshev(&nodes.map(|rho| far_value(transfer, pole, rho))));
            }
        }
        hankel
    }

    /// The value at rho of the function that these panels hold.
    fn at(&self, panels: &[[f64; N]], rho: f64) -> f64 {
        let v = (0.5 * rho).asinh() / self.width;
        let panel = (v as usize).min(panels.len() - 1);
        clenshaw(&panels[panel], 2.0 * (v - panel as f64) - 1.0)
    }

    /// F_1 at the distance rho, which must lie on the panels of small rho.
    pub fn layer(&self, rho: f64) -> f64 {
        self.at(&self.layer, rho) / (1.0 + 0.25 * rho * rho).sqrt()
    }

    /// F_B0 at the distance rho.
    pub fn substrate(&self, rho: f64) -> f64 {
        self.at(&self.substrate, rho) / rho
    }
}

/// `F_B0 rho` by Ogata's rule.
fn far_value(transfer: &dyn Response, pole: f64, rho: f64) -> f64 {
    let term = |(x, w): &(f64, f64)| w * (transfer.at(x / rho) - transfer.substrate());
    hankel_rule(rho / pole).iter().map(term).sum()
}

/// Nodes s, and weights times B(s) - 1, of a rule for distances up to `rho_max`: composite 24-point Gauss-Legendre quadrature. A panel has at
/// most 30 radians of J0, and the error is `(15 e/96)^48 = 2e-18`. The first panel ends at most halfway to the nearest pole of B; each later end
/// is at most four times the one before.
fn near_rule(transfer: &dyn Response, pole: f64, rho_max: f64) -> Vec<(f64, f64)> {
    let width = f64::min(1.5, 30.0 / rho_max);
    let (mut rule, mut low, mut high) = (Vec::new(), 0.0, f64::min(width, 0.5 / pole));
    while low < S_MAX {
        for (x, w) in gauss::rule(24) {
            let s = low + (high - low) * x;
            rule.push((s, (high - low) * w * transfer.less_one(s)));
        }
        (low, high) = (high, f64::min(4.0 * high, high + width));
    }
    rule
}
