//! Projected conjugate gradients on discs, for shifts and steps of transient rolling with given motion.
//!
//! Each iteration predicts the slip area as [`Tangent`] does (P, D, n), and takes one product:
//!
//! ```text
//! z = the preconditioned P(-s);   t = P(z + beta t)
//! q moves by a step of length a along t: on stick to q + a t, projected onto the disc; on slip to g (g n + a t)/|g n + a t| on the circle
//! ```
//!
//! The length a is known after the product only, and q moves along a curve. So the product is that of a chord: the change of q by a step of a
//! forecast length f, over f. f is the length of the step before. If a differs from f, u lacks the displacement by the difference of the curve and
//! the chord. This difference is a deferred correction: the next product includes it, or an extra product if it is large.
//!
//! The fields of the iteration hold the elements of C only ([`Discs`]).

use super::discs::{Discs, Sums};
use super::problem::{Problem, State};
use super::tangent::Tangent;
use crate::contact::relative;
use crate::error::Result;
use crate::methods::fields::Fields;
use crate::operator::fft::Real;
use crate::progress::Outcome;

/// The iteration ends as stagnated after this many iterations without progress.
const PATIENCE: u32 = 10;
/// Progress is a residual below this times the least one so far.
const PROGRESS: f64 = 0.9;

/// If the rms of the deferred corrections is more than this times that of the step, they are made at once by an extra product.
const MOST_DEFERRED: f64 = 0.2;

/// The least forecast length: on rough surfaces steps are short.
const LEAST_FORECAST: f64 = 0.2;

/// The memory of all methods on one grid.
#[derive(Default)]
pub struct Memory {
    /// The fields of the conjugate gradients with products in single precision.
    single: Discs<f32>,
    /// The same with products in double precision.
    double: Discs<f64>,
    /// The prediction of stick and slip for Newton's method.
    pub tangent: Tangent,
    /// Fields for reuse in linear solves.
    pub fields: Fields,
}

/// When an iteration ends.
pub struct Goal<'a> {
    /// The tolerance of the residual.
    pub tolerance: f64,
    /// The largest number of iterations of the conjugate gradients, of products in other methods.
    pub limit: u64,
    /// Whether a fresh product in double precision has to confirm the residual. On coarser grids it need not.
    pub certified: bool,
    /// Called with the residual of each iteration. It returns false to cancel.
    pub watch: &'a mut dyn FnMut(f64) -> bool,
}

impl Memory {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.single.bytes() + self.double.bytes() + self.tangent.bytes() + self.fields.bytes()
    }
}

/// What one iteration leaves to the next.
struct Steps {
    /// The forecast length f.
    forecast: f64,
    /// `t.(A + D) t` of the last direction t. 0 if the next direction shall not depend on t.
    energy: f64,
}

/// Iterates from the given state, with products of directions in single precision if they are set up.
pub fn solve(problem: &mut Problem, state: &mut State, memory: &mut Memory, goal: Goal<'_>) -> Result<Outcome> {
    match problem.operators.has_fast() {
        true => iterate(problem, state, &mut memory.single, goal),
        false => iterate(problem, state, &mut memory.double, goal),
    }
}

fn iterate<T: Real>(problem: &mut Problem, state: &mut State, discs: &mut Discs<T>, goal: Goal<'_>) -> Result<Outcome> {
    discs.load(problem, state)?;
    let end = until_it_ends(problem, state, discs, goal);
    discs.copy_to(problem, state);
    Ok(end)
}

fn until_it_ends<T: Real>(problem: &mut Problem, state: &mut State, discs: &mut Discs<T>, goal: Goal<'_>) -> Outcome {
    let Goal { tolerance, limit, certified, watch } = goal;
    let threads = problem.threads().clone();
    let rigid = problem.rms_rigid();
    let mut steps = Steps { forecast: 0.9, energy: 0.0 };
    let (mut least, mut since, mut iterations) = (f64::INFINITY, 0, 0);
    let mut sums = discs.predict(&problem.places, &threads);
    loop {
        let residual = residual(problem, rigid, discs, sums);
        if residual < tolerance {
            if state.is_exact || !certified {
                return Outcome::Converged;
            }
            discs.copy_to(problem, state);
            problem.refresh(state);
            discs.copy_from(problem, state);
            sums = discs.predict(&problem.places, &threads);
            continue;
        }
        since += 1;
        if residual < PROGRESS * least {
            (least, since) = (residual, 0);
        }
        if since > PATIENCE || !residual.is_finite() {
            return Outcome::Stagnated;
        }
        if iterations >= limit {
            return Outcome::IterationLimit;
        }
        iterations += 1;
        sums = step(problem, discs, &mut steps);
        state.is_exact = false;
        if !watch(residual) {
            return Outcome::Cancelled;
        }
    }
}

/// The residual of the certificate, from the sums of the last pass.
fn residual<T: Real>(problem: &Problem, rigid: f64, discs: &Discs<T>, sums: Sums) -> f64 {
    let [rest, displaced] = [sums.rest, sums.displaced].map(|sum| discs.unscaled_displacement(problem.rms_of(sum)));
    relative(rest, problem.compared(rigid, displaced))
}

/// Makes one iteration. Returns the sums of the new state.
fn step<T: Real>(problem: &mut Problem, discs: &mut Discs<T>, steps: &mut Steps) -> Sums {
    let along_last = discs.precondition(problem);
    let beta = if steps.energy > 0.0 { (-along_last / steps.energy).max(0.0) } else { 0.0 };
    discs.choose_direction(problem, (beta, steps.forecast));
    let [energy, gain] = discs.multiply(problem);
    let (length, next) = choose_length(gain / energy, energy, steps);
    let threads = problem.threads().clone();
    let mut sums = discs.step(&problem.places, &threads, length, steps.forecast);
    problem.update = discs.unscaled_traction(problem.rms_of(sums.moved));
    if sums.deferred > MOST_DEFERRED * MOST_DEFERRED * sums.moved {
        discs.correct(problem);
        sums = discs.predict(&problem.places, &threads);
    }
    steps.forecast = next.clamp(LEAST_FORECAST, 1.0);
    sums
}

/// Chooses the length of the step and the next forecast. `length` is the minimiser along the chord. It is used unless it differs from the forecast by
/// more than a factor of 4.
fn choose_length(length: f64, energy: f64, steps: &mut Steps) -> (f64, f64) {
    let f = steps.forecast;
    steps.energy = energy;
    if length >= 0.25 * f && length <= 4.0 * f {
        return (length, length);
    }
    steps.energy = 0.0;
    if length > 4.0 * f {
        // The forecast grows, so that the next step may be longer.
        (f, 4.0 * f)
    } else if length > 0.0 {
        let length = length.max(0.1 * f);
        (length, length)
    } else {
        (f, f)
    }
}
