//! The passes over a change of the pressures d and its displacements w, compiled for the vectors of this machine, on which no bit depends.

use crate::operator::fft::Real;
use crate::sums::Sums;

/// A row of d and w: the present values less a factor times the earlier ones, which converts their units.
pub(super) struct Change<'a, T> {
    pub(super) p: (&'a [f64], &'a [f64], f64),
    pub(super) u: (&'a [f64], &'a [f64], f64),
    pub(super) d: &'a mut [T],
    pub(super) w: &'a mut [T],
    /// The sums of d, |d| and |p|, and the measures of d and w.
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

/// Moves the values outside C from d to z, which is overwritten. Returns whether there are any.
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

/// w = w - z; returns the measures of d and w.
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

/// An element's terms of (d, w) and of the sums of d^2 and of w^2 over the elements of d. An infinite w makes (d, w) NaN at d = 0, which rejects the
/// change.
#[inline(always)]
pub(super) fn measures(d: f64, w: f64) -> [f64; 3] {
    [d * w, d * d, if d == 0.0 { 0.0 } else { w * w }]
}

#[cfg(test)]
#[path = "../../../tests/unit/deflation_passes.rs"]
mod tests;
