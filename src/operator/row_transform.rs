//! Transforms of real rows: an even length n by a complex transform of half of it (Cooley, Lewis and Welch 1970).
//!
//! ```text
//! z_j = x_2j + i x_(2j+1),   Z = F z,   w_k = exp(-2 pi i k/n)
//! X_k         = (Z_k + Z*_(n/2-k))/2 - i w_k (Z_k - Z*_(n/2-k))/2
//! X_(n/2-k)*  = (Z_k + Z*_(n/2-k))/2 + i w_k (Z_k - Z*_(n/2-k))/2
//! ```
//!
//! and backwards. What follows (or goes before) the complex transform takes as long as half of that, so it is compiled for the vectors of
//! this machine; no bit depends on them. The operations and their order are those of the crate realfft, with which the test compares.

use std::f64::consts::PI;

use super::fft::{ColumnTransform, Complex, Real};

/// Transforms of real rows of one length `n` to `n/2 + 1` complex bins and back (unnormalised).
#[derive(Clone)]
pub struct RowTransform<T: Real> {
    n: usize,
    /// Of length n/2; of n where that is odd.
    complex: ColumnTransform<T>,
    /// `w_k/2`, 0 < k < n/4.
    twiddles: Vec<Complex<T>>,
}

impl<T: Real> RowTransform<T> {
    /// Plans for rows of length `n`.
    pub fn new(n: usize) -> RowTransform<T> {
        let is_even = n % 2 == 0;
        let twiddle = |k: usize| {
            let angle = -2.0 * PI / n as f64 * k as f64;
            Complex::new(T::of(angle.cos()), T::of(angle.sin())) * T::of(0.5)
        };
        let twiddles = if is_even { (1..n.div_ceil(4)).map(twiddle).collect() } else { Vec::new() };
        RowTransform { n, complex: ColumnTransform::new(if is_even { n / 2 } else { n }), twiddles }
    }

    /// Length of a real row.
    pub fn length(&self) -> usize {
        self.n
    }

    /// Number of complex bins.
    pub fn bins(&self) -> usize {
        self.n / 2 + 1
    }

    /// Scratch that both directions need.
    pub fn scratch(&self) -> Vec<Complex<T>> {
        let mut scratch = Vec::new();
        self.fit(&mut scratch);
        scratch
    }

