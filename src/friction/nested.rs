//! Nested iteration: the coarsest grid first, each from what the one before it found.
//!
//! One grid is solved in several ways, each from where the one before it stalled: by gradients, and where they stall, in steady rolling, or
//! where forces are given by Newton's method.

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
use crate::progress::Outcome;

/// Coarser grids are solved to this residual: what they leave wrong costs more on the finest.
pub const COARSE: f64 = 1e-3;
/// The one next to the finest to this one, where its forces count: they are then right to some 1e-5 of mu N.
pub const COUNTS: f64 = 1e-4;
/// Gradients on each of them at most.
const COARSE_LIMIT: u64 = 60;
/// All of them together make this part of the products at most.
const COARSE_SHARE: f64 = 0.5;
/// Of what is left a way makes this part at most, if another can follow.
const SHARE: f64 = 0.4;

/// Creepages and tractions follow each other where more than this part of C slips.
const MOSTLY_SLIP: f64 = 0.8;
/// Where nearly all slips, Newton's method with balanced creepages comes first. It has so many products: half of 3800 random scenes then take less than
/// half of the products, and where one element alone sticks the method goes round in circles.
const TRIED: u64 = 8;
/// Plain Newton steps come next. They may go round in circles as well.
const PLAIN: u64 = 60;
/// Products that certificates take at the end of a solve that is not done: they are kept back.
const KEPT_BACK: u64 = 5;

/// The counts, and the caller's callback.
pub struct Work<'a> {
    /// On all grids, in products on the finest; and at most so many.
    pub products: f64,
    pub limit: u64,
    /// The residual that the grid next to the finest is solved to, at least.
    pub coarse: f64,
    pub watch: &'a mut dyn FnMut(&Grid, f64) -> bool,
}

/// One way to solve a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Gradients,
    Newton(Manner),
    Downhill,
    Bracket,
}

impl Way {
    /// As the log calls it.
    fn name(self) -> &'static str {
        match self {
            Way::Gradients => "the gradients' method",
            Way::Newton(_) => "Newton's method",
            Way::Downhill => "the projected Newton method",
            Way::Bracket => "a bracket of creepages",
        }
    }
}

/// Solves the finest of `levels`; `nested`: from the coarsest on. `mostly_slips`: of the step before.
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
            let coarse = if l == 1 { work.coarse } else { COARSE };
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

/// The ways to solve a grid, in turns, with the products of each at most. `slips`: by given forces, and nearly all of it.
fn ways(forces: Forces, newton_first: bool, (is_rolling, certified): (bool, bool), slips: bool) -> Vec<(Way, u64)> {
    use Way::{Gradients, Newton};
    let as_many = |ways: &[Way]| ways.iter().map(|way| (*way, u64::MAX)).collect();
    if forces.any() && !certified {
        // The next grid starts from what they leave.
        as_many(&[Newton(Manner::Plain), Newton(Manner::Balanced)])
    } else if slips {
        vec![(Newton(Manner::Balanced), TRIED), (Newton(Manner::Plain), PLAIN), (Way::Bracket, u64::MAX)]
    } else if forces.any() {
        as_many(&[Newton(Manner::Plain), Newton(Manner::Balanced), Newton(Manner::InTurns), Way::Bracket])
    } else if is_rolling {
        as_many(&[Newton(Manner::Plain), Newton(Manner::Bold), Newton(Manner::Plain)])
    } else {
        as_many(&[if newton_first { Newton(Manner::Plain) } else { Gradients }, Newton(Manner::Plain), Way::Downhill])
    }
}

/// Whether given forces let nearly all of C slip, as far as the displacements of now tell: with creepages by which the natural map carries them.
fn mostly_slips(level: &mut Level, forces: Forces) -> Result<bool> {
    let Level { problem, state, memory, .. } = level;
    let (offset, rho) = (problem.offset, 1.0 / compliance(problem));
    memory.tangent.fit(problem.grid.len())?;
    problem.offset = balanced(problem, state, rho, forces);
    memory.tangent.predict(problem, state, rho);
    problem.offset = offset;
    Ok(memory.tangent.slip_count as f64 > MOSTLY_SLIP * problem.count() as f64)
}

/// Products that a grid may make, if it is the finest or all coarser ones together.
fn products_of(limit: u64, certified: bool) -> f64 {
    if certified {
        limit.saturating_sub(KEPT_BACK).max(limit / 2) as f64
    } else {
        COARSE_SHARE * limit as f64
    }
}

/// Solves one grid from what it holds; `part`: its products, in products on the finest.
fn one(
    level: &mut Level,
    (forces, newton_first): (Forces, bool),
    tolerance: f64,
    part: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let Level { problem, state, .. } = &mut *level;
    let grid = problem.grid;
    // Nothing moves, and nothing did: forces of 0 take no creepage then.
    let is_held = !forces.any() && problem.offset != [0.0; 2];
    if forces.are_zero() && !is_held && problem.rms(|i| problem.slip[i]) == 0.0 {
        problem.offset = [0.0; 2];
        state.unload(problem.threads());
        return Ok(Outcome::Converged);
    }
    problem.given = if forces.any() { problem.rms(|i| problem.rigid[i]) } else { 0.0 };
    let certified = part == 1.0;
    let (mut end, mut best) = (Outcome::Stagnated, Best::none());
    let all = products_of(work.limit, certified);
    let slips = forces.any() && certified && mostly_slips(level, forces)?;
    let ways = ways(forces, newton_first, (level.problem.operators.rolling.is_some(), certified), slips);
    for (k, &(way, most)) in ways.iter().enumerate() {
        let Level { problem, state, memory, .. } = &mut *level;
        let left = ((all - work.products) / part).max(0.0);
        // In turns where nearly all slips.
        let slipping = memory.tangent.slip_count as f64;
        if way == Way::Newton(Manner::InTurns) && slipping < MOSTLY_SLIP * problem.count() as f64 {
            continue;
        }
        let another = k + 1 < ways.len();
        let limit = (if another { SHARE * left } else { left }.ceil() as u64).min(most);
        if limit == 0 {
            end = Outcome::IterationLimit;
            break;
        }
        if k > 0 {
            log::info!("tangential problem: no further progress, {} goes on", way.name());
            best.take_up(problem, state);
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

/// Solves one grid by one way.
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
