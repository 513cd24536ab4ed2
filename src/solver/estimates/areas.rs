//! Errors of the contact area (a count of elements) along its outline, and of the corrected area.

use crate::contact::{Outline, Problem, State};

/// Error of the corrected area over the correction.
const CORRECTION_OFF: f64 = 0.3;
/// Error of the area for each element along straight pieces of the outline, in elements.
const STRAIGHT_OFF: f64 = 0.4;
/// Error of the area for each element along straight ends of the surface, in elements.
const EDGE_OFF: f64 = 0.5;

/// The error of the contact area along straight pieces of its outline and along ends of the surface, in elements.
pub fn outline_off(problem: &Problem, outline: &Outline) -> f64 {
    let stepped_edges = (outline.edges - outline.straight_edges) as f64;
    let straight = (outline.straight.0 + outline.straight.1) as f64;
    STRAIGHT_OFF * straight + edges_off(problem, outline) + stepped_edges.sqrt()
}

/// The error of the corrected area over the correction. On a layer that is much more compliant than an element, pressures fall linearly to 0 at the
/// rim. Counting elements then has no bias, and the whole correction is an error.
pub fn correction_off(problem: &Problem, state: &State) -> f64 {
    if !problem.coefficients.has_layer() {
        return CORRECTION_OFF;
    }
    let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
    let compliance = in_contact.map(|i| problem.layer(i)).fold(0.0, f64::max);
    let over_element = compliance * problem.modulus() / f64::min(state.grid.dx, state.grid.dy);
    CORRECTION_OFF + (1.0 - CORRECTION_OFF) * over_element / (1.0 + over_element)
}

/// The error of the contact area along straight ends of the surface, in elements: half an element for each of their elements if all ends are
/// straight, and less by the straight part of all ends otherwise. (A circular end has four short straight pieces; the pieces in steps compensate
/// their errors.)
fn edges_off(problem: &Problem, outline: &Outline) -> f64 {
    if problem.exact_edges || outline.edges == 0 {
        return 0.0;
    }
    let straight = outline.straight_edges as f64;
    EDGE_OFF * straight * straight / outline.edges as f64
}
