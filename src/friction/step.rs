//! One step of Newton's method (see [`newton`](super::newton)).
//!
//! It starts with the step onto the circles and a part of the preconditioned residual, so that given forces are met:
//!
//! ```text
//! x0 = g n - q on slip,   z1 = theta M P(-s),   theta = 1 - 1/5/(1 + D/(10 a0)),   less Y dc so that sum(q + x0 + z1) = F/(dx dy)
//! ```
//!
//! If the curvature D dominates, M is near the inverse of the system, and theta near 1. One product serves x0 and z1; flexible GMRES does the rest.
//! If x0 is short, the step starts from 0, and all products are GMRES'.

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

/// Most directions of a linear solve.
pub const DIRECTIONS: usize = 40;
/// The last linear solve stops at ENOUGH times the tolerance, and none at more than the relative residual LEAST_GAIN.
const ENOUGH: f64 = 0.9;
const LEAST_GAIN: f64 = 0.5;
/// theta on stick, and the weight of D in its growth to 1.
const LEAST_THETA: f64 = 0.8;
const THETA_GROWTH: f64 = 0.1;

/// The step onto the circles is short if three ratios are at most this: its displacement over the residual at which the
/// linear solve ends, its size relative to the bounds over the relative residual, and the slips of elements inside
/// their circles over the projected slips. (If slips are 1e10 times the displacements by tractions, the projected slips
/// are round-off, and a step of 1e-6 of the bounds is the residual.)
const SHORT_STEP: f64 = 0.1;

/// The kind of a step.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The relative residual of the linear solve.
    pub inner: f64,
    /// Most directions of the linear solve.
    pub most: usize,
    /// The relative residual before the step.
    pub residual: f64,
    /// The length of the step, as a part of the full one.
    pub length: f64,
}

/// The start of a step.
struct Start {
    /// `x0 + z1`.
    gained: Vec<Vector>,
    /// z1.
    along: Vec<Vector>,
    /// dc.
    by: Vector,
}

/// The relative residual of a linear solve, `inner` far from the tolerance.
pub fn enough(inner: f64, tolerance: f64, residual: f64) -> f64 {
    inner.max((ENOUGH * tolerance / residual).min(LEAST_GAIN))
}

/// An estimate of the displacement by unit tractions on all of C; in steady rolling, where near and far tractions cancel in a step, by one on a
/// single element.
pub fn compliance(problem: &Problem) -> f64 {
    let own = problem.operators.self_influence;
    match problem.operators.rolling {
        Some(_) => own,
        None => own * (problem.count().max(1) as f64).sqrt(),
    }
}

/// x0 at element i.
#[inline]
fn to_the_circle(tangent: &Tangent, bound: &[f64], state: &State, i: usize) -> Vector {
    match tangent.side[i] {
        Side::Slip => plus(tangent.normal[i].map(|n| bound[i] * n), -1.0, state.q[i]),
        _ => [0.0; 2],
    }
}

/// The norms of x0 and of the slips of elements that slip inside their circles, which certificates count as slips of stick.
fn way_to_the_circles(problem: &Problem, tangent: &Tangent, state: &State) -> [f64; 2] {
    let squared = |i: usize| {
        let is_inside = tangent.side[i] == Side::Slip && !is_on_circle(state.q[i], problem.bound[i]);
        let slip = if is_inside { square(problem.slip_at(i, &state.u)) } else { 0.0 };
        [square(to_the_circle(tangent, &problem.bound, state, i)), slip]
    };
    fields::sum(problem.threads(), problem.bound.len(), squared).map(f64::sqrt)
}

impl Start {
    fn nothing(n: usize, threads: &Threads, fields: &mut Fields) -> Result<Start> {
        Ok(Start { gained: fields.zeros(n, threads)?, along: fields.zeros(n, threads)?, by: [0.0; 2] })
    }

    fn new(system: &mut TangentSystem<'_>, state: &State, forces: Forces, fields: &mut Fields) -> Result<Start> {
        let (n, threads, tangent) = (state.q.len(), system.problem.threads().clone(), system.tangent);
        let mut along = fields.take(n)?;
        system.precondition_field(&tangent.projected, &mut along);
        let (a0, bound) = (system.problem.operators.self_influence, &system.problem.bound);
        fields::map(&threads, &mut along, |i, z| {
            let theta = 1.0 - (1.0 - LEAST_THETA) / (1.0 + THETA_GROWTH * tangent.curvature[i] / a0);
            z.map(|z| theta * z)
        });
        let mut gained = fields.take(n)?;
        fields::fill(&threads, &mut gained, |i| add(to_the_circle(tangent, bound, state, i), along[i]));
        let missing = forces.less(|| sum_of_both(system.problem, &state.q, &gained));
        let by = system.border.creepages(missing.map(|value| -value));
        system.border.balance(&threads, by, &mut along);
        system.border.balance(&threads, by, &mut gained);
        Ok(Start { gained, along, by })
    }
}

