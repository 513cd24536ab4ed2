//! Kinks of the surface at the largest pressure. Without a layer pressures are infinite there, as a logarithm.

use std::f64::consts::{LN_2, PI};

use super::jumps::Line;
use crate::contact::{Problem, State};
use crate::direction::Direction;

/// The surface has a kink between two elements if their second differences exceed those beside them by more than KINK_RATIO times the changes of the
/// latter, and by more than KINK_SHARE times the mean of the latter. Measured and refined profiles have ripples of some hundredths.
const KINK_RATIO: f64 = 4.0;
const KINK_SHARE: f64 = 0.5;

/// The doublings of the elements in which a kink must add less than the error of the peak.
const DOUBLINGS: f64 = 4.0;

/// A lower bound on the additional pressure of an element on finer grids by a kink of the surface; 0 without a kink.
///
/// Where the slope of the undeformed distance jumps by s, pressures are `E* s/(2 pi) ln(1/distance)` (a wedge: Johnson 1985, section 5.2). On a layer
/// c that is softer than an element they are finite, but the kink lies anywhere in the element: `s d/(2 c)`.
pub fn missed(problem: &Problem, state: &State, at: usize) -> f64 {
    let (grid, layer) = (&state.grid, problem.layer(at));
    let is_soft = layer * problem.modulus() > grid.dx.min(grid.dy);
    let [x, y] = Direction::both(grid, problem.coefficients.repeats(grid));
    let (ix, iy) = (at % grid.mx, at / grid.mx);
    let row = (Line { number: iy, along: x, across: y }, ix, grid.dx);
    let column = (Line { number: ix, along: y, across: x }, iy, grid.dy);
    let each = [row, column].map(|(line, place, d)| {
        let jump = jump(state, line, place as isize);
        if is_soft {
            0.5 * jump / layer
        } else {
            DOUBLINGS * problem.modulus() * jump / d * LN_2 / (2.0 * PI)
        }
    });
    each[0].max(each[1])
}

/// The jump of the slope, as a change of the difference in h between neighbours, at element number `place` of a line; 0 without a kink.
fn jump(state: &State, line: Line, place: isize) -> f64 {
    // NaN beside a hole or the border of the grid.
    let bend = |place: isize| line.second(place, &|i| state.h[i]);
    // The kink is between this element and one beside it.
    let jumps = [place - 1, place].map(|one| {
        let (before, behind) = (bend(one - 1), bend(one + 2));
        // Beyond the curvature that the surface has beside it: twice the larger one, NaN if either is.
        let jump = bend(one) + bend(one + 1) - (before + behind) - (before - behind).abs();
        let changes = [before - bend(one - 2), behind - bend(one + 3)];
        let least = KINK_SHARE * 0.5 * (before + behind).abs();
        let is_alone = changes.iter().all(|change| jump > KINK_RATIO * change.abs());
        if is_alone && jump > least {
            jump
        } else {
            0.0
        }
    });
    jumps[0].max(jumps[1])
}
