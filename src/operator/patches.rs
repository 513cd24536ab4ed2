//! Products of a scene with [patches](crate::influence::Patches): one product for each of them,
//!
//! ```text
//! u on patch a = A (sum over patches b of F(a, b) p on b)
//! ```

use super::fft::Real;
use crate::influence::Patches;

/// What a product needs to know of patches.
pub(super) struct Mask<T> {
    count: usize,
    patch: Vec<u16>,
    factors: Vec<T>,
}

impl<T: Real> Mask<T> {
    pub fn new(patches: &Patches) -> Mask<T> {
        let count = patches.count();
        let factors = (0..count * count).map(|k| T::of(patches.factor(k / count, k % count))).collect();
        Mask { count, patch: patches.patch().to_vec(), factors }
    }

    /// The same in another precision.
    pub fn in_precision<S: Real>(&self) -> Mask<S> {
        let factors = self.factors.iter().map(|factor| S::of(factor.to_double())).collect();
        Mask { count: self.count, patch: self.patch.clone(), factors }
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
