//! A quantity on a sequence of finer grids, and its error on the last one.
//!
//! All quantities except pressures and stresses at the surface are integrals of the solution, or lie below the surface. So they converge, however
//! slowly. While their changes do not fall yet, a geometric series that falls slowly bounds the remaining changes ([`Sequence::slow`]).
//!
//! *Largest stresses.* Where tractions or pressures end steeply, the error of stresses at the surface and some elements below it falls as the square
//! root of the element size. Elsewhere it falls as the square of the size. On coarse elements the largest stress lies deep. Its changes from grid to
//! grid do not show that another stress, close to the surface, will exceed it. So stresses at some depths, counted in elements, are followed too. The
//! error of the largest stress includes the predicted excess of each. If there is an excess, the error of the depth is the whole depth.
//!
//! *Lucky changes.* Two grids give one change, which may be small by chance. This is frequent for tractions, and for stresses at the ends of
//! tractions and of limits. Their errors are trusted from three grids on ([`Course::is_believed`]). A stress some elements below the surface follows
//! the largest pressure. While that pressure has no estimate, because elements are too coarse for its peak, the stress is not trusted either.

use super::deepest::{Peak, CLOSE};
use super::{Quantity, Sequence};
use crate::scene::{Motion, Scene};
use crate::solver::falling::Falling;

/// The largest ratio of successive changes with a doubling, for a sum and for a stress close to the surface.
pub const SUM_RATIO: f64 = 2.0 / 3.0;
const SURFACE_RATIO: f64 = 0.75;
/// From this depth in elements on a stress is a mean of many pressures. Measured where a roller's rounded ends begin: stresses at 0.6 to 1.8 elements
/// had errors of 2 to 10 % with changes of 1 % from grid to grid. From 2.8 elements on the errors were below 2 %.
const DEEP: f64 = 4.0;
/// The value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    pub value: f64,
    /// The peak, for a largest stress or its depth.
    pub peak: Option<Peak>,
    /// The least relative error of a sum: several grids may agree by chance on the elements of an area, or where the surface ends.
    pub least: f64,
}

impl From<f64> for Value {
    fn from(value: f64) -> Value {
        Value { value, peak: None, least: 0.0 }
    }
}

/// The sequence of values of one quantity.
#[derive(Clone, Debug)]
pub struct Course {
    quantity: Quantity,
    /// Whether the error is of first order and irregular: in steady rolling due to the step of the tractions, and of areas due to whole elements.
    is_irregular: bool,
    /// Steady rolling of unlike bodies, which converges more slowly on coarse grids.
    is_slow: bool,
    /// Whether a single change may be small by chance.
    is_steep: bool,
    /// Whether the last grid is fine enough for the largest pressure.
    pressure_is_known: bool,
    values: Sequence,
    /// The largest stress, and the stresses close to the surface.
    stress: Sequence,
    close: [Sequence; CLOSE.len()],
    last: Option<Peak>,
    /// The least error of a sum.
    least: f64,
}

