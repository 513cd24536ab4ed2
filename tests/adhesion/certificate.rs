//! The contact conditions with adhesion, recomputed by direct sums with Love's coefficients, and by the test's own formulas of the laws.

use std::f64::consts::PI;

use contact_normal::adhesion::Law;
use contact_normal::contact::State;
use contact_normal::grid::Grid;

/// The displacements u = A p of half-spaces by direct sums (Love 1929, as in Johnson, eq. 3.25).
pub fn displacements(grid: &Grid, modulus: f64, p: &[f64]) -> Vec<f64> {
    let (mx, my) = (grid.mx as i64, grid.my as i64);
    let side = |a: f64, b: f64| a * (b / a.abs()).asinh() + b * (a / b.abs()).asinh();
    let at = |kx: i64, ky: i64| {
        let (x, y) = (kx as f64 * grid.dx, ky as f64 * grid.dy);
        let (right, left, up, down) = (x + grid.dx / 2.0, x - grid.dx / 2.0, y + grid.dy / 2.0, y - grid.dy / 2.0);
        (side(right, up) - side(left, up) - side(right, down) + side(left, down)) / (PI * modulus)
    };
    let table: Vec<f64> = (0..my).flat_map(|ky| (0..mx).map(move |kx| (kx, ky))).map(|(kx, ky)| at(kx, ky)).collect();
    let loaded: Vec<usize> = (0..p.len()).filter(|&i| p[i] != 0.0).collect();
    let mut u = vec![0.0; p.len()];
    for (i, u) in u.iter_mut().enumerate() {
        let (x, y) = (i % grid.mx, i / grid.mx);
        *u =
            loaded.iter().map(|&j| table[(j / grid.mx).abs_diff(y) * grid.mx + (j % grid.mx).abs_diff(x)] * p[j]).sum();
    }
    u
}

/// The attraction sigma(e) of a law, by the formulas of docs/adhesion.md.
pub fn traction(law: Law, work: f64, range: f64, e: f64) -> f64 {
    let t = e.max(0.0) / range;
    work / range
        * match law {
            Law::Exponential => (-t).exp(),
            Law::Dugdale(smear) if t <= 1.0 - smear => 1.0,
            Law::Dugdale(smear) if t >= 1.0 + smear => 0.0,
            Law::Dugdale(smear) => 0.5 * (1.0 + smear - t) / smear,
            Law::Cubic if t >= 3.0 => 0.0,
            Law::Cubic => (1.0 - t / 3.0) * (1.0 - t / 3.0),
            Law::VanDerWaals => 1.0 / (1.0 + 0.5 * t).powi(3),
        }
}

/// The largest relative violation of the conditions, with the contact pressure q = p + sigma. In C e = 0, and outside e >= 0, relative to the
/// distances in C; outside q = 0, and in C q >= 0, relative to p.
pub fn worst(state: &State, u: &[f64], attraction: impl Fn(usize, f64) -> f64) -> f64 {
    let (mut inside, mut distances, mut outside, mut all) = (0.0, 0.0, 0.0, 0.0);
    let (mut penetration, mut pulled, mut largest) = (0.0f64, 0.0f64, 0.0f64);
    for (i, &p) in state.p.iter().enumerate() {
        let e = state.h[i] - state.approach + u[i];
        let q = p + attraction(i, e);
        all += p * p;
        largest = largest.max(p.abs());
        if state.contact[i] {
            inside += e * e;
            distances += (state.h[i] - state.approach).powi(2);
            pulled = pulled.max(-q);
        } else {
            outside += q * q;
            penetration = penetration.max(-e);
        }
    }
    let count = state.contact_count().max(1) as f64;
    let ratio = |value: f64, of: f64| if value == 0.0 { 0.0 } else { value / of };
    let depth = (distances / count).sqrt();
    let scale = if depth > 0.0 { depth } else { u.iter().fold(0.0, |largest: f64, u| largest.max(u.abs())) };
    let parts = [
        ratio((inside / count).sqrt(), scale),
        ratio(penetration, scale),
        ratio(outside.sqrt(), all.sqrt()),
        ratio(pulled, largest),
    ];
    parts.into_iter().fold(0.0, f64::max)
}
