//! The grids of the multigrid method, finest first. Each grid has a separate operator.
//!
//! Standard coarsening joins 2 x 2 elements. If the number of elements in a direction is odd, the last coarse element covers the single remaining
//! element. The coefficients of this coarse element have the doubled size, but only its part inside the grid carries pressure.
//!
//! A direction is not coarsened if it has at most `coarsest` elements, or while its elements are more than twice as long as in the other direction
//! (slender elements are first joined along their short side).

use std::sync::Arc;

use super::smoother::{Smoother, SmootherKind};
use super::transfer::interpolate;
use crate::contact::Problem;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::{zeros, Operator, Workspace};

/// One grid: its operator, its smoother, and its unknowns during a cycle.
pub struct Level {
    /// The grid.
    pub grid: Grid,
    /// The influence coefficients of the grid.
    pub coefficients: Coefficients,
    /// The operator of `u = A p` on the grid.
    pub operator: Arc<Operator<f64>>,
    /// The cost of one product on the grid, in work units.
    pub work: f64,
    pub(super) smoother: Smoother,
    /// The correction v.
    pub(super) correction: Vec<f64>,
    /// The right-hand side d, 0 outside C.
    pub(super) defect: Vec<f64>,
    /// The residual d - A v, 0 outside C.
    pub(super) residual: Vec<f64>,
    /// The contact area C on the grid.
    pub(super) contact: Vec<bool>,
    /// The number of products since it was last asked for.
    pub(super) products: u64,
}

impl Level {
    /// Sets up one grid of the hierarchy. The finest grid shares the operator of the problem.
    fn new(problem: &mut Problem, grid: Grid, coefficients: Coefficients, kind: SmootherKind) -> Result<Level> {
        let (n, finest) = (grid.len(), problem.grid.len());
        let operator = match grid == problem.grid {
            true => problem.operator()?.clone(),
            false => Arc::new(Operator::new(&coefficients, &grid, &problem.threads.suited_to(n))?),
        };
        let array = || zeros(n, "the multigrid levels");
        Ok(Level {
            smoother: Smoother::new(kind, &coefficients, &grid, &problem.threads)?,
            grid,
            coefficients,
            operator,
            work: n as f64 / finest as f64,
            correction: array()?,
            defect: array()?,
            residual: array()?,
            contact: zeros(n, "the multigrid levels")?,
            products: 0,
        })
    }

    /// Computes the residual `r = d - A v` on the contact area, unless the smoother has updated it.
    pub(super) fn update_residual(&mut self, workspace: &mut Workspace<f64>) {
        if self.smoother.keeps_residual() {
            return;
        }
        self.operator.apply(&self.correction, &mut self.residual, workspace);
        self.products += 1;
        for ((r, d), &inside) in self.residual.iter_mut().zip(&self.defect).zip(&self.contact) {
            *r = if inside { d - *r } else { 0.0 };
        }
    }

    /// Makes one sweep of the smoother, which overwrites the residual or updates it.
    pub(super) fn smooth(&mut self, relaxation: f64, workspace: &mut Workspace<f64>) {
        let Level { operator, smoother, correction, residual, contact, products, .. } = self;
        smoother.sweep(correction, residual, contact, relaxation, |changes, product| {
            operator.apply(changes, product, workspace);
            *products += 1;
        });
    }

    /// Adds the correction of the next coarser level, interpolated piecewise constant, and zero outside the contact area. The FFT smoother multiplies
    /// it by a step length.
    pub(super) fn correct(&mut self, coarser: &Level, workspace: &mut Workspace<f64>) {
        let Level { grid, operator, smoother, correction, residual, contact, products, .. } = self;
        let from = &coarser.correction;
        if let Smoother::Fft(fft) = smoother {
            let fill = |to: &mut [f64]| interpolate(grid, &coarser.grid, from, to, |to, value| *to = value);
            fft.correct(correction, residual, contact, fill, |changes, product| {
                operator.apply(changes, product, workspace);
                *products += 1;
            });
            return;
        }
        interpolate(grid, &coarser.grid, from, correction, |v, coarse| *v += coarse);
        clear_exterior(correction, contact);
    }
}

/// Sets values outside the contact area to 0.
pub(super) fn clear_exterior(values: &mut [f64], contact: &[bool]) {
    values.iter_mut().zip(contact).filter(|(_, &inside)| !inside).for_each(|(value, _)| *value = 0.0);
}

/// Sets up the levels, finest first: coarsens the grid of `problem` until no direction has more than `coarsest` elements.
pub(super) fn levels(problem: &mut Problem, kind: SmootherKind, coarsest: usize) -> Result<Vec<Level>> {
    let (grid, coefficients) = (problem.grid, problem.coefficients.clone());
    let mut levels = vec![Level::new(problem, grid, coefficients, kind)?];
    while let Some(coarse) = levels.last().and_then(|finer| coarsen(&finer.grid, coarsest)) {
        let finer = &levels[levels.len() - 1];
        let coefficients = finer.coefficients.coarsen(&finer.grid, &coarse)?;
        levels.push(Level::new(problem, coarse, coefficients, kind)?);
    }
    Ok(levels)
}

/// The next coarser grid. None if both directions have at most `coarsest` elements.
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
