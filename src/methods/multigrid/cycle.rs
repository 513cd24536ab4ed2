//! One multigrid V(n1, n2)-cycle for `A v = d` on the contact area (section 4.2 of the paper), from `v = 0`.
//!
//! The active-set loop applies the cycle to the residual and adds v to p. If the sweeps of the smoother are linear, the cycle is linear in d, and p +
//! v is the result of a cycle that starts from p. The FFT smoother is not linear, because its step lengths depend on d.

use super::coarsest::Coarsest;
use super::hierarchy::{clear_exterior, levels, Level};
use super::smoother::{Smoother, SmootherKind};
use super::transfer;
use crate::contact::Problem;
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::Workspace;

/// The shape of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleShape {
    /// The smoother.
    pub smoother: SmootherKind,
    /// The number n1 of sweeps before the coarse-grid correction.
    pub pre_sweeps: usize,
    /// The number n2 of sweeps after the coarse-grid correction.
    pub post_sweeps: usize,
    /// The relaxation factor omega. 0: the smoother's default.
    pub relaxation: f64,
    /// The coarsest grid has at most this many elements in each direction.
    pub coarsest: usize,
}

impl Default for CycleShape {
    /// The best cycle of the paper: V(1,1) with Gauss-Seidel, omega = 0.8, and a coarsest grid of 4 x 4 elements.
    fn default() -> CycleShape {
        CycleShape { smoother: SmootherKind::GaussSeidel, pre_sweeps: 1, post_sweeps: 1, relaxation: 0.0, coarsest: 4 }
    }
}

impl CycleShape {
    /// The relaxation factor omega that is used.
    pub fn relaxation(&self) -> f64 {
        if self.relaxation > 0.0 {
            self.relaxation
        } else {
            self.smoother.default_relaxation()
        }
    }
}

/// A hierarchy of grids, and all that a cycle on them needs.
pub struct Multigrid {
    /// The levels; `levels[0]` is the finest.
    pub levels: Vec<Level>,
    shape: CycleShape,
    coarsest: Coarsest,
    /// Memory for products on any of the levels.
    workspace: Workspace<f64>,
}

impl Multigrid {
    /// Sets up cycles of one shape, whose finest grid is that of `problem`.
    pub fn new(problem: &mut Problem, shape: CycleShape) -> Result<Multigrid> {
        let levels = levels(problem, shape.smoother, shape.coarsest)?;
        let workspace = Workspace::new(levels.iter().map(|level| &*level.operator))?;
        Ok(Multigrid { levels, shape, coarsest: Coarsest::new(), workspace })
    }

    /// The number of levels. Level 0 is the finest.
    pub fn depth(&self) -> usize {
        self.levels.len()
    }

    /// Returns the number of products on level `l` since the last call.
    pub fn take_products(&mut self, l: usize) -> u64 {
        std::mem::take(&mut self.levels[l].products)
    }

    /// Computes `u = A p` on level `l`.
    pub fn displace(&mut self, l: usize, p: &[f64], u: &mut [f64]) {
        self.levels[l].operator.apply(p, u, &mut self.workspace);
        self.levels[l].products += 1;
    }

    /// Returns the cost of eliminations on the coarsest grid since the last call, in work units.
    pub fn take_eliminations(&mut self) -> f64 {
        self.coarsest.take_multiplications() / multiplications_of_product(&self.levels[0].grid)
    }

    /// Makes one cycle that starts on level `l`. Returns the correction v, with `A v` near `defect` on the contact area and v = 0 outside.
    pub fn cycle(&mut self, l: usize, defect: &[f64], contact: &[bool]) -> &[f64] {
        let level = &mut self.levels[l];
        level.contact.copy_from_slice(contact);
        level.defect.copy_from_slice(defect);
        clear_exterior(&mut level.defect, contact);
        self.cycle_level(l);
        &self.levels[l].correction
    }

    /// The correction of the last cycle that started on level `l`.
    pub fn correction(&self, l: usize) -> &[f64] {
        &self.levels[l].correction
    }

    /// `A v` on the whole grid, where v is the correction of the last cycle that started on level `l`. Only the FFT smoother computes this product as
    /// a by-product; None with other smoothers, and on the coarsest level.
    pub fn correction_product(&self, l: usize) -> Option<&[f64]> {
        match &self.levels[l].smoother {
            Smoother::Fft(fft) if l + 1 < self.depth() => Some(fft.product()),
            _ => None,
        }
    }

    /// Makes the part of a cycle on level `l` and below, for the level's `defect` and `contact`.
    fn cycle_level(&mut self, l: usize) {
        let Multigrid { levels, shape, coarsest, workspace } = self;
        let (finer, coarser) = levels.split_at_mut(l + 1);
        let level = &mut finer[l];
        let Some(coarse) = coarser.first_mut() else {
            let Level { grid, coefficients, correction, defect, contact, .. } = level;
            coarsest.solve(coefficients, grid, contact, defect, correction);
            return;
        };

        // Pre-smoothing starts from v = 0, whose residual is the defect.
        level.correction.fill(0.0);
        level.residual.copy_from_slice(&level.defect);
        if let Smoother::Fft(fft) = &mut level.smoother {
            fft.start();
        }
        for _ in 0..shape.pre_sweeps {
            level.smooth(shape.relaxation(), workspace);
            level.update_residual(workspace);
        }

        // Defect and contact area are restricted to the coarse grid. Its correction is interpolated back.
        transfer::restrict_contact(&level.grid, &coarse.grid, &level.contact, &mut coarse.contact);
        transfer::restrict_mean(&level.grid, &coarse.grid, |i| level.residual[i], &mut coarse.defect);
        clear_exterior(&mut coarse.defect, &coarse.contact);
        self.cycle_level(l + 1);
        let Multigrid { levels, shape, workspace, .. } = self;
        let (finer, coarser) = levels.split_at_mut(l + 1);
        let level = &mut finer[l];
        level.correct(&coarser[0], workspace);

        // Post-smoothing.
        for _ in 0..shape.post_sweeps {
            level.update_residual(workspace);
            level.smooth(shape.relaxation(), workspace);
        }
    }

    /// Bytes of the unknowns of all grids, and of the operators and coefficients of the coarser grids. Those of the finest grid belong to the
    /// problem.
    pub fn bytes(&self) -> usize {
        let elements: usize = self.levels.iter().map(|level| level.grid.len()).sum();
        let coarser: usize =
            self.levels[1..].iter().map(|level| level.coefficients.bytes() + level.operator.bytes()).sum();
        coarser + elements * (3 * size_of::<f64>() + 1)
    }
}

/// The number of multiplications of a product by FFT. It has a forward and an inverse transform of n real values, each with about `n log2 n`
/// multiplications; n is 4 times the number of elements, because of the padding.
fn multiplications_of_product(grid: &Grid) -> f64 {
    let n = 4.0 * grid.len() as f64;
    2.0 * n * n.log2()
}
