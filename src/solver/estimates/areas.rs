//! The errors of contact areas along their outlines, and of the corrected area.

use crate::contact::{Outline, Problem, State};
use crate::grid::Grid;
use crate::influence::{HalfSpace, Kernel};

/// Error of the corrected area, over the correction, and in elements along straight outlines and edges.
const CORRECTION_OFF: f64 = 0.3;
const STRAIGHT_OFF: f64 = 0.4;
const EDGE_OFF: f64 = 0.5;

/// The error of the contact area along its outline, in elements.
pub fn outline_off(problem: &Problem, outline: &Outline) -> f64 {
    let curved = (outline.edges - outline.straight_edges) as f64;
    let straight = (outline.straight.0 + outline.straight.1) as f64;
    STRAIGHT_OFF * straight + edges_off(problem, outline) + curved.sqrt()
}

/// The error of the corrected area over the correction. Where an element gives way more under its own pressure than a half-space does, as with a layer or a thin
/// coating, pressures fall linearly at the rim. Counting has no bias there, and the whole correction is an error.
pub fn correction_off(problem: &Problem, state: &State) -> f64 {
    let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
    let layer = in_contact.map(|i| problem.layer(i)).fold(0.0, f64::max);
    let (compliance, modulus) = beyond_half_space(problem);
    let by_element = (layer + compliance) * modulus / f64::min(state.grid.dx, state.grid.dy);
    if by_element.is_finite() {
        CORRECTION_OFF + (1.0 - CORRECTION_OFF) * by_element / (1.0 + by_element)
    } else {
        1.0
    }
}

/// The compliance of an element beyond that of a half-space with the same coefficients at other elements, and E* of this half-space, which is infinite if these
/// coefficients do not fall. Differences of coefficients have no constant part.
fn beyond_half_space(problem: &Problem) -> (f64, f64) {
    let Grid { mx, my, dx, dy, .. } = problem.grid;
    if mx.max(my) <= 2 {
        return (0.0, problem.modulus());
    }
    let differences = |kernel: &dyn Kernel| {
        let [own, one, two] = [0, 1, 2].map(|k| if mx >= my { kernel.at(k, 0) } else { kernel.at(0, k) });
        [own - one, one - two]
    };
    let unit = HalfSpace::new(dx, dy, 1.0);
    let ([own, next], [unit_own, unit_next]) = (differences(problem.coefficients.kernel()), differences(&unit));
    let compliance = next / unit_next;
    if compliance > 0.0 {
        ((own - compliance * unit_own).max(0.0), problem.grid.modulus(compliance * unit.at(0, 0)))
    } else {
        (0.0, f64::INFINITY)
    }
}

/// The error of the contact area along straight ends of the surface, in elements: half of these if all ends are straight. A circle has four short
/// straight pieces, which the pieces in steps compensate.
fn edges_off(problem: &Problem, outline: &Outline) -> f64 {
    if problem.exact_edges || outline.edges == 0 {
        return 0.0;
    }
    let straight = outline.straight_edges as f64;
    EDGE_OFF * straight * straight / outline.edges as f64
}
