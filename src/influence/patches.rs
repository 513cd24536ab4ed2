//! Several contact patches on one grid. The coefficient between elements of two patches is multiplied by a factor.
//!
//! ```text
//! A_IJ = F(patch of I, patch of J) c(I - J)
//! ```
//!
//! F is symmetric with ones on the diagonal. Two patches with the factor 0 are independent; with the factor 1 they interact as one patch.
//!
//! Examples are contact patches in different planes (wheel tread and flange on the rail, the teeth of a gear) and bodies with a gap between them.
//! If F is positive semi-definite, so is A, as the elementwise product of two positive semi-definite matrices (Schur 1911).

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The name of the memory of patches in messages.
const PATCHES: &str = "the patches";

/// The patch of each element, and the factors between patches.
#[derive(Clone, Debug)]
pub struct Patches {
    /// The number of patches.
    pub(crate) count: usize,
    /// The patch of each element, 0 to `count - 1`.
    pub(crate) patch: Arc<Vec<u16>>,
    /// The factors F, `[count][count]`.
    factors: Arc<[f64]>,
}

impl Patches {
    /// Patches from the patch of each element, 0 to `count - 1`, and the factors `[count][count]`.
    pub fn new(count: usize, patch: impl ExactSizeIterator<Item = u16>, factors: &[f64]) -> Result<Patches> {
        assert_eq!(factors.len(), count * count);
        Ok(Patches { count, patch: Arc::new(collected(patch, PATCHES)?), factors: factors.into() })
    }

    /// The factor between the patches `a` and `b`.
    pub fn factor(&self, a: usize, b: usize) -> f64 {
        self.factors[a * self.count + b]
    }

    /// The factor between the elements `i` and `j`: that of their patches.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.factor(self.patch[i].into(), self.patch[j].into())
    }

    /// Bytes of the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.patch[..]) + size_of_val(&self.factors[..])
    }

    /// The patches on a coarser grid. A coarse element gets the patch of the first fine element in it.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Patches> {
        // Each coarse element contains at least one fine element, so that the default 0 is never used.
        let first = |i: usize| coarse.children(fine, i).next().map_or(0, |first| self.patch[first]);
        Ok(Patches { patch: Arc::new(collected((0..coarse.len()).map(first), PATCHES)?), ..self.clone() })
    }
}
