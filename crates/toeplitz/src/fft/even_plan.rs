//! Where the symbol of even columns is kept.
//!
//! Bins stay in the order in which the stages leave them ([`stages`](crate::fft::stages)): of each block of bins that comes out of the
//! last stage the mirror image, the bins py - k, is a block too, from behind. So one of the two is kept of S.

use std::sync::Arc;

use par::memory::{collected, reserve, zeros};
use par::Result;

use crate::fft::stage_plan::Stages;
use crate::plan::{find, shared, Plan, PLAN};
use crate::real::Scalar;

/// The stages of one length, and the order of S.
pub struct EvenPlan<T: Scalar> {
    pub(crate) stages: Stages<T>,
    /// Where S is kept, for each block of the last stage.
    pub(crate) kept: Vec<Kept>,
    /// The bin of each kept row, at most py/2.
    pub(crate) bins: Vec<usize>,
    /// Whether it is kept of the bin py less that.
    pub(crate) mirrored: Vec<bool>,
}

/// The kept rows of a block: the first, and the step to the next.
#[derive(Clone, Copy)]
pub struct Kept {
    pub first: usize,
    pub step: isize,
}

impl<T: Scalar> EvenPlan<T> {
    /// That of a length. None where it has no stages.
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

/// Where S is kept of each block of the last stage, of which the lowest bin is given, and the bin of each kept row, of all.
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
