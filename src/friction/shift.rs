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
use super::vectors::Fields;
use super::Vector;
use crate::error::Result;
use crate::memory::zeros;
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
        let field = || zeros(n, "the iteration on discs");
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

/// Lengths of the steps: see the module.
struct Steps {
    /// f.
    held_back: f64,
    /// `t.(A + D) t` of the last direction; 0: forgotten.
    energy: f64,
}

impl Steps {
    /// What of the last direction is kept: the parts are those of `z . (A + D) t`.
    fn beta(&self, parts: impl Iterator<Item = f64>) -> f64 {
        if self.energy > 0.0 {
            (parts.fold(0.0, |sum, part| sum - part) / self.energy).max(0.0)
        } else {
            0.0
        }
    }
}

/// Iterates from what the state holds.
pub fn solve(problem: &mut Problem, state: &mut State, memory: &mut Memory, goal: Goal<'_>) -> Outcome {
    let Goal { tolerance, limit, watch, .. } = goal;
    let a0 = problem.operators.self_influence;
    let cap = 0.3 / (a0 * (problem.count().max(1) as f64).sqrt());
    let slip = problem.rms_slip();
    let rho = if slip > 0.0 { cap.min(problem.rms_bound() / slip) } else { cap };
    let mut steps = Steps { held_back: 0.9, energy: 0.0 };
    let (mut least, mut since, mut iterations) = (f64::INFINITY, 0, 0);
    memory.debt.fill([0.0; 2]);
    loop {
        let sight = memory.tangent.predict(problem, state, rho);
        if sight.residual < tolerance {
            if state.is_exact {
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
    let Memory { tangent, direction, chord, product, debt, given, z, .. } = memory;
    let unit = problem.rms_bound();
    tangent.precondition(problem, &tangent.driving, unit, given, z);
    let f = steps.held_back;
    let along_last = |i: usize| dot(z[i], plus(product[i], tangent.curvature[i], direction[i]));
    let beta = steps.beta(problem.contact().map(along_last));
    // Outside C there are still continued residuals.
    given.fill([0.0; 2]);
    for i in problem.contact() {
        let t = tangent.project(i, plus(z[i], beta, direction[i]));
        let moved = moved(tangent, problem.bound[i], i, state.q[i], t, f);
        chord[i] = [(moved[0] - state.q[i][0]) / f, (moved[1] - state.q[i][1]) / f];
        given[i] = plus(chord[i], 1.0 / f, debt[i]);
        direction[i] = t;
    }
    problem.operators.multiply_fast(given, unit, product);
    let (mut energy, mut gain) = (0.0, 0.0);
    for i in problem.contact() {
        let along = if tangent.side[i] == Side::Slip { direction[i] } else { chord[i] };
        energy += dot(along, product[i]) + tangent.curvature[i] * square(along);
        gain += dot(tangent.driving[i], along);
    }
    let mut length = gain / energy;
    steps.energy = energy;
    if !(length >= 0.25 * f && length <= 4.0 * f) {
        length = if length > 0.0 && length < 0.25 * f { length.max(0.1 * f) } else { f };
        steps.energy = 0.0;
    }
    let (mut owed, mut gone) = (0.0, 0.0);
    for i in problem.contact() {
        let (q, g) = (state.q[i], problem.bound[i]);
        let straight = plus(q, length, chord[i]);
        let new = match tangent.side[i] {
            Side::Slip => moved(tangent, g, i, q, direction[i], length),
            _ => onto_disc(straight, g),
        };
        debt[i] = add(plus(debt[i], -length / f, debt[i]), [new[0] - straight[0], new[1] - straight[1]]);
        owed += square(debt[i]).sqrt();
        gone += square([new[0] - q[0], new[1] - q[1]]).sqrt();
        state.u[i] = plus(state.u[i], length, product[i]);
        if tangent.side[i] != Side::Slip {
            direction[i] = chord[i];
        }
        state.q[i] = new;
    }
    state.is_exact = false;
    if owed > MOST_DEBT * gone {
        given.copy_from_slice(debt);
        problem.operators.multiply_fast(given, unit, z);
        for i in problem.contact() {
            state.u[i] = add(state.u[i], z[i]);
            debt[i] = [0.0; 2];
        }
    }
    steps.held_back = length.clamp(LEAST_HELD_BACK, 1.0);
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
