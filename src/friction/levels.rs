//! Nested iteration: the problem on coarser grids, coarsest first, each the start of the next.
//!
//! ```text
//! g of a coarse element: the mean of its children's, 0 where there is none;  w: the mean of those in C,
//!                                                                              in steady rolling times 2: a step is 2 dq long
//! start of the next grid: q per area in C, interpolated between the centres of those in C, and back into the disc;
//!                         where all that it is interpolated from slip, g times the direction of q/g; in steady rolling g times q/g
//! ```
//!
//! Grids are coarsened by two until the shorter side has fewer than 24 elements, a single row along itself only.

use super::certificate::ON_THE_CIRCLE;
use super::extension::neighbours;
use super::march::Rolling;
use super::operators::Operators;
use super::problem::{add, onto_disc, plus, square, Problem, State};
use super::quadrant::Quadrant;
use super::shift::Memory;
use super::{Tangential, Vector};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use crate::threads::Threads;

/// A side with fewer elements is not coarsened.
const COARSEST: usize = 24;

/// One grid: its problem, its unknowns, the memory of its iteration.
pub struct Level {
    pub problem: Problem,
    pub state: State,
    pub memory: Memory,
    /// Where iterations are not prepared yet: the coefficients, and whether directions may be multiplied in single precision.
    pending: Option<(Quadrant, bool)>,
}

impl Level {
    /// Nothing slides. Iterations are to be [prepared](Level::prepare).
    fn new(grid: Grid, operators: Operators) -> Result<Level> {
        let (state, memory) = (State::new(grid.len())?, Memory::default());
        Ok(Level { problem: Problem::new(grid, operators)?, state, memory, pending: None })
    }

    /// The finest grid alone, for products only before it is [ready to iterate](Level::be_ready).
    pub fn alone(tangential: &Tangential, grid: Grid, single: bool, threads: &Threads) -> Result<Level> {
        let quadrant = Quadrant::new(tangential, &grid, (0.0, 0.0), &threads.suited_to(grid.len()))?;
        let operators = Operators::new(&quadrant, &grid, None, false, threads)?;
        Ok(Level { pending: Some((quadrant, single)), ..Level::new(grid, operators)? })
    }

    /// Prepares iterations, if they are not.
    pub fn be_ready(&mut self) -> Result<()> {
        match self.pending.take() {
            Some((quadrant, single)) => self.prepare(&quadrant, single),
            None => Ok(()),
        }
    }

    fn prepare(&mut self, quadrant: &Quadrant, single: bool) -> Result<()> {
        self.problem.prepare(quadrant, single)?;
        self.memory = Memory::new(self.problem.grid.len())?;
        Ok(())
    }

    /// The force, and the creepages that were found, of a step of rolling.
    pub fn found(&self) -> (Vector, Vector) {
        let Problem { grid, offset, operators, .. } = &self.problem;
        let sum = super::forces::sum_of(&self.problem, &self.state.q);
        let distance = operators.step().map_or(1.0, |rolling| rolling.distance);
        (sum.map(|sum| sum * grid.element_area()), offset.map(|offset| offset / distance))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.problem.bytes() + 12 * self.state.q.len() * size_of::<Vector>() + self.memory.fields.bytes()
    }
}

/// The next coarser grid, if there is one.
fn coarser(grid: &Grid) -> Option<Grid> {
    let Grid { mx, my, dx, dy } = *grid;
    let (in_x, in_y) = match (mx, my) {
        (_, 1) => (mx >= COARSEST, false),
        (1, _) => (false, my >= COARSEST),
        _ => (mx.min(my) >= COARSEST, mx.min(my) >= COARSEST),
    };
    if !in_x && !in_y {
        return None;
    }
    let half = |m: usize, d: f64, is_coarsened: bool| if is_coarsened { (m.div_ceil(2), 2.0 * d) } else { (m, d) };
    let ((mx, dx), (my, dy)) = (half(mx, dx, in_x), half(my, dy, in_y));
    Some(Grid { mx, my, dx, dy })
}

/// The grids of a box, the finest first. `single`: whether directions may be multiplied in single precision; on coarser grids that
/// serves for all.
pub fn levels(
    tangential: &Tangential,
    grid: Grid,
    rolling: Option<Rolling>,
    single: bool,
    threads: &Threads,
) -> Result<Vec<Level>> {
    let by = |rolling: Option<Rolling>| rolling.map_or((0.0, 0.0), |rolling| rolling.by);
    let mut quadrant = Quadrant::new(tangential, &grid, by(rolling), &threads.suited_to(grid.len()))?;
    let mut finest = Level::new(grid, Operators::new(&quadrant, &grid, rolling, false, threads)?)?;
    finest.prepare(&quadrant, single)?;
    let mut levels = vec![finest];
    let (mut last, mut rolling) = (grid, rolling);
    while let Some(grid) = coarser(&last) {
        let tangential = quadrant.tangential().for_element(grid.dx, grid.dy)?;
        rolling = rolling.map(|rolling| rolling.on(&last, &grid));
        quadrant = quadrant.coarser(&tangential, &grid, by(rolling), &threads.suited_to(grid.len()))?;
        let mut level = Level::new(grid, Operators::new(&quadrant, &grid, rolling, single, threads)?)?;
        level.prepare(&quadrant, single)?;
        levels.push(level);
        last = grid;
    }
    Ok(levels)
}

