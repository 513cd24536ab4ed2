//! Kinks of the surface at the largest pressure. Pressures are infinite there, as a logarithm.

use std::f64::consts::{LN_2, PI};

use crate::contact::{Problem, State};
use crate::direction::Direction;

/// The surface has a kink where the second differences of two elements side by side exceed those beside them by this factor.
const KINK_RATIO: f64 = 4.0;

/// The growth of the pressure of an element with each halving of the elements, by a kink of the surface; 0 without one.
///
/// Where the slope of the undeformed distance jumps by s, pressures are `E* s/(2 pi) ln(1/distance)` (a wedge: Johnson 1985, section 5.2).
pub fn growth(problem: &Problem, state: &State, at: usize) -> f64 {
    let grid = &state.grid;
    // A layer that is softer than an element spreads the kink.
    if problem.layer(at) * problem.modulus() > grid.dx.min(grid.dy) {
        return 0.0;
    }
    let places = [at % grid.mx, at / grid.mx];
    let lines =
        Direction::both(grid, problem.coefficients.repeats(grid)).into_iter().zip(places).zip([grid.dx, grid.dy]);
    let slopes = lines.map(|((along, place), d)| jump(state, along, (at, place)) / d);
    problem.modulus() * slopes.fold(0.0, f64::max) * LN_2 / (2.0 * PI)
}

/// The jump of the steps of h from element to element, at the element `at`, which is number `place` of its line; 0 without a kink.
fn jump(state: &State, along: Direction, (at, place): (usize, usize)) -> f64 {
    let first = at - place * along.step;
    let h = |place: isize| along.at(place).map_or(f64::NAN, |next| state.h[first + next]);
    let bend = |place: isize| h(place - 1) - 2.0 * h(place) + h(place + 1);
    let place = place as isize;
    // The kink is between this element and one beside it. Beside a hole or the border of the grid these are NaN.
    let jumps = [place - 1, place].map(|one| {
        let (jump, beside) = (bend(one) + bend(one + 1), [bend(one - 1), bend(one + 2)]);
        let is_kink = beside.iter().all(|bend| jump > KINK_RATIO * bend.abs());
        if is_kink {
            jump
        } else {
            0.0
        }
    });
    jumps[0].max(jumps[1])
}
