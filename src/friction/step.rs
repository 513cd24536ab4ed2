//! One step of Newton's method (see [`newton`](super::newton)).
//!
//! Flexible GMRES solves the linear system of the step. Its initial guess is `x0 + z1`, the step onto the circles and a part of the preconditioned
//! residual:
//!
//! ```text
//! x0 = g n - q on slip,   z1 = theta M P(-s) - Y dc,   theta = 1 - 1/5/(1 + D/(10 a0)),   dc such that sum(q + x0 + z1) = F/(dx dy)
//! ```
//!
//! M is the preconditioner, and Y are its columns for the creepages (see [`system`](super::system)). If the curvature D dominates, M is near the
//! inverse of the system, and theta is near 1. One product serves x0 and z1 together. If x0 is short, the initial guess is 0: it saves this product.

use super::certificate::{is_on_circle, scale};
use super::forces::{sum_of, sum_of_both, sum_of_bounds, Forces};
use super::plane::{add, plus, square, Vector};
use super::problem::{Problem, State};
use super::system::TangentSystem;
use super::tangent::{Side, Tangent};
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Until};
use crate::methods::fields::{self, Fields};
use crate::threads::Threads;

/// The largest number of search directions of a linear solve.
pub const DIRECTIONS: usize = 40;
/// The linear solve of the last step stops where the residual of the problem would be this times its tolerance.
const ENOUGH: f64 = 0.9;
/// Near the tolerance a linear solve reduces its residual at least by this factor.
const LEAST_GAIN: f64 = 0.5;
/// theta on stick, where D = 0.
const LEAST_THETA: f64 = 0.8;
/// The weight of D/a0 in the growth of theta to 1.
const THETA_GROWTH: f64 = 0.1;

/// x0 is short if each of three ratios is at most this:
///
/// * the displacement by x0, over the residual at which the linear solve ends;
/// * x0 relative to the bounds, over the relative residual before the step;
/// * the slips of slipping elements whose traction is inside the circle, over the projected slips. (If slips are 1e10 times the displacements by
///   tractions, the projected slips are round-off, and an x0 of 1e-6 of the bounds is the residual.)
const SHORT_STEP: f64 = 0.1;

/// How accurately a step is solved, and how much of it is made.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The relative residual at which the linear solve ends.
    pub inner: f64,
    /// The largest number of search directions of the linear solve.
    pub most: usize,
    /// The relative residual of the problem before the step.
    pub residual: f64,
    /// The factor on the solution of the linear system: 1 for a full step.
    pub length: f64,
}

/// The initial guess of a step.
struct InitialGuess {
    /// `x0 + z1`.
    change: Vec<Vector>,
    /// z1.
    z1: Vec<Vector>,
    /// dc.
    creepages: Vector,
}

/// The relative residual at which a linear solve ends: `inner`, or more if the residual of the problem is near its tolerance.
pub fn enough(inner: f64, tolerance: f64, residual: f64) -> f64 {
    inner.max((ENOUGH * tolerance / residual).min(LEAST_GAIN))
}

/// An estimate of the displacement by unit tractions on all of C. In steady rolling it is the change of the displacement in a step by a unit traction
/// on a single element, because the parts of distant tractions cancel.
pub fn compliance(problem: &Problem) -> f64 {
    let a0 = problem.operators.self_influence;
    match problem.operators.rolling {
        Some(_) => a0,
        None => a0 * (problem.count().max(1) as f64).sqrt(),
    }
}

/// x0 of element i.
#[inline]
fn to_the_circle(tangent: &Tangent, bound: &[f64], state: &State, i: usize) -> Vector {
    match tangent.side[i] {
        Side::Slip => plus(tangent.normal[i].map(|n| bound[i] * n), -1.0, state.q[i]),
        _ => [0.0; 2],
    }
}

/// Two norms: that of x0, and that of the slips of elements predicted to slip whose tractions are inside the circle. Certificates count such slips as
/// residuals.
fn way_to_the_circles(problem: &Problem, tangent: &Tangent, state: &State) -> [f64; 2] {
    let squared = |i: usize| {
        let is_inside = tangent.side[i] == Side::Slip && !is_on_circle(state.q[i], problem.bound[i]);
        let slip = if is_inside { square(problem.slip_at(i, &state.u)) } else { 0.0 };
        [square(to_the_circle(tangent, &problem.bound, state, i)), slip]
    };
    fields::sum(problem.threads(), problem.bound.len(), squared).map(f64::sqrt)
}

impl InitialGuess {
    fn zero(n: usize, threads: &Threads, fields: &mut Fields) -> Result<InitialGuess> {
        Ok(InitialGuess { change: fields.zeros(n, threads)?, z1: fields.zeros(n, threads)?, creepages: [0.0; 2] })
    }

    fn new(system: &mut TangentSystem<'_>, state: &State, forces: Forces, fields: &mut Fields) -> Result<InitialGuess> {
        let (n, threads, tangent) = (state.q.len(), system.problem.threads().clone(), system.tangent);
        let mut z1 = fields.take(n)?;
        system.precondition_field(&tangent.projected, &mut z1);
        let (a0, bound) = (system.problem.operators.self_influence, &system.problem.bound);
        fields::map(&threads, &mut z1, |i, z| {
            let theta = 1.0 - (1.0 - LEAST_THETA) / (1.0 + THETA_GROWTH * tangent.curvature[i] / a0);
            z.map(|z| theta * z)
        });
        let mut change = fields.take(n)?;
        fields::fill(&threads, &mut change, |i| add(to_the_circle(tangent, bound, state, i), z1[i]));
        let missing = forces.less(|| sum_of_both(system.problem, &state.q, &change));
        let creepages = system.border.creepages(missing.map(|value| -value));
        system.border.balance(&threads, creepages, &mut z1);
        system.border.balance(&threads, creepages, &mut change);
        Ok(InitialGuess { change, z1, creepages })
    }
}

