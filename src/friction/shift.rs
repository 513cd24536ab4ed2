//! Shift, and a step of transient rolling, with the motion given: projected conjugate gradients on discs.
//!
//! Per iteration, with the prediction of [`Tangent`] and one product `A t`:
//!
//! ```text
//! z = the preconditioned P(-s);   t = P(z + beta t)
//! q moves by a t: on stick straight on, and back into the disc; on slip along the circle, g (g n + a t)/|g n + a t|
//! ```
//!
//! The move is not straight, so a step is held back: its chord at the length f that the step before had is taken as the direction and
//! multiplied, and what a step of another length leaves of it is a debt, which the next product pays, or a product of its own where
//! the debt is large.

use super::problem::{add, dot, onto_disc, plus, square, Problem, State};
use super::tangent::{Side, Tangent};
use super::vectors::{self, Fields, BLOCK};
use super::Vector;
use crate::error::Result;
use crate::memory::{blank, keep};
use crate::progress::Outcome;

/// Iterations without a new least residual after which another method takes over.
const PATIENCE: u32 = 10;

/// A debt above this part of a step is paid at once.
const MOST_DEBT: f64 = 0.2;

/// The length at which a step is held back is at least this: on rough surfaces steps are short.
const LEAST_HELD_BACK: f64 = 0.2;

/// Memory of the iteration.
#[derive(Default)]
pub struct Memory {
    pub tangent: Tangent,
    /// t, its chord, and `A` of the chord and the debt.
    direction: Vec<Vector>,
    chord: Vec<Vector>,
    product: Vec<Vector>,
    debt: Vec<Vector>,
    /// What is multiplied, and z.
    given: Vec<Vector>,
    z: Vec<Vector>,
    /// Of Newton's method.
    pub fields: Fields,
}

/// What an iteration has to reach.
pub struct Goal<'a> {
    /// The residual.
    pub tolerance: f64,
    /// Iterations at most.
    pub limit: u64,
    /// Whether it has to hold by a fresh product.
    pub certified: bool,
    /// Told the residual of each iteration; says whether to go on.
    pub watch: &'a mut dyn FnMut(f64) -> bool,
}

impl Memory {
    /// For n elements.
    pub fn new(n: usize) -> Result<Memory> {
        let field = || blank(n, [f64::NAN; 2], "the iteration on discs");
        Ok(Memory {
            tangent: Tangent::new(n)?,
            direction: field()?,
            chord: field()?,
            product: field()?,
            debt: field()?,
            given: field()?,
            z: field()?,
            fields: Fields::default(),
        })
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        let Memory { direction, chord, product, debt, given, z, .. } = self;
        keep([direction, chord, product, debt, given, z]);
    }
}

/// Lengths of the steps: see the module.
struct Steps {
    /// f.
    held_back: f64,
    /// `t.(A + D) t` of the last direction; 0: forgotten.
    energy: f64,
}

/// Iterates from what the state holds.
pub fn solve(problem: &mut Problem, state: &mut State, memory: &mut Memory, goal: Goal<'_>) -> Outcome {
    let Goal { tolerance, limit, certified, watch } = goal;
    let a0 = problem.operators.self_influence;
    let cap = 0.3 / (a0 * (problem.count().max(1) as f64).sqrt());
    let slip = problem.rms_slip();
    let rho = if slip > 0.0 { cap.min(problem.rms_bound() / slip) } else { cap };
    let mut steps = Steps { held_back: 0.9, energy: 0.0 };
    let (mut least, mut since, mut iterations) = (f64::INFINITY, 0, 0);
    for field in [&mut memory.debt, &mut memory.direction, &mut memory.chord] {
        field.fill([0.0; 2]);
    }
    loop {
        let sight = memory.tangent.predict(problem, state, rho);
        if sight.residual < tolerance {
            if state.is_exact || !certified {
                return Outcome::Converged;
            }
            problem.refresh(state);
            memory.debt.fill([0.0; 2]);
            continue;
        }
        since += 1;
        if sight.residual < least {
            (least, since) = (sight.residual, 0);
        }
        if since > PATIENCE || !sight.residual.is_finite() {
            return Outcome::Stagnated;
        }
        if iterations >= limit {
            return Outcome::IterationLimit;
        }
        iterations += 1;
        step(problem, state, memory, &mut steps);
        if !watch(sight.residual) {
            return Outcome::Cancelled;
        }
    }
}

