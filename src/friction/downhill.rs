//! The projected Newton method on the discs `|q| <= g`, for shifts and steps of transient rolling with given motion in which faster methods cycle.
//! Every step reduces the energy `1/2 q.Aq + w.q`, so that no state recurs (Bertsekas, *Projected Newton methods for optimization problems with
//! simple constraints*, 1982).
//!
//! ```text
//! z       a step of Newton's method                            (module `step`)
//! d = clip(q + z + c) - q,    c: the vector for which sum d = sum z       clip: the projection onto the discs
//! a = -(d, s)/(d, A d), at most 1;    q = q + a d
//! ```
//!
//! c is needed because the projection changes the force, and a change of the force displaces all of C: on long lines a tends to 0 without c. If d is
//! no descent direction, `z = -rho s` with c = 0 takes its place.

use super::best::Best;
use super::forces::Forces;
use super::plane::{add, clip, dot, plus, square, Vector};
use super::problem::{Problem, State};
use super::shift::Goal;
use super::step::{compliance, enough, step, Effort};
use super::tangent::{rho_of, Tangent};
use crate::error::Result;
use crate::methods::fields::{self, Fields};
use crate::progress::Outcome;

/// The relative residual at which the linear solve of a step ends.
const INNER: f64 = 0.1;
/// The largest number of search directions of a linear solve.
const MOST_DIRECTIONS: usize = 16;
/// The largest number of iterations for c.
const ROUNDS: u32 = 4;
/// The iteration ends as stagnated after this many steps without a new least residual: then the energy changes by round-off only.
const PATIENCE: u32 = 40;

/// The direction of a step.
struct Way {
    d: Vec<Vector>,
    /// The derivative of the energy along d, `(d, s)`. d is a descent direction if it is negative.
    slope: f64,
}

/// Iterates from the given state.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    (tangent, fields, best): (&mut Tangent, &mut Fields, &mut Best),
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Goal { tolerance, limit, watch, .. } = goal;
    let made = problem.operators.products;
    tangent.fit(problem.grid.len())?;
    problem.continue_residuals()?;
    problem.refresh(state);
    let (mut least, mut since) = (f64::INFINITY, 0);
    loop {
        let rho = rho_of((problem.rms_bound(), problem.rms_slip()), 1.0 / compliance(problem));
        let residual = tangent.predict(problem, state, rho).residual;
        best.see(problem, state, residual, fields)?;
        if residual < tolerance {
            if state.is_exact {
                return Ok(Outcome::Converged);
            }
            problem.refresh(state);
            continue;
        }
        since += 1;
        if residual < least {
            (least, since) = (residual, 0);
        }
        if since > PATIENCE || !residual.is_finite() {
            return Ok(Outcome::Stagnated);
        }
        let left = limit.saturating_sub(problem.operators.products - made);
        if left == 0 {
            return Ok(Outcome::IterationLimit);
        }
        let inner = enough(INNER, tolerance, residual);
        let effort = Effort { inner, most: MOST_DIRECTIONS.min(left as usize), residual, length: 1.0 };
        let length = descend(problem, state, tangent, (effort, rho), fields)?;
        if !(length > 0.0) {
            problem.refresh(state);
            return Ok(Outcome::Stagnated);
        }
        if !watch(residual) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// Makes one step. Returns its length a; 0 if there is no descent direction.
fn descend(
    problem: &mut Problem,
    state: &mut State,
    tangent: &Tangent,
    (effort, rho): (Effort, f64),
    fields: &mut Fields,
) -> Result<f64> {
    let (n, threads) = (state.q.len(), problem.threads().clone());
    let (mut q, mut u) = (fields.take(n)?, fields.take(n)?);
    fields::fill(&threads, &mut q, |i| state.q[i]);
    fields::fill(&threads, &mut u, |i| state.u[i]);
    step(problem, state, tangent, (Forces::NONE, effort), fields)?;
    let (mut way, mut product) = (Way { d: fields.take(n)?, slope: f64::NAN }, fields.take(n)?);
    let c = force_correction(problem, &state.q);
    way.set(problem, (&q, &u), |i| add(state.q[i], c));
    if !(way.slope < 0.0) {
        way.set(problem, (&q, &u), |i| plus(q[i], -rho, problem.slip_at(i, &u)));
    }
    let mut length = 0.0;
    if way.slope < 0.0 {
        problem.operators.multiply(&way.d, problem.rms_bound(), &mut product);
        let curvature = fields::dot(&threads, &way.d, &product);
        length = if curvature > 0.0 { (-way.slope / curvature).min(1.0) } else { 1.0 };
        fields::map(&threads, &mut q, |i, q| plus(q, length, way.d[i]));
        fields::map(&threads, &mut u, |i, u| plus(u, length, product[i]));
    }
    problem.update = length * problem.rms_of(fields::dot(&threads, &way.d, &way.d));
    std::mem::swap(&mut state.q, &mut q);
    std::mem::swap(&mut state.u, &mut u);
    state.is_exact = false;
    [q, u, way.d, product].into_iter().for_each(|field| fields.give(field));
    Ok(length)
}

/// The vector c with which the sum of `clip(to + c)` is that of `to`.
fn force_correction(problem: &Problem, to: &[Vector]) -> Vector {
    let mut c = [0.0; 2];
    for _ in 0..ROUNDS {
        let of_element = |i: usize| {
            let (g, shifted) = (problem.bound[i], add(to[i], c));
            if !(g > 0.0) {
                return [0.0; 3];
            }
            let missing = plus(to[i], -1.0, clip(shifted, g));
            [missing[0], missing[1], f64::from(u8::from(square(shifted) < g * g))]
        };
        // The missing force is distributed to the elements inside their discs.
        let [x, y, inside] = fields::sum(problem.threads(), to.len(), of_element);
        if inside == 0.0 {
            break;
        }
        c = add(c, [x / inside, y / inside]);
    }
    c
}

impl Way {
    /// Sets d to the projection of `to` onto the discs less q, and computes the slope.
    fn set(&mut self, problem: &Problem, (q, u): (&[Vector], &[Vector]), to: impl Fn(usize) -> Vector + Sync + Send) {
        let threads = problem.threads();
        fields::fill(threads, &mut self.d, |i| plus(clip(to(i), problem.bound[i]), -1.0, q[i]));
        let d = &self.d;
        let [slope] = fields::sum(threads, d.len(), |i| {
            [if problem.bound[i] > 0.0 { dot(d[i], problem.slip_at(i, u)) } else { 0.0 }]
        });
        self.slope = slope;
    }
}
