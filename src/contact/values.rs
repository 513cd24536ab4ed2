//! How accurate the displacements of a state are, and two small functions: whether any pressure is not 0, and the smallest distance.

use crate::sums::least;

/// How accurately the stored u of a state equals A p ("freshness").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freshness {
    /// u is A p in double precision, from a product or from a linear combination of products.
    Exact,
    /// u approximates A p: u was updated step by step, or interpolated from a coarser grid. A fresh product replaces u before a solve counts as
    /// converged.
    Near,
    /// u does not belong to p. A product computes u before it is used.
    Stale,
}

/// Whether any pressure is not 0. NaN counts as a pressure, -0 does not.
#[inline(always)]
pub fn presses(p: &[f64]) -> bool {
    // The shift drops the sign bit. With bits instead of `!= 0.0` the loop has no branch, and the compiler vectorises it.
    p.iter().fold(0, |any, p| any | p.to_bits() << 1) != 0
}

/// The smallest distance. It is infinite if all elements are excluded (`h = +infinity`).
pub fn lowest(h: &[f64]) -> f64 {
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || least(h),
    )
}
