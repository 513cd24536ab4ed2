//! The effect of the position of a surface's end within the contact.
//!
//! An edge of the surface lies somewhere between two centres of elements. Pressures are singular at the edge:
//! `p ~ K/sqrt(2 pi s)` at the distance s from it. If the surface ends farther out by t, the approach of a given force
//! F falls by the energy released (Irwin 1957; Rice 1968):
//!
//! ```text
//! F d(approach) = -t integral along the edge of K^2/E*,    K^2 = (pi/2) d p^2
//! ```
//!
//! with the pressure p of the last element, d long across the edge. A layer of compliance c adds `t integral of c p^2`.
//! The force of a given approach changes by `F d(approach) S/F`, S = dF/d(approach): pressures grow with the approach
//! as `p S/F` for a flat punch, and for other surfaces nearly so. For the change of another quantity at the edge, such
//! as tractions, that quantity replaces one of the two factors p.
//!
//! Along a straight edge parallel to the elements t is at most about half an element. A part of this is the
//! discretisation error of the singularity. Along an edge with steps most of t cancels. At the border of the grid, and
//! if the caller's elements are the surface, the edge lies exactly on edges of elements. (Measured, in elements:
//! straight -0.46 to 0.2, in steps -0.15 to 0.05, on edges of elements -0.15.)
//!
//! *Jumps of the coefficients.* Pressures are singular, too, where two patches touch that displace each other less than
//! themselves, and beside an element whose layer is much softer. Such an edge lies on an edge of elements. It counts as
//! a part of an end. Between patches with the factor F this part is 1 - F. For a layer it is jump/(jump + c'), where c'
//! is [`BESIDE_JUMP`] times the compliance of an element and its layer. The larger part counts. A jump is the change of
//! the compliance beyond the changes beside it. So a slope has no jump.

use std::f64::consts::PI;

use crate::contact::{Problem, State, STRAIGHT};
use crate::direction::Direction;
use crate::sums::in_blocks;

/// t in elements: at a straight edge, at an edge with steps, and where the edge lies on edges of elements.
const STRAIGHT_EDGE: f64 = 0.55;
const STEPPED_EDGE: f64 = 0.12;
const EXACT_EDGE: f64 = 0.2;
/// c' of a jump, in compliances of an element and its layer. Measured with balls on two halves, of compliances from 0 | 0.01 to 0 | 10: estimates are
/// 2 to 5 times the error.
const BESIDE_JUMP: f64 = 4.0;
/// The least part of an end at which the largest pressure grows with each finer grid: of a layer, and between patches.
const SINGULAR_LAYER: f64 = 0.1;
const SINGULAR_PATCHES: f64 = 0.015;
/// Change of a sum over the parts of force and energy: 1 for a flat punch, and up to 1.22 for x^6.
const SUM_FACTOR: f64 = 1.3;

/// The neighbour of an element.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    /// The neighbour with this index has a surface.
    Surface(usize),
    /// The neighbour has no surface.
    Hole,
    /// The grid ends.
    Border,
}

/// A side of an element at which pressures end within the contact.
struct End {
    /// t in elements.
    elements: f64,
    /// Whether the end lies on an edge of elements.
    is_exact: bool,
    /// Whether the pressures are singular there.
    is_singular: bool,
    /// The compliance `pi d/(2 E*) + c`; at a jump without c, whose part `c p` is known.
    compliance: f64,
}

impl End {
    /// `t (pi d/(2 E*) + c) p` times the area of the element.
    fn released(&self, state: &State, i: usize) -> f64 {
        self.elements * self.compliance * state.p[i] * state.grid.element_area()
    }
}

/// Sum over the sides at which pressures end within the contact: `t (pi d/(2 E*) + c) p` times the area of an element, with the weights
/// `w(i)` of the elements, in x and in y. A direction of one element has no ends here.
pub fn at_ends(problem: &Problem, state: &State, weights: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    each_end(problem, state, |i, end| {
        let (released, weights) = (end.released(state, i), weights(i));
        (0..2).for_each(|k| sums[k] += released * weights[k]);
    });
    sums
}

/// The sum of [`at_ends`] with the pressures as weights, and the largest pressure at a singular end.
pub fn pressures_at_ends(problem: &Problem, state: &State) -> (f64, f64) {
    let (mut sum, mut highest) = (0.0, 0.0_f64);
    each_end(problem, state, |i, end| {
        sum += end.released(state, i) * state.p[i];
        if end.is_singular {
            highest = highest.max(state.p[i]);
        }
    });
    (sum, highest)
}

/// The relative change of a sum if the surface ends farther out by t: the energy released over the whole one, `(p, u)`, and where pressures are
/// at their limit their force on the strip over the whole one. Ends on edges of elements change nothing.
pub fn beyond_ends(problem: &Problem, state: &State) -> f64 {
    let (mut strips, mut released) = (0.0, 0.0);
    each_end(problem, state, |i, end| {
        let force = end.elements * state.p[i].abs();
        match (end.is_exact, state.contact[i]) {
            (true, _) => {}
            (false, true) => released += force * end.compliance * state.p[i].abs(),
            (false, false) => strips += force,
        }
    });
    if strips == 0.0 && released == 0.0 {
        return 0.0;
    }
    let over = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let there = || (0..state.p.len()).filter(|&i| state.touches(i));
    let force = in_blocks(there().map(|i| state.p[i].abs()));
    let energy = in_blocks(there().map(|i| state.p[i] * state.u[i]));
    SUM_FACTOR * (over(strips, force) + over(released, energy))
}

