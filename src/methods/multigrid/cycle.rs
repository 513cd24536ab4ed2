//! One multigrid V(n1, n2)-cycle for `A v = d` on the contact area (section 4.2 of the paper), from `v = 0`.
//!
//! The active-set loop applies the cycle to the residual and adds v to p. With the smoothers whose sweeps are linear
//! the cycle is linear in d, and these are the iterates of a cycle that starts at p; the FFT smoother chooses its step
//! lengths by d.

use super::coarsest::Coarsest;
use super::smoother::{Smoother, SmootherKind};
use super::{transfer, Hierarchy};
use crate::contact::Problem;
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::zeros;

/// The shape of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleShape {
    /// The smoother.
    pub smoother: SmootherKind,
    /// n1, sweeps before the coarse-grid correction.
    pub pre_sweeps: usize,
    /// n2, sweeps after it.
    pub post_sweeps: usize,
    /// omega.
    pub relaxation: f64,
    /// The coarsest grid has at most this many elements in each direction.
    pub coarsest: usize,
}

impl Default for CycleShape {
    /// The paper's best: V(1,1) with Gauss-Seidel, omega = 0.8, down to 4 x 4.
    fn default() -> CycleShape {
        CycleShape { smoother: SmootherKind::GaussSeidel, pre_sweeps: 1, post_sweeps: 1, relaxation: 0.8, coarsest: 4 }
    }
}

/// The unknowns of one level during a cycle.
struct Unknowns {
    smoother: Smoother,
    correction: Vec<f64>,
    defect: Vec<f64>,
    residual: Vec<f64>,
    contact: Vec<bool>,
}

/// The multigrid solver: a hierarchy of grids and what a cycle needs on each of them.
pub struct Multigrid {
    /// The grids and operators.
    pub hierarchy: Hierarchy,
    shape: CycleShape,
    unknowns: Vec<Unknowns>,
    coarsest: Coarsest,
    /// Matrix products done by cycles, per level, since the last [`take_products`](Self::take_products).
    products: Vec<u64>,
}

impl Multigrid {
    /// Sets up cycles of one shape on the grid of `problem`.
    pub fn new(problem: &Problem, shape: CycleShape) -> Result<Multigrid> {
        let hierarchy = Hierarchy::new(problem, shape.coarsest)?;
        let mut unknowns = Vec::new();
        for level in &hierarchy.levels {
            let n = level.grid.len();
            let array = || zeros(n, "the multigrid levels");
            unknowns.push(Unknowns {
                smoother: Smoother::new(shape.smoother, &level.influence, &level.grid, &problem.threads)?,
                correction: array()?,
                defect: array()?,
                residual: array()?,
                contact: zeros(n, "the multigrid levels")?,
            });
        }
        let products = vec![0; hierarchy.levels.len()];
        Ok(Multigrid { hierarchy, shape, unknowns, coarsest: Coarsest::new(), products })
    }

    /// Number of levels; level 0 is the finest.
    pub fn depth(&self) -> usize {
        self.unknowns.len()
    }

    /// Products done on level `l` since the last call.
    pub fn take_products(&mut self, l: usize) -> u64 {
        std::mem::take(&mut self.products[l])
    }

    /// `u = A p` on level `l`.
    pub fn displace(&mut self, l: usize, p: &[f64], u: &mut [f64]) {
        self.hierarchy.levels[l].operator.apply(p, u, &mut self.hierarchy.workspace);
        self.products[l] += 1;
    }

    /// The work of eliminations on the coarsest grid since the last call, in products on the finest.
    pub fn take_eliminations(&mut self) -> f64 {
        let finest = &self.hierarchy.levels[0].grid;
        self.coarsest.take_multiplications() / multiplications_of_product(finest)
    }

    /// One cycle that starts on level `l`: the correction `v` with `A v` near `defect` on the contact area, zero
    /// outside.
    pub fn cycle(&mut self, l: usize, defect: &[f64], contact: &[bool]) -> &[f64] {
        let unknowns = &mut self.unknowns[l];
        unknowns.contact.copy_from_slice(contact);
        for ((d, &value), &inside) in unknowns.defect.iter_mut().zip(defect).zip(contact) {
            *d = if inside { value } else { 0.0 };
        }
        self.cycle_level(l);
        &self.unknowns[l].correction
    }

    /// The correction of the last cycle that started on level `l`.
    pub fn correction(&self, l: usize) -> &[f64] {
        &self.unknowns[l].correction
    }

    /// `A v` on the whole grid, v being the correction of the last cycle that started on level `l`, if it is a
    /// by-product of it.
    pub fn correction_product(&self, l: usize) -> Option<&[f64]> {
        match &self.unknowns[l].smoother {
            Smoother::Fft(fft) if l + 1 < self.depth() => Some(fft.product()),
            _ => None,
        }
    }