    /// Makes scratch long enough.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) {
        let of_complex = if self.n % 2 == 0 { self.complex.scratch_to() } else { self.complex.scratch_length() };
        scratch.resize(scratch.len().max(self.complex.length() + of_complex), Complex::default());
    }

    /// Real row to bins; what the row lacks of its length is zero.
    pub fn forward(&self, row: &[T], bins: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        assert!(row.len() <= self.n && bins.len() == self.bins(), "a row transform of the wrong length");
        let (packed, scratch) = scratch.split_at_mut(self.complex.length());
        if self.n % 2 == 1 {
            let (given, rest) = packed.split_at_mut(row.len());
            given.iter_mut().zip(row).for_each(|(value, x)| *value = Complex::new(*x, T::zero()));
            rest.fill(Complex::default());
            self.complex.forward(packed, scratch);
            bins.copy_from_slice(&packed[..bins.len()]);
            bins[0].im = T::zero();
            return;
        }
        let (given, rest) = packed.split_at_mut(row.len().div_ceil(2));
        let pairs = row.chunks_exact(2);
        if let ([x], Some(last)) = (pairs.remainder(), given.last_mut()) {
            *last = Complex::new(*x, T::zero());
        }
        given.iter_mut().zip(pairs).for_each(|(value, x)| *value = Complex::new(x[0], x[1]));
        rest.fill(Complex::default());
        self.complex.forward_to(packed, &mut bins[..self.n / 2], scratch);
        let first = bins[0];
        bins[0] = Complex::new(first.re + first.im, T::zero());
        bins[self.n / 2] = Complex::new(first.re - first.im, T::zero());
        self.pass::<true>(bins);
    }

    /// Bins to the first values of a real row; the bins are overwritten.
    pub fn inverse(&self, bins: &mut [Complex<T>], row: &mut [T], scratch: &mut [Complex<T>]) {
        assert!(row.len() <= self.n && bins.len() == self.bins(), "a row transform of the wrong length");
        let (packed, scratch) = scratch.split_at_mut(self.complex.length());
        bins[0].im = T::zero();
        if self.n % 2 == 1 {
            packed[..bins.len()].copy_from_slice(bins);
            packed.iter_mut().rev().zip(&bins[1..]).for_each(|(value, bin)| *value = bin.conj());
            self.complex.inverse(packed, scratch);
            row.iter_mut().zip(&*packed).for_each(|(x, value)| *x = value.re);
            return;
        }
        let (first, last) = (bins[0].re, bins[self.n / 2].re);
        bins[0] = Complex::new(first + last, first - last);
        self.pass::<false>(bins);
        self.complex.inverse_to(&mut bins[..self.n / 2], packed, scratch);
        let row_pairs = row.len() / 2;
        let mut pairs = row.chunks_exact_mut(2);
        for (x, value) in pairs.by_ref().zip(&*packed) {
            (x[0], x[1]) = (value.re, value.im);
        }
        if let ([x], Some(last)) = (pairs.into_remainder(), packed.get(row_pairs)) {
            *x = last.re;
        }
    }

    /// All bins k and n/2 - k but the outermost: from those of the complex transform, or to them.
    fn pass<const FORWARD: bool>(&self, bins: &mut [Complex<T>]) {
        let count = self.twiddles.len();
        let (front, back) = bins.split_at_mut(self.n / 2 - count);
        pulp::Arch::new().dispatch(Pass::<T, FORWARD> {
            twiddles: &self.twiddles,
            front: &mut front[1..=count],
            back: &mut back[..count],
        });
        if self.n % 4 == 0 && self.n > 0 {
            let centre = &mut bins[self.n / 4];
            *centre = if FORWARD { centre.conj() } else { (*centre + *centre).conj() };
        }
    }
}

/// `back` is the mirror image of `front`. Compiled for the vectors of this machine.
struct Pass<'a, T: Real, const FORWARD: bool> {
    twiddles: &'a [Complex<T>],
    front: &'a mut [Complex<T>],
    back: &'a mut [Complex<T>],
}

impl<T: Real, const FORWARD: bool> pulp::NullaryFnOnce for Pass<'_, T, FORWARD> {
    type Output = ();

    // One loop over slices of one length, which the compiler can vectorise.
    #[inline(always)]
    fn call(self) {
        let count = self.twiddles.len();
        let (w, a, b) = (self.twiddles, &mut self.front[..count], &mut self.back[..count]);
        let half = T::one() / (T::one() + T::one());
        for k in 0..count {
            let (w, front, back) = (w[k], a[k], b[count - 1 - k]);
            let (sum_re, sum_im) = (front.re + back.re, front.im + back.im);
            let (difference_re, difference_im) = (front.re - back.re, front.im - back.im);
            if FORWARD {
                let (re, im) = (sum_im * w.re + difference_re * w.im, sum_im * w.im - difference_re * w.re);
                let (mean_re, mean_im) = (half * sum_re, half * difference_im);
                a[k] = Complex::new(mean_re + re, mean_im + im);
                b[count - 1 - k] = Complex::new(mean_re - re, im - mean_im);
            } else {
                let (re, im) = (sum_im * w.re - difference_re * w.im, sum_im * w.im + difference_re * w.re);
                let (re, im) = (re + re, im + im);
                a[k] = Complex::new(sum_re - re, difference_im + im);
                b[count - 1 - k] = Complex::new(sum_re + re, im - difference_im);
            }
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/row_transform.rs"]
mod tests;
