//! Errors from ends of the surface within the contact, whose exact position the grid does not know.
//!
//! An edge of the surface lies somewhere between two centres of elements. Pressures are singular at the edge: `p ~ K/sqrt(2 pi s)` at the distance s
//! from it. If the edge lies farther out by t, energy is released, and the approach of a given force F changes by (Irwin 1957; Rice 1968)
//!
//! ```text
//! F d(approach) = -t integral along the edge of K^2/E*,    K^2 = (pi/2) d p^2
//! ```
//!
//! Here p is the pressure of the last element before the edge, and d the length of that element across the edge. A layer of compliance c adds
//! `t integral of c p^2`. The force of a given approach changes by S d(approach), S = dF/d(approach). For another quantity at the edge, such as a
//! traction, that quantity replaces one of the two factors p.
//!
//! t depends on the edge. Measured values, in elements:
//!
//! | edge | t | why |
//! |---|---|---|
//! | straight, parallel to the elements | -0.46 to 0.2 | it lies anywhere in half an element, plus the discretisation error of the singularity |
//! | in steps | -0.15 to 0.05 | most of t cancels along the edge |
//! | exactly on edges of elements | -0.15 | only the discretisation error of the singularity |
//!
//! The last row is that of the border of the grid, and of surfaces that consist of the caller's elements.
//!
//! *Jumps of the coefficients.* Pressures are also singular between patches that displace each other less than themselves, and beside an element
//! whose layer is much softer. The jump lies on an edge of elements. It counts as a part of an end: as 1 - F between patches with the factor F, and
//! as jump/(jump + c') in a layer, where c' is [`BESIDE_JUMP`] times the compliance of an element and its layer. The larger part counts. The jump of
//! a layer is the change of its compliance between two elements, beyond the changes beside them; so a slope has no jump.

use std::f64::consts::PI;

use crate::contact::{Problem, State, STRAIGHT};
use crate::direction::Direction;
use crate::sums::in_blocks;

/// The bound on t, in elements, at a straight edge.
const STRAIGHT_EDGE: f64 = 0.55;
/// The bound on t, in elements, at an edge in steps.
const STEPPED_EDGE: f64 = 0.12;
/// The bound on t, in elements, at an edge that lies on edges of elements.
const EXACT_EDGE: f64 = 0.2;
/// c' of a jump, over the compliance of an element and its layer. On balls pressed on two halves, one without a layer and one with a compliance of
/// 0.01 to 10, estimates were 2 to 5 times the error.
const BESIDE_JUMP: f64 = 4.0;
/// If a jump of a layer counts as more than this part of an end, the pressure beside it grows with each finer grid.
const SINGULAR_LAYER: f64 = 0.1;
/// The same bound between patches.
const SINGULAR_PATCHES: f64 = 0.015;
/// Relative change of a sum over the parts of force and energy in [`beyond_ends`]: 1 for a flat punch, and up to 1.22 for a punch of the shape x^6.
const SUM_FACTOR: f64 = 1.3;

/// What lies beyond a side of an element.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    /// The neighbour with this index has a surface.
    Surface(usize),
    /// The neighbour has no surface.
    Hole,
    /// The grid ends.
    Border,
}

/// A side of an element in contact at which the surface ends or coefficients jump.
struct End {
    /// t in elements; at a jump times the part of an end as which it counts.
    elements: f64,
    /// Whether the position of the end is known: it lies on an edge of elements.
    is_exact: bool,
    /// Whether the pressures are singular there.
    is_singular: bool,
    /// The compliance `pi d/(2 E*) + c`. At a jump without c, because the layer's displacement `c p` has no error there.
    compliance: f64,
}

impl End {
    /// The energy released at the end, without one of the two factors p: `t (pi d/(2 E*) + c) p` times the area of the element.
    fn released(&self, state: &State, i: usize) -> f64 {
        self.elements * self.compliance * state.p[i] * state.grid.element_area()
    }
}

/// The sum over all ends of `t (pi d/(2 E*) + c) p` times the area of the element, times `weights(i)` of the element i at the end: two sums with two
/// weights. A direction of one element has no ends here.
pub fn at_ends(problem: &Problem, state: &State, weights: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    each_end(problem, state, |i, end| {
        let (released, weights) = (end.released(state, i), weights(i));
        (0..2).for_each(|k| sums[k] += released * weights[k]);
    });
    sums
}

