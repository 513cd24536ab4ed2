//! Step 1 of section 4.1: the starting contact area.

use super::values::lowest;
use super::State;
use crate::bisection::bisect;
use crate::grid::Grid;
use crate::scene::Load;

impl State {
    /// Step 1: sets the starting contact area to the elements with `h <= approach`. If the force is prescribed, the approach is estimated first.
    pub fn start(&mut self, self_influence: f64) {
        if let Load::Force(force) = self.load {
            self.approach = estimate_approach(&self.grid, &self.h, force, self_influence);
        }
        self.contact.iter_mut().zip(&self.h).for_each(|(inside, h)| *inside = *h <= self.approach);
    }
}

/// Estimates the approach at which the bodies carry `force`. The elements with `h <= approach` have the area S and the mean penetration d. They are
/// taken to carry as much as a circular flat punch of the area S, `F = 2 E* sqrt(S/pi) d` (Johnson, Contact Mechanics, eq. 3.36). This force grows
/// with the approach, so bisection finds the approach. The estimate is a starting value only.
fn estimate_approach(grid: &Grid, h: &[f64], force: f64, self_influence: f64) -> f64 {
    let lowest = lowest(h);
    let highest = h.iter().copied().filter(|h| h.is_finite()).fold(lowest, f64::max);
    let modulus = grid.modulus(self_influence);
    let carried = |approach: f64| {
        let (mut count, mut sum) = (0.0, 0.0);
        for h in h.iter().filter(|h| **h <= approach) {
            count += 1.0;
            sum += approach - h;
        }
        let area = count * grid.element_area();
        2.0 * modulus * (area / std::f64::consts::PI).sqrt() * sum / f64::max(count, 1.0)
    };
    // At the upper end of the bracket the lowest element alone carries `force`, so the estimate lies below that end.
    let alone = force / (2.0 * modulus * (grid.element_area() / std::f64::consts::PI).sqrt());
    let ends = (lowest, lowest + alone.min(2.0 * (highest - lowest) + alone));
    let is_enough = |low: f64, high: f64| high - low <= 1e-3 * (high - lowest);
    bisect(ends, is_enough, |approach| carried(approach) < force).1
}
