//! The stages of transforms of even columns, and the order in which they leave bins.
//!
//! Bins stay in the order in which the stages leave them ([`even_stages`](super::even_stages)): of each block of bins that comes out of the
//! last stage the mirror image, the bins py - k, is a block too, from behind. So one of the two is kept of S.

use std::f64::consts::PI;

use super::even_stages::Stage;
use super::fft::{Complex, Real};

/// Rows of a vector, 64 bytes each with AVX2, that the nearest cache holds beside what else is read.
const NEAR: usize = 256;

/// The stages of one length.
pub struct EvenPlan<T: Real> {
    /// The first, and those in the middle.
    pub(super) first: Stage<T>,
    pub(super) middle: Vec<Stage<T>>,
    /// Of those in the middle, how many go over all rows; the others go over parts of so many rows.
    pub(super) wide: usize,
    pub(super) part: usize,
    /// The radix of the last.
    pub(super) last: usize,
    /// Where S is kept, for each block of the last stage.
    pub(super) kept: Vec<Kept>,
    /// The bin of each kept row, at most py/2.
    pub(super) bins: Vec<usize>,
}

/// The kept rows of a block: the first, and the step to the next.
#[derive(Clone, Copy)]
pub(super) struct Kept {
    pub first: usize,
    pub step: isize,
}

impl<T: Real> EvenPlan<T> {
    /// None for lengths of other factors than 2, 3 and 5, or of one stage.
    pub fn new(length: usize) -> Option<EvenPlan<T>> {
        let radices = radices(length)?;
        let (&last, rest) = radices.split_last()?;
        let mut n = length;
        let mut stage = |&radix: &usize| {
            let m = n / radix;
            let angle = |j: usize, q: usize| -2.0 * PI * (j * q) as f64 / n as f64;
            let of_row = |j: usize| (1..radix).map(move |q| angle(j, q));
            let twiddles = (0..m).flat_map(of_row).map(|angle| Complex::new(T::of(angle.cos()), T::of(angle.sin())));
            let stage = Stage { radix, twiddles: twiddles.collect() };
            n = m;
            stage
        };
        let (first, middle) = rest.split_first()?;
        let (first, middle): (_, Vec<_>) = (stage(first), middle.iter().map(&mut stage).collect());
        let (wide, part) = near_parts(&middle, length, first.stride());
        let (kept, bins) = kept_rows(length, rest, last);
        Some(EvenPlan { first, middle, wide, part, last, kept, bins })
    }
}

/// Factors of a length: a four first, the other fours last, what else there is between them.
fn radices(length: usize) -> Option<Vec<usize>> {
    let (mut rest, mut fours, mut others) = (length, 0, Vec::new());
    while rest % 4 == 0 {
        (rest, fours) = (rest / 4, fours + 1);
    }
    for radix in [5, 3, 2] {
        while rest % radix == 0 {
            rest /= radix;
            others.push(radix);
        }
    }
    let first = fours.min(1);
    let radices = [vec![4; first], others, vec![4; fours - first]].concat();
    (rest == 1 && radices.len() > 1).then_some(radices)
}

/// The stages in the middle that go over all rows, until what they leave are parts that the nearest cache holds, and the rows of these.
/// Twice as many rows still fit by themselves, so such lengths are one part.
fn near_parts<T: Real>(middle: &[Stage<T>], length: usize, after_first: usize) -> (usize, usize) {
    if length <= 2 * NEAR {
        return (0, length);
    }
    let after = |stages: usize| middle[..stages].last().map_or(after_first, Stage::stride);
    let wide = (0..middle.len()).find(|&stages| after(stages) <= NEAR).unwrap_or(middle.len());
    (wide, after(wide))
}

/// Where S is kept of each block of the last stage, and the bin of each kept row. Block b holds bins `lowest(b) + q length/last`.
fn kept_rows(length: usize, before: &[usize], last: usize) -> (Vec<Kept>, Vec<usize>) {
    let blocks = length / last;
    // Row b of the stages before the last holds bin lowest(b) of a transform of their length: digits from behind.
    let lowest = |b: usize| {
        let (mut rest, mut below, mut bin) = (b, blocks, 0);
        let mut weight = 1;
        for radix in before {
            below /= radix;
            bin += weight * (rest / below);
            rest %= below;
            weight *= radix;
        }
        bin
    };
    let lowest: Vec<usize> = (0..blocks).map(lowest).collect();
    let (mut block_of, mut bins) = (vec![0; blocks], Vec::new());
    let is_kept = |bin: usize| 2 * bin <= blocks;
    for &bin in lowest.iter().filter(|&&bin| is_kept(bin)) {
        block_of[bin] = bins.len();
        bins.extend((0..last).map(|q| bin + q * blocks).map(|bin| bin.min(length - bin)));
    }
    let kept = lowest.iter().map(|&bin| match is_kept(bin) {
        true => Kept { first: block_of[bin], step: 1 },
        false => Kept { first: block_of[blocks - bin] + last - 1, step: -1 },
    });
    (kept.collect(), bins)
}

impl Kept {
    /// The kept row of value q of the block.
    #[inline(always)]
    pub fn row(&self, q: usize) -> usize {
        self.first.wrapping_add_signed(self.step * q as isize)
    }
}
