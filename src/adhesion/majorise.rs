//! Majorise-minimise iteration, called descent: each step freezes the attraction sigma and solves the contact problem that results.
//!
//! ```text
//! sigma_k = sigma(e);    e = h - approach - A sigma_k + A q,  q >= 0,  e >= 0,  q e = 0;    p = q - sigma_k
//! ```
//!
//! W is convex. Therefore the energy with sigma_k is an upper bound of the energy, and equals it at the last iterate, so that each step lowers
//! the energy, however strong the attraction is.

use super::level::{FrozenSolver, Level, MakeFrozen};
use super::newton::{End, Goal};
use super::unknowns::Measured;
use crate::contact::Freshness;
use crate::error::Result;
use crate::methods::fields::{self, BLOCK};
use crate::progress::{Monitor, Outcome};
use crate::scene::Load;

/// The tolerance of a frozen problem, relative to the residual of the law; at most LARGEST_TOLERANCE.
const TOLERANCE_PER_ERROR: f64 = 0.05;
const LARGEST_TOLERANCE: f64 = 1e-2;
/// The smallest tolerance of a frozen problem, relative to the goal's.
const TOLERANCE_PER_GOAL: f64 = 0.5;

/// How descent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Descent {
    /// As Newton's method may end: solved, failed or interrupted.
    By(End),
    /// The given force pulls more than the frozen attraction holds: the bodies part.
    Parted,
}

/// The options of descent.
#[derive(Clone, Copy)]
pub struct Steps<'a> {
    /// The largest number of steps.
    pub most: u64,
    /// Whether the first step solves the contact problem without attraction.
    pub starts_without_attraction: bool,
    /// Makes the solver of frozen problems.
    pub make: MakeFrozen<'a>,
}

/// Descends from the current iterate of the level. The contact area and u need not be consistent with p.
pub fn descend(
    level: &mut Level,
    goal: Goal,
    steps: Steps<'_>,
    monitor: &mut Monitor<'_>,
) -> Result<(Descent, Measured)> {
    let mut frozen_solver = level.take_frozen(steps.make)?;
    let ended = descend_with(level, &mut frozen_solver, goal, steps, monitor);
    level.give_frozen(frozen_solver);
    ended
}

/// Descends with this solver of frozen problems.
fn descend_with(
    level: &mut Level,
    frozen_solver: &mut FrozenSolver,
    goal: Goal,
    steps: Steps<'_>,
    monitor: &mut Monitor<'_>,
) -> Result<(Descent, Measured)> {
    let mut measured = level.measure(false, goal.wanted);
    for step in 0..steps.most {
        if goal.is_interrupted(monitor) {
            return Ok((Descent::By(End::Interrupted), measured));
        }
        let off = if step == 0 { LARGEST_TOLERANCE / TOLERANCE_PER_ERROR } else { measured.law };
        let tolerance = (TOLERANCE_PER_ERROR * off).min(LARGEST_TOLERANCE).max(TOLERANCE_PER_GOAL * goal.tolerance);
        match take_step(level, frozen_solver, (goal, tolerance), steps.starts_without_attraction && step == 0, monitor)?
        {
            Step::Parted => return Ok((Descent::Parted, measured)),
            Step::Unsolved => return Ok((Descent::By(End::Failed), measured)),
            Step::Solved => {}
        }
        measured = level.measure(false, goal.wanted);
        if measured.worst() < goal.tolerance {
            if goal.certified {
                level.refresh()?;
                measured = level.measure(false, goal.wanted);
                level.count_products(monitor);
            }
            if measured.worst() < goal.tolerance {
                return Ok((Descent::By(End::Solved), measured));
            }
        }
    }
    Ok((Descent::By(End::Failed), measured))
}

/// How a step ended.
enum Step {
    /// The level has the next iterate, to the tolerance or as near as the cycles allow.
    Solved,
    /// The contact problem failed without a cycle, and would fail again.
    Unsolved,
    /// No contact pressures carry the given force.
    Parted,
}

/// Makes one step. `tolerance`: that of the contact problem.
fn take_step(
    level: &mut Level,
    (frozen, state): &mut FrozenSolver,
    (goal, tolerance): (Goal, f64),
    starts_without_attraction: bool,
    monitor: &mut Monitor<'_>,
) -> Result<Step> {
    let (n, threads) = (level.now.u.len(), level.problem.threads.clone());
    let mut fields = std::mem::take(&mut level.fields);
    let (mut attraction, mut product) = (fields.take(n)?, fields.take(n)?);
    let (surface, now) = (&level.surface, &level.now);
    fields::fill(&threads, &mut attraction, |i| {
        [if starts_without_attraction { 0.0 } else { surface.traction(i, surface.distance(i, now)) }]
    });
    let [held] = fields::sum(&threads, n, |i| attraction[i]);
    let problem = &mut level.problem;
    problem.displace(attraction.as_flattened(), product.as_flattened_mut())?;
    let (surface, now) = (&level.surface, &level.now);
    threads.for_each_plain_row(&mut state.h, BLOCK, |k, h| {
        h.iter_mut().zip(k * BLOCK..).for_each(|(h, i)| *h = surface.h[i] - product[i][0]);
    });
    threads.for_each_row_pair((&mut state.p, BLOCK), (&mut state.contact, BLOCK), |k, p, contact| {
        for ((p, contact), i) in p.iter_mut().zip(contact).zip(k * BLOCK..) {
            let q = now.p.field[i][0] + attraction[i][0];
            *p = if q > 0.0 { q } else { 0.0 };
            *contact = *p > 0.0;
        }
    });
    state.approach = level.now.approach();
    let area = problem.grid.element_area();
    state.load = match goal.wanted {
        None => Load::Approach(state.approach),
        Some(wanted) => Load::Force((wanted + held) * area),
    };
    state.u_is = Freshness::Stale;
    let is_carried = !matches!(state.load, Load::Force(force) if !(force > 0.0));
    let mut step = Step::Parted;
    if is_carried {
        let cycles = monitor.count.cycles;
        let left = goal.most.saturating_sub(cycles).max(1);
        let outcome = frozen.solve(problem, state, (tolerance, left), monitor)?;
        log::debug!("the contact problem of a frozen_solver attraction: {outcome:?}");
        let failed = outcome == Outcome::Stagnated && monitor.count.cycles == cycles;
        step = if failed { Step::Unsolved } else { Step::Solved };
        fields::fill(&threads, &mut level.now.p.field, |i| [state.p[i] - attraction[i][0]]);
        fields::fill(&threads, &mut level.now.u, |i| [state.u[i] - product[i][0]]);
        level.now.p.border = [state.approach];
    }
    [attraction, product].into_iter().for_each(|field| fields.give(field));
    level.fields = fields;
    level.count_products(monitor);
    Ok(step)
}
