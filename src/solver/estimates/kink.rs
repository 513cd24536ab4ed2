//! Kinks of the surface (jumps of its slope) at the largest pressure. Without a layer the exact pressure is infinite there: it grows as a logarithm.

use std::f64::consts::{LN_2, PI};

use super::jumps::Line;
use crate::contact::{Problem, State};
use crate::direction::Direction;

/// A kink between two elements makes their second differences exceed those beside them: by more than this times the changes of those beside.
const KINK_RATIO: f64 = 4.0;
/// The excess is also more than this part of the mean of the second differences beside. Measured and refined profiles have ripples of a few per cent.
const KINK_SHARE: f64 = 0.5;

/// The number of doublings of the elements after which [`missed`] bounds the pressure.
const DOUBLINGS: f64 = 4.0;

/// A lower bound on how much the pressure of element `i` grows on finer grids because of a kink of the surface. 0 without a kink.
///
/// Where the slope of the undeformed distance jumps by s, pressures are `E* s/(2 pi) ln(1/distance)` (a wedge: Johnson 1985, section 5.2). On a layer
/// of compliance c that is softer than an element of size d, pressures are finite. But the kink lies anywhere in the element: the bound is `s d/(2
/// c)`.
pub fn missed(problem: &Problem, state: &State, i: usize) -> f64 {
    let (grid, layer) = (&state.grid, problem.layer(i));
    let is_soft = layer * problem.modulus() > grid.dx.min(grid.dy);
    let [x, y] = Direction::both(grid, problem.coefficients.repeats(grid));
    let (ix, iy) = (i % grid.mx, i / grid.mx);
    let row = (Line { number: iy, along: x, across: y }, ix, grid.dx);
    let column = (Line { number: ix, along: y, across: x }, iy, grid.dy);
    let each = [row, column].map(|(line, position, d)| {
        let jump = jump(state, line, position as isize);
        if is_soft {
            0.5 * jump / layer
        } else {
            DOUBLINGS * problem.modulus() * jump / d * LN_2 / (2.0 * PI)
        }
    });
    each[0].max(each[1])
}

/// The jump of the slope times the size of an element, at a position of a line; 0 without a kink.
fn jump(state: &State, line: Line, position: isize) -> f64 {
    // Second differences; NaN beside a hole or the border of the grid.
    let bend = |position: isize| line.second(position, &|i| state.h[i]);
    // The kink lies between this element and the one before or after it: between positions `one` and `one + 1`.
    let jumps = [position - 1, position].map(|one| {
        let (before, after) = (bend(one - 1), bend(one + 2));
        // The curvature that the surface has beside the kink is subtracted: twice the larger of both sides. NaN if either is NaN.
        let jump = bend(one) + bend(one + 1) - (before + after) - (before - after).abs();
        let changes = [before - bend(one - 2), after - bend(one + 3)];
        let least = KINK_SHARE * 0.5 * (before + after).abs();
        let is_alone = changes.iter().all(|change| jump > KINK_RATIO * change.abs());
        if is_alone && jump > least {
            jump
        } else {
            0.0
        }
    });
    jumps[0].max(jumps[1])
}