    fn cycle_level(&mut self, l: usize) {
        let level = &self.hierarchy.levels[l];
        if l + 1 == self.depth() {
            let Unknowns { correction, defect, contact, .. } = &mut self.unknowns[l];
            self.coarsest.solve(&level.influence, &level.grid, contact, defect, correction);
            return;
        }

        // Pre-smoothing, from v = 0, whose residual is the defect.
        let unknowns = &mut self.unknowns[l];
        unknowns.correction.fill(0.0);
        unknowns.residual.copy_from_slice(&unknowns.defect);
        if let Smoother::Fft(fft) = &mut unknowns.smoother {
            fft.start();
        }
        for sweep in 0..self.shape.pre_sweeps {
            if sweep > 0 {
                self.update_residual(l);
            }
            self.smooth(l);
        }
        if self.shape.pre_sweeps > 0 {
            self.update_residual(l);
        }

        // Defects and contact area to the coarse grid, the correction there, and back.
        let (fine, coarse) = (self.hierarchy.levels[l].grid, self.hierarchy.levels[l + 1].grid);
        let (finer, coarser) = self.unknowns.split_at_mut(l + 1);
        transfer::restrict_contact(&fine, &coarse, &finer[l].contact, &mut coarser[0].contact);
        transfer::restrict_mean(&fine, &coarse, |i| finer[l].residual[i], &mut coarser[0].defect);
        for (d, &inside) in coarser[0].defect.iter_mut().zip(&coarser[0].contact) {
            if !inside {
                *d = 0.0;
            }
        }
        self.cycle_level(l + 1);
        self.correct(l);

        // Post-smoothing.
        for _ in 0..self.shape.post_sweeps {
            self.update_residual(l);
            self.smooth(l);
        }
    }

    /// Adds the correction of the next coarser level, piecewise constant, zero outside the contact area.
    fn correct(&mut self, l: usize) {
        let (level, coarse) = (&self.hierarchy.levels[l], &self.hierarchy.levels[l + 1].grid);
        let (finer, coarser) = self.unknowns.split_at_mut(l + 1);
        let Unknowns { smoother, correction, residual, contact, .. } = &mut finer[l];
        let from = &coarser[0].correction;
        if let Smoother::Fft(fft) = smoother {
            let (workspace, products) = (&mut self.hierarchy.workspace, &mut self.products[l]);
            let fill =
                |to: &mut [f64]| transfer::interpolate(&level.grid, coarse, |i| from[i], to, |to, value| *to = value);
            fft.correct(correction, residual, contact, fill, |changes, product| {
                level.operator.apply(changes, product, workspace);
                *products += 1;
            });
            return;
        }
        transfer::interpolate(&level.grid, coarse, |i| from[i], correction, |v, coarse| *v += coarse);
        for (v, &inside) in correction.iter_mut().zip(&*contact) {
            if !inside {
                *v = 0.0;
            }
        }
    }

    /// `r = d - A v` on the contact area, zero outside, unless the smoother keeps it so.
    fn update_residual(&mut self, l: usize) {
        let Unknowns { smoother, correction, defect, residual, contact } = &mut self.unknowns[l];
        if smoother.keeps_residual() {
            return;
        }
        self.hierarchy.levels[l].operator.apply(correction, residual, &mut self.hierarchy.workspace);
        self.products[l] += 1;
        for ((r, d), &inside) in residual.iter_mut().zip(&*defect).zip(&*contact) {
            *r = if inside { d - *r } else { 0.0 };
        }
    }

    /// One sweep; the residual is used up, or kept up to date.
    fn smooth(&mut self, l: usize) {
        let Unknowns { smoother, correction, residual, contact, .. } = &mut self.unknowns[l];
        let (level, workspace, products) =
            (&self.hierarchy.levels[l], &mut self.hierarchy.workspace, &mut self.products[l]);
        smoother.sweep(correction, residual, contact, self.shape.relaxation, |changes, product| {
            level.operator.apply(changes, product, workspace);
            *products += 1;
        });
    }

    /// Bytes held by operators and unknowns.
    pub fn bytes(&self) -> usize {
        let elements: usize = self.hierarchy.levels.iter().map(|level| level.grid.len()).sum();
        self.hierarchy.bytes() + elements * (3 * std::mem::size_of::<f64>() + 1)
    }
}

/// Multiplications of a product by FFT: transforms of 4 n real values there and back, each of `n log2 n` of them.
fn multiplications_of_product(grid: &Grid) -> f64 {
    let n = 4.0 * grid.len() as f64;
    2.0 * n * n.log2()
}