/// The start of a step only, feasible to the last bit, with a fresh product. `by_step`: with the part of the preconditioned residual.
pub fn polish(
    problem: &mut Problem,
    state: &mut State,
    (tangent, by_step): (&Tangent, bool),
    forces: Forces,
    fields: &mut Fields,
) -> Result<()> {
    if !by_step {
        return settle(problem, state, tangent, fields);
    }
    let mut system = TangentSystem::new(problem, tangent, forces, fields)?;
    let Start { gained, along, by } = Start::new(&mut system, state, forces, fields)?;
    system.give(fields);
    problem.update = problem.rms_of(fields::dot(problem.threads(), &gained, &gained));
    fields::add_all(problem.threads(), &mut state.q, &[(1.0, &gained)]);
    problem.offset = add(problem.offset, by);
    [gained, along].into_iter().for_each(|field| fields.give(field));
    problem.refresh(state);
    Ok(())
}

/// [`polish`] by the step onto the circles alone.
fn settle(problem: &mut Problem, state: &mut State, tangent: &Tangent, fields: &mut Fields) -> Result<()> {
    let mut way = fields.take(state.q.len())?;
    fields::fill(problem.threads(), &mut way, |i| to_the_circle(tangent, &problem.bound, state, i));
    problem.update = problem.rms_of(fields::dot(problem.threads(), &way, &way));
    fields::add_all(problem.threads(), &mut state.q, &[(1.0, &way)]);
    fields.give(way);
    problem.refresh(state);
    Ok(())
}

/// The square of the weight of forces against the field of slips: that of the corresponding slip.
pub fn border_weight(problem: &Problem, state: &State, forces: Forces) -> f64 {
    if !forces.any() {
        return 0.0;
    }
    let (bounds, stiff) = (sum_of_bounds(problem), problem.rms_bound() * compliance(problem));
    let slips = scale(problem, state).max(square(forces.sum).sqrt() / bounds * stiff);
    let slips = if slips > 0.0 { slips } else { stiff };
    (slips / bounds).powi(2) * problem.count() as f64
}

/// One step.
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
    let all = effort.residual * system.problem.rms_bound() * (system.problem.count() as f64).sqrt();
    let is_short = compliance(system.problem) * way <= SHORT_STEP * target
        && way <= SHORT_STEP * all
        && inside <= SHORT_STEP * projected.sqrt();
    let Start { gained, along, by } = if is_short {
        fields::fill(&threads, &mut product, |_| [0.0; 2]);
        Start::nothing(n, &threads, fields)?
    } else {
        let start = Start::new(&mut system, state, forces, fields)?;
        system.multiply(&start.gained, &mut product);
        start
    };
    let mut r = fields.take(n)?;
    fields::fill(&threads, &mut r, |i| {
        let left = plus(
            tangent.projected[i],
            -1.0,
            tangent.project_inside(i, add(product[i], system.problem.weighted(i, by))),
        );
        plus(left, -tangent.curvature[i], along[i])
    });
    fields.give(along);
    let border = forces.less(|| sum_of_both(system.problem, &state.q, &gained));
    let (r, until) = (Bordered { field: r, border }, Until { target, most: effort.most });
    let found = fgmres::solve(&mut system, r, (until, weight), &threads, fields)?;
    let mut gained = Bordered { field: gained, border: by };
    found.add_to(&mut gained, &mut product, &threads, fields);
    system.give(fields);
    problem.update = effort.length * problem.rms_of(fields::dot(&threads, &gained.field, &gained.field));
    fields::add_all(&threads, &mut state.q, &[(effort.length, &gained.field)]);
    fields::add_all(&threads, &mut state.u, &[(effort.length, &product)]);
    fields.give(gained.field);
    fields.give(product);
    problem.offset = plus(problem.offset, effort.length, forces.only_given(gained.border));
    state.is_exact = false;
    Ok(())
}
