//! The formulas of the loops over the contact area, for one element. Symbols are those of module `iteration`.

use pulp::Simd;

use super::segments::{Becomes, Terms, Wanted};
use super::step_sums::Update;
use crate::contact::AdmissibleSet;
use crate::lanes::{Holds, Lanes};
use crate::methods::fields::Stored;

/// An element counts as clipped if the forecast step leaves at most this part of its pressure, which is round-off of single precision.
pub(super) const CLIPPED_SHARE: f64 = f32::ROUND_OFF;

/// The sum of `h - approach + u`, where u is that after `update` (without a step along the deflation direction).
#[derive(Clone, Copy)]
pub(super) struct Distance<'a> {
    pub(super) update: &'a Update,
    /// The approach of the last iteration: the mean of equal distances is then exact.
    pub(super) approach: f64,
}

impl Terms<2, 2, 1> for Distance<'_> {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u]: [Lanes<S>; 2], [q, z]: [Lanes<S>; 2]) -> [Lanes<S>; 1] {
        let u = u + self.update.alpha * q;
        [h - self.approach + self.update.factor * if self.update.is_corrected { u + z } else { u }]
    }
}

/// Sets r = -e; sums e^2 and `(h - approach)^2`; or sums (r, d) and (r, r).
#[derive(Clone, Copy)]
pub(super) struct Residual {
    pub(super) approach: f64,
}

impl Becomes<2, 0> for Residual {
    #[inline(always)]
    fn of<S: Simd>(&self, _: Lanes<S>, [h, u]: [Lanes<S>; 2], []: [Lanes<S>; 0]) -> Lanes<S> {
        -(h - self.approach + u)
    }
}

impl Terms<2, 0, 2> for Residual {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u]: [Lanes<S>; 2], []: [Lanes<S>; 0]) -> [Lanes<S>; 2] {
        let distance = h - self.approach;
        let e = distance + u;
        [e * e, distance * distance]
    }
}

/// The sums (r, d), with the deflation direction d, and (r, r).
impl Terms<2, 1, 2> for Residual {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u]: [Lanes<S>; 2], [d]: [Lanes<S>; 1]) -> [Lanes<S>; 2] {
        let r = self.approach - h - u;
        [r * d, r * r]
    }
}

/// The sums of t, of z and of q, and the inner product (z, q).
#[derive(Clone, Copy)]
pub(super) struct Conjugate;

impl Terms<0, 3, 4> for Conjugate {
    #[inline(always)]
    fn of<S: Simd>(&self, []: [Lanes<S>; 0], [t, z, q]: [Lanes<S>; 3]) -> [Lanes<S>; 4] {
        [t, z, q, z * q]
    }
}

/// Sets `t = z - mean + beta t`, clipped so that the forecast step does not take p below 0.
#[derive(Clone, Copy)]
pub(super) struct Direction {
    pub(super) mean: f64,
    pub(super) beta: f64,
    pub(super) forecast: Option<f64>,
}

impl Becomes<1, 1> for Direction {
    #[inline(always)]
    fn of<S: Simd>(&self, t: Lanes<S>, [p]: [Lanes<S>; 1], [z]: [Lanes<S>; 1]) -> Lanes<S> {
        let t = z - self.mean + self.beta * t;
        match self.forecast {
            Some(forecast) => (p + forecast * t).is_below(p.all(0.0)).choose(-p / forecast, t),
            None => t,
        }
    }
}

/// Sets `t = t - shift`, clipped as by [`Direction`].
#[derive(Clone, Copy)]
pub(super) struct Lowered {
    pub(super) shift: f64,
    pub(super) forecast: f64,
}

impl Becomes<1, 0> for Lowered {
    #[inline(always)]
    fn of<S: Simd>(&self, t: Lanes<S>, [p]: [Lanes<S>; 1], []: [Lanes<S>; 0]) -> Lanes<S> {
        let t = t - self.shift;
        (p + self.forecast * t).is_below(p.all(0.0)).choose(-p / self.forecast, t)
    }
}

/// The sums of t and of |t|, and the number of elements that are not clipped.
#[derive(Clone, Copy)]
pub(super) struct Free {
    pub(super) forecast: f64,
}

impl Terms<1, 1, 3> for Free {
    #[inline(always)]
    fn of<S: Simd>(&self, [p]: [Lanes<S>; 1], [t]: [Lanes<S>; 1]) -> [Lanes<S>; 3] {
        let held = (p + self.forecast * t).is_at_most(CLIPPED_SHARE * p);
        [t, t.abs(), held.choose(t.all(0.0), t.all(1.0))]
    }
}

/// The sums (r, t), (t, q), (t, t), the sum of |t|, (p, p).
#[derive(Clone, Copy)]
pub(super) struct StepTerms {
    pub(super) approach: f64,
}

impl Terms<3, 2, 5> for StepTerms {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u, p]: [Lanes<S>; 3], [t, q]: [Lanes<S>; 2]) -> [Lanes<S>; 5] {
        let e = h - self.approach + u;
        [-e * t, t * q, t * t, t.abs(), p * p]
    }
}

/// The same sums, then with `d = approach - h` the sums (p, d), (t, d), (p, u), (p, q).
impl Terms<3, 2, 9> for StepTerms {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u, p]: [Lanes<S>; 3], [t, q]: [Lanes<S>; 2]) -> [Lanes<S>; 9] {
        let depth = self.approach - h;
        [(depth - u) * t, t * q, t * t, t.abs(), p * p, p * depth, t * depth, p * u, p * q]
    }
}

