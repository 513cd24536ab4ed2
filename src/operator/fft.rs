//! Fast Fourier transforms: the only file that names the FFT crate.
//!
//! Plans are kept per thread and precision, so that a second operator of the same size costs no planning. Each length has a planner of its own: the
//! crate's makes a plan from parts of the plans before it, so that bits would depend on what a thread planned before.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;
use std::sync::Arc;

pub use rustfft::num_complex::Complex;
use rustfft::num_traits::{Float, FromPrimitive};

use rustfft::{Fft, FftNum, FftPlanner};

use super::even_plan::EvenPlan;
use super::lane_rows::RowPlan;
use super::lanes::Lanes;
use crate::error::Result;
use crate::memory::{reserve, sparse};
use crate::sums::Value;

/// `f32` or `f64`.
pub trait Real:
    Value + Lanes + FftNum + Float + FromPrimitive + Default + std::iter::Sum + std::ops::AddAssign
{
    #[doc(hidden)]
    fn with_plans<R>(use_it: impl FnOnce(&mut Plans<Self>) -> R) -> R;

    /// The nearest value of this precision.
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::from_f64(value).unwrap_or_default()
    }
}

/// What a thread has planned.
#[doc(hidden)]
pub struct Plans<T: Real> {
    columns: HashMap<usize, ColumnTransform<T>>,
    /// Lengths for whose plans there was room.
    planned: HashSet<usize>,
    /// Of transforms of real rows, by their length.
    twiddles: HashMap<usize, Arc<[Complex<T>]>>,
    /// Of columns of even coefficients, by theirs.
    even: HashMap<usize, Option<Arc<EvenPlan<T>>>>,
    /// Of rows in the places of vectors, by theirs.
    rows: HashMap<usize, Option<Arc<RowPlan<T>>>>,
}

macro_rules! real {
    ($t:ty, $plans:ident) => {
        thread_local! {
            static $plans: RefCell<Plans<$t>> =
                RefCell::new(Plans {
                    columns: HashMap::new(),
                    planned: HashSet::new(),
                    twiddles: HashMap::new(),
                    even: HashMap::new(),
                    rows: HashMap::new(),
                });
        }
        impl Real for $t {
            fn with_plans<R>(use_it: impl FnOnce(&mut Plans<$t>) -> R) -> R {
                $plans.with_borrow_mut(use_it)
            }
        }
    };
}
real!(f64, PLANS_F64);
real!(f32, PLANS_F32);

/// Values that the plans of a length take, both ways, relative to it: one in each stage, and what a stage is made from.
const PLANS: usize = 4;

/// Refuses transforms of some lengths where there is no room for their plans. The FFT crate cannot refuse: it would end the process. Plans that
/// this thread has take no room.
pub fn room_for_plans<T: Real>(lengths: &[usize]) -> Result<()> {
    T::with_plans(|plans| {
        let new = || lengths.iter().filter(|length| !plans.planned.contains(length));
        let values = new().fold(0_usize, |all, length| all.saturating_add(length.saturating_mul(PLANS)));
        drop(sparse::<Complex<T>>(values, "the plans of transforms")?);
        plans.planned.extend(lengths);
        Ok(())
    })
}

/// The twiddles of real rows of length `n`, computed once.
pub(super) fn twiddles<T: Real>(n: usize, compute: impl FnOnce() -> Vec<Complex<T>>) -> Arc<[Complex<T>]> {
    T::with_plans(|plans| plans.twiddles.entry(n).or_insert_with(|| compute().into()).clone())
}

/// The stages of columns of even coefficients, computed once.
pub(super) fn even_plan<T: Real>(length: usize) -> Option<Arc<EvenPlan<T>>> {
    T::with_plans(|plans| plans.even.entry(length).or_insert_with(|| EvenPlan::new(length).map(Arc::new)).clone())
}

/// The stages of rows in the places of vectors, computed once.
pub(super) fn row_plan<T: Real>(length: usize) -> Option<Arc<RowPlan<T>>> {
    T::with_plans(|plans| plans.rows.entry(length).or_insert_with(|| RowPlan::new(length).map(Arc::new)).clone())
}

