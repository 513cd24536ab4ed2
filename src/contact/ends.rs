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
//! *Jumps of the coefficients.* Where two patches touch that displace each other less than themselves, and beside an
//! element whose layer is much softer, pressures are singular, too. The edge lies on an edge of elements. A part of the
//! release counts: 1 - F for a factor of F between the patches, and for a layer jump/(jump + [`BESIDE_JUMP`] times the
//! compliance of an element and its layer). The larger one counts. A jump is a change beyond the changes beside it, so
//! a slope has none.

use std::f64::consts::PI;

use super::direction::Direction;
use super::outline::STRAIGHT;
use super::{Problem, State};
use crate::sums::in_blocks;

/// t in elements: at a straight edge, at an edge with steps, and where the edge lies on edges of elements.
const STRAIGHT_EDGE: f64 = 0.55;
const STEPPED_EDGE: f64 = 0.12;
const EXACT_EDGE: f64 = 0.2;
/// See above. Measured with balls on two halves, of compliances from 0 | 0.01 to 0 | 10: estimates are 2 to 5 times the error.
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

/// The largest pressure where the surface ends or coefficients jump within the contact.
pub fn highest_at_ends(problem: &Problem, state: &State) -> f64 {
    let mut highest = 0.0_f64;
    each_end(problem, state, |i, end| {
        if end.is_singular {
            highest = highest.max(state.p[i]);
        }
    });
    highest
}

/// Sum over the sides at which the surface ends within the contact: `t (pi d/(2 E*) + c) p` times the area of an element, with the
/// weights `w(i)` of the elements. A direction of one element has no ends here.
pub fn at_ends<const N: usize>(problem: &Problem, state: &State, weights: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    each_end(problem, state, |i, end| {
        let part = end.elements * end.compliance * state.p[i] * state.grid.element_area();
        let weights = weights(i);
        (0..N).for_each(|n| sums[n] += part * weights[n]);
    });
    sums
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
            let (across, along) = (directions[k], directions[1 - k]);
            for side in [0, 1] {
                let compliance = flexibility * sizes[k];
                let (elements, is_exact) = match beside(across, state, (i, place[k]), side) {
                    Beside::Surface(_) if !problem.coefficients.may_jump() => continue,
                    Beside::Surface(j) => {
                        let (part, is_singular) = jump(problem, state, [i, j], (across, place[k], side), compliance);
                        if part > 0.0 {
                            each(i, End { elements: EXACT_EDGE * part, is_exact: true, is_singular, compliance });
                        }
                        continue;
                    }
                    Beside::Border => (EXACT_EDGE, true),
                    Beside::Hole if problem.exact_edges => (EXACT_EDGE, true),
                    Beside::Hole if is_straight(along, state, (i, place[1 - k]), (across, place[k], side)) => {
                        (STRAIGHT_EDGE, false)
                    }
                    Beside::Hole => (STEPPED_EDGE, false),
                };
                let compliance = compliance + problem.layer(i);
                each(i, End { elements, is_exact, is_singular: true, compliance });
            }
        }
    }
}

/// The part of an end that the jump of the coefficients from element i to its neighbour j is, from 0 to 1, and whether pressures are singular
/// there. `compliance` is that of a side of i.
fn jump(
    problem: &Problem,
    state: &State,
    [i, j]: [usize; 2],
    (across, place, side): (Direction, usize, usize),
    compliance: f64,
) -> (f64, bool) {
    if !state.touches(j) {
        return (0.0, false);
    }
    let of_patches = 1.0 - problem.coefficients.patches().map_or(1.0, |patches| patches.between(i, j));
    let change = problem.layer(j) - problem.layer(i);
    if change <= 0.0 {
        return (of_patches, of_patches > SINGULAR_PATCHES);
    }
    // The changes before i and behind j, in the same direction. One back is that of a single line, or of noise: half of it counts.
    let step = if side == 0 { -1 } else { 1 };
    let beyond = |steps: isize, of: usize| {
        let next = across.at(place as isize + step * steps).map(|at| i + at - place * across.step);
        let change = next.map_or(0.0, |next| (problem.layer(next) - problem.layer(of)) * steps.signum() as f64);
        if change < 0.0 {
            -0.5 * change
        } else {
            change
        }
    };
    let softer = (change - beyond(-1, i).max(beyond(2, j))).max(0.0);
    let of_layer = softer / (softer + BESIDE_JUMP * (compliance + problem.layer(i)));
    (of_layer.max(of_patches), of_layer > SINGULAR_LAYER || of_patches > SINGULAR_PATCHES)
}

/// The neighbour of element `i` at `place` of its line in this direction: the one before (side 0), or behind.
fn beside(direction: Direction, state: &State, (i, place): (usize, usize), side: usize) -> Beside {
    let next = if side == 0 { place as isize - 1 } else { place as isize + 1 };
    match direction.at(next) {
        None => Beside::Border,
        Some(next) => match i + next - place * direction.step {
            j if state.h[j].is_finite() => Beside::Surface(j),
            _ => Beside::Hole,
        },
    }
}

/// Whether this edge continues along a line, as a straight piece of the [outline](super::Outline) does.
fn is_straight(
    along: Direction,
    state: &State,
    (i, place): (usize, usize),
    (across, place_across, side): (Direction, usize, usize),
) -> bool {
    let same = |n: usize| {
        let at = i + n * along.step - place * along.step;
        state.touches(at) && beside(across, state, (at, place_across), side) == Beside::Hole
    };
    let before = (0..place).rev().take(STRAIGHT).take_while(|&n| same(n)).count();
    let behind = (place + 1..along.m).take(STRAIGHT).take_while(|&n| same(n)).count();
    before + 1 + behind >= STRAIGHT.min(along.m)
}
