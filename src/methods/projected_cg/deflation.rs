//! The deflation direction: a change d of the pressures whose displacement w = A d is known, so that a step along d costs no product.
//!
//! If the approach is prescribed, the residual has a part that is uniform over C. The pressure of a flat punch on C would remove this part, but a few
//! products with M do not approximate this pressure, because M ignores the boundary of C. A small change of the load changes p by nearly the pressure
//! of a flat punch. So d is the change of p since the last solution in time. Module `uniform` has another choice of d.
//!
//! An element that leaves C later is removed from d, but neither from w = A d nor from (d, w). The missing part of u is added to the deferred
//! corrections.

use super::deflation_passes::measures;
use crate::error::Result;
use crate::memory::{keep, reserve};
use crate::operator::fft::Real;
use crate::sums::Sums;

/// The pressures and displacements of an earlier solution, on the whole grid, in the scene's units.
#[derive(Clone, Copy)]
pub struct Last<'a> {
    /// The pressures p.
    pub p: &'a [f64],
    /// The displacements u = A p. If they are not known, w takes a product.
    pub u: Option<&'a [f64]>,
}

/// The deflation direction d and its displacement w = A d.
#[derive(Default)]
pub(super) struct Deflation<T> {
    pub(super) d: Vec<T>,
    pub(super) w: Vec<T>,
    /// (d, w); 0 without a direction.
    pub(super) energy: f64,
    /// The sum of d^2.
    length: f64,
    /// The sum of w^2 over the elements where d is not 0.
    pub(super) size: f64,
    /// Whether d depends on C alone (modules `uniform` and `flat_punch`), not on the last change of p.
    pub(super) is_uniform: bool,
    /// The number of elements in C when d was set up.
    pub(super) elements: u64,
    /// The elements that left C since then, with their former d. d is now 0 there, but w contains their displacements.
    pub(super) outside: Vec<(usize, f64)>,
}

impl<T> Deflation<T> {
    /// Discards the direction.
    pub(super) fn forget(&mut self) {
        self.energy = 0.0;
    }

    /// Whether there is a direction.
    pub(super) fn is_there(&self) -> bool {
        self.energy > 0.0
    }

    /// Bytes of d and w.
    pub(super) fn bytes(&self) -> usize {
        2 * self.d.len() * size_of::<T>()
    }
}

impl<T: Real> Deflation<T> {
    /// The arrays d and w for a step of length gamma along d. If gamma is 0, t and q stand for them, so that no other memory is read.
    pub(super) fn beside<'a>(&'a self, gamma: f64, t: &'a [T], q: &'a [T]) -> (&'a [T], &'a [T]) {
        if gamma == 0.0 {
            (t, q)
        } else {
            (&self.d, &self.w)
        }
    }

    /// The number of elements that left d.
    pub(super) fn left(&self) -> usize {
        self.outside.len()
    }

    /// The 2-norm of d.
    pub(super) fn norm(&self) -> f64 {
        self.length.sqrt()
    }

    /// Allocates memory for d and w, and forgets the elements that left d.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        for values in [&mut self.d, &mut self.w] {
            reserve(values, n, "the change of the last step")?;
            values.resize(n, T::zero());
        }
        self.outside.clear();
        Ok(())
    }

    /// Gives the memory of d and w to later solves, when this direction is no longer used.
    pub(super) fn keep(&mut self) {
        keep([&mut self.d, &mut self.w]);
    }

    /// Computes (d, w) and the sums of d^2 and w^2.
    pub(super) fn measure(&mut self) {
        let mut sums = Sums::new();
        sums.add([], [&self.d, &self.w], |[], [d, w]| measures(d, w));
        self.take_measures(sums.values());
    }

    /// Sets (d, w), and the sums of d^2 and of w^2. Discards the direction if (d, w) is not finite, because w is out of the range of single
    /// precision.
    pub(super) fn take_measures(&mut self, [energy, length, size]: [f64; 3]) {
        let energy = if energy.is_finite() { energy } else { 0.0 };
        (self.energy, self.length, self.size) = (energy, length, size);
    }
}
