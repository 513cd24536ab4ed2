//! Effect: the scene repeats itself, in x, in y or in both; the grid is one period.
//!
//! See [`Periodic`](crate::influence::Periodic) for the coefficients and for what the approach is relative to.

use super::{Load, Scene};
use crate::error::{invalid, Error, Result};

/// In which directions the scene repeats itself, after `mx dx` and `my dy`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    /// In x.
    pub x: bool,
    /// In y.
    pub y: bool,
}

impl Period {
    /// Refuses a period of nothing.
    pub(super) fn check(&self) -> Result<()> {
        if !self.x && !self.y {
            return invalid("period->x and period->y are 0; at least one of them must be 1: no period is NULL".into());
        }
        Ok(())
    }

    /// With two periods the mean displacement is zero, so no approach is possible at which the mean of the distance vanishes: contact
    /// is full there, and any force fits.
    pub(super) fn check_load(&self, scene: &Scene<'_>) -> Result<()> {
        let (Load::Approach(approach), true, true) = (scene.load, self.x, self.y) else { return Ok(()) };
        if scene.layer.is_some_and(|layer| !layer.is_rigid()) {
            return Ok(()); // gives way in the mean, too
        }
        let h = scene.undeformed_distance;
        let mean = h.iter().sum::<f64>() / h.len() as f64;
        if approach >= mean {
            return Err(Error::Infeasible(format!(
                "approach is {approach}, the mean of undeformed_distance {mean}; with two periods the approach is relative to the \
                 mean plane and must be less than that: contact is full there, at any force. Prescribe the force"
            )));
        }
        Ok(())
    }
}
