//! A quantity on a sequence of finer grids, and its error on the last one.
//!
//! *Convergence.* All quantities except pressures, and stresses at the surface, are integrals of the solution or lie below the surface. Therefore
//! they converge, perhaps slowly. While their changes from grid to grid do not decrease yet, a slowly decreasing geometric series bounds the
//! remaining changes ([`Sequence::error_if_slow`]).
//!
//! *Largest stresses.* Where tractions or pressures end steeply, the error of stresses at the surface and some elements below it decreases as the
//! square root of the element size. Elsewhere it decreases as the square of the size. On coarse elements the largest stress may lie deep, while
//! another stress, close to the surface, grows and will exceed it on finer grids. The changes of the largest stress do not show this. Therefore the
//! largest stresses at some depths, counted in elements, are followed as well ([`CLOSE`]). If one of them is predicted to exceed the largest stress,
//! the error of the largest stress includes the excess, and the error of the depth is the whole depth.
//!
//! *Changes that are small by chance.* Two grids give one change, which may be small by chance. This is frequent for tractions, and for stresses
//! where tractions or pressure limits end. Their errors are accepted from three grids on ([`Course::is_believed`]). A stress some elements below the
//! surface depends on the largest pressure. While that pressure has no estimate, because elements are too coarse for its peak, the error of the
//! stress is not accepted either.

use super::deepest::{Peak, CLOSE};
use super::{Quantity, Sequence};
use crate::scene::{Motion, Scene};
use crate::solver::falling::Falling;

/// The ratio of successive changes, one doubling apart, that is assumed for a sum if its changes do not decrease faster.
pub const SUM_RATIO: f64 = 2.0 / 3.0;
/// The same ratio for a stress close to the surface.
const SURFACE_RATIO: f64 = 0.75;
/// From this depth on, in elements, a stress is a mean of many pressures. Measurements at the place where the rounded ends of a roller begin:
/// stresses at depths of 0.6 to 1.8 elements had errors of 2 to 10 %, with changes of 1 % from grid to grid. From 2.8 elements on the errors were
/// below 2 %.
const DEEP: f64 = 4.0;

/// The value of a quantity on one grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// The largest stress, if the quantity is one or its depth.
    pub peak: Option<Peak>,
    /// A lower bound on the relative error of a sum. Several grids may agree by chance on the elements of an area, or on where the surface ends.
    pub least: f64,
}

impl From<f64> for Value {
    fn from(value: f64) -> Value {
        Value { value, peak: None, least: 0.0 }
    }
}

/// One quantity on a sequence of finer grids.
#[derive(Clone, Debug)]
pub struct Course {
    quantity: Quantity,
    /// Whether the error is of first order and irregular: of tractions in steady rolling because of the step, of areas because of whole elements.
    is_irregular: bool,
    /// Whether the quantity is one of steady rolling of unlike bodies, which converges more slowly on coarse grids.
    is_slow: bool,
    /// Whether a single change may be small by chance: tractions, or loads that end steeply, determine the quantity.
    is_steep: bool,
    /// Whether the largest pressure on the last grid has an estimate, or pressures have none in this scene.
    pressure_is_known: bool,
    /// The values of the quantity.
    values: Sequence,
    /// The largest stress, if the quantity is one or its depth.
    stress: Sequence,
    /// The largest stress at each depth of [`CLOSE`].
    close: [Sequence; CLOSE.len()],
    /// The largest stress on the last grid.
    last: Option<Peak>,
    /// A lower bound on the error of the last value, if it is a sum.
    least: f64,
}

impl Course {
    /// The sequence of a quantity of a scene, without grids yet.
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

    /// Whether the last value is an area of 0. Finer grids may have a few elements of such an area.
    pub fn is_empty(&self) -> bool {
        self.quantity.is_area() && self.values.value() == Some(0.0)
    }

    /// Adds the value on a grid, whose elements are those of the scene doubled `doublings` times in both directions (halved if negative). `residual`
    /// is the relative error of the value due to the residual.
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

    /// Records that elements are at their pressure limit or attract each other, so that pressures end steeply.
    pub fn reaches_limit(&mut self) {
        self.is_steep |= self.quantity.is_stress();
    }

    /// Records whether the largest pressure on the last grid has an estimate. True as well if no grid of the scene can have one.
    pub fn below_known_pressure(&mut self, is_known: bool) {
        self.pressure_is_known = is_known;
    }

