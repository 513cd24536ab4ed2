//! How much it matters where exactly a surface ends within the contact.
//!
//! Elements know of an edge of the surface between which two centres it lies, and no more. Pressures are singular there,
//! `p ~ K/sqrt(2 pi s)` at the distance s, and if the surface ends farther out by t, then the approach of a given force F falls by the
//! energy that this sets free (Irwin 1957; Rice 1968):
//!
//! ```text
//! F d(approach) = -t integral along the edge of K^2/E*,    K^2 = (pi/2) d p^2
//! ```
//!
//! with the pressure p of the last element, d long across the edge. A layer of compliance c adds `t integral of c p^2`. The force of
//! a given approach changes by `F d(approach) S/F`, S = dF/d(approach): pressures grow with the approach as `p S/F` for a flat punch, and for
//! other surfaces nearly so. Whatever else is carried at the edge, tractions for instance, takes the place of one of the two factors p.
//!
//! t is half an element at most, where a straight edge lies as the elements do, and some of it is an error of the singularity
//! itself. Along edges in steps most of it goes out. The border of the grid is an edge of elements, as are all where the caller's elements are
//! the surface. (Measured, in elements: straight -0.46 to
//! 0.2, in steps -0.15 to 0.05, on edges of elements -0.15.)

use std::f64::consts::PI;

use super::curvature::neighbours;
use super::outline::STRAIGHT;
use super::{Problem, State};

/// t, in elements.
const AT_STRAIGHT: f64 = 0.5;
const AT_STEPS: f64 = 0.12;
const AT_EXACT: f64 = 0.2;

/// One of the two directions of a grid.
#[derive(Clone, Copy)]
struct Direction {
    /// Elements along it, and how far apart they are in memory.
    m: usize,
    step: usize,
    /// Of an element.
    size: f64,
    repeats: bool,
}

/// What is beside an element.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    Surface,
    /// None.
    Hole,
    /// The grid ends.
    Border,
}

/// Sum over the sides at which the surface ends within the contact: `t (pi d/(2 E*) + c) p` times the area of an element, with the
/// weights `w(i)` of the elements. A direction of one element has no ends here.
pub fn at_ends<const N: usize>(problem: &Problem, state: &State, weights: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let grid = &state.grid;
    let (x, y) = problem.coefficients.repeats(grid);
    let directions = [
        Direction { m: grid.mx, step: 1, size: grid.dx, repeats: x },
        Direction { m: grid.my, step: grid.mx, size: grid.dy, repeats: y },
    ];
    let flexibility = PI / (2.0 * problem.modulus());
    let mut sums = [0.0; N];
    for i in state.rows_with_contact().flatten().filter(|&i| state.contact[i]) {
        let place = [i % grid.mx, i / grid.mx];
        for k in (0..2).filter(|&k| directions[k].m > 1) {
            let (across, along) = (directions[k], directions[1 - k]);
            for side in [0, 1] {
                let elements = match across.beside(state, (i, place[k]), side) {
                    Beside::Surface => continue,
                    Beside::Border => AT_EXACT,
                    Beside::Hole if problem.exact_edges => AT_EXACT,
                    Beside::Hole if along.is_straight(state, (i, place[1 - k]), (across, place[k], side)) => {
                        AT_STRAIGHT
                    }
                    Beside::Hole => AT_STEPS,
                };
                let part = elements * (flexibility * across.size + problem.layer(i)) * state.p[i] * grid.element_area();
                let weights = weights(i);
                (0..N).for_each(|n| sums[n] += part * weights[n]);
            }
        }
    }
    sums
}

impl Direction {
    /// What is beside element `i`, the one at `place` in this direction: before it (side 0) or behind it.
    fn beside(&self, state: &State, (i, place): (usize, usize), side: usize) -> Beside {
        match neighbours(place, self.m, self.repeats)[side] {
            None => Beside::Border,
            Some(next) if state.h[i + next * self.step - place * self.step].is_finite() => Beside::Surface,
            Some(_) => Beside::Hole,
        }
    }

    /// Whether this edge goes on in this direction, as a straight piece of the [outline](super::Outline) does.
    fn is_straight(
        &self,
        state: &State,
        (i, place): (usize, usize),
        (across, place_across, side): (Direction, usize, usize),
    ) -> bool {
        let same = |n: usize| {
            let at = i + n * self.step - place * self.step;
            state.contact[at] && across.beside(state, (at, place_across), side) == Beside::Hole
        };
        let before = (0..place).rev().take(STRAIGHT).take_while(|&n| same(n)).count();
        let behind = (place + 1..self.m).take(STRAIGHT).take_while(|&n| same(n)).count();
        before + 1 + behind >= STRAIGHT.min(self.m)
    }
}
