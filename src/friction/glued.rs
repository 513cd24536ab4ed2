//! Bounds of very different size, as those of glued elements beside others. The unit of tractions is the largest bound; beside it the least bounds
//! may be round-off. Elements that stick carry far less than a bound of such a size, so a bound beyond the reach of all tractions is lowered to it.

use super::forces::Forces;
use super::plane::{add, length};
use super::request::{before, Request, Start};
use super::solver::Solver;
use crate::effects::Motion;
use crate::methods::fields;
use crate::rectangle::Rectangle;

/// Bounds below this fraction of the largest are round-off and make the system singular. Their elements are solved with the bound 0, and get their
/// traction from the slip.
pub(super) const NEGLIGIBLE_BOUND: f64 = 1e-17;

/// Upper bound on the largest traction over its estimate: an element that displaces itself alone by its slip.
const REACH: f64 = 1e3;

impl Solver {
    /// The largest value on the elements of a window; at least 0.
    pub(super) fn largest(&self, window: &Rectangle, of: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
        let rows = window.grid(&self.grid).my;
        let threads = self.threads.suited_to(self.grid.len());
        let of_row = |iy: usize| window.row(&self.grid, iy).map(&of).fold(0.0, f64::max);
        fields::largest(&threads, rows, of_row)
    }

    /// The largest bound to solve with.
    pub(super) fn largest_bound(&self, request: &Request<'_>, window: &Rectangle, forces: &Forces) -> f64 {
        let largest = self.largest(window, |i| request.bound(i));
        let inverse = self.largest(window, |i| if request.bound(i) > 0.0 { 1.0 / request.bound(i) } else { 0.0 });
        let are_alike = !(inverse * (NEGLIGIBLE_BOUND * largest) > 1.0);
        if are_alike || request.friction.has_law() {
            return largest;
        }
        largest.min((REACH * self.estimated_traction(request, window, forces)).max(1.0 / inverse))
    }

    /// An estimate of the largest traction if all elements stick.
    fn estimated_traction(&self, request: &Request<'_>, window: &Rectangle, forces: &Forces) -> f64 {
        let (friction, grid, kept) = (request.friction, &self.grid, &self.before);
        let held = if let Start::Held(offset) = request.start { length(offset) } else { 0.0 };
        let sideways = |i: usize| request.sideways.map_or([0.0; 2], |sideways| sideways[i]);
        let slip = held + self.largest(window, |i| length(add(friction.rigid_slip_at(grid, i), sideways(i))));
        // In steady rolling an element displaces itself by the slip of all steps since it came into contact.
        let Rectangle { x, y } = window;
        let steps = match friction.motion {
            Motion::SteadyRolling => {
                1.0 + (x.len() as f64 * grid.dx + y.len() as f64 * grid.dy) / friction.distance(grid)
            }
            Motion::Shift | Motion::TransientRolling => 1.0,
        };
        let [xx, yy, _] = self.tangential.at(0.0, 0.0);
        let had = self.largest(window, |i| length(before(friction, kept, i)));
        steps * slip / xx.min(yy) + had + length(forces.sum)
    }
}
