//! Complex transforms of any length, by the crate rustfft.
//!
//! Each length is planned by a new planner of rustfft. A shared planner would reuse parts of earlier plans, so the bits of a transform would depend
//! on which lengths were planned before.

use std::sync::Arc;

use par::memory::{reserve, sparse};
use par::Result;
use rustfft::Fft;

use crate::passes::Real;
use crate::plan::{shared, Plan, PLAN};
use crate::real::Complex;

/// The number of complex values that rustfft allocates while it plans both directions of a length, relative to the length: if all prime factors are
/// small, and otherwise. In measurements at lengths up to 100000, in steps of 257, and at longer ones, it was at most 2.3 with small prime factors.
/// It was at most 16.5 for primes, which use a transform of more than twice the length.
const RELATIVE_SIZES: [usize; 2] = [3, 17];
/// The largest small prime: rustfft transforms it in one step.
const SMALL_PRIME: usize = 31;

/// The number of complex values that must be available before a length is planned.
fn room(length: usize) -> usize {
    let (mut rest, mut prime) = (length, 2);
    while rest > 1 && prime <= SMALL_PRIME {
        match rest % prime {
            0 => rest /= prime,
            _ => prime += 1,
        }
    }
    length.saturating_mul(RELATIVE_SIZES[usize::from(rest > 1)])
}

/// Lengthens the scratch of transforms to this length, if it is shorter.
pub fn fit<T: Real>(scratch: &mut Vec<Complex<T>>, length: usize) -> Result<()> {
    let length = scratch.len().max(length);
    reserve(scratch, length, "the scratch of transforms")?;
    scratch.resize(length, Complex::default());
    Ok(())
}

/// Allocates scratch of this length.
pub fn scratch_of<T: Real>(length: usize) -> Result<Vec<Complex<T>>> {
    let mut scratch = Vec::new();
    fit(&mut scratch, length)?;
    Ok(scratch)
}

/// Complex transforms of columns of one length and their inverses. Both are unnormalised: a column transformed there and back is `length` times
/// itself.
#[derive(Clone)]
pub struct ColumnTransform<T: Real> {
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
}

impl<T: Real> Plan for ColumnTransform<T> {
    fn bytes(&self) -> usize {
        room(self.length()) * size_of::<Complex<T>>()
    }
}

impl<T: Real> ColumnTransform<T> {
    /// Makes the plans for columns of length `n`. Without memory rustfft would end the process, so this function first tests whether there is enough.
    pub fn new(n: usize) -> Result<ColumnTransform<T>> {
        Ok((*shared(n, || ColumnTransform::planned(n))?).clone())
    }

    /// Makes a new plan.
    fn planned(n: usize) -> Result<ColumnTransform<T>> {
        drop(sparse::<Complex<T>>(room(n), PLAN)?);
        let [forward, inverse] = T::plans(n);
        Ok(ColumnTransform { forward, inverse })
    }

    /// The length of a column.
    pub fn length(&self) -> usize {
        self.forward.len()
    }

    /// Allocates the scratch of the transforms in both directions.
    pub fn scratch(&self) -> Result<Vec<Complex<T>>> {
        scratch_of(self.scratch_length())
    }

    /// Lengthens scratch to [`scratch_length`](Self::scratch_length), if it is shorter.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) -> Result<()> {
        fit(scratch, self.scratch_length())
    }

    /// The length of the scratch that all transforms need, in place and out of place.
    pub fn scratch_length(&self) -> usize {
        let length = |fft: &dyn Fft<T>| fft.get_inplace_scratch_len().max(fft.get_outofplace_scratch_len());
        length(&*self.forward).max(length(&*self.inverse))
    }

    /// The length of the scratch that transforms out of place need.
    pub fn scratch_to(&self) -> usize {
        self.forward.get_outofplace_scratch_len().max(self.inverse.get_outofplace_scratch_len())
    }

    /// Transforms one column out of place; `column` is overwritten.
    pub fn forward_to(&self, column: &mut [Complex<T>], to: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.forward.process_outofplace_with_scratch(column, to, scratch);
    }

    /// Transforms one column back, out of place; `column` is overwritten.
    pub fn inverse_to(&self, column: &mut [Complex<T>], to: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.inverse.process_outofplace_with_scratch(column, to, scratch);
    }

    /// Transforms consecutive columns in place.
    pub fn forward(&self, columns: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.forward.process_with_scratch(columns, scratch);
    }

    /// Transforms consecutive columns back in place.
    pub fn inverse(&self, columns: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.inverse.process_with_scratch(columns, scratch);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/any_length.rs"]
mod tests;
