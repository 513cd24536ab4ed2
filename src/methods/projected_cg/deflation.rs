//! The deflation direction: a direction d whose displacement w = A d is known, so that a step along it costs no product.
//!
//! Under a prescribed approach the residual has a part that is uniform over C. The pressure of a flat punch on C removes it, but a few
//! products with M do not approximate this pressure, because M ignores the boundary of C. A small change of the load changes p by nearly this
//! pressure, so the change of p since the last solution in time serves for d. Module `uniform` has another direction.
//!
//! An element that leaves C later is removed from d but not from w = A d and from (d, w); the missing part is added to the deferred corrections.

use super::deflation_passes::measures;
use crate::error::Result;
use crate::memory::{keep, reserve};
use crate::operator::fft::Real;
use crate::sums::Sums;

/// Pressures of an earlier solution and their displacements, on the whole grid, in the scene's units.
#[derive(Clone, Copy)]
pub struct Last<'a> {
    /// p.
    pub p: &'a [f64],
    /// u = A p. Without it w takes a product.
    pub u: Option<&'a [f64]>,
}

/// d and w = A d.
#[derive(Default)]
pub(super) struct Deflation<T> {
    pub(super) d: Vec<T>,
    pub(super) w: Vec<T>,
    /// (d, w); 0 without a direction.
    pub(super) energy: f64,
    /// The sums of d^2, and of w^2 over the elements of d.
    length: f64,
    pub(super) size: f64,
    /// Whether d follows from C, not from the last change (modules `uniform` and `flat_punch`).
    pub(super) is_uniform: bool,
    /// Elements of C when d was made.
    pub(super) elements: u64,
    /// Elements that left C: they are 0 in d, but w contains their displacements.
    pub(super) outside: Vec<(usize, f64)>,
}

impl<T> Deflation<T> {
    /// Drops the direction.
    pub(super) fn forget(&mut self) {
        self.energy = 0.0;
    }

    /// Whether there is a direction.
    pub(super) fn is_there(&self) -> bool {
        self.energy > 0.0
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        2 * self.d.len() * size_of::<T>()
    }
}

impl<T: Real> Deflation<T> {
    /// d and w; t and q if gamma is 0, so that no other memory is read.
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

    /// Allocates memory for d and w, and removes the elements that left.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        for values in [&mut self.d, &mut self.w] {
            reserve(values, n, "the change of the last step")?;
            values.resize(n, T::zero());
        }
        self.outside.clear();
        Ok(())
    }

    /// Keeps the memory for later solves.
    pub(super) fn keep(&mut self) {
        keep([&mut self.d, &mut self.w]);
    }

    /// Measures d and w = A d.
    pub(super) fn measure(&mut self) {
        let mut sums = Sums::new();
        sums.add([], [&self.d, &self.w], |[], [d, w]| measures(d, w));
        self.take_measures(sums.values());
    }

    /// Takes (d, w), and the sums of d^2 and of w^2, from a pass. Drops the direction if w is out of the range of single precision.
    pub(super) fn take_measures(&mut self, [energy, length, size]: [f64; 3]) {
        let energy = if energy.is_finite() { energy } else { 0.0 };
        (self.energy, self.length, self.size) = (energy, length, size);
    }
}
