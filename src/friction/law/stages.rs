//! The two stages of a solve with a law.
//!
//! 1. lagged: before each Newton step with fixed bounds, the bounds of slipping elements are updated from the slips of the step before;
//! 2. below a residual of [`NEWTON_RESIDUAL`], Newton's method with the derivatives of the bounds
//!    ([`system`](super::system)); without progress a few lagged steps follow.
//!
//! With given forces both steps are bordered by the creepages. The iteration then begins with the solution of Coulomb's law, the least
//! creepage that carries the forces.
//!
//! If a layer hardens or softens, or bounds rise steeply by a memory of lower bounds, bounds must not lag. Then all steps are Newton's.
//!
//! The result lies on its circles (unless bounds rise steeply), with a fresh product. It has two certificates: that of the conditions with
//! fixed bounds `g = |q|`, and `R_g = rms(|q| - g(slip))/rms g(0)` over the slip area, by a march with the slips of that product.

use super::super::best::Best;
use super::super::forces::Forces;
use super::super::newton::PROGRESS;
use super::super::plane::{plus, square};
use super::super::problem::{Problem, State};
use super::super::shift::Goal;
use super::super::step::{self, compliance, enough, Effort, DIRECTIONS};
use super::super::take_over::LARGEST_RATIO;
use super::super::tangent::{mixing, project, rho_of, Side, Tangent};
use super::bounds::{freeze, lag, settle, worst};
use super::march::March;
use super::{system, RISING};
use crate::error::Result;
use crate::methods::fields::Fields;
use crate::progress::Outcome;

/// Residual below which steps are Newton's.
pub const NEWTON_RESIDUAL: f64 = 1e-2;
/// A Newton step must make [`PROGRESS`]; if not, LAGGED_STEPS lagged steps follow.
const LAGGED_STEPS: u32 = 5;
/// Relative residual of linear solves, of Newton steps and of lagged ones.
const INNER: f64 = 0.2;
const INNER_LAGGED: f64 = 0.35;
/// rho of the natural map in Newton steps, over the inverse of an element's influence on itself: more than the largest slope of a bound, so
/// that each element has one state. 4 takes 15 to 24 products, 2 takes 15 to 36 (192 x 176 elements to 1e-6).
const RHO: f64 = 4.0;
/// Steps without a residual below GAIN times the least, after which the iteration ends.
const PATIENCE: u32 = 15;
const GAIN: f64 = 0.9;

/// The progress of the steps.
struct Course {
    least: f64,
    since: u32,
    held: u32,
    was_newton: bool,
    hardens: bool,
}

/// The outcome, and the larger of both certificates' residuals.
pub struct Ended {
    pub outcome: Outcome,
    pub residual: f64,
}

/// Iterates from the state. `has_slipped` tells whether the state has a slip area. Otherwise no element has slipped yet.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    (tangent, fields): (&mut Tangent, &mut Fields),
    (march, forces, has_slipped): (&mut March, Forces, bool),
    goal: Goal<'_>,
) -> Result<Ended> {
    tangent.fit(state.q.len())?;
    problem.continue_residuals()?;
    let mut best = Best::none();
    if has_slipped {
        tangent.predict(problem, state, 1.0 / compliance(problem));
    } else {
        tangent.side.fill(Side::Stick);
    }
    let tolerance = goal.tolerance;
    let outcome = iterate(problem, state, (tangent, fields), (march, &mut best, forces), goal)?;
    if outcome != Outcome::Converged && best.take_up(problem, state) {
        problem.refresh_unclipped(state);
        lag(problem, state, tangent, march);
        tangent.predict(problem, state, 1.0 / compliance(problem));
        settle(problem, state, tangent, march);
    }
    best.give(fields);
    let residual = freeze(problem, state, tangent, march);
    let is_off = outcome == Outcome::Converged && !(residual < tolerance);
    Ok(Ended { outcome: if is_off { Outcome::Stagnated } else { outcome }, residual })
}

