//! Coefficients of several contact patches on one grid: the influence of one patch on another is scaled.
//!
//! ```text
//! A_IJ = F(patch of I, patch of J) c(I - J),    F symmetric, 1 on the diagonal, 0: independent, 1: as if there were no patches
//! ```
//!
//! For patches that lie on planes of their own: wheel tread and flange on the rail, teeth of a gear, bodies with a gap between them.
//! Where F is positive semi-definite so is A: a product by elements of two such matrices (Schur 1911).

use std::sync::Arc;

use super::Influence;
use crate::error::Result;
use crate::grid::Grid;

/// Coefficients, patches and factors.
#[derive(Clone, Debug)]
pub struct Patches {
    base: Box<Influence>,
    count: usize,
    /// Of each element.
    patch: Arc<[u16]>,
    /// `[count][count]`.
    factors: Arc<[f64]>,
}

impl Patches {
    /// Coefficients of which those between two of the `count` patches are scaled.
    pub fn new(base: Influence, count: usize, patch: impl Iterator<Item = u16>, factors: &[f64]) -> Patches {
        assert_eq!(factors.len(), count * count);
        Patches { base: Box::new(base), count, patch: patch.collect(), factors: factors.into() }
    }

    /// The same patches of other coefficients.
    pub fn on(&self, base: Influence) -> Patches {
        Patches { base: Box::new(base), ..self.clone() }
    }

    /// The coefficients without factors.
    pub fn base(&self) -> &Influence {
        &self.base
    }

    /// Number of patches.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The patch of each element.
    pub fn patch(&self) -> &[u16] {
        &self.patch
    }

    /// The factor between two patches.
    pub fn factor(&self, a: usize, b: usize) -> f64 {
        self.factors[a * self.count + b]
    }

    /// Bytes held, beside the base.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.patch[..]) + size_of_val(&self.factors[..])
    }

    /// The coefficients times `factor`.
    pub fn times(&self, factor: f64) -> Result<Patches> {
        Ok(Patches { base: Box::new(self.base.times(factor)?), ..self.clone() })
    }

    /// The coefficients of a coarser grid: an element belongs where the first of its finer ones does.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Patches> {
        let factor = |fine: usize, coarse: usize| if coarse < fine { 2 } else { 1 };
        let (by_x, by_y) = (factor(fine.mx, coarse.mx), factor(fine.my, coarse.my));
        let first = |i: usize| self.patch[fine.index(by_x * (i % coarse.mx), by_y * (i / coarse.mx))];
        let patch = (0..coarse.len()).map(first).collect();
        Ok(Patches { base: Box::new(self.base.coarsen(fine, coarse)?), patch, ..self.clone() })
    }
}
