//! One multigrid V(n1, n2)-cycle for `A v = d` on the contact area (section 4.2 of the paper), from `v = 0`.
//!
//! The active-set loop applies the cycle to the residual and adds v to p. With the smoothers whose sweeps are linear
//! the cycle is linear in d, and these are the iterates of a cycle that starts at p; the FFT smoother chooses its step
//! lengths by d.

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
    /// n1, sweeps before the coarse-grid correction.
    pub pre_sweeps: usize,
    /// n2, sweeps after it.
    pub post_sweeps: usize,
    /// omega; 0: the smoother's default.
    pub relaxation: f64,
    /// The coarsest grid has at most this many elements in each direction.
    pub coarsest: usize,
}

impl Default for CycleShape {
    /// The paper's best: V(1,1) with Gauss-Seidel and its omega = 0.8, down to 4 x 4.
    fn default() -> CycleShape {
        CycleShape { smoother: SmootherKind::GaussSeidel, pre_sweeps: 1, post_sweeps: 1, relaxation: 0.0, coarsest: 4 }
    }
}

impl CycleShape {
    /// omega.
    pub fn relaxation(&self) -> f64 {
        if self.relaxation > 0.0 {
            self.relaxation
        } else {
            self.smoother.default_relaxation()
        }
    }
}

/// The multigrid solver: a hierarchy of grids, with the memory of a cycle on each.
pub struct Multigrid {
    /// The levels; `levels[0]` is the finest.
    pub levels: Vec<Level>,
    shape: CycleShape,
    coarsest: Coarsest,
    /// Memory for the product on any of the levels.
    workspace: Workspace<f64>,
}

impl Multigrid {
    /// Sets up cycles of one shape on the grid of `problem`.
    pub fn new(problem: &mut Problem, shape: CycleShape) -> Result<Multigrid> {
        let levels = levels(problem, shape.smoother, shape.coarsest)?;
        let workspace = Workspace::new(levels.iter().map(|level| &*level.operator))?;
        Ok(Multigrid { levels, shape, coarsest: Coarsest::new(), workspace })
    }

    /// Number of levels; level 0 is the finest.
    pub fn depth(&self) -> usize {
        self.levels.len()
    }

    /// Products done on level `l` since the last call.
    pub fn take_products(&mut self, l: usize) -> u64 {
        std::mem::take(&mut self.levels[l].products)
    }

    /// `u = A p` on level `l`.
    pub fn displace(&mut self, l: usize, p: &[f64], u: &mut [f64]) {
        self.levels[l].operator.apply(p, u, &mut self.workspace);
        self.levels[l].products += 1;
    }

    /// The work of eliminations on the coarsest grid since the last call, in products on the finest.
    pub fn take_eliminations(&mut self) -> f64 {
        self.coarsest.take_multiplications() / multiplications_of_product(&self.levels[0].grid)
    }

    /// One cycle that starts on level `l`: the correction `v` with `A v` near `defect` on the contact area, zero
    /// outside.
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

    /// `A v` on the whole grid, v being the correction of the last cycle that started on level `l`, if it is a
    /// by-product of it.
    pub fn correction_product(&self, l: usize) -> Option<&[f64]> {
        match &self.levels[l].smoother {
            Smoother::Fft(fft) if l + 1 < self.depth() => Some(fft.product()),
            _ => None,
        }
    }

    fn cycle_level(&mut self, l: usize) {
        let Multigrid { levels, shape, coarsest, workspace } = self;
        let (finer, coarser) = levels.split_at_mut(l + 1);
        let level = &mut finer[l];
        let Some(coarse) = coarser.first_mut() else {
            let Level { grid, coefficients, correction, defect, contact, .. } = level;
            coarsest.solve(coefficients, grid, contact, defect, correction);
            return;
        };

        // Pre-smoothing, from v = 0, whose residual is the defect.
        level.correction.fill(0.0);
        level.residual.copy_from_slice(&level.defect);
        if let Smoother::Fft(fft) = &mut level.smoother {
            fft.start();
        }
        for _ in 0..shape.pre_sweeps {
            level.smooth(shape.relaxation(), workspace);
            level.update_residual(workspace);
        }

        // Defects and contact area to the coarse grid, the correction there, and back.
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

    /// Bytes held by the unknowns, and by the operators and coefficients of coarser grids; the finest grid's are the problem's.
    pub fn bytes(&self) -> usize {
        let elements: usize = self.levels.iter().map(|level| level.grid.len()).sum();
        let coarser: usize =
            self.levels[1..].iter().map(|level| level.coefficients.bytes() + level.operator.bytes()).sum();
        coarser + elements * (3 * size_of::<f64>() + 1)
    }
}

/// Multiplications of a product by FFT: transforms of 4 n real values there and back, each of `n log2 n` of them.
fn multiplications_of_product(grid: &Grid) -> f64 {
    let n = 4.0 * grid.len() as f64;
    2.0 * n * n.log2()
}
