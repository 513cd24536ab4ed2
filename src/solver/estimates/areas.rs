//! The errors of contact areas along their outlines, and of the corrected area.

use crate::contact::{Outline, Problem, State};

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

/// The error of the corrected area over the correction. Below a layer that gives way more than an element pressures fall linearly at the rim, where counting has no
/// bias, and the whole correction is an error.
pub fn correction_off(problem: &Problem, state: &State) -> f64 {
    if !problem.coefficients.has_layer() {
        return CORRECTION_OFF;
    }
    let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
    let compliance = in_contact.map(|i| problem.layer(i)).fold(0.0, f64::max);
    let by_element = compliance * problem.modulus() / f64::min(state.grid.dx, state.grid.dy);
    CORRECTION_OFF + (1.0 - CORRECTION_OFF) * by_element / (1.0 + by_element)
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
