//! Fast Fourier transforms: the only file that names the FFT crates.
//!
//! Plans are kept per thread and precision, so that a second operator of the same size costs no planning.

use std::cell::RefCell;
use std::sync::Arc;

pub use rustfft::num_complex::Complex;
use rustfft::num_traits::{Float, FromPrimitive, ToPrimitive};

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftNum, FftPlanner};

/// `f32` or `f64`.
pub trait Real: FftNum + Float + FromPrimitive + ToPrimitive + Default + std::iter::Sum + std::ops::AddAssign {
    #[doc(hidden)]
    fn with_planners<R>(use_them: impl FnOnce(&mut RealFftPlanner<Self>, &mut FftPlanner<Self>) -> R) -> R;

    /// The nearest value of this precision.
    fn of(value: f64) -> Self {
        Self::from_f64(value).unwrap_or_default()
    }

    /// This value in double precision.
    fn to_double(self) -> f64 {
        self.to_f64().unwrap_or_default()
    }
}

macro_rules! real {
    ($t:ty, $planners:ident) => {
        thread_local! {
            static $planners: RefCell<(RealFftPlanner<$t>, FftPlanner<$t>)> =
                RefCell::new((RealFftPlanner::new(), FftPlanner::new()));
        }
        impl Real for $t {
            fn with_planners<R>(use_them: impl FnOnce(&mut RealFftPlanner<$t>, &mut FftPlanner<$t>) -> R) -> R {
                $planners.with_borrow_mut(|(real, complex)| use_them(real, complex))
            }
        }
    };
}
real!(f64, PLANNERS_F64);
real!(f32, PLANNERS_F32);

/// Work of a transform of length `2^a 3^b 5^c` relative to one of a power of two: measured, in single precision, where it
/// matters more. What is left of a twos, fours and eights is vectorised badly, and so are fives.
fn relative_work(twos: u32, fives: u32) -> f64 {
    let of_twos = [3.0, 1.5, 1.25, 1.1].get(twos as usize).copied().unwrap_or(1.0);
    let of_fives = [1.0, 1.12, 1.3].get(fives as usize).copied().unwrap_or(1.6);
    of_twos * of_fives
}

/// The even `2^a 3^b 5^c >= n` the transform of which is fastest: lengths with a large prime factor cost six times as much.
pub fn good_length(n: usize) -> usize {
    let longest = n.max(2).next_power_of_two();
    let (mut best, mut least) = (longest, longest as f64);
    let (mut fives, mut power_of_five) = (0, 1);
    while power_of_five < longest {
        let mut odd = power_of_five;
        while odd < longest {
            let even = n.div_ceil(odd).max(2).next_power_of_two();
            let work = (odd * even) as f64 * relative_work(even.trailing_zeros(), fives);
            if work < least {
                (best, least) = (odd * even, work);
            }
            odd *= 3;
        }
        (fives, power_of_five) = (fives + 1, 5 * power_of_five);
    }
    best
}

/// Transforms of real rows of one length `n` to `n/2 + 1` complex bins and back (unnormalised).
#[derive(Clone)]
pub struct RowTransform<T: Real> {
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
}

impl<T: Real> RowTransform<T> {
    /// Plans for rows of length `n`.
    pub fn new(n: usize) -> RowTransform<T> {
        T::with_planners(|planner, _| RowTransform {
            forward: planner.plan_fft_forward(n),
            inverse: planner.plan_fft_inverse(n),
        })
    }

    /// Length of a real row.
    pub fn length(&self) -> usize {
        self.forward.len()
    }

    /// Number of complex bins.
    pub fn bins(&self) -> usize {
        self.forward.len() / 2 + 1
    }

    /// Scratch that [`forward`](Self::forward) and [`inverse`](Self::inverse) need.
    pub fn scratch(&self) -> Vec<Complex<T>> {
        let mut scratch = Vec::new();
        self.fit(&mut scratch);
        scratch
    }

    /// Makes scratch long enough.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) {
        let length = self.forward.get_scratch_len().max(self.inverse.get_scratch_len());
        scratch.resize(scratch.len().max(length), Complex::default());
    }

    /// Real row to bins; the row is overwritten.
    pub fn forward(&self, row: &mut [T], bins: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        let scratch = &mut scratch[..self.forward.get_scratch_len()];
        let done = self.forward.process_with_scratch(row, bins, scratch);
        assert!(done.is_ok(), "a row transform of the wrong length");
    }

    /// Bins to real row; the bins are overwritten.
    pub fn inverse(&self, bins: &mut [Complex<T>], row: &mut [T], scratch: &mut [Complex<T>]) {
        // What round-off leaves there is refused by the library.
        bins[0].im = T::zero();
        if self.length() % 2 == 0 {
            let last = bins.len() - 1;
            bins[last].im = T::zero();
        }
        let scratch = &mut scratch[..self.inverse.get_scratch_len()];
        let done = self.inverse.process_with_scratch(bins, row, scratch);
        assert!(done.is_ok(), "a row transform of the wrong length");
    }
}

/// Complex transforms of one length, many columns at a time (unnormalised).
#[derive(Clone)]
pub struct ColumnTransform<T: Real> {
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
}

impl<T: Real> ColumnTransform<T> {
    /// Plans for columns of length `n`.
    pub fn new(n: usize) -> ColumnTransform<T> {
        T::with_planners(|_, planner| ColumnTransform {
            forward: planner.plan_fft_forward(n),
            inverse: planner.plan_fft_inverse(n),
        })
    }

    /// Length of a column.
    pub fn length(&self) -> usize {
        self.forward.len()
    }

    /// Scratch that both directions need.
    pub fn scratch(&self) -> Vec<Complex<T>> {
        let mut scratch = Vec::new();
        self.fit(&mut scratch);
        scratch
    }

    /// Makes scratch long enough.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) {
        scratch.resize(scratch.len().max(self.scratch_length()), Complex::default());
    }

    /// Its length.
    pub fn scratch_length(&self) -> usize {
        self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len())
    }

    /// Transforms the columns that stand one after the other in `columns`, in place.
    pub fn forward(&self, columns: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.forward.process_with_scratch(columns, scratch);
    }

    /// The inverse, likewise.
    pub fn inverse(&self, columns: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.inverse.process_with_scratch(columns, scratch);
    }
}
