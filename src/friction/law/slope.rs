//! The largest slope with which bounds fall with the slip, for any state of the particle: `law_slope` of a report.
//!
//! For an element of pressure p, with mu at rest, memory c and the part t = c/(c + dt max(v, v0)) that a particle keeps of its coefficient m:
//!
//! ```text
//! -dg/dv = p mu [(1 - t) (-f') + (-t') (1 - f)] + p (m - mu) (-t')        f: mu_s(v)/mu
//! ```
//!
//! Both factors in v are not negative, so an element on the hull of the pairs `(p mu, p (m - mu))` has the largest slope. In steady rolling m is at
//! most the largest coefficient on the particle's way.

use super::element::{Law, Particle};
use super::march::March;
use crate::error::Result;
use crate::memory::zeros;

/// Slip velocities per octave, and octaves on either side of each half speed and of the speed of the memory.
const SLIPS_PER_OCTAVE: i32 = 8;
const OCTAVES: i32 = 20;

/// Sets the largest slopes with which bounds fall and rise, each times the influence of its element on itself.
pub fn measure(march: &mut March, influence: impl Fn(usize) -> f64) -> Result<()> {
    let law = march.law;
    let softening = law.layer.map_or(0.0, |layer| (-layer.hardening).max(0.0));
    let (mut softest, mut stiffest, mut pairs) = (0.0f64, 0.0f64, Vec::new());
    if law.remembers() {
        pairs = zeros(march.grid.len(), "the slope of a law")?;
    }
    march.go(|k, place, had| {
        let most = had.coefficient.max(place.coefficient);
        if place.pressure > 0.0 {
            let by = influence(k);
            let [at_rest, beyond] =
                [place.coefficient, had.coefficient - place.coefficient].map(|mu| place.pressure * mu * by);
            (softest, stiffest) = (softest.max(by), stiffest.max(at_rest));
            if let Some(pair) = pairs.get_mut(k) {
                *pair = [at_rest, beyond];
            }
        }
        Particle { coefficient: most, ..had }
    });
    if pairs.is_empty() {
        pairs.push([stiffest, 0.0]);
    }
    let hull = hull(pairs);
    let slope = |[by_bound, by_memory]: [f64; 2]| {
        hull.iter().map(|[at_rest, beyond]| by_bound * at_rest + by_memory * beyond).fold(0.0, f64::max)
    };
    march.falls = law.slopes().map(slope).fold(softening * softest, f64::max);
    march.rises = rises(march, influence);
    Ok(())
}

/// The largest upward slope: of particles below the coefficient at rest, and of a hardening layer.
fn rises(march: &mut March, influence: impl Fn(usize) -> f64) -> f64 {
    let law = march.law;
    let hardening = law.layer.map_or(0.0, |layer| layer.hardening.max(0.0));
    let [_, forgets] = law.slopes().fold([0.0f64; 2], |most, slope| [0, 1].map(|k| most[k].max(slope[k])));
    let mut steepest = 0.0f64;
    march.go(|k, place, had| {
        let lacks = place.pressure * (place.coefficient - had.coefficient);
        if place.pressure > 0.0 {
            steepest = steepest.max(influence(k) * hardening.max(forgets * lacks));
        }
        Particle { coefficient: had.coefficient.min(place.coefficient), ..had }
    });
    steepest
}

/// The points that are farthest in some direction with components >= 0.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    let mut count = 0;
    for k in 0..points.len() {
        let point = points[k];
        if count > 0 && point[1] <= points[count - 1][1] {
            continue;
        }
        // The last point lies inside if the path turns inwards there.
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
    /// Whether the law has a memory.
    fn remembers(&self) -> bool {
        self.fall.is_some_and(|law| law.memory_distance > 0.0)
    }

    /// The factors of the slope at slip velocities: of the bound at rest, and of the particle's coefficient beyond.
    fn slopes(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        // Just below the velocities, one of which is the kink of a linear law.
        let below = 1.0 - 2.0 * f64::EPSILON;
        let place = move |h: f64, k: i32| below * h * (f64::from(k) / f64::from(SLIPS_PER_OCTAVE)).exp2();
        let places = move |h: f64| (-SLIPS_PER_OCTAVE * OCTAVES..=SLIPS_PER_OCTAVE * OCTAVES).map(move |k| place(h, k));
        self.fall.iter().flat_map(move |law| {
            let (c, dt) = (law.memory_distance, self.duration);
            let at = move |v: f64| {
                let (value, slope) = law.at(v);
                let whole = c + dt * v.max(law.memory_speed);
                let kept = if c > 0.0 { c / whole } else { 0.0 };
                // From memory_speed on, inclusive.
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
