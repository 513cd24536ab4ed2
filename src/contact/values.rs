//! The freshness of displacements, and reductions over arrays of pressures and distances.

use crate::sums::least;

/// The freshness of a state's u.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freshness {
    /// u = A p.
    Exact,
    /// u is near A p.
    Near,
    /// u may be anything.
    Stale,
}

/// Whether any pressure is not 0.
#[inline(always)]
pub fn presses(p: &[f64]) -> bool {
    p.iter().fold(0, |any, p| any | p.to_bits() << 1) != 0
}

/// The least of all distances; infinite if there is no surface.
pub fn lowest(h: &[f64]) -> f64 {
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || least(h),
    )
}
