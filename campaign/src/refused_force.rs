//! Refused forces on unlike bodies: tractions change the pressures, so that no closed form gives the greatest force. No creepage may carry more than
//! a refused force.

use contact_normal::ffi::*;

use crate::friction_call::{call, frictionless};
use crate::friction_case::Case;

/// The decades of the creepages that are tried, from a hundredth to a thousand times the displacement of full slip, and their number per decade.
const DECADES: (i32, i32) = (-2, 3);
const A_DECADE: i32 = 8;
/// A force counts as reached if it is exceeded by this part, in addition to the tolerances of two solves: previous tractions may differ.
const MORE: f64 = 1e-3;

/// A creepage that carries more than the given force in one direction, and its force. None: there is no such creepage, or the question does not
/// arise.
pub fn exceeded(case: &Case) -> Option<(f64, f64)> {
    let Case { place, slide, stop, .. } = case;
    let k = match [0, 1].map(|k| slide.is_force(k)) {
        [true, false] => 0,
        [false, true] => 1,
        _ => return None,
    };
    let wanted = slide.amount[k];
    if !stop.is_unhindered() || wanted == 0.0 {
        return None;
    }
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let full = largest(&slide.mu) * largest(&frictionless(place, stop).u) / slide.length(&place.grid);
    let mut trial = slide.clone();
    trial.prescribed[k] = CONTACT_NORMAL_PRESCRIBED_CREEPAGE;
    let most = wanted.abs() * (1.0 + MORE + 10.0 * stop.tolerance);
    (DECADES.0 * A_DECADE..=DECADES.1 * A_DECADE).find_map(|j| {
        trial.amount[k] = -wanted.signum() * full * 10f64.powf(f64::from(j) / f64::from(A_DECADE));
        let found = call(place, &trial, stop);
        let area = place.grid.dx * place.grid.dy;
        let force = wanted.signum() * found.q.iter().map(|q| q[k]).sum::<f64>() * area;
        (found.status == CONTACT_NORMAL_OK && force >= most).then_some((trial.amount[k], force))
    })
}
