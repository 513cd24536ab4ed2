//! The conditions of friction, recomputed from the returned arrays by direct sums. The coefficients are differences of closed forms over the
//! corners of an element (Johnson, Contact Mechanics, section 3.6), with `r = hypot(X, Y)`:
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G),   Ayy = (a + (1 - nu) b)/(pi G),   Axy = nu c/(pi G)
//! a = [X asinh(Y/|X|)],   b = [Y asinh(X/|Y|)],   c = [-r]
//! ```

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::scene::{Motion, Prescribed};
use contact_normal::solver::{solve, Options, Outcome};

use super::cases::Case;

/// Elements whose traction exceeds this part of the bound count as slipping (docs/friction.md).
const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;

/// Round-off of coefficients, transforms and sums in a displacement, relative to the sum of absolute values.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// The result of a case.
#[derive(Debug)]
pub enum Verdict {
    /// Status OK, and the conditions hold.
    Solved { residual: f64, products: f64 },
    /// Status OK, but the conditions do not hold.
    Wrong { residual: f64, products: f64, why: String },
    /// The solve ended with another status than OK.
    Stopped { outcome: Outcome, residual: f64, products: f64 },
    /// Refused with the expected status.
    Refused(&'static str),
    /// Refused with another status, or without a reason.
    RefusedOtherwise(String),
}

type Vector = [f64; 2];

fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Axx, Ayy and Axy for G = 1 at a place relative to the centre of the element.
fn coefficients(case: &Case, x: f64, y: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (sx, sy) in [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
        let (cx, cy) = (x + sx * case.grid.dx, y + sy * case.grid.dy);
        let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        let parts = [term(cx, cy), term(cy, cx), -cx.hypot(cy)];
        (0..3).for_each(|k| sums[k] += 4.0 * sx * sy * parts[k] / PI);
    }
    let [a, b, c] = sums;
    [(1.0 - case.nu) * a + b, a + (1.0 - case.nu) * b, case.nu * c]
}

/// Displacements caused by tractions q, at places that are `ahead` in x of the centres of elements.
fn displace(case: &Case, q: &[Vector], ahead: f64) -> Vec<Vector> {
    let (mx, my) = (case.grid.mx as i64, case.grid.my as i64);
    let reach = |m: i64| 1 - m..m;
    let offsets = reach(my).flat_map(|ky| reach(mx).map(move |kx| (kx, ky)));
    let at = |(kx, ky): (i64, i64)| coefficients(case, kx as f64 * case.grid.dx + ahead, ky as f64 * case.grid.dy);
    let table: Vec<[f64; 3]> = offsets.map(at).collect();
    let loaded: Vec<i64> = (0..mx * my).filter(|&j| q[j as usize] != [0.0; 2]).collect();
    let displacement = |i: i64| {
        loaded.iter().fold([0.0; 2], |u, &j| {
            let k = (i / mx - j / mx + my - 1) * (2 * mx - 1) + i % mx - j % mx + mx - 1;
            let ([xx, yy, xy], q) = (table[k as usize], q[j as usize]);
            [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]]
        })
    };
    (0..mx * my).map(displacement).collect()
}

/// The rigid slip of element i.
fn rigid_slip(case: &Case, motion: Motion, i: usize, creepage: Vector) -> Vector {
    let grid = &case.grid;
    let step = if motion == Motion::Shift { 0.0 } else { grid.dx };
    let distance = if motion == Motion::Shift { 1.0 } else { grid.dx };
    let x = ((i % grid.mx) as f64 - 0.5 * (grid.mx as f64 - 1.0)) * grid.dx + step / 6.0;
    let y = ((i / grid.mx) as f64 - 0.5 * (grid.my as f64 - 1.0)) * grid.dy;
    let own = case.rigid_slip.as_ref().map_or([0.0; 2], |own| [own[0][i], own[1][i]]);
    [distance * (creepage[0] - case.spin * y) + own[0], distance * (creepage[1] + case.spin * x) + own[1]]
}

