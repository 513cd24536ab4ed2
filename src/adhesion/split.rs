//! The total pressures of a result, split into contact pressures and attraction.

use super::unknowns::Surface;
use crate::contact::State;
use crate::error::Result;
use crate::memory::copied;

/// The law and the works of adhesion of a result. They stay when the handle later gets another scene or other
/// coefficients.
pub struct Split(Surface);

impl Split {
    /// The split of a solution for these surfaces.
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

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.0.works[..])
    }
}
