//! Transforms of real rows x of length n to complex bins X. If n is even, a complex transform of length n/2 is used (Cooley, Lewis and Welch 1970):
//!
//! ```text
//! z_j = x_2j + i x_(2j+1),   Z = F z,   w_k = exp(-2 pi i k/n)
//! X_k         = (Z_k + Z*_(n/2-k))/2 - i w_k (Z_k - Z*_(n/2-k))/2
//! X_(n/2-k)*  = (Z_k + Z*_(n/2-k))/2 + i w_k (Z_k - Z*_(n/2-k))/2
//! ```
//!
//! The inverse solves these equations for 2 Z. The pass between Z and X takes half as long as the complex transform, so pulp compiles it for the
//! vectors of this machine. No bit depends on these vectors. The operations and their order are those of the crate realfft; a test compares all bits.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::block::{parts, parts_mut};
use crate::fft::any_length::{fit, scratch_of, ColumnTransform};
use crate::passes::Real;
use crate::plan::{shared, Plan, PLAN};
use crate::real::Complex;
use par::memory::collected;
use par::Result;

/// Rows of at most this length are short.
const LONGEST_SHORT: usize = 256;
/// The number of short rows that are transformed together.
const MOST_ROWS: usize = 8;

/// Transforms of real rows of one length `n` to `n/2 + 1` complex bins and back. Both are unnormalised: a row transformed there and back is n times
/// itself.
#[derive(Clone)]
pub struct RowTransform<T: Real> {
    n: usize,
    /// The complex transform, of length n/2, or of length n if n is odd.
    complex: ColumnTransform<T>,
    /// `w_k/2` for 0 < k < n/4; none if n is odd.
    twiddles: Arc<Twiddles<T>>,
}

/// The twiddles of rows of one length.
struct Twiddles<T: Real>(Vec<Complex<T>>);

impl<T: Real> Plan for Twiddles<T> {
    fn bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }
}

impl<T: Real> RowTransform<T> {
    /// Makes the plans for rows of length `n`.
    pub fn new(n: usize) -> Result<RowTransform<T>> {
        let is_even = n % 2 == 0;
        let twiddle = |k: usize| {
            let angle = -2.0 * PI / n as f64 * k as f64;
            Complex::new(T::of(angle.cos()), T::of(angle.sin())) * T::of(0.5)
        };
        let count = if is_even { n.div_ceil(4) } else { 1 };
        let twiddles = shared(n, || Ok(Twiddles(collected((0..count - 1).map(|k| twiddle(k + 1)), PLAN)?)))?;
        Ok(RowTransform { n, complex: ColumnTransform::new(if is_even { n / 2 } else { n })?, twiddles })
    }

    /// The length of a real row.
    pub fn length(&self) -> usize {
        self.n
    }

    /// The number of complex bins of a row.
    pub fn bins(&self) -> usize {
        self.n / 2 + 1
    }

    /// The number of rows that are transformed together. For short rows the call of the complex transform takes as long as its work, so one call
    /// transforms several rows. Long rows are transformed out of place, one after the other: together, their intermediate values would not fit in the
    /// first-level cache.
    pub fn at_a_time(&self) -> usize {
        if self.n > LONGEST_SHORT {
            1
        } else {
            MOST_ROWS
        }
    }

    /// Allocates the scratch of the transforms in both directions.
    pub fn scratch(&self) -> Result<Vec<Complex<T>>> {
        scratch_of(self.scratch_length())
    }

