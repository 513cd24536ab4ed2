//! Nested iteration: the coarsest grid first. Each grid starts from the solution on the previous one.
//!
//! Several methods solve a grid, each from the state at which the one before stalled. Gradients come first, then Newton's method. Newton's method
//! comes first in steady rolling, with given forces, and if most of C slipped in the step before.

use super::balance::balanced;
use super::best::Best;
use super::bracket;
use super::downhill;
use super::forces::Forces;
use super::interpolation::interpolate;
use super::levels::{restrict, Level};
use super::newton::{self, Manner};
use super::shift::{self, Goal};
use super::step::compliance;
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::{Outcome, METHOD_SHARE};

/// Residual on coarser grids: larger errors cost more on the finest grid.
pub const COARSE_TOLERANCE: f64 = 1e-3;
/// Residual on the grid next to the finest if its forces are used: their error is then about 1e-5 of mu N.
pub const COUNTED_TOLERANCE: f64 = 1e-4;
/// Most gradient iterations on each coarser grid.
const COARSE_LIMIT: u64 = 60;
/// Largest part of the products for all coarser grids together.
const COARSE_SHARE: f64 = 0.5;
/// Products of Newton's method with balanced creepages, which comes first near full slip: half of 3800 random scenes then take less than half of the
/// products. If a single element sticks, the method cycles.
const BALANCED_PRODUCTS: u64 = 8;
/// Products of plain Newton steps, which come next and may cycle as well.
const PLAIN_PRODUCTS: u64 = 60;
/// Products reserved for the certificates at the end of an unfinished solve.
pub const KEPT_BACK: u64 = 5;

/// The products so far, and the caller's callback.
pub struct Work<'a> {
    /// Products on all grids, in products on the finest, and their limit.
    pub products: f64,
    pub limit: u64,
    /// Largest residual of the grid next to the finest.
    pub coarse: f64,
    pub watch: &'a mut dyn FnMut(&Grid, f64) -> bool,
}

/// One method to solve a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Gradients,
    Newton(Manner),
    Downhill,
    Bracket,
}

impl Way {
    /// The name in the log.
    fn name(self) -> &'static str {
        match self {
            Way::Gradients => "the gradients' method",
            Way::Newton(_) => "Newton's method",
            Way::Downhill => "the projected Newton method",
            Way::Bracket => "a bracket of creepages",
        }
    }
}

/// Solves the finest of `levels`; `nested` tells whether to start on the coarsest, `mostly_slips` whether most of C slipped in the step before.
pub fn solve(
    levels: &mut [Level],
    forces: Forces,
    (nested, mostly_slips): (bool, bool),
    tolerance: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let finest = levels[0].problem.grid.len() as f64;
    let finest_area = levels[0].problem.grid.element_area();
    if nested {
        for l in 1..levels.len() {
            let (fine, coarse) = levels.split_at_mut(l);
            restrict(&fine[l - 1].problem, &mut coarse[0])?;
        }
        for l in (1..levels.len()).rev() {
            let level = &mut levels[l];
            let part = level.problem.grid.len() as f64 / finest;
            let area = level.problem.grid.element_area() / finest_area;
            let forces = forces.times(1.0 / area);
            let coarse = if l == 1 { work.coarse } else { COARSE_TOLERANCE };
            let end = one(level, (forces, forces.any()), tolerance.max(coarse), part, work)?;
            if end == Outcome::Cancelled {
                return Ok(end);
            }
            let (fine, coarse) = levels.split_at_mut(l);
            let Level { problem, state, .. } = &mut fine[l - 1];
            interpolate((&coarse[0].problem, &coarse[0].state), (problem, state))?;
            problem.refresh_to(state, tolerance);
        }
    }
    one(&mut levels[0], (forces, forces.any() || mostly_slips), tolerance, 1.0, work)
}

/// The methods to solve a grid, in order, with the most products of each. `slips`: with given forces, near full slip.
fn ways(forces: Forces, newton_first: bool, (is_rolling, certified): (bool, bool), slips: bool) -> Vec<(Way, u64)> {
    use Way::{Gradients, Newton};
    let as_many = |ways: &[Way]| ways.iter().map(|way| (*way, u64::MAX)).collect();
    if forces.any() && !certified {
        // On a coarser grid these need not converge: the next grid starts from their last state.
        as_many(&[Newton(Manner::Plain), Newton(Manner::Balanced)])
    } else if slips {
        vec![
            (Newton(Manner::Balanced), BALANCED_PRODUCTS),
            (Newton(Manner::Plain), PLAIN_PRODUCTS),
            (Way::Bracket, u64::MAX),
        ]
    } else if forces.any() {
        as_many(&[Newton(Manner::Plain), Newton(Manner::Balanced), Newton(Manner::InTurns), Way::Bracket])
    } else if is_rolling {
        as_many(&[Newton(Manner::Plain), Newton(Manner::Balanced), Newton(Manner::Plain)])
    } else {
        as_many(&[if newton_first { Newton(Manner::Plain) } else { Gradients }, Newton(Manner::Plain), Way::Downhill])
    }
}

