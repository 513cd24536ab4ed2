//! What a solver keeps for problems coupled with the normal one: histories of effects, and displaced distances. Friction has its undisplaced memory.

use crate::effects::{History, COUNT};
use crate::error::Result;
use crate::memory::zeros;

/// What a solver keeps for coupled problems, except friction.
#[derive(Default)]
pub struct Beside {
    /// The history of each effect from step to step, in the order of the list of effects.
    pub histories: [History; COUNT],
    /// The undeformed distance without and with the displacements by coupled problems.
    pub distances: Distances,
}

impl Beside {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.histories.iter().map(History::bytes).sum::<usize>() + self.distances.bytes()
    }
}

/// The undeformed distance of a scene, and the same distance displaced by coupled problems. The former is a copy, because a callback may change the
/// caller's array. Both are empty before the first step with turns.
#[derive(Default)]
pub struct Distances {
    /// The distance of the scene.
    pub undisplaced: Vec<f64>,
    /// The distance of the scene plus the last displacements by coupled problems.
    pub displaced: Vec<f64>,
}

impl Distances {
    /// Copies the distance of the scene, and allocates both arrays at the first call.
    pub fn take(&mut self, h: &[f64]) -> Result<()> {
        for values in [&mut self.undisplaced, &mut self.displaced] {
            if values.is_empty() {
                *values = zeros(h.len(), "the distance with what coupled problems displace")?;
            }
        }
        self.undisplaced.copy_from_slice(h);
        Ok(())
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.undisplaced[..]) + size_of_val(&self.displaced[..])
    }
}
