//! Admissible sets: the pressures that a scene allows. Steps (4.1) and (4.2) are projections on them, with one implementation for all sets.
//!
//! ```text
//! half-line   0 <= p              (NonNegative)
//! box         0 <= p <= p_max     (PressureLimit, the effect)
//! ```
//!
//! A third set is that of a given contact area (active_set FIXED): any pressure on the given elements ([`Fixed`]).
//!
//! An element is free (in C, with e = 0), exterior (p = 0, e >= 0), or at its limit (p = p_max, e <= 0). A half-line has no limit:
//! [`AdmissibleSet::LIMITED`] is a constant, and code for limits is not compiled.

use crate::effects::{Each, PressureLimit};

/// The pressures that each element may have.
pub trait AdmissibleSet: Copy + Send + Sync {
    /// Whether there are limits.
    const LIMITED: bool;

    /// Whether the contact area is given: no element enters or leaves it, and pressures may be negative.
    const FIXED: bool = false;

    /// The set on a part of the grid, or on a coarser one.
    type Within<'a>: AdmissibleSet;

    /// The set with the `limits` of its elements, if there are any.
    fn within(limits: &[f64]) -> Self::Within<'_>;

    /// The greatest pressure of element i; `+infinity` without a limit.
    fn limit(&self, _i: usize) -> f64 {
        f64::INFINITY
    }

    /// Whether any of the pressures `p` of elements from `first` on exceeds its limit, in a loop that the compiler vectorises.
    fn any_beyond(&self, _first: usize, _p: impl Iterator<Item = f64>) -> bool {
        false
    }

    /// The admissible pressure nearest to `p`.
    fn project(&self, i: usize, p: f64) -> f64 {
        let p = p.max(0.0);
        if Self::LIMITED {
            p.min(self.limit(i))
        } else {
            p
        }
    }

    /// Step (4.1): whether a free element with pressure `p` leaves C for the exterior area or for its limit.
    fn leaves(&self, i: usize, p: f64) -> bool {
        !Self::FIXED && (p < 0.0 || Self::LIMITED && p > self.limit(i))
    }

    /// Step (4.2): whether an element that is not free, at its limit or exterior, enters C with the deformed distance `e`. The paper has `e <= 0`. An
    /// element with `e = 0` and `p = 0` satisfies the conditions of C and of the exterior area. Here it stays exterior. So it does not count as a
    /// change of C (step 5), and conforming bodies do not enter C as a whole.
    fn enters(&self, at_limit: bool, e: f64) -> bool {
        !Self::FIXED && if at_limit { e > 0.0 } else { e < 0.0 }
    }
}

/// `p >= 0`.
#[derive(Clone, Copy, Debug)]
pub struct NonNegative;

impl AdmissibleSet for NonNegative {
    const LIMITED: bool = false;

    type Within<'a> = NonNegative;

    fn within(_: &[f64]) -> NonNegative {
        NonNegative
    }
}

/// Any pressure on a given contact area.
#[derive(Clone, Copy, Debug)]
pub struct Fixed;

impl AdmissibleSet for Fixed {
    const LIMITED: bool = false;
    const FIXED: bool = true;

    type Within<'a> = Fixed;

    fn within(_: &[f64]) -> Fixed {
        Fixed
    }

    fn project(&self, _: usize, p: f64) -> f64 {
        p
    }
}

/// `0 <= p <= p_max`.
impl AdmissibleSet for PressureLimit<'_> {
    const LIMITED: bool = true;

    type Within<'a> = PressureLimit<'a>;

    fn within(limits: &[f64]) -> PressureLimit<'_> {
        PressureLimit(Each::PerElement(limits))
    }

    #[inline]
    fn limit(&self, i: usize) -> f64 {
        self.0.at(i)
    }

    #[inline]
    fn any_beyond(&self, first: usize, p: impl Iterator<Item = f64>) -> bool {
        match self.0 {
            Each::Uniform(limit) => p.fold(false, |any, p| any | (p > limit)),
            Each::PerElement(limits) => p.zip(&limits[first..]).fold(false, |any, (p, limit)| any | (p > *limit)),
        }
    }
}
