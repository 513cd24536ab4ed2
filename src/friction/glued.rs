//! Bounds that no traction reaches, as of glued elements, or beside forces and motions that are small. The unit of tractions is the largest bound:
//! beside such a one tractions, and other bounds, would be round-off. So bounds are lowered to what tractions may reach.

use super::certificate::{scale, Certificate};
use super::forces::Forces;
use super::levels::Level;
use super::plane::{add, dot, length};
use super::problem::Problem;
use super::request::{before, Request, Start};
use super::solver::Solver;
use crate::effects::{Motion, Previous};
use crate::methods::fields;
use crate::rectangle::Rectangle;
use crate::sums::in_blocks;

/// Bounds below this fraction of the largest are round-off and make the system singular. Their elements are solved with the bound 0, and get their
/// traction from the slip.
pub(super) const NEGLIGIBLE_BOUND: f64 = 1e-17;

/// Upper bound on the largest traction over its estimate: an element that displaces itself alone by its slip.
const REACH: f64 = 1e3;

impl Solver {
    /// The largest value on the elements of a window; at least 0.
    fn largest(&self, window: &Rectangle, of: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
        let rows = window.grid(&self.grid).my;
        let threads = self.threads.suited_to(self.grid.len());
        let of_row = |iy: usize| window.row(&self.grid, iy).map(&of).fold(0.0, f64::max);
        fields::largest(&threads, rows, of_row)
    }

    /// The largest bound, and the largest one to solve with. Laws have bounds of their own, which are not lowered.
    pub(super) fn largest_bounds(&self, request: &Request<'_>, window: &Rectangle, forces: &Forces) -> (f64, f64) {
        let largest = self.largest(window, |i| request.bound(i));
        let inverse = self.largest(window, |i| if request.bound(i) > 0.0 { inverse(request.bound(i)) } else { 0.0 });
        // By creepages alone small slips are solved beside any bounds that are alike.
        if !(forces.any() || inverse * (NEGLIGIBLE_BOUND * largest) > 1.0) {
            return (largest, largest);
        }
        let reached = REACH * self.estimated_traction(request, window, forces);
        let is_lowered = !request.friction.has_law() && reached > 0.0 && reached < largest;
        (largest, if is_lowered { reached } else { largest })
    }

    /// The most that friction carries: the sum of the bounds times the area of an element.
    pub(super) fn carried(&self, request: &Request<'_>, is_lowered: bool) -> f64 {
        let area = self.grid.element_area();
        if is_lowered {
            return area * in_blocks((0..self.grid.len()).map(|i| request.bound(i)));
        }
        let Problem { bound, operators, .. } = &self.levels[0].problem;
        let [sum] = fields::sum(&operators.threads, bound.len(), |k| [bound[k]]);
        self.scales.own_traction([sum * area, 0.0])[0]
    }

    /// The gap of the [certificate](Certificate) of the result with the bounds themselves, where they were lowered.
    pub(super) fn gap_of_bounds(&self, request: &Request<'_>) -> f64 {
        let (friction, grid, solution) = (request.friction, &self.grid, &self.solution);
        let Level { problem, state, .. } = &self.levels[0];
        let [scale, _] = self.scales.own_displacement([scale(problem, state), 0.0]);
        let found = friction.has_forces();
        let terms = |i: usize| {
            let (g, s, weight) = (request.bound(i), solution.slip[i], friction.weight_at(i));
            let by_creepages = [0, 1].map(|k| if found[k] { weight[k] * self.offset[k] } else { 0.0 });
            let sideways = request.sideways.map_or([0.0; 2], |sideways| sideways[i]);
            let rigid = add(add(friction.rigid_slip_at(grid, i), sideways), by_creepages);
            [dot(s, solution.traction[i]) + g * length(s), g * length(rigid), g * scale]
        };
        let [gap, work, least] = fields::sum(&self.threads.suited_to(grid.len()), grid.len(), terms);
        Certificate::relative_gap(gap, work, least)
    }

    /// An estimate of the largest traction if all elements stick.
    fn estimated_traction(&self, request: &Request<'_>, window: &Rectangle, forces: &Forces) -> f64 {
        let (friction, grid, kept) = (request.friction, &self.grid, &self.before);
        let held = if let Start::Held(offset) = request.start { length(offset) } else { 0.0 };
        // In steady rolling an element displaces itself by the slip of all steps since it came into contact.
        let Rectangle { x, y } = window;
        let steps = match friction.motion {
            Motion::SteadyRolling => {
                1.0 + (x.len() as f64 * grid.dx + y.len() as f64 * grid.dy) / friction.distance(grid)
            }
            Motion::Shift | Motion::TransientRolling => 1.0,
        };
        let [xx, yy, _] = self.tangential.at(0.0, 0.0);
        let had = match friction.previous {
            Previous::None => 0.0,
            Previous::Given(_) | Previous::Kept => self.largest(window, |i| length(before(friction, kept, i))),
        };
        // Forces are sums of weighted tractions.
        let most = friction.weights.map_or(1.0, |[x, y]| self.largest(window, |i| inverse(x[i]).max(inverse(y[i]))));
        steps * (held + self.largest_slip(request, window)) / xx.min(yy) + had + length(forces.sum) * most.max(1.0)
    }

    /// The largest rigid slip of the elements of a window. Without arrays it is linear in the place.
    fn largest_slip(&self, request: &Request<'_>, window: &Rectangle) -> f64 {
        let (friction, grid) = (request.friction, &self.grid);
        let sideways = |i: usize| request.sideways.map_or([0.0; 2], |sideways| sideways[i]);
        let slip = |i: usize| length(add(friction.rigid_slip_at(grid, i), sideways(i)));
        if request.sideways.is_some() || friction.rigid_slip.is_some() || friction.weights.is_some() {
            return self.largest(window, slip);
        }
        let Rectangle { x, y } = window;
        let corner = |ix: usize, iy: usize| slip(grid.index(ix, iy));
        let (right, top) = (x.end - 1, y.end - 1);
        corner(x.start, y.start).max(corner(right, y.start)).max(corner(x.start, top)).max(corner(right, top))
    }
}

/// The inverse of a weight; 0 of a weight that carries nothing.
fn inverse(weight: f64) -> f64 {
    if weight == 0.0 {
        0.0
    } else {
        1.0 / weight.abs()
    }
}
