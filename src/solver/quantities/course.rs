//! A quantity on grids of more and more elements, and its error on the last of them.
//!
//! All but pressures and stresses at the surface are integrals of what is solved for, or lie below it: they converge, however slowly. Where their changes do not
//! fall yet, a row of changes that fall slowly bounds the rest ([`Sequence::slow`]).
//!
//! *Largest stresses.* A stress at the surface converges as the root of the elements where tractions or pressures end steeply, one below it with their
//! square. While the elements are coarse the largest one lies below, and no change from grid to grid tells that the one at the surface overtakes it. So both
//! are followed: the largest stress is off by what the one at the surface is predicted to exceed it, too, and its depth by the whole of it.

use super::deepest::Peak;
use super::{Quantity, Sequence};
use crate::scene::{Motion, Scene};
use crate::solver::falling::Falling;

/// A ratio by which changes of a sum fall with a doubling at least, and those of a stress at the surface.
pub const SUM: f64 = 2.0 / 3.0;
const SURFACE: f64 = 0.75;
/// Elements by which an area is off at least, over the root of their number: the outline of a circle of n elements has `3.5 sqrt(n)`, of which grids of twice
/// the elements may agree by chance.
const OUTLINE: f64 = 0.3;

/// The value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    pub value: f64,
    /// Of a largest stress and of its depth: that stress.
    pub peak: Option<Peak>,
    /// Of an area that is counted: its elements.
    pub counted: f64,
}

impl From<f64> for Value {
    fn from(value: f64) -> Value {
        Value { value, peak: None, counted: 0.0 }
    }
}

/// Of one quantity.
#[derive(Clone, Debug)]
pub struct Course {
    quantity: Quantity,
    /// Steady rolling: of first order in the step of the tractions, and irregular.
    rolls: bool,
    values: Sequence,
    /// Of a largest stress: itself, and the largest one at the surface.
    stress: Sequence,
    surface: Sequence,
    last: Option<Peak>,
    /// What counting elements leaves uncertain of an area.
    least: f64,
}

impl Course {
    /// Of which no grid is solved yet.
    pub fn of(quantity: Quantity, scene: &Scene<'_>) -> Course {
        let rolls = scene.friction.is_some_and(|friction| friction.motion == Motion::SteadyRolling);
        let [values, stress, surface] = std::array::from_fn(|_| Sequence::default());
        Course { quantity, rolls: rolls && quantity.is_tangential(), values, stress, surface, last: None, least: 0.0 }
    }

    /// Which.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Adds the value on a grid with so many doublings, of which `residual` may hide this part.
    pub fn add(&mut self, doublings: i32, found: Value, residual: f64) {
        self.values.add(doublings, found.value, residual * found.value.abs());
        self.last = found.peak;
        self.least = if found.counted > 0.0 { OUTLINE * found.value.abs() / found.counted.sqrt() } else { 0.0 };
        if let Some(peak) = found.peak {
            self.stress.add(doublings, peak.value, residual * peak.value);
            self.surface.add(doublings, peak.at_surface, residual * peak.at_surface);
        }
    }

    /// Grids so far.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether a value that does not converge shows: in three changes.
    pub fn tells_singular(&self) -> bool {
        self.values.len() > 3
    }

    /// The error on the last grid, where one grid has no estimate of it: of forces, pressures and areas only where nothing is estimated at all
    /// (`lacks_estimates`: a single peak without an estimate is singular, or not resolved), and from three grids at least, since a value that
    /// is infinite shows in its changes only.
    pub fn falling(&self, lacks_estimates: bool) -> Option<Falling> {
        match (self.quantity, self.last) {
            (quantity, _) if quantity.has_estimate() && !(lacks_estimates && self.len() > 2) => None,
            (Quantity::MaxPressure, _) => self.values.falling(),
            (Quantity::VonMisesDepth, Some(peak)) => self.of_depth(peak),
            (_, Some(peak)) => self.of_stress(peak),
            _ => {
                let known = if self.rolls { self.values.of_first_order() } else { self.values.falling() };
                let found = known.or(self.values.slow(SUM))?;
                Some(Falling { by_two: found.by_two + (self.least - found.now()).max(0.0), ..found })
            }
        }
    }

    /// Of the largest stress as if it stayed where it is. Below the surface a stress is a mean of what acts there: it converges.
    fn of_peak(&self, peak: Peak) -> Option<Falling> {
        let falling = self.stress.falling();
        if peak.is_near {
            falling
        } else {
            falling.or(self.stress.slow(SURFACE))
        }
    }

    /// By how much the stress at the surface will exceed the largest one, its error included; negative: it stays below.
    fn overtakes(&self, peak: Peak, error: f64) -> Option<f64> {
        Some(peak.at_surface + self.surface.slow(SURFACE)?.now() - peak.value - error)
    }

    fn of_stress(&self, peak: Peak) -> Option<Falling> {
        let own = self.of_peak(peak)?;
        let more = match peak.is_near {
            // It is that one.
            true => self.surface.slow(SURFACE)?.now() - own.now(),
            false => self.overtakes(peak, own.now())?,
        };
        Some(Falling { by_two: own.by_two + more.max(0.0), ..own })
    }

    fn of_depth(&self, peak: Peak) -> Option<Falling> {
        let own = self.values.falling().or(self.values.slow(SUM))?;
        let stress = self.of_peak(peak).filter(|_| !peak.is_near);
        let rises = stress.is_some_and(|stress| self.overtakes(peak, -stress.now()).is_some_and(|more| more > 0.0));
        let more = if rises { peak.depth - own.now() } else { 0.0 };
        Some(Falling { by_two: own.by_two + more.max(0.0), ..own })
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/course.rs"]
mod tests;
