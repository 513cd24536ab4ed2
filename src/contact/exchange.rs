//! Steps 1, (4.1) and (4.2) of section 4.1: who enters the contact area and who leaves it.

use crate::grid::Grid;

use super::admissible::AdmissibleSet;
use super::state::lowest;
use super::State;

/// Step (4.1): elements of C that would pull go to the exterior area, with `p = 0`, and those above their limit to that. Returns how
/// many.
pub fn truncate<S: AdmissibleSet>(state: &mut State, set: S) -> usize {
    if S::FIXED {
        return 0;
    }
    let mut changed = 0;
    for i in 0..state.p.len() {
        if state.contact[i] && set.leaves(i, state.p[i]) {
            if S::LIMITED && state.p[i] > 0.0 {
                (state.at_limit[i], state.reached_limit) = (true, true);
            }
            state.p[i] = set.project(i, state.p[i]);
            state.contact[i] = false;
            changed += 1;
        }
    }
    changed
}

/// Step (4.2): exterior elements with `e < 0`, and elements at their limit with `e > 0`, go to the contact area. Returns how many.
/// Needs u = A p of the truncated p.
pub fn admit<S: AdmissibleSet>(state: &mut State, set: S) -> usize {
    if S::FIXED {
        return 0;
    }
    let mut changed = 0;
    for i in 0..state.p.len() {
        let at_limit = S::LIMITED && state.at_limit[i];
        if !state.contact[i] && set.enters(at_limit, state.deformed_distance(i)) {
            state.contact[i] = true;
            if at_limit {
                state.at_limit[i] = false;
            }
            changed += 1;
        }
    }
    changed
}

/// The approach whose starting contact area would carry about this force: area S and mean penetration d of
/// `{h <= approach}` carry as much as a flat punch of that area, `F = 2 E* sqrt(S/pi) d` (Johnson, eq. 3.36). Grows with
/// the approach, so bisection finds it; it is a start, not a result.
pub fn estimate_approach(grid: &Grid, h: &[f64], force: f64, self_influence: f64) -> f64 {
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
    // One element alone carries `force` at the second of these, so the answer lies below it.
    let alone = force / (2.0 * modulus * (grid.element_area() / std::f64::consts::PI).sqrt());
    let (mut low, mut high) = (lowest, lowest + alone.min(2.0 * (highest - lowest) + alone));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(middle) < force {
            low = middle;
        } else {
            high = middle;
        }
        if high - low <= 1e-3 * (high - lowest) {
            break;
        }
    }
    high
}