/// One iteration.
fn step(problem: &mut Problem, state: &mut State, memory: &mut Memory, steps: &mut Steps) {
    let unit = problem.rms_bound();
    let Memory { tangent, given, z, .. } = memory;
    tangent.precondition(problem, &tangent.driving, unit, given, z);
    choose_direction(problem, state, memory, steps);
    problem.operators.multiply_fast(&memory.given, unit, &mut memory.product);
    let length = choose_length(problem, memory, steps);
    let (owed, gone) = go(problem, state, memory, (length, steps.held_back));
    state.is_exact = false;
    if owed > MOST_DEBT * gone {
        let Memory { debt, given, z, .. } = memory;
        given.copy_from_slice(debt);
        problem.operators.multiply_fast(given, unit, z);
        vectors::add_all(problem.threads(), &mut state.u, &[(1.0, z)]);
        debt.fill([0.0; 2]);
    }
    steps.held_back = length.clamp(LEAST_HELD_BACK, 1.0);
}

/// The direction t, its chord, and what is multiplied: the chord with the debt.
fn choose_direction(problem: &Problem, state: &State, memory: &mut Memory, steps: &Steps) {
    let Memory { tangent, direction, chord, product, debt, given, z, .. } = memory;
    let (threads, f) = (problem.threads(), steps.held_back);
    let inverse = 1.0 / f;
    // z is 0 outside C.
    let along_last = |i: usize| [dot(z[i], plus(product[i], tangent.curvature[i], direction[i])), 0.0];
    let beta = match steps.energy > 0.0 {
        true => (-vectors::sum(threads, z.len(), along_last)[0] / steps.energy).max(0.0),
        false => 0.0,
    };
    let blocks = direction.chunks_mut(BLOCK).zip(chord.chunks_mut(BLOCK)).zip(given.chunks_mut(BLOCK));
    vectors::over(threads, blocks, |start, ((direction, chord), given)| {
        for k in 0..direction.len() {
            let i = start + k;
            if tangent.side[i] == Side::Outside {
                given[k] = [0.0; 2];
                continue;
            }
            let q = state.q[i];
            let t = tangent.project(i, plus(z[i], beta, direction[k]));
            let moved = moved(tangent, problem.bound[i], i, q, t, f);
            chord[k] = [inverse * (moved[0] - q[0]), inverse * (moved[1] - q[1])];
            given[k] = plus(chord[k], inverse, debt[i]);
            direction[k] = t;
        }
        []
    });
}

/// How far to go along the chord.
fn choose_length(problem: &Problem, memory: &Memory, steps: &mut Steps) -> f64 {
    let Memory { tangent, direction, chord, product, .. } = memory;
    let [energy, gain] = vectors::sum(problem.threads(), chord.len(), |i| {
        let along = if tangent.side[i] == Side::Slip { direction[i] } else { chord[i] };
        [dot(along, product[i]) + tangent.curvature[i] * square(along), dot(tangent.driving[i], along)]
    });
    let (length, f) = (gain / energy, steps.held_back);
    steps.energy = energy;
    if length >= 0.25 * f && length <= 4.0 * f {
        return length;
    }
    steps.energy = 0.0;
    if length > 0.0 && length < 0.25 * f {
        length.max(0.1 * f)
    } else {
        f
    }
}

/// Goes so far, of what the chord was taken for; the sums of what is owed then and of how far elements went.
fn go(problem: &Problem, state: &mut State, memory: &mut Memory, (length, f): (f64, f64)) -> (f64, f64) {
    let Memory { tangent, direction, chord, product, debt, .. } = memory;
    let states = state.q.chunks_mut(BLOCK).zip(state.u.chunks_mut(BLOCK));
    let blocks = states.zip(direction.chunks_mut(BLOCK).zip(debt.chunks_mut(BLOCK)));
    let [owed, gone] = vectors::over(problem.threads(), blocks, |start, ((q, u), (direction, debt))| {
        let (mut owed, mut gone) = (0.0, 0.0);
        for k in 0..q.len() {
            let i = start + k;
            if tangent.side[i] == Side::Outside {
                continue;
            }
            let g = problem.bound[i];
            let straight = plus(q[k], length, chord[i]);
            let new = match tangent.side[i] {
                Side::Slip => moved(tangent, g, i, q[k], direction[k], length),
                _ => onto_disc(straight, g),
            };
            debt[k] = add(plus(debt[k], -length / f, debt[k]), [new[0] - straight[0], new[1] - straight[1]]);
            owed += square(debt[k]).sqrt();
            gone += square([new[0] - q[k][0], new[1] - q[k][1]]).sqrt();
            u[k] = plus(u[k], length, product[i]);
            if tangent.side[i] != Side::Slip {
                direction[k] = chord[i];
            }
            q[k] = new;
        }
        [owed, gone]
    });
    (owed, gone)
}

/// Where element i goes from q by `a t`.
#[inline]
fn moved(tangent: &Tangent, g: f64, i: usize, q: Vector, t: Vector, a: f64) -> Vector {
    if tangent.side[i] != Side::Slip {
        return onto_disc(plus(q, a, t), g);
    }
    let n = tangent.normal[i];
    let to = [g * n[0] + a * t[0], g * n[1] + a * t[1]];
    let factor = g / square(to).sqrt();
    [to[0] * factor, to[1] * factor]
}
