//! A start for surfaces with a limit of pressure: the bearing area.
//!
//! If displacements are small compared with the differences in distance of elements, the contact area of such a surface follows from its heights
//! (Abbott & Firestone 1933): the lowest elements are at their limit, as many as the force needs, or all below the approach.

use super::{AdmissibleSet, Freshness, State};
use crate::scene::Load;
use crate::threads::Threads;

/// Most elements whose state depends on displacements, relative to those at their limit. With more, a start from coarser grids is better.
pub const UNDECIDED_SHARE: f64 = 0.1;
/// Accuracy of the depth, relative to the largest displacement.
const DEPTH_ACCURACY: f64 = 0.25;
/// Most halvings of a bracket of the depth: the bits of a double.
const HALVINGS: u32 = 64;

/// The elements below a depth.
struct Below {
    count: usize,
    /// The sum of the limits, and the largest.
    limits: f64,
    largest: f64,
}

impl State {
    /// Starts on the bearing area, if at most this share of elements depend on displacements. Returns the bound on displacements there.
    pub fn start_on_bearing_area<S: AdmissibleSet>(
        &mut self,
        set: S,
        (self_influence, undecided_share): (f64, f64),
        threads: &Threads,
    ) -> Option<f64> {
        if !S::LIMITED {
            return None;
        }
        let (low, high) = match self.load {
            Load::Approach(approach) => (approach, approach),
            Load::Force(force) => self.depth_of_bearing(set, force / self.grid.element_area(), self_influence),
        };
        let held = self.below(set, low);
        let reach = self.deepest(&held, self_influence);
        let undecided = self.h.iter().filter(|&h| low - reach <= *h && *h <= high + reach).count();
        // The count is 0 if the approach is less than all distances.
        if held.count == 0 || !(undecided as f64 <= undecided_share * held.count as f64) {
            return None;
        }
        self.u.fill(0.0);
        self.press_below(set, (low, high), held.limits);
        (self.u_is, self.approach) = (Freshness::Stale, high);
        self.carry_force(set, threads);
        Some(reach)
    }

    /// Two depths around the one that carries `pressures` at the limits, as close as displacements allow.
    fn depth_of_bearing<S: AdmissibleSet>(&self, set: S, pressures: f64, self_influence: f64) -> (f64, f64) {
        let finite = || self.h.iter().copied().filter(|h| h.is_finite());
        let (mut low, mut high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), h| (a.min(h), b.max(h)));
        for _ in 0..HALVINGS {
            let middle = low + 0.5 * (high - low);
            let below = self.below(set, middle);
            if high - low <= DEPTH_ACCURACY * self.deepest(&below, self_influence) {
                break;
            }
            if below.limits < pressures {
                low = middle;
            } else {
                high = middle;
            }
        }
        (low, high)
    }

    fn below<S: AdmissibleSet>(&self, set: S, depth: f64) -> Below {
        let mut below = Below { count: 0, limits: 0.0, largest: 0.0 };
        for (i, _) in self.h.iter().enumerate().filter(|(_, h)| **h <= depth) {
            let limit = set.limit(i);
            below.count += 1;
            below.limits += limit;
            below.largest = below.largest.max(limit);
        }
        below
    }

    /// A bound on the displacement by pressures up to the largest on this area: that of uniform pressure on a circle, `2 p a / E*` at its centre
    /// (Johnson, eq. 3.22).
    fn deepest(&self, below: &Below, self_influence: f64) -> f64 {
        let area = below.count as f64 * self.grid.element_area();
        2.0 * below.largest * (area / std::f64::consts::PI).sqrt() / self.grid.modulus(self_influence)
    }

    /// Puts elements up to the first depth at their limit; those up to the second carry the rest, one after the other.
    fn press_below<S: AdmissibleSet>(&mut self, set: S, (low, high): (f64, f64), carried: f64) {
        let mut left = match self.load {
            Load::Approach(_) => 0.0,
            Load::Force(force) => (force / self.grid.element_area() - carried).max(0.0),
        };
        self.reached_limit = true;
        for i in 0..self.h.len() {
            let limit = set.limit(i);
            self.at_limit[i] = self.h[i] <= low || self.h[i] <= high && left >= limit;
            self.contact[i] = !self.at_limit[i] && self.h[i] <= high && left > 0.0;
            self.p[i] = match (self.at_limit[i], self.contact[i]) {
                (true, _) => limit,
                (_, true) => left,
                _ => 0.0,
            };
            if self.h[i] > low {
                left -= self.p[i];
            }
        }
    }
}
