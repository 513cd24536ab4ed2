//! The grids of nested iteration, and the restriction of the problem to them. Grids are coarsened by two until the shorter side has fewer than 24
//! elements. A single row of elements is coarsened along the row only.
//!
//! On a coarse element, whose children are the fine elements in it:
//!
//! * g is the mean of the children's g, where children outside C count as 0;
//! * w, the weights of creepages and the layer are means over the children in C;
//! * in steady rolling the step on the coarse grid is longer by a factor f, usually 2. So w is f times the mean of the children's w. Spin changes the
//!   rigid slip from place to place; therefore w is taken [`SPIN_SHIFT`] (f - 1) fine steps ahead of the centre.

use std::iter::successors;

use super::excess::Excess;
use super::interpolation::{children, step_ratio};
use super::operators::Operators;
use super::plane::{add, plus, Vector};
use super::problem::{Problem, State};
use super::quadrant::Quadrant;
use super::shift::Memory;
use super::sweep::Rolling;
use super::Tangential;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, sparse};
use crate::methods::extension::Extension;
use crate::threads::Threads;

/// A side with fewer elements is not coarsened.
const COARSEST: usize = 24;
/// The distance from the centre at which the rigid slip by spin of a coarse element is taken, over the difference of the coarse and the fine step.
const SPIN_SHIFT: f64 = 1.0 / 3.0;

/// One grid of the nested iteration.
pub struct Level {
    /// The tangential problem on this grid.
    pub problem: Problem,
    /// Its tractions and displacements.
    pub state: State,
    /// The fields of the iterations on this grid.
    pub memory: Memory,
}

impl Level {
    /// Sets up the operators of a grid. `quadrant` has the coefficients of all offsets that they need. `single` tells whether products of search
    /// directions may be in single precision, `only_single` whether all products are.
    fn new(
        quadrant: &Quadrant,
        grid: Grid,
        rolling: Option<Rolling>,
        (only_single, single): (bool, bool),
        threads: &Threads,
    ) -> Result<Level> {
        let mut operators = Operators::new(quadrant, &grid, rolling, only_single, threads)?;
        operators.prepare(quadrant, &grid, single)?;
        let (state, memory) = (State::new(grid.len())?, Memory::default());
        Ok(Level { problem: Problem::new(grid, operators)?, state, memory })
    }

    /// The force, and the creepages found for given forces, of a step of rolling, in the units of the iterations.
    pub fn force_and_creepages(&self) -> (Vector, Vector) {
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

/// The next coarser grid; none if the grid is the coarsest.
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

/// Sets up a box and its coarser grids, the finest first. `single` tells whether products of search directions may be in single precision. Then all
/// products on the coarser grids are in single precision.
pub fn levels(
    tangential: &Tangential,
    grid: Grid,
    rolling: Option<Rolling>,
    single: bool,
    threads: &Threads,
) -> Result<Vec<Level>> {
    let by = |rolling: Option<Rolling>| rolling.map_or((0.0, 0.0), |rolling| rolling.by);
    let mut quadrant = Quadrant::new(tangential, &grid, by(rolling), &threads.suited_to(grid.len()))?;
    let finest = Level::new(&quadrant, grid, rolling, (false, single), threads)?;
    let below = || successors(coarser(&grid), coarser);
    let mut levels = sparse(1 + below().count(), "the grids of friction")?;
    levels.push(finest);
    let (mut last, mut rolling) = (grid, rolling);
    for grid in below() {
        let tangential = quadrant.tangential().for_element(grid.dx, grid.dy)?;
        rolling = rolling.map(|rolling| rolling.on(&last, &grid));
        quadrant = quadrant.coarser(&tangential, &grid, by(rolling), &threads.suited_to(grid.len()))?;
        levels.push(Level::new(&quadrant, grid, rolling, (single, single), threads)?);
        last = grid;
    }
    Ok(levels)
}

/// Restricts g, w, the weights and the layer to the next coarser grid, as the module describes, and sets q = 0 there.
pub fn restrict(fine: &Problem, coarse: &mut Level) -> Result<()> {
    let Level { problem, state, .. } = coarse;
    let (from, to) = (fine.grid, problem.grid);
    let longer = step_ratio(problem, fine);
    let all = children(&from, &to);
    let by_spin = fine.ahead.map(|w| SPIN_SHIFT * longer * (longer - 1.0) * w);
    let element = |i: usize| {
        let (mut bound, mut slip, mut rigid, mut count) = (0.0, [0.0; 2], [0.0; 2], 0);
        for child in to.children(&from, i).filter(|&child| fine.bound[child] > 0.0) {
            bound += fine.bound[child];
            slip = add(slip, fine.slip[child]);
            rigid = add(rigid, fine.rigid[child]);
            count += 1;
        }
        let share = longer / f64::from(count.max(1));
        // Without children in C the slip is 0.
        let is_inside = f64::from(count.min(1));
        let of_step = |sum: Vector| plus(sum.map(|w| share * w), is_inside, by_spin);
        (bound / all as f64, of_step(slip), of_step(rigid))
    };
    let rows = problem.bound.chunks_mut(to.mx).zip(problem.slip.chunks_mut(to.mx)).zip(problem.rigid.chunks_mut(to.mx));
    let mut rows = collected(rows, "the rows of a coarser grid")?;
    problem.operators.threads.for_each(&mut rows, |iy, ((bound, slip), rigid)| {
        for ix in 0..to.mx {
            (bound[ix], slip[ix], rigid[ix]) = element(iy * to.mx + ix);
        }
    });
    // The mean of a field over the children of element i that are in C.
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
