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
        // Of all of them first, which the compiler can vectorise.
        let is_none = |v: &f64| v.is_nan() | (*v == f64::NEG_INFINITY);
        let any = h.iter().fold(false, |any, v| any | is_none(v));
        match any.then(|| h.iter().position(is_none)).flatten() {
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
