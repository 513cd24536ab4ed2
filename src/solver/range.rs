//! Refuses units in which numbers leave the range of double precision.

use super::Guess;
use crate::contact::Problem;
use crate::error::{invalid, Result};
use crate::scene::{Load, Scene};

/// Refuses units in which pressures, displacements or their squares leave the range of double precision. `fixed`: a contact
/// area that is given.
pub fn check(scene: &Scene<'_>, problem: &Problem, largest: f64, fixed: Option<Guess<'_>>) -> Result<()> {
    let influence = problem.self_influence();
    let (pressure, displacement) = match (scene.load, fixed) {
        (Load::Approach(approach), Some(fixed)) => {
            let on_contact = scene.undeformed_distance.iter().zip(fixed.contact);
            let on_contact = on_contact.filter(|(h, inside)| **inside && h.is_finite());
            let depth = on_contact.fold(0.0, |depth: f64, (h, _)| depth.max((h - approach).abs()));
            (depth / influence, depth)
        }
        (Load::Approach(approach), None) => {
            let lowest = scene.undeformed_distance.iter().copied().fold(f64::INFINITY, f64::min);
            let depth = if lowest.is_finite() { (approach - lowest).max(0.0) } else { 0.0 };
            (depth / influence, depth)
        }
        (Load::Force(force), _) => {
            let pressure = force / scene.grid.element_area();
            (pressure, pressure * influence)
        }
    };
    // With a prescribed force the approach is a mean of distances, whatever they are measured from.
    let farthest = match (scene.load, fixed) {
        (Load::Approach(_), _) => 0.0,
        (Load::Force(_), Some(fixed)) => {
            let on_contact = scene.undeformed_distance.iter().zip(fixed.contact);
            let on_contact = on_contact.filter(|(h, inside)| **inside && h.is_finite());
            on_contact.fold(0.0, |farthest: f64, (h, _)| farthest.max(h.abs()))
        }
        (Load::Force(_), None) => scene.undeformed_distance.iter().copied().fold(f64::INFINITY, f64::min).abs(),
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
