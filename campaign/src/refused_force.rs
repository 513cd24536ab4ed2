//! Checks refused tangential forces on unlike bodies. Tractions change the pressures of unlike bodies, so no closed form gives the largest force. If
//! the library refuses a force, no creepage may carry a larger one.

use contact_normal::ffi::*;

use crate::friction_call::{call, frictionless};
use crate::friction_case::Case;

/// The creepages that are tried are 10^-2 to 10^3 times one of the order of full slip.
const FIRST_DECADE: i32 = -2;
const LAST_DECADE: i32 = 3;
/// The number of creepages per decade.
const PER_DECADE: i32 = 8;
/// A force counts as exceeded if the other one is larger by this part, in addition to the tolerances of two solves. Both solves may differ in their
/// previous tractions.
const MARGIN: f64 = 1e-3;

/// Searches for a creepage that carries more than the given force in one direction. Returns this creepage and its force. None if no creepage carries
/// more, or if the case is not one that can be decided: not exactly one force is given, the force is 0, or the solve has few cycles or is cancelled.
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
    // The creepage at which the rigid slip is mu times the largest normal displacement. Most contacts slip as a whole at a creepage of this order.
    let full = largest(&slide.mu) * largest(&frictionless(place, stop).u) / slide.length(&place.grid);
    let mut trial = slide.clone();
    trial.prescribed[k] = CONTACT_NORMAL_PRESCRIBED_CREEPAGE;
    let most = wanted.abs() * (1.0 + MARGIN + 10.0 * stop.tolerance);
    (FIRST_DECADE * PER_DECADE..=LAST_DECADE * PER_DECADE).find_map(|j| {
        trial.amount[k] = -wanted.signum() * full * 10f64.powf(f64::from(j) / f64::from(PER_DECADE));
        let found = call(place, &trial, stop);
        let area = place.grid.dx * place.grid.dy;
        let force = wanted.signum() * found.q.iter().map(|q| q[k]).sum::<f64>() * area;
        (found.status == CONTACT_NORMAL_OK && force >= most).then_some((trial.amount[k], force))
    })
}
