//! The grids of the multigrid method, finest first, each with its own operator.
//!
//! Standard coarsening joins 2 x 2 elements. Where a count is odd the last coarse element covers what is left: it keeps
//! the doubled size in its coefficients, and only its part inside the grid carries anything. A direction is left alone
//! once it has no more than `coarsest` elements, or while its elements are over twice as long as those of the other
//! direction (slender elements are joined along their short side first).

use std::sync::Arc;

use crate::contact::Problem;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::{Operator, Workspace};

/// One grid and its operator.
pub struct Level {
    /// The grid.
    pub grid: Grid,
    /// Its coefficients.
    pub influence: Coefficients,
    /// `u = A p` on it.
    pub operator: Arc<Operator<f64>>,
}

/// The grids, finest first.
pub struct Hierarchy {
    /// The levels; `levels[0]` is the finest.
    pub levels: Vec<Level>,
    /// Memory for the product on any of the levels.
    pub workspace: Workspace<f64>,
}

impl Hierarchy {
    /// Coarsens the grid of `problem` until no direction has more than `coarsest` elements.
    pub fn new(problem: &Problem, coarsest: usize) -> Result<Hierarchy> {
        let mut levels = Vec::new();
        let (mut grid, mut influence) = (problem.grid, problem.coefficients.clone());
        loop {
            let operator = match levels.is_empty() {
                true => problem.operator.clone(),
                false => Arc::new(Operator::new(&influence, &grid, &problem.threads.suited_to(grid.len()))?),
            };
            levels.push(Level { grid, influence: influence.clone(), operator });
            let Some(coarse) = coarsen(&grid, coarsest) else { break };
            influence = influence.coarsen(&grid, &coarse)?;
            grid = coarse;
        }
        let mut workspace = levels[0].operator.workspace()?;
        for level in &levels[1..] {
            workspace.cover(level.operator.workspace()?);
        }
        Ok(Hierarchy { levels, workspace })
    }

    /// The work of one product on level `l`, the finest being 1 (a work unit).
    pub fn work(&self, l: usize) -> f64 {
        self.levels[l].grid.len() as f64 / self.levels[0].grid.len() as f64
    }

    /// Bytes held by the coarser grids' operators and coefficients; the finest grid's are the problem's.
    pub fn bytes(&self) -> usize {
        self.levels[1..].iter().map(|level| level.influence.bytes() + level.operator.bytes()).sum()
    }
}

/// The next coarser grid; none when both directions have at most `coarsest` elements.
pub fn coarsen(grid: &Grid, coarsest: usize) -> Option<Grid> {
    let (more_x, more_y) = (grid.mx > coarsest, grid.my > coarsest);
    let x = more_x && (!more_y || grid.dx <= 2.0 * grid.dy);
    let y = more_y && (!more_x || grid.dy <= 2.0 * grid.dx);
    let halve = |halved: bool, m: usize| if halved { m.div_ceil(2) } else { m };
    let double = |doubled: bool, d: f64| if doubled { 2.0 * d } else { d };
    (x || y).then(|| Grid {
        mx: halve(x, grid.mx),
        my: halve(y, grid.my),
        dx: double(x, grid.dx),
        dy: double(y, grid.dy),
    })
}
