//! Projected conjugate gradients on discs, for shifts and steps of transient rolling with given motion.
//!
//! Per iteration, with the prediction of [`Tangent`] and one product `A t`:
//!
//! ```text
//! z = the preconditioned P(-s);   t = P(z + beta t)
//! q moves by a t: on stick straight, projected onto the disc; on slip along the circle, g (g n + a t)/|g n + a t|
//! ```
//!
//! The move is curved, so its chord at the forecast length f, the length of the step before, is multiplied. The
//! difference of a step of another length is a deferred correction: the next product includes it, or an extra product
//! if it is large.
//!
//! Fields are on C only ([`Discs`]).

use super::discs::{Discs, Sums};
use super::problem::{Problem, State};
use super::tangent::Tangent;
use crate::contact::relative;
use crate::error::Result;
use crate::methods::fields::Fields;
use crate::operator::fft::Real;
use crate::progress::Outcome;

/// Iterations without progress after which another method follows; progress is a residual below PROGRESS times the least.
const PATIENCE: u32 = 10;
const PROGRESS: f64 = 0.9;

/// Rms of deferred corrections over that of the step above which they are multiplied at once.
const MOST_DEFERRED: f64 = 0.2;

/// Least forecast length: on rough surfaces steps are short.
const LEAST_FORECAST: f64 = 0.2;

/// Memory of the iterations.
#[derive(Default)]
pub struct Memory {
    /// The fields with products in single precision, and in double.
    single: Discs<f32>,
    double: Discs<f64>,
    /// The prediction of Newton's method.
    pub tangent: Tangent,
    pub fields: Fields,
}

/// The goal of an iteration.
pub struct Goal<'a> {
    /// The tolerance of the residual.
    pub tolerance: f64,
    /// Most iterations; in Newton's method most products.
    pub limit: u64,
    /// Whether a fresh product has to confirm the residual.
    pub certified: bool,
    /// Called with the residual of each iteration; false cancels.
    pub watch: &'a mut dyn FnMut(f64) -> bool,
}

impl Memory {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.single.bytes() + self.double.bytes() + self.tangent.bytes() + self.fields.bytes()
    }
}

/// Lengths of the steps: see the module.
struct Steps {
    /// f.
    forecast: f64,
    /// `t.(A + D) t` of the last direction; 0: forgotten.
    energy: f64,
}

/// Iterates from the state.
pub fn solve(problem: &mut Problem, state: &mut State, memory: &mut Memory, goal: Goal<'_>) -> Result<Outcome> {
    match problem.operators.has_fast() {
        true => iterate(problem, state, &mut memory.single, goal),
        false => iterate(problem, state, &mut memory.double, goal),
    }
}

fn iterate<T: Real>(problem: &mut Problem, state: &mut State, discs: &mut Discs<T>, goal: Goal<'_>) -> Result<Outcome> {
    discs.load(problem, state)?;
    let end = until_it_ends(problem, state, discs, goal);
    discs.give(problem, state);
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
            discs.give(problem, state);
            problem.refresh(state);
            discs.take(problem, state);
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

/// The residual of the certificate.
fn residual<T: Real>(problem: &Problem, rigid: f64, discs: &Discs<T>, sums: Sums) -> f64 {
    let [rest, displaced] = [sums.rest, sums.displaced].map(|sum| discs.unscaled_displacement(problem.rms_of(sum)));
    relative(rest, problem.compared(rigid, displaced))
}

/// One iteration. Returns the sums of the new state.
fn step<T: Real>(problem: &mut Problem, discs: &mut Discs<T>, steps: &mut Steps) -> Sums {
    let along_last = discs.precondition(problem);
    let beta = if steps.energy > 0.0 { (-along_last / steps.energy).max(0.0) } else { 0.0 };
    discs.choose_direction(problem, (beta, steps.forecast));
    let [energy, gain] = discs.multiply(problem);
    let (length, next) = choose_length(gain / energy, energy, steps);
    let threads = problem.threads().clone();
    let mut sums = discs.go(&problem.places, &threads, length, steps.forecast);
    problem.update = discs.unscaled_traction(problem.rms_of(sums.moved));
    if sums.deferred > MOST_DEFERRED * MOST_DEFERRED * sums.moved {
        discs.correct(problem);
        sums = discs.predict(&problem.places, &threads);
    }
    steps.forecast = next.clamp(LEAST_FORECAST, 1.0);
    sums
}

/// The step along the chord, and the next forecast.
fn choose_length(length: f64, energy: f64, steps: &mut Steps) -> (f64, f64) {
    let f = steps.forecast;
    steps.energy = energy;
    if length >= 0.25 * f && length <= 4.0 * f {
        return (length, length);
    }
    steps.energy = 0.0;
    if length > 4.0 * f {
        // Otherwise steps would never lengthen.
        (f, 4.0 * f)
    } else if length > 0.0 {
        let length = length.max(0.1 * f);
        (length, length)
    } else {
        (f, f)
    }
}
