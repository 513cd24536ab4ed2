//! The order in which an even symbol S is stored.
//!
//! The stages ([`stages`](crate::fft::stages)) leave the bins of a column in an order of their own, in which products use them. The last stage of
//! radix R writes blocks of R bins. The bins py - k of a block are again a block, in reverse order, and have the same values of S. Only one of these
//! two blocks is stored.

use std::sync::Arc;

use par::memory::{collected, reserve, zeros};
use par::Result;

use crate::fft::stage_plan::Stages;
use crate::plan::{find, shared, Plan, PLAN};
use crate::real::Scalar;

/// The stages of one length, and the order of S after them. A stored row of S, with one value for each column of a block, is called a kept row.
pub struct EvenPlan<T: Scalar> {
    pub(crate) stages: Stages<T>,
    /// For each block of the last stage, the kept rows that have its values of S.
    pub(crate) kept: Vec<Kept>,
    /// The bin k of each kept row, 0 ..= py/2.
    pub(crate) bins: Vec<usize>,
    /// For each kept row, whether the stages leave bin py - k in its place instead of bin k.
    pub(crate) mirrored: Vec<bool>,
}

/// The kept rows of one block of the last stage.
#[derive(Clone, Copy)]
pub struct Kept {
    /// The kept row of the block's first bin.
    pub first: usize,
    /// The step to the kept row of the next bin: 1 if the block itself is stored, -1 if its mirror image is.
    pub step: isize,
}

impl<T: Scalar> EvenPlan<T> {
    /// The shared plan of a length. None if the length has no stages.
    pub fn shared(length: usize) -> Result<Option<Arc<EvenPlan<T>>>> {
        // A known plan is found without an allocation.
        match find(length) {
            None if !Stages::<T>::exist(length) => Ok(None),
            None => shared(length, || EvenPlan::new(length)).map(Some),
            known => Ok(known),
        }
    }

    fn new(length: usize) -> Result<EvenPlan<T>> {
        let stages = Stages::new(length)?;
        let (kept, bins) = kept_rows(&stages.lowest_bins()?, stages.last)?;
        let mirrored = collected(bins.iter().map(|bin| 2 * bin > length), PLAN)?;
        let bins = collected(bins.iter().map(|&bin| bin.min(length - bin)), PLAN)?;
        Ok(EvenPlan { stages, kept, bins, mirrored })
    }
}

impl<T: Scalar> Plan for EvenPlan<T> {
    fn bytes(&self) -> usize {
        let rows = size_of_val(&self.bins[..]) + size_of_val(&self.mirrored[..]);
        self.stages.bytes() + size_of_val(&self.kept[..]) + rows
    }
}

/// Chooses the kept rows, from the lowest bin of each block of the last stage and its radix `last`. Returns the kept rows of each block, and the bin
/// of each kept row.
fn kept_rows(lowest: &[usize], last: usize) -> Result<(Vec<Kept>, Vec<usize>)> {
    let blocks = lowest.len();
    // The first kept row of the stored block with a given lowest bin.
    let (mut first_row_of, mut bins) = (zeros(blocks, PLAN)?, Vec::new());
    reserve(&mut bins, (blocks / 2 + 1) * last, PLAN)?;
    let is_kept = |bin: usize| 2 * bin <= blocks;
    for &bin in lowest.iter().filter(|&&bin| is_kept(bin)) {
        first_row_of[bin] = bins.len();
        bins.extend((0..last).map(|q| bin + q * blocks));
    }
    let kept = lowest.iter().map(|&bin| match is_kept(bin) {
        true => Kept { first: first_row_of[bin], step: 1 },
        false => Kept { first: first_row_of[blocks - bin] + last - 1, step: -1 },
    });
    Ok((collected(kept, PLAN)?, bins))
}

impl Kept {
    /// The kept row of the block's bin number q.
    #[inline(always)]
    pub fn row(&self, q: usize) -> usize {
        self.first.wrapping_add_signed(self.step * q as isize)
    }
}