    /// Whether a search may accept the error: there are enough grids, and the last one is fine enough (see "Changes that are small by chance" above).
    pub fn is_believed(&self) -> bool {
        let is_settled = self.pressure_is_known || self.last.is_none_or(|peak| peak.elements >= DEEP);
        is_settled && (!self.is_steep || self.len() > 2)
    }

    /// The number of grids so far.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are three changes. If there is no error then, the value does not converge.
    pub fn tells_singular(&self) -> bool {
        self.values.len() > 3
    }

    /// The error on the last grid that follows from the sequence.
    ///
    /// Force, largest pressure and area have estimates from one grid, and no error from the sequence. The exception are scenes in which no grid has
    /// estimates (`lacks_estimates`). They need at least three grids, because only the changes reveal an infinite value. In other scenes a largest
    /// pressure without an estimate is singular or not resolved, so it must not get an error here. An [empty](Course::is_empty) area has no error.
    pub fn error(&self, lacks_estimates: bool) -> Option<Falling> {
        match (self.quantity, self.last) {
            _ if self.is_empty() => None,
            (quantity, _) if quantity.has_estimate() && !(lacks_estimates && self.len() > 2) => None,
            (Quantity::MaxPressure, _) => self.values.error(),
            (Quantity::VonMisesDepth, Some(peak)) => self.error_of_depth(peak),
            (_, Some(peak)) => self.error_of_stress(peak),
            _ => {
                let error = if self.is_irregular { self.values.error_of_first_order() } else { self.values.error() };
                let if_slow = self.values.error_if_slow(SUM_RATIO);
                let error = if self.is_slow { larger(error, if_slow) } else { error };
                let error = error.or(if_slow)?;
                Some(Falling { by_two: error.by_two + (self.least - error.now()).max(0.0), ..error })
            }
        }
    }

    /// The error of the largest stress if no other one exceeds it on finer grids. Below the surface a stress is a mean of the loads and converges.
    fn error_of_peak(&self, peak: Peak) -> Option<Falling> {
        let (error, if_slow) = (self.stress.error(), self.stress.error_if_slow(SURFACE_RATIO));
        if peak.is_near() {
            error.and(larger(error, if_slow))
        } else {
            error.or(if_slow)
        }
    }

    /// The largest value that a stress close to the surface is predicted to reach, less the largest stress `peak` and its `error`. Negative if all
    /// are predicted to stay below. Two kinds of stresses are left out, because they belong to the flank of the largest one: those that decrease from
    /// grid to grid, and those that were deeper than the largest one on the grid before.
    fn predicted_excess(&self, peak: Peak, error: f64) -> f64 {
        let predicted = |(depth, stress): (&f64, &Sequence)| {
            let (change, doublings) = stress.last_change()?;
            let is_of_flank = *depth > 0.0 && depth * 2f64.powi(doublings) > peak.elements;
            let rest = stress.error_if_slow(SURFACE_RATIO).filter(|_| change > 0.0 && !is_of_flank)?;
            Some(stress.value()? + rest.now())
        };
        let largest = CLOSE.iter().zip(&self.close).filter_map(predicted).fold(f64::NEG_INFINITY, f64::max);
        largest - peak.value - error
    }

    /// The error of the largest stress, including the predicted excess of other stresses.
    fn error_of_stress(&self, peak: Peak) -> Option<Falling> {
        let error = self.error_of_peak(peak)?;
        let excess = self.predicted_excess(peak, error.now());
        Some(Falling { by_two: error.by_two + excess.max(0.0), ..error })
    }

    /// The error of the depth of the largest stress: the whole depth if another stress may exceed it.
    fn error_of_depth(&self, peak: Peak) -> Option<Falling> {
        let error = self.values.error().or(self.values.error_if_slow(SUM_RATIO))?;
        let of_stress = self.error_of_peak(peak).filter(|_| !peak.is_near());
        let may_move = of_stress.is_some_and(|of_stress| self.predicted_excess(peak, -of_stress.now()) > 0.0);
        let more = if may_move { peak.depth - error.now() } else { 0.0 };
        Some(Falling { by_two: error.by_two + more.max(0.0), ..error })
    }
}

/// The error that is larger on this grid; the other one if one is unknown.
fn larger(a: Option<Falling>, b: Option<Falling>) -> Option<Falling> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if a.now() < b.now() { b } else { a }),
        _ => a.or(b),
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/course.rs"]
mod tests;
