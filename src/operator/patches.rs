//! Products of a scene with [patches](crate::influence::Patches): one product for each of them,
//!
//! ```text
//! u on patch a = A (sum over patches b of F(a, b) p on b)
//! ```

use super::fft::Real;
use crate::influence::Patches;

/// `u = A p`, by products `multiply(p, u)` without factors.
pub(super) fn apply<T: Real>(
    patches: &Patches,
    p: &[T],
    u: &mut [T],
    [scaled, product]: &mut [Vec<T>; 2],
    mut multiply: impl FnMut(&[T], &mut [T]),
) {
    for a in 0..patches.count() {
        for ((scaled, p), &b) in scaled.iter_mut().zip(p).zip(patches.patch()) {
            *scaled = *p * T::of(patches.factor(a, b.into()));
        }
        multiply(scaled, product);
        for ((u, product), &b) in u.iter_mut().zip(&*product).zip(patches.patch()) {
            if usize::from(b) == a {
                *u = *product;
            }
        }
    }
}
