//! Nested iteration: the problem on coarser grids, coarsest first, each the start of the next.
//!
//! ```text
//! g of a coarse element: the mean of its children's, 0 where there is none;  w: the mean of those in C,
//!                                                                              in steady rolling times 2: a step is 2 dq long,
//!                                                                              and w a third of the difference ahead
//! start of the next grid: q per area in C, interpolated between the centres of those in C, and back into the disc;
//!                         where all that it is interpolated from slip, g times the direction of q/g; in steady rolling g times q/g
//! ```
//!
//! In steady rolling what slips far turns against its slip: with d the q/g that is interpolated, s = w + u with w of the finer grid and u
//! interpolated, and k = |s|/(a0 g), it starts from `d - 0.3 k^2 s/|s|`, back into the disc. Where spin dominates the slip turns from
//! element to element, and coarse tractions do not show it; where little slips s is the difference of large numbers.
//!
//! Grids are coarsened by two until the shorter side has fewer than 24 elements, a single row along itself only.

use std::iter::successors;

use super::certificate::ON_THE_CIRCLE;
use super::excess::Excess;
use super::extension::{neighbours, Extension};
use super::march::Rolling;
use super::operators::Operators;
use super::problem::{add, onto_disc, plus, square, Problem, State};
use super::quadrant::Quadrant;
use super::shift::Memory;
use super::{Tangential, Vector};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, sparse, zeros};
use crate::threads::Threads;

/// A side with fewer elements is not coarsened.
const COARSEST: usize = 24;
/// How far ahead of a coarse element's centre the slip by spin is taken, of the difference of both steps.
const AHEAD: f64 = 1.0 / 3.0;
/// How much what slips turns against its slip.
const TURNING: f64 = 0.3;

/// One grid: its problem, its unknowns, the memory of its iteration.
pub struct Level {
    pub problem: Problem,
    pub state: State,
    pub memory: Memory,
    /// Where there are no operators yet: whether directions may be multiplied in single precision.
    pending: Option<bool>,
}

impl Level {
    /// Iterations are to be [prepared](Level::prepare).
    fn new(grid: Grid, operators: Operators) -> Result<Level> {
        let (state, memory) = (State::new(grid.len())?, Memory::default());
        Ok(Level { problem: Problem::new(grid, operators)?, state, memory, pending: None })
    }

    /// The finest grid alone, without operators before it is [ready to iterate](Level::be_ready).
    pub fn alone(tangential: &Tangential, grid: Grid, single: bool, threads: &Threads) -> Result<Level> {
        let operators = Operators::none(tangential, &grid, threads);
        Ok(Level { pending: Some(single), ..Level::new(grid, operators)? })
    }

    /// Sets up the operators and prepares iterations, if they are not.
    pub fn be_ready(&mut self) -> Result<()> {
        let Some(single) = self.pending else { return Ok(()) };
        let Operators { tangential, threads, .. } = &self.problem.operators;
        let grid = self.problem.grid;
        let quadrant = Quadrant::new(tangential, &grid, (0.0, 0.0), threads)?;
        self.problem.operators = Operators::new(&quadrant, &grid, None, false, threads)?;
        self.prepare(&quadrant, single)?;
        self.pending = None;
        Ok(())
    }

    fn prepare(&mut self, quadrant: &Quadrant, single: bool) -> Result<()> {
        self.problem.prepare(quadrant, single)
    }

