//! The two stages of a solve with a law.
//!
//! 1. Lagged steps: the bounds are computed from the slips of the step before, then a Newton step with these fixed bounds follows.
//! 2. Newton steps with the derivatives of the bounds ([`system`](super::system)), below a residual of [`NEWTON_RESIDUAL`]. If such a step makes no
//!    progress, a few lagged steps follow.
//!
//! With given forces the linear systems of both stages are bordered by the creepages. The iteration then starts from the solution of Coulomb's law,
//! with the least creepage that carries the forces.
//!
//! If a layer hardens or softens, or if bounds rise steeply because particles remember lower bounds, lagged steps would alternate. Then all steps are
//! those of the second stage.
//!
//! The tractions of the result lie on their circles (unless bounds rise steeply), and their displacements are a fresh product. The result has two
//! residuals: that of Coulomb's conditions with the bounds `g = |q|` on slip, and that of the bounds, the rms over C of `|q| - g(slip)` on slip over
//! the rms of g, where g(slip) follows from the slips of that product.

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

/// Below this residual steps are Newton steps with the derivatives of the bounds.
pub const NEWTON_RESIDUAL: f64 = 1e-2;
/// So many lagged steps follow if a Newton step does not reduce the residual below [`PROGRESS`] times the least one.
const LAGGED_STEPS: u32 = 5;
/// The relative residual at which the linear solve of a Newton step ends.
const INNER: f64 = 0.2;
/// The same for a lagged step.
const INNER_LAGGED: f64 = 0.35;
/// rho of the natural map in Newton steps with a law, times an element's influence on itself. rho exceeds the largest slope of a bound, so that each
/// element has one state. With 4 solves take 15 to 24 products, with 2 they take 15 to 36 (192 x 176 elements to 1e-6).
const RHO: f64 = 4.0;
/// The iteration ends as stagnated after more than this many steps without a residual below [`GAIN`] times the least one.
const PATIENCE: u32 = 15;
/// See [`PATIENCE`].
const GAIN: f64 = 0.9;

/// The progress of the steps.
struct Course {
    /// The least residual so far.
    least: f64,
    /// The number of steps since the residual fell below [`GAIN`] times the least one.
    since: u32,
    /// The number of lagged steps that still follow before the next Newton step.
    lagged_steps: u32,
    /// Whether the last step was a Newton step.
    was_newton: bool,
    /// Whether bounds must not lag, so that all steps are Newton steps.
    hardens: bool,
}

/// How a solve ended.
pub struct Ended {
    pub outcome: Outcome,
    /// The larger of the two residuals of the module.
    pub residual: f64,
}

/// Iterates from the given state. `has_slipped` tells whether the first slip area is predicted from the state. Otherwise no element slips at first.
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
    let mut course = Course { least: f64::INFINITY, since: 0, lagged_steps: 0, was_newton: false, hardens };
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
    /// Whether the next step is a Newton step, after an iterate with the residual `worst`. None if the iteration ends.
    fn next(&mut self, worst: f64) -> Option<bool> {
        let mut is_newton = self.hardens || worst < NEWTON_RESIDUAL && self.lagged_steps == 0;
        if is_newton && !self.hardens && self.was_newton && worst > PROGRESS * self.least {
            (self.lagged_steps, is_newton) = (LAGGED_STEPS, false);
        }
        self.since = if worst < GAIN * self.least { 0 } else { self.since + 1 };
        self.least = self.least.min(worst);
        self.lagged_steps = if is_newton { 0 } else { self.lagged_steps.saturating_sub(1) };
        self.was_newton = is_newton;
        (self.since <= PATIENCE).then_some(is_newton)
    }
}

/// Predicts stick, slip and bounds of all elements together: the slip of each element is that at which its bound plus rho times the slip is |tau|.
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
