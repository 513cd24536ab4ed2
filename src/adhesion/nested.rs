//! Nested iteration: the coarsest grid is solved first, then each finer grid from the solution of the coarser one. Coarse grids have longer
//! ranges of attraction, and therefore little hysteresis.

use super::level::{Level, MakeFrozen};
use super::levels::prolong;
use super::majorise::{descend, Descent, Steps};
use super::newton::{End, Goal};
use super::robust::{self, Ended, DESCENT_STEPS};
use super::start::Start;
use crate::error::Result;
use crate::progress::Monitor;
use crate::sums::mean;

/// The tolerance on coarser grids. Larger errors there cost more steps on the finest grid.
pub const COARSE_TOLERANCE: f64 = 1e-2;
/// The number of steps of descent before Newton's method: on the coarsest grid, and on the finest grid for a start from bodies apart.
const COARSEST_DESCENT: u64 = 3;
const DESCENT_FROM_APART: u64 = 12;
/// A start from contact has this additional approach in ranges, which is removed in this number of steps.
const ADDED_APPROACH: f64 = 4.0;
const ADDED_APPROACH_STEPS: u32 = 4;
/// The largest additional approach with two periods, as a fraction of the way to the mean distance.
const LARGEST_CLOSING: f64 = 0.9;

/// Solves the finest of `levels`, from p = 0 on the coarsest, or on the finest for a start from bodies apart.
pub fn solve(
    levels: &mut [Level],
    goal: Goal,
    (start, make): (Start, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Ended> {
    let last = levels.len() - 1;
    if start == Start::Apart && goal.wanted.is_none() {
        let level = &mut levels[0];
        begin(level, goal);
        let steps = Steps { most: DESCENT_FROM_APART, starts_without_attraction: true, make };
        let (end, measured) = descend(level, goal, steps, monitor)?;
        return match end {
            Descent::By(End::Failed) => robust::solve(level, goal, (false, make), monitor),
            end => Ok(Ended { end, measured, is_lost: true }),
        };
    }
    levels[last].fields = std::mem::take(&mut levels[0].fields);
    for l in (1..=last).rev() {
        // After a cancellation no grid is solved; the state is only interpolated to the finest one.
        if !monitor.is_cancelled() {
            monitor.enter_grid();
            let coarse = coarse_goal(levels, l, goal);
            solve_one_grid(levels, l, coarse, (start, make), monitor)?;
        }
        let (fine, coarse) = levels.split_at_mut(l);
        prolong(&mut coarse[0], &mut fine[l - 1])?;
        fine[l - 1].count_products(monitor);
    }
    monitor.enter_grid();
    solve_one_grid(levels, 0, goal, (start, make), monitor)
}

/// The goal on grid `l`. The elements of a coarser grid are larger, so that the same force is a smaller sum of pressures.
pub fn coarse_goal(levels: &[Level], l: usize, goal: Goal) -> Goal {
    let area = |l: usize| levels[l].problem.grid.element_area();
    let wanted = goal.wanted.map(|wanted| wanted * area(0) / area(l));
    let tolerance = if l == 0 { goal.tolerance } else { goal.tolerance.max(COARSE_TOLERANCE) };
    Goal { tolerance, wanted, certified: l == 0, ..goal }
}

/// Solves grid `l`: the coarsest from p = 0, the others from their present state.
fn solve_one_grid(
    levels: &mut [Level],
    l: usize,
    goal: Goal,
    (start, make): (Start, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Ended> {
    let level = &mut levels[l..];
    let (is_coarsest, level) = (level.len() == 1, &mut level[0]);
    if is_coarsest {
        let approach = begin(level, goal);
        if start == Start::Contact && goal.wanted.is_none() {
            return from_contact(level, goal, (approach, make), monitor);
        }
        let steps = Steps { most: COARSEST_DESCENT, starts_without_attraction: true, make };
        let (end, measured) = descend(level, goal, steps, monitor)?;
        if matches!(end, Descent::By(End::Interrupted)) {
            return Ok(Ended { end, measured, is_lost: false });
        }
        if end == Descent::Parted {
            // Without attraction no pressures carry a force of 0. With attraction, descent from p = 0 is far cheaper than Newton's method.
            let steps = Steps { most: DESCENT_STEPS, starts_without_attraction: false, make };
            let (end, measured) = descend(level, goal, steps, monitor)?;
            if end != Descent::By(End::Failed) {
                return Ok(Ended { end, measured, is_lost: true });
            }
        }
    }
    robust::solve(level, goal, (false, make), monitor)
}

/// Sets p = 0 at the given approach, or, for a given force, at the approach of first contact. Returns the approach.
fn begin(level: &mut Level, goal: Goal) -> f64 {
    level.now.unload(&level.problem.threads);
    if goal.wanted.is_some() {
        let lowest = crate::contact::lowest(&level.surface.h);
        level.now.p.border = [if lowest.is_finite() { lowest } else { 0.0 }];
    }
    level.now.approach()
}

/// Solves for a larger approach and decreases it to the given one, so that elements in contact tend to stay in contact.
fn from_contact(
    level: &mut Level,
    goal: Goal,
    (approach, make): (f64, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Ended> {
    let apart = (crate::contact::lowest(&level.surface.h) - approach).max(0.0);
    let deeper =
        Some(apart + ADDED_APPROACH * level.surface.attraction.range).filter(|by| by.is_finite()).unwrap_or(0.0);
    // With two periods no pressure brings the bodies nearer than their mean distance.
    let room = if level.is_mean_free() {
        LARGEST_CLOSING * (mean(&level.surface.h) - approach).max(0.0)
    } else {
        f64::INFINITY
    };
    let deeper = deeper.min(room);
    level.now.p.border = [approach + deeper];
    let first = Goal { tolerance: goal.tolerance.max(COARSE_TOLERANCE), certified: false, ..goal };
    descend(level, first, Steps { most: COARSEST_DESCENT, starts_without_attraction: true, make }, monitor)?;
    for step in (1..=ADDED_APPROACH_STEPS).rev() {
        level.now.p.border = [approach + deeper * f64::from(step) / f64::from(ADDED_APPROACH_STEPS)];
        robust::solve(level, first, (step < ADDED_APPROACH_STEPS, make), monitor)?;
    }
    level.now.p.border = [approach];
    robust::solve(level, goal, (true, make), monitor)
}
