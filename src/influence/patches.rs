//! Several contact patches on one grid. Coefficients between two patches are scaled by a factor.
//!
//! ```text
//! A_IJ = F(patch of I, patch of J) c(I - J),    F symmetric, 1 on the diagonal, 0: independent, 1: as if there were no patches
//! ```
//!
//! They serve patches in different planes: wheel tread and flange on the rail, teeth of a gear, bodies with a gap between them.
//! If F is positive semi-definite, so is A, as the elementwise product of two such matrices (Schur 1911).

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The name of this memory in messages.
const PATCHES: &str = "the patches";

/// Patches and factors.
#[derive(Clone, Debug)]
pub struct Patches {
    pub(crate) count: usize,
    /// The patch of each element.
    pub(crate) patch: Arc<Vec<u16>>,
    /// `[count][count]`.
    factors: Arc<[f64]>,
}

impl Patches {
    /// The patch of each element, 0 to `count - 1`, and the factors between them.
    pub fn new(count: usize, patch: impl ExactSizeIterator<Item = u16>, factors: &[f64]) -> Result<Patches> {
        assert_eq!(factors.len(), count * count);
        Ok(Patches { count, patch: Arc::new(collected(patch, PATCHES)?), factors: factors.into() })
    }

    /// The factor between two patches.
    pub fn factor(&self, a: usize, b: usize) -> f64 {
        self.factors[a * self.count + b]
    }

    /// The factor between two elements.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.factor(self.patch[i].into(), self.patch[j].into())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.patch[..]) + size_of_val(&self.factors[..])
    }

    /// The patches of a coarser grid: an element has the patch of its first finer element.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Patches> {
        // Each element has at least one finer element.
        let first = |i: usize| coarse.children(fine, i).next().map_or(0, |first| self.patch[first]);
        Ok(Patches { patch: Arc::new(collected((0..coarse.len()).map(first), PATCHES)?), ..self.clone() })
    }
}
