//! Ogata's double-exponential rule for Hankel transforms, which integrates the radial functions.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use crate::threads::made_once;

/// The mesh size h of the coarsest rule. Its nodes begin at `pi^2 h/3`; the integrand must not vary on a scale shorter than ten times this.
const MESH: f64 = 0.004;
/// The argument of psi beyond which the nodes are zeros of J0, up to round-off, so that their terms vanish.
const LAST_ARGUMENT: f64 = 3.6;
/// The number of rules. Each has half the mesh size of the one before.
const RULES: usize = 8;

/// The nodes x and weights w of a rule `integral from 0 to infinity of f(x) J0(x) dx = sum of w f(x)` (Ogata 2005), for a function f that varies
/// on a scale of `scale` or longer:
///
/// ```text
/// x = (pi/h) psi(h xi),  w = pi (Y0/J1)(pi xi) J0(x) psi'(h xi),  psi(t) = t tanh(pi/2 sinh t),  pi xi the zeros of J0
/// ```
pub fn hankel_rule(scale: f64) -> &'static [(f64, f64)] {
    static RULES_SO_FAR: [OnceLock<Vec<(f64, f64)>>; RULES] = [const { OnceLock::new() }; RULES];
    let rule = (0.3 / scale).log2().ceil().clamp(0.0, RULES as f64 - 1.0) as usize;
    made_once(&RULES_SO_FAR[rule], || {
        let mesh = MESH / (1u32 << rule) as f64;
        let zeros = (1..).map(zero_of_j0).take_while(|zero| zero * mesh / PI < LAST_ARGUMENT);
        zeros.map(|zero| rule_at(zero, mesh)).filter(|(_, w)| w.abs() > 1e-19).collect()
    })
    .as_slice()
}

/// The node and the weight that belong to one zero of J0.
fn rule_at(zero: f64, mesh: f64) -> (f64, f64) {
    let t = mesh * zero / PI;
    let u = FRAC_PI_2 * t.sinh();
    let slope = u.tanh() + t * FRAC_PI_2 * t.cosh() / u.cosh().powi(2);
    // The node is x = zero + d. Near the zero J0(x) is computed from its Taylor series there, because J0 itself would return round-off.
    let fade = (-2.0 * u).exp();
    let d = -zero * 2.0 * fade / (1.0 + fade);
    let j1 = libm::j1(zero);
    let value = match d.abs() < 1e-4 {
        true => -j1 * d * (1.0 - 0.5 * d / zero - (1.0 - 2.0 / (zero * zero)) * d * d / 6.0),
        false => libm::j0(zero + d),
    };
    (zero + d, PI * libm::y0(zero) / j1 * value * slope)
}

/// The k-th zero of J0: McMahon's expansion (Abramowitz & Stegun 9.5.12), then Newton's method.
fn zero_of_j0(k: usize) -> f64 {
    let b = (k as f64 - 0.25) * PI;
    let e = 1.0 / (8.0 * b);
    let mut zero = b + e - 124.0 / 3.0 * e * e * e;
    for _ in 0..3 {
        zero += libm::j0(zero) / libm::j1(zero);
    }
    zero
}