/// Elements of a grid that make one of the next coarser.
fn children(fine: &Grid, coarse: &Grid) -> usize {
    (1 + usize::from(coarse.dx > fine.dx)) * (1 + usize::from(coarse.dy > fine.dy))
}

/// g, w and what goes with them on the next coarser grid; q = 0.
pub fn restrict(fine: &Problem, coarse: &mut Level) {
    let Level { problem, state, .. } = coarse;
    let (from, to) = (fine.grid, problem.grid);
    let longer = step_ratio(problem, fine);
    let all = children(&from, &to);
    for i in 0..to.len() {
        let (mut bound, mut slip, mut rigid, mut count) = (0.0, [0.0; 2], [0.0; 2], 0);
        for child in to.children(&from, i).filter(|&child| fine.bound[child] > 0.0) {
            bound += fine.bound[child];
            slip = add(slip, fine.slip[child]);
            rigid = add(rigid, fine.rigid[child]);
            count += 1;
        }
        let share = longer / f64::from(count.max(1));
        problem.bound[i] = bound / all as f64;
        problem.slip[i] = [share * slip[0], share * slip[1]];
        problem.rigid[i] = [share * rigid[0], share * rigid[1]];
    }
    (problem.offset, problem.scale) = (fine.offset.map(|w| longer * w), fine.scale);
    problem.bound_changed();
    state.unload();
}

/// How much longer a step of steady rolling is on a coarse grid.
fn step_ratio(coarse: &Problem, fine: &Problem) -> f64 {
    match (coarse.operators.step(), fine.operators.step()) {
        (Some(coarse), Some(fine)) => coarse.distance / fine.distance,
        _ => 1.0,
    }
}

/// q on the next finer grid, from the coarser one.
pub fn interpolate(coarse: &Level, fine: &mut Level) -> Result<()> {
    let (from, to) = (coarse.problem.grid, fine.problem.grid);
    // Elements of a coarse one by those of them in C: q carries on C what it carried on the whole.
    let mut shares: Vec<f64> = zeros(from.len(), "the start from a coarser grid")?;
    fine.problem.threads().for_each_plain_row(&mut shares, from.mx, |iy, row| {
        for (ix, share) in row.iter_mut().enumerate() {
            let all = from.children(&to, iy * from.mx + ix);
            let in_contact = all.filter(|&child| fine.problem.bound[child] > 0.0).count();
            *share = children(&to, &from) as f64 / in_contact.max(1) as f64;
        }
    });
    // Behind the leading edge tractions of steady rolling begin as their bound does.
    let is_rolling = fine.problem.operators.rolling.is_some();
    let (x, y) = (places(to.mx, from.mx), places(to.my, from.my));
    let between = |i: usize| {
        let g = fine.problem.bound[i];
        if !(g > 0.0) {
            return [0.0; 2];
        }
        let (mut direction, mut traction, mut weights, mut all_slip) = ([0.0; 2], [0.0; 2], 0.0, true);
        for (column, in_x) in x[i % to.mx] {
            for (row, in_y) in y[i / to.mx] {
                let k = row * from.mx + column;
                let (bound, weight) = (coarse.problem.bound[k], in_x * in_y);
                if !(bound > 0.0) || weight == 0.0 {
                    continue;
                }
                let (q, share) = (coarse.state.q[k], shares[k]);
                all_slip &= square(q).sqrt() >= ON_THE_CIRCLE * bound;
                direction = plus(direction, weight / bound, q);
                traction = plus(traction, weight * share, q);
                weights += weight;
            }
        }
        let length = square(direction).sqrt();
        if weights == 0.0 {
            [0.0; 2]
        } else if all_slip && length > 0.0 {
            onto_disc(direction.map(|v| g * v / length), g)
        } else if is_rolling {
            onto_disc(direction.map(|v| g * v / weights), g)
        } else {
            onto_disc(traction.map(|v| v / weights), g)
        }
    };
    fine.problem.threads().for_each_plain_row(&mut fine.state.q, to.mx, |iy, row| {
        row.iter_mut().enumerate().for_each(|(ix, q)| *q = between(iy * to.mx + ix));
    });
    let shorter = 1.0 / step_ratio(&coarse.problem, &fine.problem);
    fine.problem.offset = coarse.problem.offset.map(|w| shorter * w);
    fine.state.is_exact = false;
    Ok(())
}

/// Of each fine place the two coarse ones between which its centre lies, with their weights.
fn places(fine: usize, coarse: usize) -> Vec<[(usize, f64); 2]> {
    let of = |i: usize| if fine == coarse { [(i, 1.0), (i, 0.0)] } else { neighbours(i, coarse) };
    (0..fine).map(of).collect()
}
