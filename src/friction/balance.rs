//! The creepages at which the natural map itself carries the given forces.
//!
//! ```text
//! sum of P(q - rho (s + dc)) = F/(dx dy)        P: onto the discs
//! ```
//!
//! The sum falls as dc grows, and its slope is known: Newton's method finds dc within a [`Corral`]. The predicted tractions then carry the
//! forces. As long as these are less than mu N, not all elements slip one way, and the border of the linear systems is not singular.

use super::corral::{Corral, PROGRESS};
use super::forces::{sum_of_bounds, Forces};
use super::plane::{add, onto_disc, plus, square, Vector};
use super::problem::{Problem, State};
use super::system::inverse;
use crate::methods::fields;

/// Missing force, relative to the sum of all bounds, at which forces are met.
const FORCES_MET: f64 = 1e-13;
/// Most trials: halvings from the largest creepage to round-off.
const MOST_TRIALS: usize = 200;

/// The sum of the natural map's tractions, and its derivative by `-rho dc`: xx, xy, yy.
fn response(problem: &Problem, state: &State, rho: f64, dc: Vector) -> (Vector, [Vector; 2]) {
    let [x, y, xx, xy, yy] = fields::sum(problem.threads(), problem.bound.len(), |i| {
        let g = problem.bound[i];
        if !(g > 0.0) {
            return [0.0; 5];
        }
        let weight = problem.weighted(i, [1.0; 2]);
        let tau = plus(state.q[i], -rho, add(problem.slip_at(i, &state.u), problem.weighted(i, dc)));
        let length = square(tau).sqrt();
        let of = |[x, y]: Vector, [xx, xy, yy]: [f64; 3]| {
            let [a, b] = weight;
            [a * x, b * y, a * a * xx, a * b * xy, b * b * yy]
        };
        if !(length > g) {
            return of(tau, [1.0, 0.0, 1.0]);
        }
        let (n, share) = (tau.map(|tau| tau / length), g / length);
        let turned = [share * n[1] * n[1], -share * n[0] * n[1], share * n[0] * n[0]];
        of(onto_disc(tau, g), turned)
    });
    ([x, y], [[xx, xy], [xy, yy]])
}

/// The balanced creepages, to replace the problem's offset.
pub fn balanced(problem: &Problem, state: &State, rho: f64, forces: Forces) -> Vector {
    let bounds = sum_of_bounds(problem);
    let part = square(forces.only_given(forces.sum)).sqrt() / bounds;
    // With a larger dc all elements slip against it and carry more than F.
    let furthest = fields::largest(problem.threads(), problem.bound.len(), |i| {
        let reach = if problem.bound[i] > 0.0 { square(problem.slip_at(i, &state.u)).sqrt() } else { 0.0 };
        reach + (square(state.q[i]).sqrt() + problem.bound[i]) / rho
    });
    let furthest = furthest * problem.farthest_creepage();
    let mut corral = Corral::new(4.0 * furthest / (1.0 - part).max(f64::EPSILON), forces.given);
    let (mut dc, mut least, mut last) = ([0.0; 2], (f64::INFINITY, [0.0; 2]), f64::INFINITY);
    for _ in 0..MOST_TRIALS {
        let (sum, slope) = response(problem, state, rho, dc);
        let excess = forces.less(|| sum).map(|missing| -missing);
        let missing = square(excess).sqrt() / bounds;
        if missing < least.0 {
            least = (missing, dc);
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
    add(problem.offset, least.1)
}

/// The rows and columns of directions with given forces; 0 in the others.
fn only_given([xx, yy]: [Vector; 2], forces: Forces) -> [Vector; 2] {
    let keep = |row: Vector, k: usize| if forces.given[k] { forces.only_given(row) } else { [0.0; 2] };
    [keep(xx, 0), keep(yy, 1)]
}