    /// Lengthens scratch to [`scratch_length`](Self::scratch_length), if it is shorter.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) -> Result<()> {
        fit(scratch, self.scratch_length())
    }

    /// The length of the scratch that the transforms in both directions need.
    pub fn scratch_length(&self) -> usize {
        let is_out_of_place = self.n % 2 == 0 && self.at_a_time() == 1;
        let of_complex = if is_out_of_place { self.complex.scratch_to() } else { self.complex.scratch_length() };
        self.at_a_time() * self.complex.length() + of_complex
    }

    /// Transforms a real row to bins. A shorter row is padded with zeros.
    pub fn forward(&self, row: &[T], bins: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.forward_together(row, row.len(), bins, scratch);
    }

    /// Transforms bins back to the first values of a real row, as many as `row` has. The bins are overwritten.
    pub fn inverse(&self, bins: &mut [Complex<T>], row: &mut [T], scratch: &mut [Complex<T>]) {
        let width = row.len();
        self.inverse_together(bins, row, width, scratch);
    }

    /// [`forward`](Self::forward) of up to [`at_a_time`](Self::at_a_time) rows, each of `width` values.
    pub fn forward_together(&self, rows: &[T], width: usize, bins: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        let (nb, length) = (self.bins(), self.complex.length());
        assert!(width <= self.n && bins.len() % nb == 0, "a row transform of the wrong length");
        let (packed, scratch) = scratch.split_at_mut(bins.len() / nb * length);
        if self.n % 2 == 1 {
            for (k, packed) in packed.chunks_exact_mut(length).enumerate() {
                let (given, rest) = packed.split_at_mut(width);
                given.iter_mut().zip(&rows[k * width..]).for_each(|(value, x)| *value = Complex::new(*x, T::zero()));
                rest.fill(Complex::default());
            }
            self.complex.forward(packed, scratch);
            for (bins, packed) in bins.chunks_exact_mut(nb).zip(packed.chunks_exact(length)) {
                bins.copy_from_slice(&packed[..nb]);
                bins[0].im = T::zero();
            }
            return;
        }
        for (k, packed) in packed.chunks_exact_mut(length).enumerate() {
            let (given, rest) = parts_mut(packed).split_at_mut(width);
            given.copy_from_slice(&rows[k * width..(k + 1) * width]);
            rest.fill(T::zero());
        }
        if self.at_a_time() == 1 {
            self.complex.forward_to(packed, &mut bins[..length], scratch);
        } else {
            self.complex.forward(packed, scratch);
            let rows = bins.chunks_exact_mut(nb).zip(packed.chunks_exact(length));
            rows.for_each(|(bins, packed)| bins[..length].copy_from_slice(packed));
        }
        for bins in bins.chunks_exact_mut(nb) {
            let first = bins[0];
            bins[0] = Complex::new(first.re + first.im, T::zero());
            bins[length] = Complex::new(first.re - first.im, T::zero());
        }
        let twiddles = &self.twiddles.0[..];
        pulp::Arch::new().dispatch(Passes::<T, true> { twiddles, length, bins });
    }

    /// [`inverse`](Self::inverse) to up to [`at_a_time`](Self::at_a_time) rows, each of `width` values.
    pub fn inverse_together(&self, bins: &mut [Complex<T>], rows: &mut [T], width: usize, scratch: &mut [Complex<T>]) {
        let (nb, length) = (self.bins(), self.complex.length());
        assert!(width <= self.n && bins.len() % nb == 0, "a row transform of the wrong length");
        let (packed, scratch) = scratch.split_at_mut(bins.len() / nb * length);
        if self.n % 2 == 1 {
            for (bins, packed) in bins.chunks_exact(nb).zip(packed.chunks_exact_mut(length)) {
                packed[..nb].copy_from_slice(bins);
                packed[0].im = T::zero();
                packed.iter_mut().rev().zip(&bins[1..]).for_each(|(value, bin)| *value = bin.conj());
            }
            self.complex.inverse(packed, scratch);
            for (k, packed) in packed.chunks_exact(length).enumerate() {
                let row = &mut rows[k * width..(k + 1) * width];
                row.iter_mut().zip(packed).for_each(|(x, value)| *x = value.re);
            }
            return;
        }
        for bins in bins.chunks_exact_mut(nb) {
            let (first, last) = (bins[0].re, bins[length].re);
            bins[0] = Complex::new(first + last, first - last);
        }
        let twiddles = &self.twiddles.0[..];
        pulp::Arch::new().dispatch(Passes::<T, false> { twiddles, length, bins: &mut *bins });
        if self.at_a_time() == 1 {
            self.complex.inverse_to(&mut bins[..length], packed, scratch);
        } else {
            let rows = bins.chunks_exact(nb).zip(packed.chunks_exact_mut(length));
            rows.for_each(|(bins, packed)| packed.copy_from_slice(&bins[..length]));
            self.complex.inverse(packed, scratch);
        }
        for (k, packed) in packed.chunks_exact(length).enumerate() {
            rows[k * width..(k + 1) * width].copy_from_slice(&parts(packed)[..width]);
        }
    }
}

/// The pass over the bins of rows: converts the `length` bins Z of each row's complex transform to the bins X of the row, or X to 2 Z. pulp compiles
/// it for the vectors of this machine.
struct Passes<'a, T: Real, const FORWARD: bool> {
    twiddles: &'a [Complex<T>],
    length: usize,
    bins: &'a mut [Complex<T>],
}

impl<T: Real, const FORWARD: bool> pulp::NullaryFnOnce for Passes<'_, T, FORWARD> {
    type Output = ();

    // The pass is in place. With separate input and output the compiler could not prove that the slices do not overlap, and would not vectorise the
    // loop.
    #[inline(always)]
    fn call(self) {
        let Passes { twiddles, length, bins } = self;
        for row in bins.chunks_exact_mut(length + 1) {
            let count = twiddles.len();
            if length % 2 == 0 {
                let centre = &mut row[length / 2];
                *centre = if FORWARD { centre.conj() } else { (*centre + *centre).conj() };
            }
            let (front, back) = row[..length].split_at_mut(length - count);
            pass::<T, FORWARD>(twiddles, &mut front[1..][..count], &mut back[..count]);
        }
    }
}

/// Converts all bins k (in `a`) and n/2 - k (in `b`, in reverse order), except k = 0 and the bin in the middle.
#[inline(always)]
fn pass<T: Real, const FORWARD: bool>(w: &[Complex<T>], a: &mut [Complex<T>], b: &mut [Complex<T>]) {
    let (count, half) = (w.len(), T::one() / (T::one() + T::one()));
    // Both slices have the length of `w`, so the compiler drops the checks of indices and vectorises the loop.
    let (a, b) = (&mut a[..count], &mut b[..count]);
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

#[cfg(test)]
#[path = "../../tests/unit/row_transform.rs"]
mod tests;
