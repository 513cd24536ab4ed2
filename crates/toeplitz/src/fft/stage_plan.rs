//! The stages of a transform of one length, and the order in which they leave the bins.

use par::memory::{collected, zeros};
use par::Result;
use pulp::Simd;

use crate::fft::lanes::Arithmetic;
use crate::fft::stages::{bytes_of_a_row, end, forward, of_radix, Row, Stage};
use crate::lengths::radices;
use crate::plan::PLAN;
use crate::real::{twiddle, Scalar};

/// The number of rows of complex vectors that fit in the first-level cache together with other data: 16 kB with AVX2, 32 kB with AVX-512.
const NEAR_ROWS: usize = 256;
/// The bytes of rows that fit in the first-level cache without other data.
const NEAREST_CACHE: usize = 1 << 15;

/// The stages of one length ([`stages`](crate::fft::stages) has the formulas).
pub(crate) struct Stages<T: Scalar> {
    /// The first stage.
    pub first: Stage<T>,
    /// The stages between the first and the last.
    pub middle: Vec<Stage<T>>,
    /// The number of middle stages that process all rows at once. The middle stages after them process parts of `part` rows.
    pub wide: usize,
    /// The number of rows of a part, which fits in the first-level cache.
    pub part: usize,
    /// The radix of the last stage, which has no twiddles.
    pub last: usize,
}

impl<T: Scalar> Stages<T> {
    /// Whether a length has stages: its only prime factors are 2, 3 and 5, and it needs more than one stage.
    pub fn exist(length: usize) -> bool {
        radices(length).is_some()
    }

    /// Makes the stages of a length, for which [`exist`](Self::exist) is true.
    pub fn new(length: usize) -> Result<Stages<T>> {
        let radices = radices(length).unwrap_or_default();
        let [first, middle @ .., last] = &radices[..] else { unreachable!("no stages have a length of {length}") };
        let mut n = length;
        let mut stage = |&radix: &usize| {
            let m = n / radix;
            let factors = radix - 1;
            let of = |k: usize| twiddle(k / factors * (k % factors + 1), n);
            let stage = Stage { radix, twiddles: collected((0..m * factors).map(of), PLAN)? };
            n = m;
            Ok(stage)
        };
        let (first, middle) = (stage(first)?, middle.iter().map(&mut stage).collect::<Result<Vec<_>>>()?);
        let (wide, part) = near_parts(&middle, length, first.stride());
        Ok(Stages { first, middle, wide, part, last: *last })
    }

    /// The bytes of the twiddles.
    pub fn bytes(&self) -> usize {
        std::iter::once(&self.first).chain(&self.middle).map(|stage| size_of_val(&stage.twiddles[..])).sum()
    }

    /// The length of the transform.
    pub fn length(&self) -> usize {
        self.first.radix * self.first.stride()
    }

    /// Applies all forward stages except the first to `rows`.
    #[inline(always)]
    pub fn forward_after_first<S: Simd>(&self, a: Arithmetic<T, S>, rows: &mut [Row<T, S>]) {
        let (wide, near) = self.middle.split_at(self.wide);
        for stage in wide {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        // The remaining stages process one part after the other, each in the first-level cache.
        for rows in rows.chunks_exact_mut(self.part) {
            for stage in near {
                of_radix!(stage.radix, forward, a, stage, rows);
            }
            of_radix!(self.last, end, a, rows);
        }
    }

    /// The lowest bin of each block of `last` rows: after the last stage, row q of block b holds the bin `lowest(b) + q length/last`.
    pub fn lowest_bins(&self) -> Result<Vec<usize>> {
        let blocks = self.length() / self.last;
        // The stages before the last one are a transform of length `blocks`, which leaves bin lowest(b) in row b. So lowest(b) is b with its digits
        // reversed, in the number system of the radices.
        let lowest = |b: usize| {
            let (mut rest, mut place_value, mut bin, mut reversed_place_value) = (b, blocks, 0, 1);
            for stage in std::iter::once(&self.first).chain(&self.middle) {
                place_value /= stage.radix;
                bin += reversed_place_value * (rest / place_value);
                rest %= place_value;
                reversed_place_value *= stage.radix;
            }
            bin
        };
        collected((0..blocks).map(lowest), PLAN)
    }

    /// The bin that each row holds after the stages.
    pub fn bins(&self) -> Result<Vec<usize>> {
        let step = self.length() / self.last;
        let (lowest, mut bins) = (self.lowest_bins()?, zeros(self.length(), PLAN)?);
        for (bins, lowest) in bins.chunks_exact_mut(self.last).zip(lowest) {
            bins.iter_mut().enumerate().for_each(|(q, bin)| *bin = lowest + q * step);
        }
        Ok(bins)
    }
}

/// The number of middle stages that process all rows, and the number of rows of a part in the stages after them. A part fits in the first-level
/// cache. If all rows fit, they are one part. `after_first` is the stride of the first stage.
fn near_parts<T: Scalar>(middle: &[Stage<T>], length: usize, after_first: usize) -> (usize, usize) {
    if length * bytes_of_a_row::<T>() <= NEAREST_CACHE {
        return (0, length);
    }
    // After a stage of stride m, each m consecutive rows are a transform of their own.
    let part_after = |stages: usize| middle[..stages].last().map_or(after_first, Stage::stride);
    let wide = (0..middle.len()).find(|&stages| part_after(stages) <= NEAR_ROWS).unwrap_or(middle.len());
    (wide, part_after(wide))
}
