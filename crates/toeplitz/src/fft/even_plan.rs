//! Storage of the symbol of even columns.
//!
//! Bins stay in the order of the stages' output ([`stages`](crate::fft::stages)). The mirror image py - k of a block of bins of the last
//! stage is a block in reverse order, with the same values of S. One of the two is stored.

use std::sync::Arc;

use par::memory::{collected, reserve, zeros};
use par::Result;

use crate::fft::stage_plan::Stages;
use crate::plan::{find, shared, Plan, PLAN};
use crate::real::Scalar;

/// The stages of one length, and the order of S.
pub struct EvenPlan<T: Scalar> {
    pub(crate) stages: Stages<T>,
    /// The rows of S for each block of the last stage.
    pub(crate) kept: Vec<Kept>,
    /// The bin of each kept row, at most py/2.
    pub(crate) bins: Vec<usize>,
    /// Whether the row comes from the mirror image, the bin py - k.
    pub(crate) mirrored: Vec<bool>,
}

/// The kept rows of a block: the first, and the step to the next.
#[derive(Clone, Copy)]
pub struct Kept {
    pub first: usize,
    pub step: isize,
}

impl<T: Scalar> EvenPlan<T> {
    /// The shared plan of a length; None if the length has no stages.
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

/// The kept rows of each block of the last stage, from the lowest bin of each block, and the bins of all kept rows.
fn kept_rows(lowest: &[usize], last: usize) -> Result<(Vec<Kept>, Vec<usize>)> {
    let blocks = lowest.len();
    let (mut block_of, mut bins) = (zeros(blocks, PLAN)?, Vec::new());
    reserve(&mut bins, (blocks / 2 + 1) * last, PLAN)?;
    let is_kept = |bin: usize| 2 * bin <= blocks;
    for &bin in lowest.iter().filter(|&&bin| is_kept(bin)) {
        block_of[bin] = bins.len();
        bins.extend((0..last).map(|q| bin + q * blocks));
    }
    let kept = lowest.iter().map(|&bin| match is_kept(bin) {
        true => Kept { first: block_of[bin], step: 1 },
        false => Kept { first: block_of[blocks - bin] + last - 1, step: -1 },
    });
    Ok((collected(kept, PLAN)?, bins))
}

impl Kept {
    /// The kept row of value q of the block.
    #[inline(always)]
    pub fn row(&self, q: usize) -> usize {
        self.first.wrapping_add_signed(self.step * q as isize)
    }
}
