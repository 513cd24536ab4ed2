//! The state of the further problems of a scene, except friction.

use crate::effects::{History, COUNT};
use crate::error::Result;
use crate::memory::zeros;

/// The state of the further problems.
#[derive(Default)]
pub struct Beside {
    /// The histories of the effects.
    pub histories: [History; COUNT],
    /// The displacements by coupled problems.
    pub distances: Distances,
}

impl Beside {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.histories.iter().map(History::bytes).sum::<usize>() + self.distances.bytes()
    }
}

/// The undeformed distance of a scene, copied as a callback may change the caller's, and the distance displaced by coupled problems.
#[derive(Default)]
pub struct Distances {
    /// The distance of the scene.
    pub own: Vec<f64>,
    /// The last displaced distance.
    pub displaced: Vec<f64>,
}

impl Distances {
    /// Copies the distance of the scene.
    pub fn take(&mut self, h: &[f64]) -> Result<()> {
        for values in [&mut self.own, &mut self.displaced] {
            if values.is_empty() {
                *values = zeros(h.len(), "the distance with what coupled problems displace")?;
            }
        }
        self.own.copy_from_slice(h);
        Ok(())
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.own[..]) + size_of_val(&self.displaced[..])
    }
}
