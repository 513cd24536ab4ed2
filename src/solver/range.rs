//! Refuses units in which numbers leave the range of double precision.

use super::Guess;
use crate::contact::Problem;
use crate::error::{invalid, Result};
use crate::scene::{Load, Scene};

/// Refuses units in which pressures, displacements or their squares leave the range of double precision. `fixed`: a contact
/// area that is given.
pub fn check(scene: &Scene<'_>, problem: &Problem, largest: f64, fixed: Option<Guess<'_>>) -> Result<()> {
    let influence = problem.self_influence();
    let h = scene.undeformed_distance;
    let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
    // The largest on the given contact area.
    let largest_on = |fixed: Guess<'_>, of: &dyn Fn(f64) -> f64| {
        let on_contact = h.iter().zip(fixed.contact).filter(|(h, inside)| **inside && h.is_finite());
        on_contact.fold(0.0, |largest: f64, (h, _)| largest.max(of(*h).abs()))
    };
    // With a prescribed force the approach is a mean of distances, whatever they are measured from.
    let (pressure, displacement, farthest) = match scene.load {
        Load::Approach(approach) => {
            let depth = match fixed {
                Some(fixed) => largest_on(fixed, &|h| h - approach),
                None if lowest.is_finite() => (approach - lowest).max(0.0),
                None => 0.0,
            };
            (depth / influence, depth, 0.0)
        }
        Load::Force(force) => {
            let pressure = force / scene.grid.element_area();
            let farthest = fixed.map_or(lowest.abs(), |fixed| largest_on(fixed, &|h| h));
            (pressure, pressure * influence, farthest)
        }
    };
    if pressure != 0.0 && farthest >= 1e140 {
        return invalid(format!(
                "the undeformed distances of the contact area are of order {farthest:e}; with a prescribed force they must lie \
                 below 1e140: choose other units"
            ));
    }
    let in_range = |value: f64| (1e-140..1e140).contains(&value);
    let loaded = pressure != 0.0 || displacement != 0.0;
    // A single element of two periods displaces nothing.
    if problem.grid.len() == 1 && problem.coefficients.is_mean_free() && in_range(pressure) {
        return Ok(());
    }
    let coefficients = in_range(influence) && in_range(largest) && in_range(largest * pressure);
    if loaded && !(in_range(pressure) && in_range(displacement) && coefficients) {
        return invalid(format!(
                "the scene has pressures of order {pressure:e}, displacements of order {displacement:e} and influence \
                 coefficients of order {influence:e} to {largest:e}; all must lie between 1e-140 and 1e140: choose other units"
            ));
    }
    Ok(())
}