/// The rms residual of the slip relative to its scale, and the round-off that it may have.
fn residual(case: &Case, motion: Motion, g: &[f64], q: &[Vector], creepage: Vector) -> (f64, f64) {
    let is_steady = motion == Motion::SteadyRolling;
    let given = |i: usize| case.previous.as_ref().map_or([0.0; 2], |before| [before[0][i], before[1][i]]);
    let before: Vec<Vector> = if is_steady { q.to_vec() } else { (0..q.len()).map(given).collect() };
    let u = displace(case, q, 0.0);
    let u_before = displace(case, &before, if motion == Motion::Shift { 0.0 } else { case.grid.dx });
    let [mut residuals, mut rigid, mut displaced] = [const { Vec::new() }; 3];
    let mut largest = 0.0f64;
    for i in (0..q.len()).filter(|&i| g[i] > 0.0) {
        let w = rigid_slip(case, motion, i, creepage);
        let s = [0, 1].map(|k| w[k] + u[i][k] - u_before[i][k]);
        largest = largest.max(length(w)).max(length(u[i])).max(length(u_before[i]));
        let mut rest = s;
        if length(q[i]) >= g[i] * ON_THE_CIRCLE {
            let outward = q[i].map(|value| value / length(q[i]));
            let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
            rest = [0, 1].map(|k| s[k] - along * outward[k]);
        }
        residuals.push(length(rest));
        rigid.push(length(w));
        displaced.push(length(if is_steady { [0, 1].map(|k| u[i][k] - u_before[i][k]) } else { u[i] }));
    }
    let has_forces = case.prescribed.iter().any(|prescribed| matches!(prescribed, Prescribed::Force(_)));
    let scale = match motion {
        Motion::Shift => rms(&rigid).max(rms(&displaced)),
        Motion::SteadyRolling if has_forces => rms(&rigid).max(rms(&displaced)),
        // In slow rolling the scale is at least the root of the machine epsilon, 1.5e-8, times the displacements.
        _ => rms(&rigid).max(f64::EPSILON.sqrt() * rms(&displaced)),
    };
    let part = |value: f64| if value == 0.0 { 0.0 } else { value / scale };
    (part(rms(&residuals)), part(ROUND_OFF * largest))
}

/// Describes the first bound or prescribed force that does not hold. `None`: all of them hold.
fn broken(case: &Case, g: &[f64], q: &[Vector]) -> Option<String> {
    if let Some(i) = (0..q.len()).find(|&i| !(length(q[i]) <= g[i])) {
        return Some(format!("element {i}: {:?} beyond {}", q[i], g[i]));
    }
    let carried = g.iter().sum::<f64>();
    for (k, prescribed) in case.prescribed.iter().enumerate() {
        if let Prescribed::Force(force) = prescribed {
            let given = force / case.grid.element_area();
            let sum: f64 = q.iter().map(|q| q[k]).sum();
            if !((sum - given).abs() <= 1.001 * Options::default().tolerance * carried) {
                return Some(format!("a force of {sum} for {given}"));
            }
        }
    }
    None
}

/// Solves a case and recomputes the conditions.
pub fn judge(case: &Case, motion: Motion) -> Verdict {
    let options = Options::default();
    let (solver, outcome, report) = match solve(&case.scene(motion), &options) {
        Ok(found) => found,
        Err(error) => {
            let status = match error {
                Error::InvalidArgument(_) => "INVALID_ARGUMENT",
                Error::NotFinite(_) => "NOT_FINITE",
                Error::Infeasible(_) => "INFEASIBLE",
                _ => "another",
            };
            return match case.refusal {
                Some(expected) if expected == status => Verdict::Refused(expected),
                _ => Verdict::RefusedOtherwise(format!("{status}: {error}")),
            };
        }
    };
    let found = report.friction.expect("a report of the friction");
    let q = &solver.friction().expect("tractions").traction;
    let g: Vec<f64> = solver.state().p.iter().zip(&case.mu).map(|(p, mu)| mu * p).collect();
    let (residual, rounding) = residual(case, motion, &g, q, found.creepage);
    let products = found.products;
    if outcome != Outcome::Converged {
        return Verdict::Stopped { outcome, residual, products };
    }
    let why = match broken(case, &g, q) {
        None if case.refusal.is_some() => "not refused".into(),
        None if residual <= options.tolerance + rounding => return Verdict::Solved { residual, products },
        None => format!("residual {residual}, rounding {rounding}"),
        Some(why) => why,
    };
    Verdict::Wrong { residual, products, why }
}