/// Changes q by the initial guess of a step, or by x0 alone if not `with_z1`. Projects q onto the discs, and computes u by a fresh product.
pub fn polish(
    problem: &mut Problem,
    state: &mut State,
    (tangent, with_z1): (&Tangent, bool),
    forces: Forces,
    fields: &mut Fields,
) -> Result<()> {
    if !with_z1 {
        return settle(problem, state, tangent, fields);
    }
    let mut system = TangentSystem::new(problem, tangent, forces, fields)?;
    let InitialGuess { change, z1, creepages } = InitialGuess::new(&mut system, state, forces, fields)?;
    system.give(fields);
    problem.update = problem.rms_of(fields::dot(problem.threads(), &change, &change));
    fields::add_all(problem.threads(), &mut state.q, &[(1.0, &change)]);
    problem.offset = add(problem.offset, creepages);
    [change, z1].into_iter().for_each(|field| fields.give(field));
    problem.refresh(state);
    Ok(())
}

/// [`polish`] by x0 alone.
fn settle(problem: &mut Problem, state: &mut State, tangent: &Tangent, fields: &mut Fields) -> Result<()> {
    let mut x0 = fields.take(state.q.len())?;
    fields::fill(problem.threads(), &mut x0, |i| to_the_circle(tangent, &problem.bound, state, i));
    problem.update = problem.rms_of(fields::dot(problem.threads(), &x0, &x0));
    fields::add_all(problem.threads(), &mut state.q, &[(1.0, &x0)]);
    fields.give(x0);
    problem.refresh(state);
    Ok(())
}

/// The weight of missing forces in the norm of a bordered residual, `|slips|^2 + weight |missing|^2`. With this weight a missing force of the sum of
/// all bounds counts like a residual of the scale of slips on each element of C.
pub fn border_weight(problem: &Problem, state: &State, forces: Forces) -> f64 {
    if !forces.any() {
        return 0.0;
    }
    let (bounds, displaced) = (sum_of_bounds(problem), problem.rms_bound() * compliance(problem));
    let slips = scale(problem, state).max(square(forces.sum).sqrt() / bounds * displaced);
    let slips = if slips > 0.0 { slips } else { displaced };
    (slips / bounds).powi(2) * problem.count() as f64
}

/// Makes one Newton step: changes q, and u by the products of the linear solve, and the creepages of given forces.
pub fn step(
    problem: &mut Problem,
    state: &mut State,
    tangent: &Tangent,
    (forces, effort): (Forces, Effort),
    fields: &mut Fields,
) -> Result<()> {
    let (n, threads) = (state.q.len(), problem.threads().clone());
    let weight = border_weight(problem, state, forces);
    let missing = forces.less(|| sum_of(problem, &state.q));
    let projected = fields::dot(&threads, &tangent.projected, &tangent.projected);
    let target = effort.inner * projected.max(weight * square(missing)).sqrt();
    let mut system = TangentSystem::new(problem, tangent, forces, fields)?;
    let mut product = fields.take(n)?;
    let [way, inside] = way_to_the_circles(system.problem, tangent, state);
    let residual_of_bounds = effort.residual * system.problem.rms_bound() * (system.problem.count() as f64).sqrt();
    let is_short = compliance(system.problem) * way <= SHORT_STEP * target
        && way <= SHORT_STEP * residual_of_bounds
        && inside <= SHORT_STEP * projected.sqrt();
    let InitialGuess { change, z1, creepages } = if is_short {
        fields::fill(&threads, &mut product, |_| [0.0; 2]);
        InitialGuess::zero(n, &threads, fields)?
    } else {
        let guess = InitialGuess::new(&mut system, state, forces, fields)?;
        system.multiply(&guess.change, &mut product);
        guess
    };
    let mut r = fields.take(n)?;
    fields::fill(&threads, &mut r, |i| {
        let left = plus(
            tangent.projected[i],
            -1.0,
            tangent.project_inside(i, add(product[i], system.problem.weighted(i, creepages))),
        );
        plus(left, -tangent.curvature[i], z1[i])
    });
    fields.give(z1);
    let border = forces.less(|| sum_of_both(system.problem, &state.q, &change));
    let (r, until) = (Bordered { field: r, border }, Until { target, most: effort.most });
    let found = fgmres::solve(&mut system, r, (until, weight), &threads, fields)?;
    let mut change = Bordered { field: change, border: creepages };
    found.add_to(&mut change, &mut product, &threads, fields);
    system.give(fields);
    problem.update = effort.length * problem.rms_of(fields::dot(&threads, &change.field, &change.field));
    fields::add_all(&threads, &mut state.q, &[(effort.length, &change.field)]);
    fields::add_all(&threads, &mut state.u, &[(effort.length, &product)]);
    fields.give(change.field);
    fields.give(product);
    problem.offset = plus(problem.offset, effort.length, forces.only_given(change.border));
    state.is_exact = false;
    Ok(())
}
