//! A quantity on grids of more and more elements, and its error on the last of them.
//!
//! All but pressures and stresses at the surface are integrals of what is solved for, or lie below it: they converge, however slowly. Where their changes do not
//! fall yet, a row of changes that fall slowly bounds the rest ([`Sequence::slow`]).
//!
//! *Largest stresses.* Where tractions or pressures end steeply, stresses at the surface and some elements below it converge as the root of the elements.
//! Elsewhere stresses converge with their square. On coarse elements the largest stress lies deep. Its changes from grid to grid do not tell that another one,
//! close to the surface, will exceed it. So stresses at some depths, counted in elements, are followed, too. The error of the largest stress includes the
//! predicted excess of each of them; if there is one, the error of the depth is the whole depth.
//!
//! *Lucky changes.* Of two grids there is one change, which may be small by chance. Tractions have such changes often, and so have stresses at the ends of
//! tractions and of limits: their errors are believed from three grids on ([`Course::is_believed`]). A stress some elements below the surface follows the
//! largest pressure: while that has no estimate, because elements are too coarse for its peak, the stress is not believed either.

use super::deepest::{Peak, CLOSE};
use super::{Quantity, Sequence};
use crate::scene::{Motion, Scene};
use crate::solver::falling::Falling;

/// A ratio by which changes of a sum fall with a doubling at least, and those of a stress close to the surface.
pub const SUM: f64 = 2.0 / 3.0;
const SURFACE: f64 = 0.75;
/// From so many elements below the surface on a stress is a mean of many pressures. Where a roller's rounded ends begin, stresses at 0.6 to 1.8 elements were
/// off by 2 to 10 % with changes of 1 % from grid to grid; from 2.8 on by less than 2 %.
const DEEP: f64 = 4.0;
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
    /// The same of unlike bodies: slower on coarse grids.
    is_slow: bool,
    /// Whether single changes may be lucky.
    is_steep: bool,
    /// Whether the last grid is fine enough for the largest pressure.
    pressure_is_known: bool,
    values: Sequence,
    /// Of a largest stress: itself, and those close to the surface.
    stress: Sequence,
    close: [Sequence; CLOSE.len()],
    last: Option<Peak>,
    /// What counting elements leaves uncertain of an area.
    least: f64,
}

impl Course {
    /// Of which no grid is solved yet.
    pub fn of(quantity: Quantity, scene: &Scene<'_>) -> Course {
        let rolls = scene.friction.is_some_and(|friction| friction.motion == Motion::SteadyRolling);
        let rolls = rolls && quantity.is_tangential();
        Course {
            quantity,
            rolls,
            is_slow: rolls && scene.bodies.unlike() != 0.0,
            is_steep: scene.friction.is_some() && (quantity.is_tangential() || quantity.is_stress()),
            pressure_is_known: true,
            values: Sequence::default(),
            stress: Sequence::default(),
            close: std::array::from_fn(|_| Sequence::default()),
            last: None,
            least: 0.0,
        }
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
            for (course, value) in self.close.iter_mut().zip(peak.close) {
                course.add(doublings, value, residual * value);
            }
        }
    }

    /// Elements are at their limit, or attract each other: pressures end steeply there.
    pub fn reaches_limit(&mut self) {
        self.is_steep |= self.quantity.is_stress();
    }

    /// Whether the last grid has an estimate of the largest pressure, or none has.
    pub fn below_known_pressure(&mut self, is_known: bool) {
        self.pressure_is_known = is_known;
    }

    /// Whether there are grids enough for a search to end with its error.
    pub fn is_believed(&self) -> bool {
        let is_settled = self.pressure_is_known || self.last.is_none_or(|peak| peak.elements >= DEEP);
        is_settled && (!self.is_steep || self.len() > 2)
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
                let known = if self.is_slow { larger(known, self.values.slow(SUM)) } else { known };
                let found = known.or(self.values.slow(SUM))?;
                Some(Falling { by_two: found.by_two + (self.least - found.now()).max(0.0), ..found })
            }
        }
    }

    /// Of the largest stress as if it stayed where it is. Below the surface a stress is a mean of what acts there: it converges.
    fn of_peak(&self, peak: Peak) -> Option<Falling> {
        let (falling, slow) = (self.stress.falling(), self.stress.slow(SURFACE));
        if peak.is_near() {
            falling.and(larger(falling, slow))
        } else {
            falling.or(slow)
        }
    }

    /// By how much a stress close to the surface will exceed the largest one, its error included; negative: all stay below. Those that fall are slopes of the
    /// largest one, and so are those that were as deep as that one is.
    fn overtakes(&self, peak: Peak, error: f64) -> f64 {
        let predicted = |(depth, stress): (&f64, &Sequence)| {
            let (change, doublings) = stress.last_change()?;
            let is_own = *depth > 0.0 && depth * 2f64.powi(doublings) > peak.elements;
            let rest = stress.slow(SURFACE).filter(|_| change > 0.0 && !is_own)?;
            Some(stress.value()? + rest.now())
        };
        let largest = CLOSE.iter().zip(&self.close).filter_map(predicted).fold(f64::NEG_INFINITY, f64::max);
        largest - peak.value - error
    }

    fn of_stress(&self, peak: Peak) -> Option<Falling> {
        let own = self.of_peak(peak)?;
        let more = self.overtakes(peak, own.now());
        Some(Falling { by_two: own.by_two + more.max(0.0), ..own })
    }

    fn of_depth(&self, peak: Peak) -> Option<Falling> {
        let own = self.values.falling().or(self.values.slow(SUM))?;
        let stress = self.of_peak(peak).filter(|_| !peak.is_near());
        let rises = stress.is_some_and(|stress| self.overtakes(peak, -stress.now()) > 0.0);
        let more = if rises { peak.depth - own.now() } else { 0.0 };
        Some(Falling { by_two: own.by_two + more.max(0.0), ..own })
    }
}

/// The larger one of two errors, on this grid.
fn larger(a: Option<Falling>, b: Option<Falling>) -> Option<Falling> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if a.now() < b.now() { b } else { a }),
        _ => a.or(b),
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/course.rs"]
mod tests;