/// Whether given forces let nearly all of C slip. This is predicted from the current displacements with balanced creepages.
fn mostly_slips(level: &mut Level, forces: Forces) -> Result<bool> {
    let Level { problem, state, memory, .. } = level;
    let (offset, rho) = (problem.offset, 1.0 / compliance(problem));
    memory.tangent.fit(problem.grid.len())?;
    problem.offset = balanced(problem, state, rho, forces);
    memory.tangent.predict(problem, state, rho);
    problem.offset = offset;
    Ok(problem.places.is_mostly_slip(memory.tangent.slip_count))
}

/// The products allowed for the finest grid, or for all coarser ones together.
fn products_of(limit: u64, certified: bool) -> f64 {
    if certified {
        limit.saturating_sub(KEPT_BACK).max(limit / 2) as f64
    } else {
        COARSE_SHARE * limit as f64
    }
}

/// Solves one grid from its state; `part` is the work of one of its products, relative to the finest grid.
fn one(
    level: &mut Level,
    (forces, newton_first): (Forces, bool),
    tolerance: f64,
    part: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let Level { problem, state, .. } = &mut *level;
    let grid = problem.grid;
    // Without motion before or now, forces of 0 need no creepage.
    let is_held = !forces.any() && problem.offset != [0.0; 2];
    if forces.are_zero() && !is_held && problem.rms(|i| problem.slip[i]) == 0.0 {
        problem.offset = [0.0; 2];
        state.unload(problem.threads());
        return Ok(Outcome::Converged);
    }
    problem.rms_given_slip = if forces.any() { problem.rms(|i| problem.rigid[i]) } else { 0.0 };
    let certified = part == 1.0;
    let (mut end, mut best) = (Outcome::Stagnated, Best::none());
    let all = products_of(work.limit, certified);
    let slips = forces.any() && certified && mostly_slips(level, forces)?;
    let ways = ways(forces, newton_first, (level.problem.operators.rolling.is_some(), certified), slips);
    for (k, &(way, most)) in ways.iter().enumerate() {
        let Level { problem, state, memory, .. } = &mut *level;
        let left = ((all - work.products) / part).max(0.0);
        // Newton's method in turns serves near full slip only.
        if way == Way::Newton(Manner::InTurns) && !problem.places.is_mostly_slip(memory.tangent.slip_count) {
            continue;
        }
        let another = k + 1 < ways.len();
        let limit = (if another { METHOD_SHARE * left } else { left }.ceil() as u64).min(most);
        if limit == 0 {
            end = Outcome::IterationLimit;
            break;
        }
        if k > 0 {
            log::info!("tangential problem: no further progress, {} goes on", way.name());
            if best.take_up(problem, state) {
                problem.refresh(state);
            }
        }
        let watch = &mut |residual: f64| (work.watch)(&grid, residual);
        let goal = Goal { tolerance, limit, certified, watch };
        end = by(way, level, &mut best, forces, goal)?;
        work.products += part * level.problem.take_products() as f64;
        if end != Outcome::Stagnated && !(end == Outcome::IterationLimit && certified) {
            break;
        }
    }
    let Level { problem, state, memory, .. } = level;
    if end != Outcome::Converged && certified {
        best.restore(problem, state, forces);
    }
    best.give(&mut memory.fields);
    work.products += part * problem.take_products() as f64;
    Ok(end)
}

/// Solves one grid by one method.
fn by(way: Way, level: &mut Level, best: &mut Best, forces: Forces, goal: Goal<'_>) -> Result<Outcome> {
    let Level { problem, state, memory, .. } = level;
    match way {
        Way::Newton(manner) => {
            let memory = (&mut memory.tangent, &mut memory.fields, best);
            newton::solve(problem, state, memory, (forces, manner), goal)
        }
        Way::Downhill => {
            let memory = (&mut memory.tangent, &mut memory.fields, best);
            downhill::solve(problem, state, memory, goal)
        }
        Way::Bracket => bracket::solve(problem, state, (memory, best), forces, goal),
        Way::Gradients => {
            let limit = if goal.certified { goal.limit } else { goal.limit.min(COARSE_LIMIT) };
            shift::solve(problem, state, memory, Goal { limit, ..goal })
        }
    }
}
