//! Bounds that no traction reaches: those of glued elements, or all bounds if forces and motions are small. The unit of tractions is the largest
//! bound. Relative to such a bound tractions and other bounds would be round-off. So bounds are lowered to what tractions may reach.

use super::certificate::{scale, Certificate};
use super::forces::Forces;
use super::levels::Level;
use super::plane::{add, dot, length};
use super::problem::Problem;
use super::request::{before, Request, Start};
use super::solution::Report;
use super::solver::Solver;
use super::sweep::Rolling;
use crate::effects::{Motion, Previous};
use crate::error::Result;
use crate::grid::Grid;
use crate::methods::fields;
use crate::progress::Outcome;
use crate::rectangle::Rectangle;
use crate::sums::in_blocks;

/// Bounds below this fraction of the largest are round-off and make the system singular. Their elements are solved with the bound 0, and get their
/// traction from the slip.
pub(super) const NEGLIGIBLE_BOUND: f64 = 1e-17;

/// Upper bound on the largest traction relative to its estimate, by which each element alone makes up for its slip.
const REACH: f64 = 1e3;

impl Solver {
    /// The largest value on the elements of a window; at least 0.
    fn largest(&self, window: &Rectangle, of: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
        let rows = window.grid(&self.grid).my;
        let threads = self.threads.suited_to(self.grid.len());
        let of_row = |iy: usize| window.row(&self.grid, iy).map(&of).fold(0.0, f64::max);
        fields::largest(&threads, rows, of_row)
    }

    /// Solves in a window with bounds within reach. Returns the outcome, and whether bounds were lowered.
    pub(super) fn solve_within_reach(
        &mut self,
        (window, rolling): (&Rectangle, Option<Rolling>),
        request: &Request<'_>,
        forces: Forces,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<(Outcome, bool)> {
        let largest = self.largest(window, |i| request.bound(i));
        let largest_bound = self.reached((largest, request), window, &forces).unwrap_or(largest);
        self.scales.fit(largest_bound);
        let (lowered, forces) = (&Request { largest_bound, ..*request }, forces.in_units_of(&self.scales));
        let end = self.solve_in((window, rolling), lowered, forces, watch, report)?;
        let is_lowered = largest_bound < largest;
        report.carried = self.carried(request, is_lowered);
        Ok((end, is_lowered))
    }

    /// The largest bound to solve with, if bounds are to be lowered. Bounds by a law are not lowered.
    fn reached(&self, (largest, request): (f64, &Request<'_>), window: &Rectangle, forces: &Forces) -> Option<f64> {
        // By creepages alone, small slips are solved with any bounds of similar size.
        let are_alike = || {
            let inverses = self.largest(window, |i| inverse(request.bound(i)));
            // The unit of tractions may exceed the largest bound by a factor of sqrt(2).
            !(inverses * (NEGLIGIBLE_BOUND * largest) > 0.5)
        };
        if request.friction.has_law() || !forces.any() && are_alike() {
            return None;
        }
        let reached = REACH * self.estimated_traction(request, window, forces);
        (reached > 0.0 && reached < largest).then_some(reached)
    }

    /// The most that friction carries: the sum of the bounds times the area of an element.
    fn carried(&self, request: &Request<'_>, is_lowered: bool) -> f64 {
        let area = self.grid.element_area();
        if is_lowered {
            return area * in_blocks((0..self.grid.len()).map(|i| request.bound(i)));
        }
        let Problem { bound, operators, .. } = &self.levels[0].problem;
        let [sum] = fields::sum(&operators.threads, bound.len(), |k| [bound[k]]);
        self.scales.callers_traction([sum * area, 0.0])[0]
    }

    /// The gap of the [certificate](Certificate) of the result with the original bounds, after a solve with lowered ones.
    pub(super) fn gap_of_bounds(&self, request: &Request<'_>) -> f64 {
        let (friction, grid, solution) = (request.friction, &self.grid, &self.solution);
        let Level { problem, state, .. } = &self.levels[0];
        let [scale, _] = self.scales.callers_displacement([scale(problem, state), 0.0]);
        let found = friction.has_forces();
        let terms = |i: usize| {
            let (g, s, weight) = (request.bound(i), solution.slip[i], friction.weight_at(i));
            let by_creepages = [0, 1].map(|k| if found[k] { weight[k] * self.offset[k] } else { 0.0 });
            let rigid = add(request.rigid_slip(grid, i), by_creepages);
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
        let had = match (friction.motion, friction.previous) {
            // Tractions before steady rolling only begin the iteration.
            (Motion::SteadyRolling, _) | (_, Previous::None) => 0.0,
            (_, Previous::Given(_) | Previous::Kept) => self.largest(window, |i| length(before(friction, kept, i))),
        };
        // Forces are sums of weighted tractions.
        let most = friction.weights.map_or(1.0, |[x, y]| self.largest(window, |i| inverse(x[i]).max(inverse(y[i]))));
        steps * (held + self.largest_slip(request, window)) / xx.min(yy) + had + length(forces.sum) * most.max(1.0)
    }

    /// The largest rigid slip of the elements of a window. Without arrays it is linear in the place, and largest at a corner.
    fn largest_slip(&self, request: &Request<'_>, window: &Rectangle) -> f64 {
        let (friction, grid) = (request.friction, &self.grid);
        let slip = |i: usize| length(request.rigid_slip(grid, i));
        if request.sideways.is_some() || friction.rigid_slip.is_some() || friction.weights.is_some() {
            return self.largest(window, slip);
        }
        let Rectangle { x, y } = window;
        let corner = |ix: usize, iy: usize| slip(grid.index(ix, iy));
        let (right, top) = (x.end - 1, y.end - 1);
        corner(x.start, y.start).max(corner(right, y.start)).max(corner(x.start, top)).max(corner(right, top))
    }
}

/// The inverse of a bound or of a weight; 0 of one that carries nothing.
fn inverse(of: f64) -> f64 {
    if of == 0.0 {
        0.0
    } else {
        1.0 / of.abs()
    }
}