/// `exp(-2 pi i k/n)`.
pub(super) fn twiddle<T: Real>(k: usize, n: usize) -> Complex<T> {
    let angle = -2.0 * PI * k as f64 / n as f64;
    Complex::new(T::of(angle.cos()), T::of(angle.sin()))
}

/// Work of a transform of length `2^a 3^b 5^c` by rustfft relative to one of `2^a 3^b` with many twos: measured, in single precision, where it
/// matters more. What is left of a twos, fours and eights is vectorised badly, and so are fives, unless one stands beside many twos alone.
fn relative_work(twos: u32, threes: u32, fives: u32) -> f64 {
    let of_twos = [3.0, 1.5, 1.25, 1.1].get(twos as usize).copied().unwrap_or(1.0);
    let of_fives = match (threes > 0, fives) {
        (_, 0) => 1.0,
        (false, 1) if twos >= 5 => 1.0,
        (_, 1) => 1.12,
        (_, 2) => 1.3,
        _ => 1.6,
    };
    of_twos * of_fives
}

/// The even `2^a 3^b 5^c >= n` the transform of which by rustfft is fastest: lengths with a large prime factor cost six times as much.
pub fn good_length(n: usize) -> usize {
    length_of_least_work(n, relative_work)
}

/// The even `2^a 3^b 5^c >= n` of which `length * relative_work(a, b, c)` is least.
pub(super) fn length_of_least_work(n: usize, relative_work: impl Fn(u32, u32, u32) -> f64) -> usize {
    let longest = n.max(2).next_power_of_two();
    let (mut best, mut least) = (longest, f64::INFINITY);
    let (mut fives, mut power_of_five) = (0, 1);
    while power_of_five < longest {
        let (mut threes, mut odd) = (0, power_of_five);
        while odd < longest {
            let even = n.div_ceil(odd).max(2).next_power_of_two();
            let work = (odd * even) as f64 * relative_work(even.trailing_zeros(), threes, fives);
            if work < least {
                (best, least) = (odd * even, work);
            }
            (threes, odd) = (threes + 1, 3 * odd);
        }
        (fives, power_of_five) = (fives + 1, 5 * power_of_five);
    }
    best
}

/// Makes the scratch of transforms so long, at least.
pub(super) fn fit<T: Real>(scratch: &mut Vec<Complex<T>>, length: usize) -> Result<()> {
    let length = scratch.len().max(length);
    reserve(scratch, length, "the scratch of transforms")?;
    scratch.resize(length, Complex::default());
    Ok(())
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
        let plan = || {
            let mut planner = FftPlanner::new();
            ColumnTransform { forward: planner.plan_fft_forward(n), inverse: planner.plan_fft_inverse(n) }
        };
        T::with_plans(|plans| plans.columns.entry(n).or_insert_with(plan).clone())
    }

    /// Length of a column.
    pub fn length(&self) -> usize {
        self.forward.len()
    }

    /// Scratch that both directions need.
    pub fn scratch(&self) -> Result<Vec<Complex<T>>> {
        let mut scratch = Vec::new();
        self.fit(&mut scratch)?;
        Ok(scratch)
    }

    /// Makes scratch long enough.
    pub fn fit(&self, scratch: &mut Vec<Complex<T>>) -> Result<()> {
        fit(scratch, self.scratch_length())
    }

    /// Its length.
    pub fn scratch_length(&self) -> usize {
        let length = |fft: &dyn Fft<T>| fft.get_inplace_scratch_len().max(fft.get_outofplace_scratch_len());
        length(&*self.forward).max(length(&*self.inverse))
    }

    /// That of transforms to another place.
    pub fn scratch_to(&self) -> usize {
        self.forward.get_outofplace_scratch_len().max(self.inverse.get_outofplace_scratch_len())
    }

    /// Transforms one column to another place; it is overwritten.
    pub fn forward_to(&self, column: &mut [Complex<T>], to: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.forward.process_outofplace_with_scratch(column, to, scratch);
    }

    /// The inverse, likewise.
    pub fn inverse_to(&self, column: &mut [Complex<T>], to: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        self.inverse.process_outofplace_with_scratch(column, to, scratch);
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

#[cfg(test)]
#[path = "../../tests/unit/fft.rs"]
mod tests;