/// Calls `each(i, end)` for each side at which the surface ends or coefficients jump beside element i of the contact.
fn each_end(problem: &Problem, state: &State, mut each: impl FnMut(usize, End)) {
    let grid = &state.grid;
    let directions = Direction::both(grid, problem.coefficients.repeats(grid));
    let sizes = [grid.dx, grid.dy];
    let flexibility = PI / (2.0 * problem.modulus());
    for i in (0..grid.len()).filter(|&i| state.touches(i)) {
        let place = [i % grid.mx, i / grid.mx];
        for k in (0..2).filter(|&k| directions[k].m > 1) {
            let along = (directions[1 - k], place[1 - k]);
            for way in [-1, 1] {
                let side = Side { i, across: directions[k], place: place[k], way };
                if let Some(end) = side.end(problem, state, along, flexibility * sizes[k]) {
                    each(i, end);
                }
            }
        }
    }
}

/// A side of an element.
#[derive(Clone, Copy)]
struct Side {
    /// The element.
    i: usize,
    /// The direction across the side, and the element's place in its line.
    across: Direction,
    place: usize,
    /// 1: the side to the next element of the line, -1: to the one before.
    way: isize,
}

impl Side {
    /// The element `steps` steps beyond this side, or, if negative, away from it.
    fn beyond(&self, steps: isize) -> Option<usize> {
        let at = self.across.at(self.place as isize + self.way * steps);
        at.map(|at| self.i + at - self.place * self.across.step)
    }

    fn beside(&self, state: &State) -> Beside {
        match self.beyond(1) {
            None => Beside::Border,
            Some(j) if state.h[j].is_finite() => Beside::Surface(j),
            Some(_) => Beside::Hole,
        }
    }

    /// The end at this side. `compliance` is that of a side of the element, and `along` the line along the side, with the element's place.
    fn end(&self, problem: &Problem, state: &State, along: (Direction, usize), compliance: f64) -> Option<End> {
        let (elements, is_exact) = match self.beside(state) {
            Beside::Surface(j) => return self.jump(problem, state, j, compliance),
            Beside::Border => (EXACT_EDGE, true),
            Beside::Hole if problem.exact_edges => (EXACT_EDGE, true),
            Beside::Hole if self.is_straight(state, along) => (STRAIGHT_EDGE, false),
            Beside::Hole => (STEPPED_EDGE, false),
        };
        Some(End { elements, is_exact, is_singular: true, compliance: compliance + problem.layer(self.i) })
    }

    /// The jump of the coefficients to the neighbour j, if there is one.
    fn jump(&self, problem: &Problem, state: &State, j: usize, compliance: f64) -> Option<End> {
        if !problem.coefficients.may_jump() || !state.touches(j) {
            return None;
        }
        let of_patches = 1.0 - problem.coefficients.patches().map_or(1.0, |patches| patches.between(self.i, j));
        let softer = self.softer(problem, j);
        let of_layer = softer / (softer + BESIDE_JUMP * (compliance + problem.layer(self.i)));
        let is_singular = of_layer > SINGULAR_LAYER || of_patches > SINGULAR_PATCHES;
        let part = of_layer.max(of_patches);
        (part > 0.0).then_some(End { elements: EXACT_EDGE * part, is_exact: true, is_singular, compliance })
    }

    /// The jump of the layer's compliance from this element to the softer neighbour j, or 0.
    fn softer(&self, problem: &Problem, j: usize) -> f64 {
        let change = |from: Option<usize>, to: Option<usize>| match (from, to) {
            (Some(from), Some(to)) => problem.layer(to) - problem.layer(from),
            _ => 0.0,
        };
        // A change back belongs to a single line of elements, or to noise: half of it counts.
        let counted = |change: f64| if change < 0.0 { -0.5 * change } else { change };
        let (before, behind) = (change(self.beyond(-1), Some(self.i)), change(Some(j), self.beyond(2)));
        (change(Some(self.i), Some(j)) - counted(before).max(counted(behind))).max(0.0)
    }

    /// Whether this edge continues along a line, as a straight piece of the [outline](super::Outline) does.
    fn is_straight(&self, state: &State, (along, place): (Direction, usize)) -> bool {
        let same = |n: usize| {
            let i = self.i + n * along.step - place * along.step;
            state.touches(i) && Side { i, ..*self }.beside(state) == Beside::Hole
        };
        let before = (0..place).rev().take(STRAIGHT).take_while(|&n| same(n)).count();
        let behind = (place + 1..along.m).take(STRAIGHT).take_while(|&n| same(n)).count();
        before + 1 + behind >= STRAIGHT.min(along.m)
    }
}
