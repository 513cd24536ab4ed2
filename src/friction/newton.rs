//! Semismooth Newton: where forces are given, and where the projected gradients stall.
//!
//! With the prediction of [`Tangent`] (P, D, n) and x0 the way to the circles, each step solves
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = P(-(s + A x0)),        x0 = g n - q on slip
//!                            sum z = F/(dx dy) - sum(q + x0)        for each direction k whose force is given
//! ```
//!
//! with B for A in steady rolling, by flexible GMRES, with the preconditioner of the gradients, bordered by the creepages dc. Then `q += x0 + z`: no line search and no
//! projection between steps (Alart and Curnier 1991; Christensen 2002).

use super::certificate::scale;
use super::fgmres::{self, Bordered, Until};
use super::forces::{sum_of_both, sum_of_bounds, Forces};
use super::problem::{add, plus, square, Problem, State};
use super::shift::Goal;
use super::system::TangentSystem;
use super::tangent::{Side, Tangent};
use super::vectors::{self, Fields};
use crate::error::{Error, Result};
use crate::progress::Outcome;

/// The inner residual relative to that of the step.
const INNER: f64 = 0.15;
const INNER_ROLLING: f64 = 0.2;
/// The last step need not be solved further than to this part of the tolerance.
const ENOUGH: f64 = 0.5;
/// It and rho are cut by this when steps bring nothing, down to the least.
const CUT: f64 = 0.3;
const LEAST_INNER: f64 = 0.01;
/// Directions of a linear solve. Where steps bring nothing, as many as it has unknowns solve it whatever the preconditioner: so many
/// elements of them together may be kept.
const DIRECTIONS: usize = 40;
const KEPT: usize = 1 << 21;
/// Steps then go this part of their way, every other time: two sets of slipping elements may follow each other for ever.
const PART: f64 = 0.5;
/// Steps without the residual falling to this part of its least.
const PATIENCE: u32 = 4;
const PROGRESS: f64 = 0.7;
/// Cuts without progress after which the steps end.
const MOST_CUTS: u32 = 6;
/// Whatever the spin, a creepage far above it carries the force to mu N. Creepages of more than so many times that at which all slips,
/// and the spin's slip, run away: the force differs from mu N by less than a tolerance.
const RUNAWAY: f64 = 1e4;

/// What tractions on all of C displace by, and in steady rolling in a step, where near and far tractions cancel, those on one element.
fn compliance(problem: &Problem) -> f64 {
    let own = problem.operators.self_influence;
    match problem.operators.rolling {
        Some(_) => own,
        None => own * (problem.count().max(1) as f64).sqrt(),
    }
}