impl Course {
    /// A sequence without grids.
    pub fn of(quantity: Quantity, scene: &Scene<'_>) -> Course {
        let rolls = scene.friction.is_some_and(|friction| friction.motion == Motion::SteadyRolling);
        let rolls = rolls && quantity.is_tangential();
        Course {
            quantity,
            is_irregular: rolls || quantity.is_area(),
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

    /// The quantity.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Whether the last value is an area of 0: finer grids may have a few elements of it.
    pub fn is_empty(&self) -> bool {
        self.quantity.is_area() && self.values.value() == Some(0.0)
    }

    /// Adds the value on a grid. `doublings`: those from the first grid. `residual`: the relative uncertainty of the
    /// value.
    pub fn add(&mut self, doublings: i32, found: Value, residual: f64) {
        self.values.add(doublings, found.value, residual * found.value.abs());
        self.last = found.peak;
        self.least = found.least * found.value.abs();
        if let Some(peak) = found.peak {
            self.stress.add(doublings, peak.value, residual * peak.value);
            for (course, value) in self.close.iter_mut().zip(peak.close) {
                course.add(doublings, value, residual * value);
            }
        }
    }

    /// Notes that elements are at their limit or attract each other. Pressures end steeply there.
    pub fn reaches_limit(&mut self) {
        self.is_steep |= self.quantity.is_stress();
    }

    /// Notes whether the last grid has an estimate of the largest pressure, or none has.
    pub fn below_known_pressure(&mut self, is_known: bool) {
        self.pressure_is_known = is_known;
    }

    /// Whether a search may accept the error: grids are enough and fine enough (see "Lucky changes" above).
    pub fn is_believed(&self) -> bool {
        let is_settled = self.pressure_is_known || self.last.is_none_or(|peak| peak.elements >= DEEP);
        is_settled && (!self.is_steep || self.len() > 2)
    }

    /// The number of grids so far.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether three changes are known, which show a value that does not converge.
    pub fn tells_singular(&self) -> bool {
        self.values.len() > 3
    }

    /// The error on the last grid from the sequence, if a single grid gives no estimate. Forces, pressures and areas have one only if nothing is
    /// estimated at all (`lacks_estimates`), because a single peak without an estimate is singular or not resolved. It then takes at least three
    /// grids, because only the changes reveal an infinite value.
    /// An [empty](Course::is_empty) area has none.
    pub fn falling(&self, lacks_estimates: bool) -> Option<Falling> {
        match (self.quantity, self.last) {
            _ if self.is_empty() => None,
            (quantity, _) if quantity.has_estimate() && !(lacks_estimates && self.len() > 2) => None,
            (Quantity::MaxPressure, _) => self.values.falling(),
            (Quantity::VonMisesDepth, Some(peak)) => self.of_depth(peak),
            (_, Some(peak)) => self.of_stress(peak),
            _ => {
                let known = if self.is_irregular { self.values.of_first_order() } else { self.values.falling() };
                let known = if self.is_slow { larger(known, self.values.slow(SUM_RATIO)) } else { known };
                let found = known.or(self.values.slow(SUM_RATIO))?;
                Some(Falling { by_two: found.by_two + (self.least - found.now()).max(0.0), ..found })
            }
        }
    }

    /// The error of the largest stress, if its position stays. Below the surface a stress is a mean of the loads and converges.
    fn of_peak(&self, peak: Peak) -> Option<Falling> {
        let (falling, slow) = (self.stress.falling(), self.stress.slow(SURFACE_RATIO));
        if peak.is_near() {
            falling.and(larger(falling, slow))
        } else {
            falling.or(slow)
        }
    }

    /// The predicted excess of a stress close to the surface over the largest one, error included. If it is negative, all stay below. Falling
    /// stresses belong to the flank of the largest one, and so do stresses that were deeper than it on the grid before.
    fn overtakes(&self, peak: Peak, error: f64) -> f64 {
        let predicted = |(depth, stress): (&f64, &Sequence)| {
            let (change, doublings) = stress.last_change()?;
            let is_own = *depth > 0.0 && depth * 2f64.powi(doublings) > peak.elements;
            let rest = stress.slow(SURFACE_RATIO).filter(|_| change > 0.0 && !is_own)?;
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
        let own = self.values.falling().or(self.values.slow(SUM_RATIO))?;
        let stress = self.of_peak(peak).filter(|_| !peak.is_near());
        let rises = stress.is_some_and(|stress| self.overtakes(peak, -stress.now()) > 0.0);
        let more = if rises { peak.depth - own.now() } else { 0.0 };
        Some(Falling { by_two: own.by_two + more.max(0.0), ..own })
    }
}

/// The larger of two errors on this grid.
fn larger(a: Option<Falling>, b: Option<Falling>) -> Option<Falling> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if a.now() < b.now() { b } else { a }),
        _ => a.or(b),
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/course.rs"]
mod tests;
