//! How well the contact conditions hold: everything here is computed from p, h and a fresh u = A p.

use super::State;

/// The measures of a solution. Status OK means that they hold to the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C.
    pub residual: f64,
    /// Largest `-e` over the exterior area, 0 when the bodies penetrate nowhere: a length.
    pub penetration: f64,
    /// `sum of p |e| / sum of p |u|` over all elements: pressures times gaps, against the elastic energy.
    pub complementarity: f64,
    /// Smallest pressure.
    pub min_pressure: f64,
}

/// 2-norm over C of `h - approach`: what residuals are compared with.
pub fn norm_of_distance(state: &State) -> f64 {
    over_contact(state, |i| state.h[i] - state.approach)
}

/// 2-norm over C of `h - approach + u`.
pub fn residual_norm(state: &State) -> f64 {
    over_contact(state, |i| state.deformed_distance(i))
}

fn over_contact(state: &State, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for (i, _) in state.contact.iter().enumerate().filter(|(_, &inside)| inside) {
        sum += value(i) * value(i);
    }
    sum.sqrt()
}

/// Measures a state whose u is A p.
pub fn certify(state: &State) -> Certificate {
    let (mut penetration, mut min_pressure): (f64, f64) = (0.0, f64::INFINITY);
    let (mut gaps, mut energy) = (0.0, 0.0);
    for i in 0..state.p.len() {
        let p = state.p[i];
        min_pressure = min_pressure.min(p);
        if !state.contact[i] {
            penetration = penetration.max(-state.deformed_distance(i));
        }
        if p != 0.0 {
            gaps += p * state.deformed_distance(i).abs();
            energy += p * state.u[i].abs();
        }
    }
    let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
    Certificate {
        residual: relative(residual_norm(state), norm_of_distance(state)),
        penetration,
        complementarity: relative(gaps, energy),
        min_pressure,
    }
}
