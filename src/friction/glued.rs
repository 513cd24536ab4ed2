//! Traction bounds far above all tractions: those of glued elements (a huge mu), or all bounds if forces and motions are small.
//!
//! The unit of tractions is the largest bound. Relative to a bound that is far too large, tractions and the other bounds would be round-off.
//! Therefore bounds are lowered before the solve, to an upper bound on the tractions.

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

/// Bounds below this part of the largest one are round-off, and would make linear systems singular. Elements with such bounds are solved with the
/// bound 0. Their tractions are then computed from their slips.
pub(super) const NEGLIGIBLE_BOUND: f64 = 1e-17;

/// Bounds are lowered to this times the estimate of the largest traction. The estimate is that each element alone compensates its slip.
const REACH: f64 = 1e3;

impl Solver {
    /// The largest value of a function on the elements of a box; at least 0.
    fn largest(&self, window: &Rectangle, of: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
        let rows = window.grid(&self.grid).my;
        let threads = self.threads.suited_to(self.grid.len());
        let of_row = |iy: usize| window.row(&self.grid, iy).map(&of).fold(0.0, f64::max);
        fields::largest(&threads, rows, of_row)
    }

    /// Solves in a box, with bounds lowered if they are far above the tractions. Returns the outcome, and whether bounds were lowered.
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

    /// The value to which larger bounds are lowered; none if bounds stay as they are. Bounds by a law of friction are not lowered.
    fn reached(&self, (largest, request): (f64, &Request<'_>), window: &Rectangle, forces: &Forces) -> Option<f64> {
        // With given creepages small slips are solved well with any bounds, if none of them is negligible beside the largest.
        let are_alike = || {
            let inverse_of_least = self.largest(window, |i| inverse(request.bound(i)));
            // 0.5, because the unit of tractions may exceed the largest bound by a factor of sqrt(2).
            !(inverse_of_least * (NEGLIGIBLE_BOUND * largest) > 0.5)
        };
        if request.friction.has_law() || !forces.any() && are_alike() {
            return None;
        }
        let reached = REACH * self.estimated_traction(request, window, forces);
        (reached > 0.0 && reached < largest).then_some(reached)
    }

    /// The largest force that friction carries: the sum of the original bounds times the area of an element.
    fn carried(&self, request: &Request<'_>, is_lowered: bool) -> f64 {
        let area = self.grid.element_area();
        if is_lowered {
            return area * in_blocks((0..self.grid.len()).map(|i| request.bound(i)));
        }
        let Problem { bound, operators, .. } = &self.levels[0].problem;
        let [sum] = fields::sum(&operators.threads, bound.len(), |k| [bound[k]]);
        self.scales.callers_traction([sum * area, 0.0])[0]
    }

    /// The gap of the [certificate](Certificate) with the original bounds, after a solve with lowered bounds.
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

    /// An estimate of the largest traction, in the caller's units, if all elements stick.
    fn estimated_traction(&self, request: &Request<'_>, window: &Rectangle, forces: &Forces) -> f64 {
        let (friction, grid, kept) = (request.friction, &self.grid, &self.before);
        let held = if let Start::Held(offset) = request.start { length(offset) } else { 0.0 };
        // In steady rolling the displacement of a particle compensates the rigid slips of all steps since it came into contact.
        let Rectangle { x, y } = window;
        let steps = match friction.motion {
            Motion::SteadyRolling => {
                1.0 + (x.len() as f64 * grid.dx + y.len() as f64 * grid.dy) / friction.distance(grid)
            }
            Motion::Shift | Motion::TransientRolling => 1.0,
        };
        let [xx, yy, _] = self.tangential.at(0.0, 0.0);
        let previous = match (friction.motion, friction.previous) {
            // Previous tractions are only a first guess in steady rolling.
            (Motion::SteadyRolling, _) | (_, Previous::None) => 0.0,
            (_, Previous::Given(_) | Previous::Kept) => self.largest(window, |i| length(before(friction, kept, i))),
        };
        // Forces are sums of weighted tractions: a small weight needs a large traction.
        let by_weight =
            friction.weights.map_or(1.0, |[x, y]| self.largest(window, |i| inverse(x[i]).max(inverse(y[i]))));
        steps * (held + self.largest_slip(request, window)) / xx.min(yy)
            + previous
            + length(forces.sum) * by_weight.max(1.0)
    }

    /// The largest rigid slip of the elements of a box. If it follows from creepages and spin alone, it is linear in x and y and thus largest at a
    /// corner.
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

/// The inverse of the absolute value of a bound or of a weight; 0 if the value is 0.
fn inverse(of: f64) -> f64 {
    if of == 0.0 {
        0.0
    } else {
        1.0 / of.abs()
    }
}