/// The same sums, then with the deflation direction d the sums (r, d), (q, d).
impl Terms<3, 3, 7> for StepTerms {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u, p]: [Lanes<S>; 3], [t, q, d]: [Lanes<S>; 3]) -> [Lanes<S>; 7] {
        let r = self.approach - h - u;
        [r * t, t * q, t * t, t.abs(), p * p, r * d, q * d]
    }
}

/// The sums `(p, approach - h)` and (p, u), where u is that after `update` before scaling.
#[derive(Clone, Copy)]
pub(super) struct WorkAndEnergy<'a> {
    pub(super) approach: f64,
    pub(super) update: &'a Update,
}

impl Terms<3, 3, 2> for WorkAndEnergy<'_> {
    #[inline(always)]
    fn of<S: Simd>(&self, [h, u, p]: [Lanes<S>; 3], [q, z, w]: [Lanes<S>; 3]) -> [Lanes<S>; 2] {
        let u = u + (self.update.alpha * q + self.update.gamma * w);
        let u = if self.update.is_corrected { u + z } else { u };
        [p * (self.approach - h), p * u]
    }
}

/// The sum of p.
#[derive(Clone, Copy)]
pub(super) struct Carried;

impl Terms<1, 0, 1> for Carried {
    #[inline(always)]
    fn of<S: Simd>(&self, p: [Lanes<S>; 1], []: [Lanes<S>; 0]) -> [Lanes<S>; 1] {
        p
    }
}

/// Sets `p = factor p`.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    pub(super) factor: f64,
}

impl Becomes<0, 0> for Scale {
    #[inline(always)]
    fn of<S: Simd>(&self, p: Lanes<S>, []: [Lanes<S>; 0], []: [Lanes<S>; 0]) -> Lanes<S> {
        self.factor * p
    }
}

/// Sets `p = p + alpha t + gamma d`.
#[derive(Clone, Copy)]
pub(super) struct Moved {
    pub(super) alpha: f64,
    pub(super) gamma: f64,
}

impl Becomes<0, 2> for Moved {
    #[inline(always)]
    fn of<S: Simd>(&self, p: Lanes<S>, []: [Lanes<S>; 0], [t, d]: [Lanes<S>; 2]) -> Lanes<S> {
        p + (self.alpha * t + self.gamma * d)
    }
}

/// Step (4.1): chooses the elements whose p the move takes beyond a bound, and clipped elements: the forecast step reduces their p, or their distance
/// from the limit, to round-off.
#[derive(Clone, Copy)]
pub(super) struct Leaving<Set> {
    pub(super) moved: Moved,
    pub(super) forecast: Option<f64>,
    pub(super) set: Set,
    /// The number of elements of the grid.
    pub(super) elements: usize,
}

impl<Set: AdmissibleSet> Wanted<2> for Leaving<Set> {
    #[inline(always)]
    fn of<S: Simd>(&self, first: usize, p: Lanes<S>, [t, d]: [Lanes<S>; 2]) -> Holds<S> {
        let Leaving { moved, forecast, set, elements } = self;
        let to = moved.of(p, [], [t, d]);
        let mut leaves = to.is_below(p.all(0.0));
        let foreseen = forecast.map(|forecast| p + forecast * t);
        if let Some(foreseen) = foreseen {
            leaves = leaves | foreseen.is_at_most(CLIPPED_SHARE * p);
        }
        if Set::LIMITED {
            // The last vector is padded: lanes beyond the last element have no limit.
            let limits = p.of_each(|lane| if first + lane < *elements { set.limit(first + lane) } else { 0.0 });
            leaves = leaves | limits.is_below(to);
            if let Some(foreseen) = foreseen {
                leaves = leaves | (limits * (1.0 - CLIPPED_SHARE)).is_at_most(foreseen);
            }
        }
        leaves
    }
}

/// Sets `u = factor (u + alpha q + gamma w + A d)`: from q alone, or from q, w and z. z holds A d if `is_corrected`.
#[derive(Clone, Copy)]
pub(super) struct MovedU<'a>(pub(super) &'a Update);

impl Becomes<1, 1> for MovedU<'_> {
    #[inline(always)]
    fn of<S: Simd>(&self, u: Lanes<S>, _: [Lanes<S>; 1], [q]: [Lanes<S>; 1]) -> Lanes<S> {
        self.0.factor * (u + self.0.alpha * q)
    }
}

impl Becomes<1, 3> for MovedU<'_> {
    #[inline(always)]
    fn of<S: Simd>(&self, u: Lanes<S>, _: [Lanes<S>; 1], [q, w, z]: [Lanes<S>; 3]) -> Lanes<S> {
        let u = u + (self.0.alpha * q + self.0.gamma * w);
        self.0.factor * if self.0.is_corrected { u + z } else { u }
    }
}

/// Step (4.2): chooses the elements that enter C.
#[derive(Clone, Copy)]
pub(super) struct Entering<'a> {
    pub(super) approach: f64,
    /// Whether the contact area is given.
    pub(super) is_fixed: bool,
    /// For each element, whether it is at its limit. Empty if none is.
    pub(super) held: &'a [bool],
}

impl Wanted<1> for Entering<'_> {
    #[inline(always)]
    fn of<S: Simd>(&self, first: usize, u: Lanes<S>, [h]: [Lanes<S>; 1]) -> Holds<S> {
        let (e, zero) = (h - self.approach + u, u.all(0.0));
        if self.is_fixed {
            return zero.is_below(zero);
        }
        if self.held.is_empty() {
            return e.is_below(zero);
        }
        // The side is 1 at the limit, where an element enters if e > 0, and -1 elsewhere, where it enters if e < 0.
        let side = e.of_each(|lane| if self.held.get(first + lane) == Some(&true) { 1.0 } else { -1.0 });
        zero.is_below(side * e)
    }
}