fn iterate(
    problem: &mut Problem,
    state: &mut State,
    (tangent, fields): (&mut Tangent, &mut Fields),
    (march, best, forces): (&mut March, &mut Best, Forces),
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Goal { tolerance, limit, watch, .. } = goal;
    let (made, cap) = (problem.operators.products, 1.0 / compliance(problem));
    // The bound of a layer that hardens or softens, or that rises steeply by its memory, must not lag behind the slip.
    let hardens = march.law.layer.is_some_and(|layer| layer.hardening != 0.0) || march.rises > RISING;
    let mut course = Course { least: f64::INFINITY, since: 0, held: 0, was_newton: false, hardens };
    let mut is_fresh = false;
    loop {
        lag(problem, state, tangent, march);
        let rho = rho_of((problem.rms_bound(), problem.rms_slip()), cap);
        let measures = tangent.predict(problem, state, rho);
        let missing = forces.missing(problem, &state.q);
        let worst = worst(problem, state, tangent).max(missing);
        if !worst.is_finite() || missing.is_nan() || forces.any() && is_far(problem) {
            return Ok(Outcome::Stagnated);
        }
        best.see(problem, state, worst, fields)?;
        if worst < tolerance {
            if is_fresh {
                return Ok(Outcome::Converged);
            }
            settle(problem, state, tangent, march);
            is_fresh = true;
            continue;
        }
        is_fresh = false;
        let left = limit.saturating_sub(problem.operators.products - made);
        if left == 0 {
            return Ok(Outcome::IterationLimit);
        }
        let Some(is_newton) = course.next(worst) else { return Ok(Outcome::Stagnated) };
        let inner = if is_newton { INNER } else { INNER_LAGGED };
        let inner = enough(inner, tolerance, worst);
        let most = DIRECTIONS.min(left as usize);
        if is_newton {
            let rho = if march.law.fall.is_none() { rho } else { RHO / problem.operators.self_influence };
            resolve(problem, state, tangent, march, rho);
            system::step(problem, state, (tangent, march, forces), (rho, inner, most), fields)?;
        } else {
            let effort = Effort { inner, most, residual: measures.residual, length: 1.0 };
            step::step(problem, state, tangent, (forces, effort), fields)?;
        }
        if !watch(worst) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// Whether the creepages diverge because no creepage carries the force.
fn is_far(problem: &Problem) -> bool {
    !(problem.rms_rigid() / problem.displaced_by_bounds() < LARGEST_RATIO)
}

impl Course {
    /// Whether the next step is Newton's. None if the iteration ends.
    fn next(&mut self, worst: f64) -> Option<bool> {
        let mut is_newton = self.hardens || worst < NEWTON_RESIDUAL && self.held == 0;
        if is_newton && !self.hardens && self.was_newton && worst > PROGRESS * self.least {
            (self.held, is_newton) = (LAGGED_STEPS, false);
        }
        self.since = if worst < GAIN * self.least { 0 } else { self.since + 1 };
        self.least = self.least.min(worst);
        self.held = if is_newton { 0 } else { self.held.saturating_sub(1) };
        self.was_newton = is_newton;
        (self.since <= PATIENCE).then_some(is_newton)
    }
}

/// Predicts sides, normals, curvatures and bounds of all elements by the resolvent of the march.
fn resolve(problem: &mut Problem, state: &State, tangent: &mut Tangent, march: &mut March, rho: f64) {
    let a0 = problem.operators.self_influence;
    let share = a0 / problem.operators.greatest();
    let natural = |k: usize| plus(state.q[k], -rho, problem.slip_at(k, &state.u));
    march.resolve(rho, |k| square(natural(k)).sqrt());
    let mut slips = 0;
    for k in 0..state.q.len() {
        if !(problem.bound[k] > 0.0) {
            tangent.side[k] = Side::Outside;
            continue;
        }
        let resolved = march.resolved(k);
        let bound = resolved.response.bound;
        let (tau, s) = (natural(k), problem.slip_at(k, &state.u));
        let against = [-s[0], -s[1]];
        let beyond = problem.operators.excess.as_ref().map_or(0.0, |excess| share * excess.at(k));
        let (side, normal, curvature) = if resolved.slips {
            let length = square(tau).sqrt();
            (Side::Slip, tau.map(|tau| tau / length), (length / bound - 1.0).max(0.0) / rho)
        } else {
            (Side::Stick, [0.0; 2], 0.0)
        };
        slips += usize::from(side == Side::Slip);
        (tangent.side[k], tangent.normal[k], tangent.curvature[k]) = (side, normal, curvature);
        tangent.mixing[k] = mixing(curvature + beyond, a0);
        tangent.projected[k] = project(normal, against);
    }
    tangent.slip_count = slips;
    for k in 0..state.q.len() {
        if problem.bound[k] > 0.0 {
            problem.bound[k] = march.resolved(k).response.bound;
        }
    }
}
