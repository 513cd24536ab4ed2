//! The largest slope with which bounds fall with the slip, at any slip and for any state of the particle: `law_slope` of a report.
//!
//! For an element of pressure p, with the coefficient mu at rest, the memory distance c and the memory speed v0, a particle keeps the part
//! t = c/(c + dt max(v, v0)) of its coefficient m before the step. With f(v) = mu_s(v)/mu
//!
//! ```text
//! -dg/dv = p mu [(1 - t) (-f') + (-t') (1 - f)] + p (m - mu) (-t')
//! ```
//!
//! The two factors that depend on v, the bracket and -t', are not negative. Therefore one of the elements on the hull of the pairs
//! `(p mu, p (m - mu))` has the largest slope. In steady rolling m is at most the largest coefficient on the particle's way.

use super::element::{Law, Particle};
use super::march::March;
use crate::error::Result;
use crate::memory::zeros;

/// The number of slip velocities per octave at which slopes are computed.
const SLIPS_PER_OCTAVE: i32 = 8;
/// The number of octaves of slip velocities on either side of each half speed and of c/dt.
const OCTAVES: i32 = 20;

/// Sets `falls` and `rises` of the march: the largest slopes with which bounds fall and rise, each times the influence of its element on itself.
pub fn measure(march: &mut March, influence: impl Fn(usize) -> f64) -> Result<()> {
    let law = march.law;
    let softening = law.layer.map_or(0.0, |layer| (-layer.hardening).max(0.0));
    let (mut largest_influence, mut largest_at_rest, mut pairs) = (0.0f64, 0.0f64, Vec::new());
    if law.remembers() {
        pairs = zeros(march.grid.len(), "the slope of a law")?;
    }
    march.go(|k, place, before| {
        let largest = before.coefficient.max(place.coefficient);
        if place.pressure > 0.0 {
            let own_influence = influence(k);
            let [at_rest, beyond] = [place.coefficient, before.coefficient - place.coefficient]
                .map(|mu| place.pressure * mu * own_influence);
            (largest_influence, largest_at_rest) = (largest_influence.max(own_influence), largest_at_rest.max(at_rest));
            if let Some(pair) = pairs.get_mut(k) {
                *pair = [at_rest, beyond];
            }
        }
        Particle { coefficient: largest, ..before }
    });
    if pairs.is_empty() {
        pairs.push([largest_at_rest, 0.0]);
    }
    let hull = hull(pairs);
    let slope = |[by_bound, by_memory]: [f64; 2]| {
        hull.iter().map(|[at_rest, beyond]| by_bound * at_rest + by_memory * beyond).fold(0.0, f64::max)
    };
    march.falls = law.slopes().map(slope).fold(softening * largest_influence, f64::max);
    march.rises = rises(march, influence);
    Ok(())
}

/// The largest slope with which bounds rise: of particles whose coefficient is below that at rest, and of a layer that hardens.
fn rises(march: &mut March, influence: impl Fn(usize) -> f64) -> f64 {
    let law = march.law;
    let hardening = law.layer.map_or(0.0, |layer| layer.hardening.max(0.0));
    let [_, forgets] = law.slopes().fold([0.0f64; 2], |most, slope| [0, 1].map(|k| most[k].max(slope[k])));
    let mut steepest = 0.0f64;
    march.go(|k, place, before| {
        let lacks = place.pressure * (place.coefficient - before.coefficient);
        if place.pressure > 0.0 {
            steepest = steepest.max(influence(k) * hardening.max(forgets * lacks));
        }
        Particle { coefficient: before.coefficient.min(place.coefficient), ..before }
    });
    steepest
}

/// The points that are farthest in some direction whose components are >= 0: the corners of the upper right part of the convex hull.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    let mut count = 0;
    for k in 0..points.len() {
        let point = points[k];
        if count > 0 && point[1] <= points[count - 1][1] {
            continue;
        }
        // The last point is inside the hull of its neighbours if the path of points turns right there, or goes straight on.
        let turn = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
        while count > 1 && turn([points[count - 2], points[count - 1]]) <= 0.0 {
            count -= 1;
        }
        points[count] = point;
        count += 1;
    }
    points.truncate(count);
    points
}

impl Law {
    /// Whether the coefficient of a particle depends on its coefficient before the step.
    fn remembers(&self) -> bool {
        self.fall.is_some_and(|law| law.memory_distance > 0.0)
    }

    /// The factors of p mu and of p (m - mu) in the slope of the module, by the slip instead of v, at many slip velocities.
    fn slopes(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        // Slopes are computed just below these velocities, because a linear law has a kink at one of them.
        let below = 1.0 - 2.0 * f64::EPSILON;
        let place = move |h: f64, k: i32| below * h * (f64::from(k) / f64::from(SLIPS_PER_OCTAVE)).exp2();
        let places = move |h: f64| (-SLIPS_PER_OCTAVE * OCTAVES..=SLIPS_PER_OCTAVE * OCTAVES).map(move |k| place(h, k));
        self.fall.iter().flat_map(move |law| {
            let (c, dt) = (law.memory_distance, self.duration);
            let at = move |v: f64| {
                let (value, slope) = law.at(v);
                let whole = c + dt * v.max(law.memory_speed);
                let kept = if c > 0.0 { c / whole } else { 0.0 };
                // At memory_speed itself the slope is that of larger velocities.
                let forgets = if c > 0.0 && v >= law.memory_speed { c * dt / (whole * whole) } else { 0.0 };
                [((kept - 1.0) * slope + forgets * (1.0 - value)) * self.rate, forgets * self.rate]
            };
            let parts = law.falling.into_iter().zip(law.half_speed).filter(|(part, _)| *part > 0.0);
            let speeds = parts.map(|(_, h)| h).chain((c > 0.0).then_some(c / dt));
            speeds.flat_map(places).chain([0.0, law.memory_speed]).map(at)
        })
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/hull.rs"]
mod tests;
