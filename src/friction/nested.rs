//! Nested iteration: the coarsest grid is solved first, and each finer grid starts from the interpolated solution on the coarser one.
//!
//! On each grid several methods follow each other ([`ways`]). If one stalls, the next starts from the best state so far. Projected conjugate
//! gradients come first, then Newton's method. Newton's method comes first in steady rolling, with given forces, and if nearly all of C slips at the
//! start.

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

/// The tolerance of coarser grids, if the caller's is not larger. With a larger one the finest grid takes more products.
pub const COARSE_TOLERANCE: f64 = 1e-3;
/// The tolerance of the grid next to the finest if its forces are used for estimates: their error is then about 1e-5 of mu N.
pub const COUNTED_TOLERANCE: f64 = 1e-4;
/// The largest number of iterations of the conjugate gradients on a coarser grid.
const COARSE_LIMIT: u64 = 60;
/// The largest part of all products that coarser grids together may take.
const COARSE_SHARE: f64 = 0.5;
/// The most products of Newton's method with balanced creepages, which comes first near full slip. With it half of 3800 random scenes take less than
/// half of the products. If a single element sticks, the method cycles.
const BALANCED_PRODUCTS: u64 = 8;
/// The most products of Newton's method without balanced creepages, which comes next near full slip, and may cycle as well.
const PLAIN_PRODUCTS: u64 = 60;
/// The products reserved for certificates at the end of a solve that does not converge.
pub const KEPT_BACK: u64 = 5;

/// The products of a solve, and the caller's callback.
pub struct Work<'a> {
    /// The products so far on all grids, counted in products on the finest grid.
    pub products: f64,
    /// The most products, counted likewise.
    pub limit: u64,
    /// The tolerance of the grid next to the finest, if the caller's is not larger.
    pub coarse: f64,
    /// Called with the grid and the residual of each iteration. It returns false to cancel.
    pub watch: &'a mut dyn FnMut(&Grid, f64) -> bool,
}

/// A method that solves the problem of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Projected conjugate gradients (module `shift`).
    Gradients,
    /// The semismooth Newton method (module `newton`).
    Newton(Manner),
    /// The projected Newton method (module `downhill`).
    Downhill,
    /// The search for creepages of given forces (module `bracket`).
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

/// Solves the problem on the finest of `levels`. `nested` tells whether to start on the coarsest one, `mostly_slips` whether nearly all of C slips at
/// the start.
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
            let end = solve_level(level, (forces, forces.any()), tolerance.max(coarse), part, work)?;
            if end == Outcome::Cancelled {
                return Ok(end);
            }
            let (fine, coarse) = levels.split_at_mut(l);
            let Level { problem, state, .. } = &mut fine[l - 1];
            interpolate((&coarse[0].problem, &coarse[0].state), (problem, state))?;
            problem.refresh_to(state, tolerance);
        }
    }
    solve_level(&mut levels[0], (forces, forces.any() || mostly_slips), tolerance, 1.0, work)
}

/// The methods for a grid, in order, with the most products of each. `newton_first` applies to given motions without steady rolling. `certified` is
/// true on the finest grid, `slips` near full slip with given forces.
fn ways(forces: Forces, newton_first: bool, (is_rolling, certified): (bool, bool), slips: bool) -> Vec<(Way, u64)> {
    use Way::{Gradients, Newton};
    let unlimited = |ways: &[Way]| ways.iter().map(|way| (*way, u64::MAX)).collect();
    if forces.any() && !certified {
        // On a coarser grid these need not converge: the next grid starts from their last state.
        unlimited(&[Newton(Manner::Plain), Newton(Manner::Balanced)])
    } else if slips {
        vec![
            (Newton(Manner::Balanced), BALANCED_PRODUCTS),
            (Newton(Manner::Plain), PLAIN_PRODUCTS),
            (Way::Bracket, u64::MAX),
        ]
    } else if forces.any() {
        unlimited(&[Newton(Manner::Plain), Newton(Manner::Balanced), Newton(Manner::InTurns), Way::Bracket])
    } else if is_rolling {
        unlimited(&[Newton(Manner::Plain), Newton(Manner::Balanced), Newton(Manner::Plain)])
    } else {
        unlimited(&[if newton_first { Newton(Manner::Plain) } else { Gradients }, Newton(Manner::Plain), Way::Downhill])
    }
}

/// Predicts whether nearly all of C will slip with given forces, from the present displacements and balanced creepages.
fn mostly_slips(level: &mut Level, forces: Forces) -> Result<bool> {
    let Level { problem, state, memory, .. } = level;
    let (offset, rho) = (problem.offset, 1.0 / compliance(problem));
    memory.tangent.fit(problem.grid.len())?;
    problem.offset = balanced(problem, state, rho, forces);
    memory.tangent.predict(problem, state, rho);
    problem.offset = offset;
    Ok(problem.places.is_mostly_slip(memory.tangent.slip_count))
}

/// The most products up to the end of the finest grid if `certified`, or up to the end of a coarser grid.
fn products_of(limit: u64, certified: bool) -> f64 {
    if certified {
        limit.saturating_sub(KEPT_BACK).max(limit / 2) as f64
    } else {
        COARSE_SHARE * limit as f64
    }
}

/// Solves the problem of one grid from its state, by one method after the other. `part` is the number of its elements over that of the finest grid: a
/// product counts as this part of a product on the finest grid.
fn solve_level(
    level: &mut Level,
    (forces, newton_first): (Forces, bool),
    tolerance: f64,
    part: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let Level { problem, state, .. } = &mut *level;
    let grid = problem.grid;
    // If there is no motion and there are no previous displacements, q = 0 meets forces of 0, with creepages of 0.
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
        // Newton's method in turns is used near full slip only.
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

/// Solves the problem of one grid by one method, from its state.
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