/// The sum of [`at_ends`] with p as the weight, and the largest pressure at a singular end.
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

/// The relative change of a sum, such as a force, if the surface ends farther out by t. It is the sum of two parts: the energy released over the
/// whole energy `(p, u)`, and, where pressures are at their limit, the force on the strip of width t over the whole force. Exact ends change nothing.
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
    let in_contact = || (0..state.p.len()).filter(|&i| state.touches(i));
    let force = in_blocks(in_contact().map(|i| state.p[i].abs()));
    let energy = in_blocks(in_contact().map(|i| state.p[i] * state.u[i]));
    SUM_FACTOR * (over(strips, force) + over(released, energy))
}

/// Calls `each(i, end)` for each side of an element i in contact at which the surface ends or coefficients jump.
fn each_end(problem: &Problem, state: &State, mut each: impl FnMut(usize, End)) {
    let grid = &state.grid;
    let directions = Direction::both(grid, problem.coefficients.repeats(grid));
    let sizes = [grid.dx, grid.dy];
    let flexibility = PI / (2.0 * problem.modulus());
    for i in (0..grid.len()).filter(|&i| state.touches(i)) {
        let position = [i % grid.mx, i / grid.mx];
        for k in (0..2).filter(|&k| directions[k].m > 1) {
            let along = (directions[1 - k], position[1 - k]);
            for sign in [-1, 1] {
                let side = Side { i, across: directions[k], number: position[k], sign };
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
    /// The direction across the side.
    across: Direction,
    /// The number of the element in its line across the side.
    number: usize,
    /// 1: the side towards the next element of the line, -1: towards the element before.
    sign: isize,
}

impl Side {
    /// The element `steps` steps beyond this side; on the other side of element i if `steps` is negative. None beyond the border of the grid.
    fn beyond(&self, steps: isize) -> Option<usize> {
        let offset = self.across.offset(self.number as isize + self.sign * steps);
        offset.map(|offset| self.i + offset - self.number * self.across.step)
    }

    /// What lies beyond this side.
    fn beside(&self, state: &State) -> Beside {
        match self.beyond(1) {
            None => Beside::Border,
            Some(j) if state.h[j].is_finite() => Beside::Surface(j),
            Some(_) => Beside::Hole,
        }
    }

    /// The end at this side, if there is one. `compliance` is `pi d/(2 E*)`. `along` is the direction along the side, and the number of the element
    /// in its line in that direction.
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

    /// The jump of the coefficients from this element to its neighbour j, as an end. None without a jump, or if j is not in contact.
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

    /// The jump of the layer's compliance from this element to its neighbour j; 0 unless j is softer.
    fn softer(&self, problem: &Problem, j: usize) -> f64 {
        let change = |from: Option<usize>, to: Option<usize>| match (from, to) {
            (Some(from), Some(to)) => problem.layer(to) - problem.layer(from),
            _ => 0.0,
        };
        // A change beside it in the opposite direction belongs to a single line of other compliance, or to noise. Half of such a change is
        // subtracted.
        let counted = |change: f64| if change < 0.0 { -0.5 * change } else { change };
        let (before, after) = (change(self.beyond(-1), Some(self.i)), change(Some(j), self.beyond(2)));
        (change(Some(self.i), Some(j)) - counted(before).max(counted(after))).max(0.0)
    }

    /// Whether the end of the surface at this side continues straight along enough elements, as a straight piece of the [outline](super::Outline)
    /// does.
    fn is_straight(&self, state: &State, (along, number): (Direction, usize)) -> bool {
        let continues = |n: usize| {
            let i = self.i + n * along.step - number * along.step;
            state.touches(i) && Side { i, ..*self }.beside(state) == Beside::Hole
        };
        let before = (0..number).rev().take(STRAIGHT).take_while(|&n| continues(n)).count();
        let after = (number + 1..along.m).take(STRAIGHT).take_while(|&n| continues(n)).count();
        before + 1 + after >= STRAIGHT.min(along.m)
    }
}