/// Iterates from what the state and the offset hold.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    (tangent, fields): (&mut Tangent, &mut Fields),
    forces: Forces,
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Goal { tolerance, limit, certified, watch } = goal;
    let cap = 1.0 / compliance(problem);
    let saturating = problem.rms_bound() / cap;
    let spinning = problem.rms(|i| problem.rigid[i]);
    let (mut factor, mut inner) = (1.0, if problem.operators.rolling.is_some() { INNER_ROLLING } else { INNER });
    let (mut least, mut since, mut cuts, mut iterations) = (f64::INFINITY, 0, 0, 0);
    loop {
        let slip = problem.rms_slip();
        let rho = factor * if slip > 0.0 { cap.min(problem.rms_bound() / slip) } else { cap };
        let sight = tangent.predict(problem, state, rho);
        let missing = if forces.any() { forces.missing(problem, &state.q) } else { 0.0 };
        let worst = sight.residual.max(sight.excess).max(missing);
        if worst < tolerance {
            if state.is_exact || !certified {
                return Ok(Outcome::Converged);
            }
            problem.refresh(state);
            continue;
        }
        if forces.any() && square(problem.offset).sqrt() > RUNAWAY * (saturating + spinning) {
            return Err(Error::Infeasible(format!(
                "the tangential forces are as good as mu N, which no creepages reach: they run away beyond {:?}",
                problem.offset
            )));
        }
        since += 1;
        if worst < PROGRESS * least {
            (least, since, cuts) = (worst, 0, 0);
        }
        if since > PATIENCE {
            (factor, inner, since, cuts) = (factor * CUT, f64::max(inner * CUT, LEAST_INNER), 0, cuts + 1);
        }
        if cuts > MOST_CUTS || !worst.is_finite() {
            return Ok(Outcome::Stagnated);
        }
        if iterations >= limit {
            return Ok(Outcome::IterationLimit);
        }
        iterations += 1;
        let enough = inner.max((ENOUGH * tolerance / worst).min(ENOUGH));
        let is_stuck = factor < 1.0;
        let most =
            if is_stuck { (KEPT / state.q.len()).min(2 * problem.count() + 2).max(DIRECTIONS) } else { DIRECTIONS };
        let effort = Effort { inner: enough, most, length: if cuts % 2 == 1 { PART } else { 1.0 } };
        step(problem, state, tangent, (forces, effort), fields)?;
        if !watch(worst) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// What a step does.
#[derive(Clone, Copy, Debug)]
struct Effort {
    /// The residual of the linear solve, relative.
    inner: f64,
    /// Its directions at most.
    most: usize,
    /// How much of the step is taken.
    length: f64,
}

/// One step.
fn step(
    problem: &mut Problem,
    state: &mut State,
    tangent: &Tangent,
    (forces, effort): (Forces, Effort),
    fields: &mut Fields,
) -> Result<()> {
    let (n, threads) = (state.q.len(), problem.threads().clone());
    let stiff = problem.rms_bound() * compliance(problem);
    let slips = scale(problem, state);
    let border_weight = match forces.any() {
        true => {
            let bounds = sum_of_bounds(problem);
            let part = square(forces.sum).sqrt() / bounds;
            let slips = slips.max(part * stiff);
            let slips = if slips > 0.0 { slips } else { stiff };
            (slips / bounds).powi(2) * problem.count() as f64
        }
        false => 0.0,
    };
    let mut system = TangentSystem::new(problem, tangent, forces, fields)?;
    // The way to the circles, and half of what the preconditioner says: one product for both.
    let mut half = fields.take(n)?;
    system.precondition_field(&tangent.driving, &mut half);
    let (mut gained, bound) = (fields.take(n)?, &system.problem.bound);
    vectors::fill(&threads, &mut gained, |i| {
        let half = half[i].map(|z| 0.5 * z);
        if tangent.side[i] != Side::Slip {
            return half;
        }
        let (g, normal, q) = (bound[i], tangent.normal[i], state.q[i]);
        add([g * normal[0] - q[0], g * normal[1] - q[1]], half)
    });
    let mut product = fields.take(n)?;
    system.multiply(&gained, &mut product);
    let mut r = fields.take(n)?;
    vectors::fill(&threads, &mut r, |i| {
        let left = plus(tangent.driving[i], -1.0, tangent.project_inside(i, product[i]));
        plus(left, -0.5 * tangent.curvature[i], half[i])
    });
    fields.give(half);
    let mut border = [0.0; 2];
    if forces.any() {
        let sum = sum_of_both(system.problem, &state.q, &gained);
        border = forces.only_given([forces.sum[0] - sum[0], forces.sum[1] - sum[1]]);
    }
    let driving = vectors::dot(&threads, &tangent.driving, &tangent.driving);
    let target = effort.inner * driving.max(border_weight * square(border)).sqrt();
    let r = Bordered { field: r, border };
    let found = fgmres::solve(&mut system, r, (Until { target, most: effort.most }, border_weight), &threads, fields)?;
    let mut gained = Bordered { field: gained, border: [0.0; 2] };
    found.add_to(&mut gained, &mut product, &threads, fields);
    system.give(fields);
    vectors::add_all(&threads, &mut state.q, &[(effort.length, &gained.field)]);
    vectors::add_all(&threads, &mut state.u, &[(effort.length, &product)]);
    fields.give(gained.field);
    fields.give(product);
    problem.offset = plus(problem.offset, effort.length, forces.only_given(gained.border));
    state.is_exact = false;
    Ok(())
}
