//! Nested iteration: the coarsest grid first, each from what the one before it found.

use super::forces::Forces;
use super::levels::{interpolate, restrict, Level};
use super::newton;
use super::shift::{self, Goal};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Outcome;

/// Coarser grids are solved to this residual: what they leave wrong costs more on the finest.
pub const COARSE: f64 = 1e-3;
/// The one next to the finest to this one, where its forces count: they are then right to some 1e-5 of mu N.
pub const COUNTS: f64 = 1e-4;
/// Iterations at most on each of them.
const COARSE_LIMIT: u64 = 60;

/// What is counted, and who is told.
pub struct Work<'a> {
    pub products: f64,
    /// The residual that the grid next to the finest is solved to, at least.
    pub coarse: f64,
    pub watch: &'a mut dyn FnMut(&Grid, f64) -> bool,
}

/// Solves the finest of `levels`; `nested`: from the coarsest on. `mostly_slips`: of the step before.
pub fn solve(
    levels: &mut [Level],
    forces: Forces,
    (nested, mostly_slips): (bool, bool),
    (tolerance, limit): (f64, u64),
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
            let end = one(level, forces, forces.any(), (tolerance.max(coarse), COARSE_LIMIT), part, work)?;
            if end == Outcome::Cancelled {
                return Ok(end);
            }
            let (fine, coarse) = levels.split_at_mut(l);
            interpolate(&coarse[0], &mut fine[l - 1])?;
            let Level { problem, state, .. } = &mut fine[l - 1];
            problem.refresh_to(state, tolerance);
        }
    }
    let level = &mut levels[0];
    one(level, forces, forces.any() || mostly_slips, (tolerance, limit), 1.0, work)
}

/// Solves one grid from what it holds: by gradients, and where they stall or forces are given by Newton's method.
fn one(
    level: &mut Level,
    forces: Forces,
    newton_first: bool,
    (tolerance, limit): (f64, u64),
    part: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let Level { problem, state, memory, .. } = level;
    let grid = problem.grid;
    let mut end = Outcome::Stagnated;
    // Nothing moves, and nothing did.
    if problem.rms_slip() == 0.0 && !forces.any() {
        state.unload(problem.threads());
        return Ok(Outcome::Converged);
    }
    let only_newton = forces.any() || problem.operators.rolling.is_some();
    for newton in [newton_first || only_newton, true, only_newton] {
        let watch = &mut |residual: f64| (work.watch)(&grid, residual);
        let certified = part == 1.0;
        let goal = Goal { tolerance, limit, certified, watch };
        end = if newton {
            newton::solve(problem, state, (&mut memory.tangent, &mut memory.fields), forces, goal)?
        } else {
            shift::solve(problem, state, memory, goal)?
        };
        if end != Outcome::Stagnated {
            break;
        }
        log::info!("tangential problem: no further progress, Newton's method goes on");
    }
    if end != Outcome::Converged && !state.is_exact && part == 1.0 {
        problem.refresh(state);
    }
    work.products += part * problem.take_products() as f64;
    Ok(end)
}