    /// The force, and the creepages that were found, of a step of rolling, in the units of the iterations.
    pub fn found(&self) -> (Vector, Vector) {
        let Problem { grid, offset, operators, .. } = &self.problem;
        let sum = super::forces::sum_of(&self.problem, &self.state.q);
        let distance = operators.step().map_or(1.0, |rolling| rolling.distance);
        (sum.map(|sum| sum * grid.element_area()), offset.map(|offset| offset / distance))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let Level { problem, state, memory, .. } = self;
        let continued = problem.extension.as_ref().map_or(0, Extension::bytes);
        let fields = 2 * state.q.len() * size_of::<Vector>();
        problem.bytes() + problem.places.bytes() + continued + fields + memory.bytes()
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
    let below = || successors(coarser(&grid), coarser);
    let mut levels = sparse(1 + below().count(), "the grids of friction")?;
    levels.push(finest);
    let (mut last, mut rolling) = (grid, rolling);
    for grid in below() {
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
pub fn restrict(fine: &Problem, coarse: &mut Level) -> Result<()> {
    let Level { problem, state, .. } = coarse;
    let (from, to) = (fine.grid, problem.grid);
    let longer = step_ratio(problem, fine);
    let all = children(&from, &to);
    let turned = fine.ahead.map(|w| AHEAD * longer * (longer - 1.0) * w);
    let element = |i: usize| {
        let (mut bound, mut slip, mut rigid, mut count) = (0.0, [0.0; 2], [0.0; 2], 0);
        for child in to.children(&from, i).filter(|&child| fine.bound[child] > 0.0) {
            bound += fine.bound[child];
            slip = add(slip, fine.slip[child]);
            rigid = add(rigid, fine.rigid[child]);
            count += 1;
        }
        let share = longer / f64::from(count.max(1));
        let of_spin = f64::from(count.min(1));
        let of_all = |w: Vector| plus(w.map(|w| share * w), of_spin, turned);
        (bound / all as f64, of_all(slip), of_all(rigid))
    };
    let rows = problem.bound.chunks_mut(to.mx).zip(problem.slip.chunks_mut(to.mx)).zip(problem.rigid.chunks_mut(to.mx));
    let mut rows = collected(rows, "the rows of a coarser grid")?;
    problem.operators.threads.for_each(&mut rows, |iy, ((bound, slip), rigid)| {
        for ix in 0..to.mx {
            (bound[ix], slip[ix], rigid[ix]) = element(iy * to.mx + ix);
        }
    });
    // Means over the children in C.
    let mean = |of: &dyn Fn(usize) -> Vector, i: usize| {
        let in_contact = || to.children(&from, i).filter(|&child| fine.bound[child] > 0.0);
        let count = in_contact().count().max(1) as f64;
        in_contact().fold([0.0; 2], |sum, child| add(sum, of(child))).map(|sum| sum / count)
    };
    problem.operators.excess = match &fine.operators.excess {
        None => None,
        Some(excess) => Some(Excess::new(&to, |i| mean(&|child| [excess.at(child), 0.0], i)[0])?),
    };
    problem.weights = match fine.weights[..] {
        [] => Vec::new(),
        _ => collected((0..to.len()).map(|i| mean(&|child| fine.weights[child], i)), "the weights of creepages")?,
    };
    (problem.offset, problem.scale) = (fine.offset.map(|w| longer * w), fine.scale);
    problem.ahead = fine.ahead.map(|w| longer * longer * w);
    problem.bound_changed();
    state.unload(problem.threads());
    Ok(())
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
    let shorter = 1.0 / step_ratio(&coarse.problem, &fine.problem);
    fine.problem.offset = coarse.problem.offset.map(|w| shorter * w);
    let (x, y) = (places(to.mx, from.mx)?, places(to.my, from.my)?);
    let between = |i: usize| {
        let g = fine.problem.bound[i];
        if !(g > 0.0) {
            return [0.0; 2];
        }
        let mut mean = Mean::default();
        for (column, in_x) in x[i % to.mx] {
            for (row, in_y) in y[i / to.mx] {
                let k = row * from.mx + column;
                let (bound, weight) = (coarse.problem.bound[k], in_x * in_y);
                if !(bound > 0.0) || weight == 0.0 {
                    continue;
                }
                mean.add(weight, bound, shares[k], coarse.state.q[k], coarse.state.u[k]);
            }
        }
        if mean.weights == 0.0 {
            return [0.0; 2];
        }
        let direction = mean.direction();
        if is_rolling && mean.any_slip {
            let s = plus(
                add(fine.problem.slip[i], fine.problem.weighted(i, fine.problem.offset)),
                shorter / mean.weights,
                mean.displaced,
            );
            let stiff = fine.problem.operators.self_influence * g;
            onto_disc(turned_against(direction, s, stiff).map(|v| g * v), g)
        } else if is_rolling || mean.all_slip {
            onto_disc(direction.map(|v| g * v), g)
        } else {
            onto_disc(mean.traction.map(|v| v / mean.weights), g)
        }
    };
    fine.problem.threads().for_each_plain_row(&mut fine.state.q, to.mx, |iy, row| {
        row.iter_mut().enumerate().for_each(|(ix, q)| *q = between(iy * to.mx + ix));
    });
    fine.state.is_exact = false;
    Ok(())
}

/// What a fine element interpolates from coarse ones: sums with weights.
struct Mean {
    /// Of q/g.
    direction: Vector,
    /// Of q, for what it carries.
    traction: Vector,
    /// Of u.
    displaced: Vector,
    weights: f64,
    all_slip: bool,
    any_slip: bool,
}

impl Default for Mean {
    fn default() -> Mean {
        let none = [0.0; 2];
        Mean { direction: none, traction: none, displaced: none, weights: 0.0, all_slip: true, any_slip: false }
    }
}

impl Mean {
    fn add(&mut self, weight: f64, bound: f64, share: f64, q: Vector, u: Vector) {
        let slips = square(q).sqrt() >= ON_THE_CIRCLE * bound;
        (self.all_slip, self.any_slip) = (self.all_slip && slips, self.any_slip || slips);
        self.direction = plus(self.direction, weight / bound, q);
        self.traction = plus(self.traction, weight * share, q);
        self.displaced = plus(self.displaced, weight, u);
        self.weights += weight;
    }

    /// q/g; of length 1 where all slip.
    fn direction(&self) -> Vector {
        let length = square(self.direction).sqrt();
        let by = if self.all_slip && length > 0.0 { length } else { self.weights };
        self.direction.map(|v| v / by)
    }
}

/// `d - TURNING k^2 s/|s|` with k = |s|/stiff, back into the disc of radius 1; k may be infinite.
fn turned_against(d: Vector, s: Vector, stiff: f64) -> Vector {
    let length = s[0].hypot(s[1]);
    if length == 0.0 {
        return onto_disc(d, 1.0);
    }
    let weight = TURNING * (length / stiff).powi(2);
    let (share, rest) = (1.0 / (1.0 + 1.0 / weight), 1.0 / (1.0 + weight));
    let turned = plus(d.map(|v| rest * v), -share, s.map(|s| s / length));
    let by = square(turned).sqrt().max(rest);
    turned.map(|v| v / by)
}

/// Of each fine place the two coarse ones between which its centre lies, with their weights.
fn places(fine: usize, coarse: usize) -> Result<Vec<[(usize, f64); 2]>> {
    let of = |i: usize| if fine == coarse { [(i, 1.0), (i, 0.0)] } else { neighbours(i, coarse) };
    Ok(collected((0..fine).map(of), "the start from a coarser grid")?)
}
