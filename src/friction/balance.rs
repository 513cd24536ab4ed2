//! The balanced creepages: those at which the tractions that the natural map predicts carry the given forces.
//!
//! ```text
//! sum of P(q - rho (s + dc)) = F/(dx dy)        P: the projection onto the discs; dc: the change of the creepages
//! ```
//!
//! The sum falls as dc grows, and its slope is known. Newton's method finds dc within a [`Corral`]. As long as the forces are less than mu N, not all
//! elements are then predicted to slip in one direction, and the border of the linear systems is not singular.

use super::corral::{Corral, PROGRESS};
use super::forces::{sum_of_bounds, Forces};
use super::plane::{add, onto_disc, plus, square, Vector};
use super::problem::{Problem, State};
use super::system::inverse;
use crate::methods::fields;

/// The forces are met if their missing part is at most this times the sum of all bounds.
const FORCES_MET: f64 = 1e-13;
/// The largest number of trials, enough to halve the largest creepage until it is round-off.
const MOST_TRIALS: usize = 200;

/// The sum of the tractions of the natural map, and its derivative by `-rho dc`, a symmetric 2 x 2 matrix.
fn response(problem: &Problem, state: &State, rho: f64, dc: Vector) -> (Vector, [Vector; 2]) {
    let [x, y, xx, xy, yy] = fields::sum(problem.threads(), problem.bound.len(), |i| {
        let g = problem.bound[i];
        if !(g > 0.0) {
            return [0.0; 5];
        }
        let weight = problem.weighted(i, [1.0; 2]);
        let tau = plus(state.q[i], -rho, add(problem.slip_at(i, &state.u), problem.weighted(i, dc)));
        let length = square(tau).sqrt();
        let weighted = |[x, y]: Vector, [xx, xy, yy]: [f64; 3]| {
            let [a, b] = weight;
            [a * x, b * y, a * a * xx, a * b * xy, b * b * yy]
        };
        if !(length > g) {
            return weighted(tau, [1.0, 0.0, 1.0]);
        }
        // On slip the projected traction moves along the circle.
        let (n, share) = (tau.map(|tau| tau / length), g / length);
        let slope = [share * n[1] * n[1], -share * n[0] * n[1], share * n[0] * n[0]];
        weighted(onto_disc(tau, g), slope)
    });
    ([x, y], [[xx, xy], [xy, yy]])
}

/// Computes the balanced creepages, times the length of the step: a new `offset` of the problem.
pub fn balanced(problem: &Problem, state: &State, rho: f64, forces: Forces) -> Vector {
    let bounds = sum_of_bounds(problem);
    let part = square(forces.only_given(forces.sum)).sqrt() / bounds;
    // The corral is so large that beyond it all elements slip against dc, and carry more than F.
    let furthest = fields::largest(problem.threads(), problem.bound.len(), |i| {
        let reach = if problem.bound[i] > 0.0 { square(problem.slip_at(i, &state.u)).sqrt() } else { 0.0 };
        reach + (square(state.q[i]).sqrt() + problem.bound[i]) / rho
    });
    let furthest = furthest * problem.farthest_creepage();
    let mut corral = Corral::new(4.0 * furthest / (1.0 - part).max(f64::EPSILON), forces.given);
    let (mut dc, mut last) = ([0.0; 2], f64::INFINITY);
    let (mut least, mut best_dc) = (f64::INFINITY, [0.0; 2]);
    for _ in 0..MOST_TRIALS {
        let (sum, slope) = response(problem, state, rho, dc);
        let excess = forces.less(|| sum).map(|missing| -missing);
        let missing = square(excess).sqrt() / bounds;
        if missing < least {
            (least, best_dc) = (missing, dc);
        }
        if !(missing > FORCES_MET) {
            break;
        }
        corral.cut(dc, excess);
        let step = inverse(only_given(slope, forces)).map(|row| (row[0] * excess[0] + row[1] * excess[1]) / rho);
        let newton = plus(dc, 1.0, forces.only_given(step));
        let is_step = newton != dc && missing <= PROGRESS * last && corral.holds(newton);
        let next = if is_step { newton } else { corral.centre() };
        last = missing;
        if next == dc {
            break;
        }
        dc = next;
    }
    add(problem.offset, best_dc)
}

/// The matrix with the rows and columns of directions without a given force set to 0.
fn only_given([xx, yy]: [Vector; 2], forces: Forces) -> [Vector; 2] {
    let keep = |row: Vector, k: usize| if forces.given[k] { forces.only_given(row) } else { [0.0; 2] };
    [keep(xx, 0), keep(yy, 1)]
}
