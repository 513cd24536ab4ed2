//! Products of a scene with [patches](crate::influence::Patches): one product for each of them,
//!
//! ```text
//! u on patch a = A (sum over patches b of F(a, b) p on b)
//! ```

use super::fft::Real;
use crate::error::Result;
use crate::influence::Patches;
use crate::memory::reserve;

/// What a product needs to know of patches.
pub(super) struct Mask<T> {
    count: usize,
    patch: Vec<u16>,
    factors: Vec<T>,
}

fn copy(patch: &[u16]) -> Result<Vec<u16>> {
    let mut kept = Vec::new();
    reserve(&mut kept, patch.len(), "the patches")?;
    kept.extend_from_slice(patch);
    Ok(kept)
}

impl<T: Real> Mask<T> {
    pub fn new(patches: &Patches) -> Result<Mask<T>> {
        let count = patches.count();
        let factors = (0..count * count).map(|k| T::of(patches.factor(k / count, k % count))).collect();
        Ok(Mask { count, patch: copy(patches.patch())?, factors })
    }

    /// The same in another precision.
    pub fn in_precision<S: Real>(&self) -> Result<Mask<S>> {
        let factors = self.factors.iter().map(|factor| S::of(factor.to_double())).collect();
        Ok(Mask { count: self.count, patch: copy(&self.patch)?, factors })
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.patch[..]) + size_of_val(&self.factors[..])
    }

    /// `u = A p`, by products `multiply(p, u)` without factors.
    pub fn apply(&self, p: &[T], u: &mut [T], scratch: &mut [Vec<T>; 2], mut multiply: impl FnMut(&[T], &mut [T])) {
        let [scaled, product] = scratch;
        for a in 0..self.count {
            let factors = &self.factors[a * self.count..(a + 1) * self.count];
            for ((scaled, p), &b) in scaled.iter_mut().zip(p).zip(&self.patch) {
                *scaled = *p * factors[usize::from(b)];
            }
            multiply(scaled, product);
            for ((u, product), _) in u.iter_mut().zip(&*product).zip(&self.patch).filter(|(_, &b)| usize::from(b) == a)
            {
                *u = *product;
            }
        }
    }
}
