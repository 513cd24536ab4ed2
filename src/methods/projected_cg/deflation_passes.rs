//! The loops over a change d of the pressures and its displacements w. They are compiled for the vector length of this machine, on which no bit
//! depends.

use crate::operator::fft::Real;
use crate::sums::Sums;

/// Computes d and w in one row: present values minus earlier values. Earlier values are in the scene's units; a factor converts them.
pub(super) struct Change<'a, T> {
    /// Present pressures, earlier pressures, and the factor on the earlier ones.
    pub(super) p: (&'a [f64], &'a [f64], f64),
    /// Present displacements, earlier displacements, and the factor on the earlier ones.
    pub(super) u: (&'a [f64], &'a [f64], f64),
    pub(super) d: &'a mut [T],
    pub(super) w: &'a mut [T],
    /// The sums of d, |d| and |p|, and the three sums of [`measures`].
    pub(super) sums: &'a mut Sums<6>,
}

impl<T: Real> pulp::NullaryFnOnce for Change<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Change { p: (p, last_p, pressure), u: (u, last_u, length), d, w, sums } = self;
        d.iter_mut().zip(p).zip(last_p).for_each(|((d, p), last)| *d = T::of(p - pressure * last));
        w.iter_mut().zip(u).zip(last_u).for_each(|((w, u), last)| *w = T::of(u - length * last));
        sums.add([p, last_p], [&*d, &*w], |[p, last_p], [d, w]| {
            let change = p - pressure * last_p;
            let [energy, length, size] = measures(d, w);
            [change, change.abs(), p.abs(), energy, length, size]
        });
    }
}

/// Moves the values of elements outside C from d to z, which is 0 elsewhere. Returns whether any of these values is not 0.
pub(super) struct Restrict<'a, T> {
    pub(super) d: &'a mut [T],
    pub(super) z: &'a mut [T],
    pub(super) contact: &'a [bool],
}

impl<T: Real> pulp::NullaryFnOnce for Restrict<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Restrict { d, z, contact } = self;
        let mut leaves = false;
        for ((d, z), inside) in d.iter_mut().zip(z).zip(contact) {
            (*d, *z) = if *inside { (*d, T::zero()) } else { (T::zero(), *d) };
            leaves |= *z != T::zero();
        }
        leaves
    }
}

/// Subtracts z from w. Returns the three sums of [`measures`].
pub(super) struct Subtract<'a, T> {
    pub(super) d: &'a [T],
    pub(super) w: &'a mut [T],
    pub(super) z: &'a [T],
}

impl<T: Real> pulp::NullaryFnOnce for Subtract<'_, T> {
    type Output = [f64; 3];

    #[inline(always)]
    fn call(self) -> [f64; 3] {
        let (Subtract { d, w, z }, mut sums) = (self, Sums::new());
        w.iter_mut().zip(z).for_each(|(w, z)| *w = *w - *z);
        sums.add([], [d, w], |[], [d, w]| measures(d, w));
        sums.values()
    }
}

/// One element's terms in (d, w), in the sum of d^2, and in the sum of w^2 over the elements where d is not 0. An infinite w makes (d, w) infinite or
/// NaN, even if d = 0. The direction is then discarded.
#[inline(always)]
pub(super) fn measures(d: f64, w: f64) -> [f64; 3] {
    [d * w, d * d, if d == 0.0 { 0.0 } else { w * w }]
}

#[cfg(test)]
#[path = "../../../tests/unit/deflation_passes.rs"]
mod tests;
