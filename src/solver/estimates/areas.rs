//! Errors of the contact area (a count of elements) along its outline, and of the corrected area.

use crate::contact::{Outline, Problem, State};
use crate::grid::Grid;
use crate::influence::{HalfSpace, Kernel};

/// Error of the corrected area over the correction.
const CORRECTION_OFF: f64 = 0.3;
/// Error of the area for each element along straight pieces of the outline, in elements.
const STRAIGHT_OFF: f64 = 0.4;
/// Error of the area for each element along straight ends of the surface, in elements.
const EDGE_OFF: f64 = 0.5;

/// An excess of a coefficient below this part is not counted: the periodic images of a half-space, and round-off.
const NEGLIGIBLE: f64 = 0.02;
/// The least number of elements of a period. In shorter ones the images change the coefficients of neighbours.
const LEAST_PERIOD: usize = 16;

/// The error of the contact area along straight pieces of its outline and along ends of the surface, in elements.
pub fn outline_off(problem: &Problem, outline: &Outline) -> f64 {
    let stepped_edges = (outline.edges - outline.straight_edges) as f64;
    let straight = (outline.straight.0 + outline.straight.1) as f64;
    STRAIGHT_OFF * straight + edges_off(problem, outline) + stepped_edges.sqrt()
}

/// The error of the corrected area over the correction. Where an element is much more compliant under its own pressure than one of a half-space, as on a layer
/// or a thin coating, pressures fall linearly to 0 at the rim. Counting elements then has no bias, and the whole correction is an error.
pub fn correction_off(problem: &Problem, state: &State) -> f64 {
    let in_contact = (0..state.p.len()).filter(|&i| state.contact[i]);
    let layer = in_contact.map(|i| problem.layer(i)).fold(0.0, f64::max);
    let (compliance, modulus) = beyond_half_space(problem);
    let over_element = (layer + compliance) * modulus / f64::min(state.grid.dx, state.grid.dy);
    if over_element.is_finite() {
        CORRECTION_OFF + (1.0 - CORRECTION_OFF) * over_element / (1.0 + over_element)
    } else {
        1.0
    }
}

/// The compliance by which an element's coefficient on itself exceeds that of the half-space with the same coefficients at neighbours, and E* of this half-space.
/// E* is infinite if the coefficients do not fall with the distance. Differences of coefficients do not contain a constant part.
fn beyond_half_space(problem: &Problem) -> (f64, f64) {
    let Grid { mx, my, dx, dy, .. } = problem.grid;
    let (kernel, plain) = (problem.coefficients.kernel(), (0.0, problem.modulus()));
    let is_periodic = kernel.repeats(&problem.grid);
    let (serves_x, serves_y) =
        (mx >= if is_periodic.0 { LEAST_PERIOD } else { 3 }, my >= if is_periodic.1 { LEAST_PERIOD } else { 3 });
    if !serves_x && !serves_y {
        return plain;
    }
    let along_x = serves_x && (!serves_y || dx < dy || dx == dy && mx >= my);
    let differences = |kernel: &dyn Kernel| {
        let [itself, next, second] = [0, 1, 2].map(|k| if along_x { kernel.at(k, 0) } else { kernel.at(0, k) });
        [itself - next, next - second]
    };
    let unit = HalfSpace::new(dx, dy, 1.0);
    let [first, second] = differences(kernel);
    let [unit_first, unit_second] = differences(&unit);
    let compliance = second / unit_second;
    let excess = first - compliance * unit_first;
    if !(compliance > 0.0) {
        (0.0, f64::INFINITY)
    } else if excess > NEGLIGIBLE * first {
        (excess, problem.grid.modulus(compliance * unit.at(0, 0)))
    } else {
        plain
    }
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
