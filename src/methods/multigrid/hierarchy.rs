//! The grids of the multigrid method, finest first, each with its own operator.
//!
//! Standard coarsening joins 2 x 2 elements. Where a count is odd the last coarse element covers what is left: it keeps
//! the doubled size in its coefficients, and only its part inside the grid carries anything. A direction is left alone
//! once it has no more than `coarsest` elements, or while its elements are over twice as long as those of the other
//! direction (slender elements are joined along their short side first).

use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::{Operator, Workspace};
use crate::threads::Threads;

/// One grid and its operator.
pub struct Level {
    /// The grid.
    pub grid: Grid,
    /// Its coefficients.
    pub influence: Coefficients,
    /// `u = A p` on it.
    pub operator: Operator<f64>,
}

/// The grids, finest first.
pub struct Hierarchy {
    /// The levels; `levels[0]` is the finest.
    pub levels: Vec<Level>,
    /// Memory for the product on any of the levels.
    pub workspace: Workspace<f64>,
}

impl Hierarchy {
    /// Coarsens until no direction has more than `coarsest` elements.
    pub fn new(grid: &Grid, influence: &Coefficients, coarsest: usize, threads: &Threads) -> Result<Hierarchy> {
        let mut levels = Vec::new();
        let (mut grid, mut influence) = (*grid, influence.clone());
        loop {
            let operator = Operator::new(&influence, &grid, threads)?;
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

    /// Bytes held by the operators, and by the coefficients of the coarser grids.
    pub fn bytes(&self) -> usize {
        let coefficients: usize = self.levels[1..].iter().map(|level| level.influence.bytes()).sum();
        coefficients + self.levels.iter().map(|level| level.operator.bytes()).sum::<usize>()
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
