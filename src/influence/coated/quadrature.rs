//! Integrals of the radial functions: Ogata's double-exponential rule for Hankel transforms.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use crate::threads::made_once;

/// The mesh size h of the coarsest of Ogata's rules. Its nodes begin at `pi^2 h/3`; the integrand may vary on ten times this scale.
const MESH: f64 = 0.004;
/// Argument of psi beyond which nodes are zeros of J0.
const LAST_ARGUMENT: f64 = 3.6;
/// Number of rules, each with half the mesh size of the one before.
const RULES: usize = 8;

/// Nodes x and weights w such that `integral from 0 to infinity of f(x) J0(x) dx = sum of w f(x)` (Ogata 2005), for f that varies on a
/// scale of `scale` or longer:
///
/// ```text
/// x = (pi/h) psi(h xi),  w = pi (Y0/J1)(pi xi) J0(x) psi'(h xi),  psi(t) = t tanh(pi/2 sinh t),  pi xi the zeros of J0
/// ```
pub fn hankel_rule(scale: f64) -> &'static [(f64, f64)] {
    static KNOWN: [OnceLock<Vec<(f64, f64)>>; RULES] = [const { OnceLock::new() }; RULES];
    let rule = (0.3 / scale).log2().ceil().clamp(0.0, RULES as f64 - 1.0) as usize;
    made_once(&KNOWN[rule], || {
        let mesh = MESH / (1u32 << rule) as f64;
        let zeros = (1..).map(zero_of_j0).take_while(|zero| zero * mesh / PI < LAST_ARGUMENT);
        zeros.map(|zero| rule_at(zero, mesh)).filter(|(_, w)| w.abs() > 1e-19).collect()
    })
    .as_slice()
}

fn rule_at(zero: f64, mesh: f64) -> (f64, f64) {
    let t = mesh * zero / PI;
    let u = FRAC_PI_2 * t.sinh();
    let slope = u.tanh() + t * FRAC_PI_2 * t.cosh() / u.cosh().powi(2);
    // x = zero + d. Near the zero J0(x) follows from its Taylor series there, because J0(x) itself would be round-off.
    let fade = (-2.0 * u).exp();
    let d = -zero * 2.0 * fade / (1.0 + fade);
    let j1 = libm::j1(zero);
    let value = match d.abs() < 1e-4 {
        true => -j1 * d * (1.0 - 0.5 * d / zero - (1.0 - 2.0 / (zero * zero)) * d * d / 6.0),
        false => libm::j0(zero + d),
    };
    (zero + d, PI * libm::y0(zero) / j1 * value * slope)
}

/// The k-th zero of J0: McMahon's expansion (Abramowitz & Stegun 9.5.12), and Newton's method.
fn zero_of_j0(k: usize) -> f64 {
    let b = (k as f64 - 0.25) * PI;
    let e = 1.0 / (8.0 * b);
    let mut zero = b + e - 124.0 / 3.0 * e * e * e;
    for _ in 0..3 {
        zero += libm::j0(zero) / libm::j1(zero);
    }
    zero
}
