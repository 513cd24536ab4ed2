//! A start for surfaces with a pressure limit: the bearing area.
//!
//! If elastic displacements are small compared with the differences in h between elements, the contact area of such a surface follows from h alone
//! (Abbott & Firestone 1933): the elements with the smallest h are at their limit. With a given force these are as many as the force needs; with a
//! given approach, all elements with h below the approach.

use super::{AdmissibleSet, Freshness, State};
use crate::scene::Load;
use crate::threads::Threads;

/// The start is used if at most this share of elements is undecided: their state (in contact, at the limit, exterior) depends on displacements. The
/// share is relative to the elements at their limit. If there are more, a start from coarser grids is better.
pub const UNDECIDED_SHARE: f64 = 0.1;
/// Accuracy of the depth, relative to the largest displacement.
const DEPTH_ACCURACY: f64 = 0.25;
/// The largest number of halvings of the bracket of the depth: as many as a double has bits.
const HALVINGS: u32 = 64;

/// The elements with h up to a depth, and their pressure limits.
struct Below {
    /// The number of these elements.
    count: usize,
    /// The sum of their limits.
    limits: f64,
    /// The largest of their limits.
    largest: f64,
}

impl State {
    /// Sets the state to the bearing area if at most the share `undecided_share` of elements depends on displacements. Returns a bound on the
    /// displacements, or None (the state is unchanged) if more elements are undecided or the scene has no limits.
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

    /// Brackets the depth up to which elements at their limits carry the sum `pressures` of all p. The bracket is as narrow as the displacements make
    /// sense of ([`DEPTH_ACCURACY`]).
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

    /// Counts the elements with h up to `depth`.
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

    /// A bound on the displacements by elements at their limits: the displacement `2 p a / E*` at the centre of a circle of the same area, with the
    /// radius a, under the largest of the limits as a uniform pressure (Johnson, Contact Mechanics, section 3.4).
    fn deepest(&self, below: &Below, self_influence: f64) -> f64 {
        let area = below.count as f64 * self.grid.element_area();
        2.0 * below.largest * (area / std::f64::consts::PI).sqrt() / self.grid.modulus(self_influence)
    }

    /// Puts elements with h up to `low` at their limit; the sum of their pressures is `carried`. Elements with h from `low` to `high` carry the rest
    /// of a given force, in their order on the grid: each is at its limit, until the last one takes what is left.
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
