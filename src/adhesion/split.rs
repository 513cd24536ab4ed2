//! Splits the total pressures of a result into contact pressures and attraction.

use super::unknowns::Surface;
use crate::contact::State;
use crate::error::Result;
use crate::memory::copied;

/// The law and the works of adhesion of a result, with which its total pressures are split. This copy stays valid when the handle gets another
/// scene or other coefficients.
pub struct Split(Surface);

impl Split {
    /// Copies the law and the works of adhesion of these surfaces.
    pub fn of(surface: &Surface) -> Result<Split> {
        let works = copied(&surface.works, "works of adhesion")?;
        Ok(Split(Surface { h: Vec::new(), attraction: surface.attraction, works, work: surface.work }))
    }

    /// The contact pressure q of element i, and its attraction sigma.
    pub fn at(&self, state: &State, i: usize) -> (f64, f64) {
        let sigma = self.0.traction(i, state.h[i] - state.approach + state.u[i]);
        // Within the residual, q may be slightly negative.
        (if state.contact[i] { (state.p[i] + sigma).max(0.0) } else { 0.0 }, sigma)
    }

    /// Bytes of the works of adhesion.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.0.works[..])
    }
}
