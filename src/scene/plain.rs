//! What every scene has, and every effect may look at.

use super::{Bodies, Load};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;

/// A scene without its effects.
#[derive(Clone, Copy, Debug)]
pub struct Plain<'a> {
    /// The potential contact area.
    pub grid: Grid,
    /// h, `[my][mx]`; `+infinity`: no surface there, the element stays exterior.
    pub undeformed_distance: &'a [f64],
    /// Elasticity of the two bodies.
    pub bodies: Bodies,
    /// Prescribed approach or prescribed force.
    pub load: Load,
}

impl Plain<'_> {
    /// Refuses distances that are none.
    pub fn check_distance(&self) -> Result<()> {
        let (h, n) = (self.undeformed_distance, self.grid.len());
        if h.len() != n {
            return invalid(format!("undeformed_distance has {} values; the grid has {n} elements", h.len()));
        }
        // NaN is not greater than anything. Of all of them first, which the compiler can vectorise.
        let is_number = |v: &f64| *v > f64::NEG_INFINITY;
        let elements = h.iter();
        let all = pulp::Arch::new().dispatch(
            #[inline(always)]
            || elements.fold(!0, |all: u64, v| all & u64::from(is_number(v)).wrapping_neg()),
        );
        match (all == 0).then(|| h.iter().position(|v| !is_number(v))).flatten() {
            Some(i) => Err(Error::NotFinite(format!(
                "undeformed_distance of {} is {}; it must be a number, or +infinity where there is no surface",
                self.grid.element(i),
                h[i]
            ))),
            None => Ok(()),
        }
    }

    /// Refuses a force that there is no surface for.
    pub fn check_surface(&self) -> Result<()> {
        match self.load {
            Load::Force(force) if force > 0.0 && self.undeformed_distance.iter().all(|v| v.is_infinite()) => {
                Err(Error::Infeasible(format!(
                    "force is {force}, but undeformed_distance is infinite on every element: nothing can carry it"
                )))
            }
            _ => Ok(()),
        }
    }
}
