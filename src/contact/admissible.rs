//! Admissible sets: the pressures that a scene allows. Steps (4.1) and (4.2) are projections on such a set, with one implementation for all sets.
//!
//! ```text
//! half-line   0 <= p              (NonNegative)
//! box         0 <= p <= p_max     (PressureLimit, the effect)
//! ```
//!
//! A third set belongs to a given contact area (option `active_set` FIXED): it allows any pressure on the given elements ([`Fixed`]).
//!
//! An element is free (in C, with e = 0), exterior (p = 0, e >= 0), or at its limit (p = p_max, e <= 0). A half-line has no limit:
//! [`AdmissibleSet::LIMITED`] is a constant, and code for limits is not compiled.

use crate::effects::{Each, PressureLimit};

/// The pressures that each element may have.
pub trait AdmissibleSet: Copy + Send + Sync {
    /// Whether elements have a pressure limit.
    const LIMITED: bool;

    /// Whether the contact area is given: no element enters or leaves it, and pressures may be negative.
    const FIXED: bool = false;

    /// The type of the same set on a part of the grid, or on a coarser grid.
    type Within<'a>: AdmissibleSet;

    /// The same set on other elements, with the pressure `limits` of these elements. A set without limits ignores them.
    fn within(limits: &[f64]) -> Self::Within<'_>;

    /// The greatest pressure of element i; `+infinity` without a limit.
    fn limit(&self, _i: usize) -> f64 {
        f64::INFINITY
    }

    /// Whether any of the pressures `p` exceeds its element's limit. The pressures are those of the elements `first`, `first + 1`, ... The compiler
    /// vectorises the loop.
    fn any_beyond(&self, _first: usize, _p: impl Iterator<Item = f64>) -> bool {
        false
    }

    /// The admissible pressure of element i that is nearest to `p`.
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

    /// Step (4.2): whether an element outside C (exterior, or `at_limit`) with the deformed distance `e` enters C. The paper admits exterior elements
    /// with `e <= 0`, this function those with `e < 0`. An element with `e = 0` and `p = 0` satisfies the conditions of C and those of the exterior
    /// area. Here it stays exterior. So it does not count as a change of C (step 5), and conforming bodies do not enter C as a whole.
    fn enters(&self, at_limit: bool, e: f64) -> bool {
        !Self::FIXED && if at_limit { e > 0.0 } else { e < 0.0 }
    }
}

/// The half-line `p >= 0`.
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

/// The box `0 <= p <= p_max`.
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
