//! The plan of the transforms of real rows of length n. The stages transform a row as h = n/2 complex numbers Z
//! ([`lane_rows`](crate::fft::lane_rows) has the formulas).

use std::sync::Arc;

use par::memory::{collected, zeros};
use par::Result;

use crate::block::BLOCK;
use crate::fft::stage_plan::Stages;
use crate::plan::{find, shared, Plan, PLAN};
use crate::real::{twiddle, Complex, Scalar};

/// The stages of one length, and the order in which they leave the bins.
pub struct RowPlan<T: Scalar> {
    /// The stages of the complex transform of length h.
    pub(crate) stages: Stages<T>,
    /// Where the stages leave the bins: Z_k is value `row_of[k]` of their output, for k = 0 ..= h, with Z_h = Z_0.
    pub(crate) row_of: Vec<usize>,
    /// `w_k/2` for k = 0 ..= h, with `w_k = exp(-2 pi i k/n)`.
    pub(crate) twiddles: Vec<Complex<T>>,
}

impl<T: Scalar> Plan for RowPlan<T> {
    fn bytes(&self) -> usize {
        self.stages.bytes() + size_of_val(&self.row_of[..]) + size_of_val(&self.twiddles[..])
    }
}

impl<T: Scalar> RowPlan<T> {
    /// The shared plan of rows of length n. None if n is odd, or if h has no stages.
    pub fn shared(n: usize) -> Result<Option<Arc<RowPlan<T>>>> {
        // A known plan is found without an allocation.
        match find(n) {
            None if n % 2 == 1 || !Stages::<T>::exist(n / 2) => Ok(None),
            None => shared(n, || RowPlan::new(n)).map(Some),
            known => Ok(known),
        }
    }

    fn new(n: usize) -> Result<RowPlan<T>> {
        let (h, stages) = (n / 2, Stages::new(n / 2)?);
        let mut row_of = zeros(h + 1, PLAN)?;
        stages.bins()?.into_iter().enumerate().for_each(|(row, bin)| row_of[bin] = row);
        row_of[h] = row_of[0];
        let half = T::of(0.5);
        let mut twiddles = collected((0..h + 1).map(|k| twiddle::<T>(k, n) * half), PLAN)?;
        twiddles[h] = Complex::new(-half, T::zero());
        Ok(RowPlan { stages, row_of, twiddles })
    }

    /// The length h = n/2 of the complex transform.
    pub(crate) fn length(&self) -> usize {
        self.row_of.len() - 1
    }

    /// The number of blocks of bins. The last block may have bins beyond h, which are undefined.
    pub(crate) fn blocks(&self) -> usize {
        (self.length() + 1).div_ceil(BLOCK)
    }
}
