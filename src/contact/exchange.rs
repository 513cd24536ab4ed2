//! Steps 1, 4.1 and 4.2 of section 4.1: who enters the contact area and who leaves it.

use crate::grid::Grid;

use super::State;

/// Step 1: `C^0 = {h <= approach}`. Returns the number of elements.
pub fn starting_contact(h: &[f64], approach: f64, contact: &mut [bool]) -> usize {
    contact.iter_mut().zip(h).for_each(|(inside, h)| *inside = *h <= approach);
    contact.iter().filter(|&&inside| inside).count()
}

/// Step 4.1: elements in contact with `p < 0` go to the exterior area, with `p = 0`. Returns how many.
pub fn truncate(state: &mut State) -> usize {
    let mut changed = 0;
    for (p, inside) in state.p.iter_mut().zip(&mut state.contact).filter(|(_, inside)| **inside) {
        if *p < 0.0 {
            *p = 0.0;
            *inside = false;
            changed += 1;
        }
    }
    changed
}

/// Step 4.2: exterior elements with `e <= 0`, and those at the pressure limit with `e > 0`, go to the contact area. Returns how many. Needs u = A p of the truncated p.
pub fn admit(state: &mut State) -> usize {
    let mut changed = 0;
    for i in 0..state.p.len() {
        if state.at_limit.get(i) == Some(&true) {
            if state.deformed_distance(i) > 0.0 {
                (state.contact[i], state.at_limit[i]) = (true, false);
                changed += 1;
            }
        } else if !state.contact[i] && state.deformed_distance(i) <= 0.0 {
            state.contact[i] = true;
            changed += 1;
        }
    }
    changed
}

/// The approach whose starting contact area would carry about this force: area S and mean penetration d of
/// `{h <= approach}` carry as much as a flat punch of that area, `F = 2 E* sqrt(S/pi) d` (Johnson, eq. 3.36). Grows with
/// the approach, so bisection finds it; it is a start, not a result.
pub fn estimate_approach(grid: &Grid, h: &[f64], force: f64, self_influence: f64) -> f64 {
    let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
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
