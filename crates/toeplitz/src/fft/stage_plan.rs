//! The stages of a transform of one length, and the order of bins after them.

use par::memory::{collected, zeros};
use par::Result;
use pulp::Simd;

use crate::fft::lanes::Arithmetic;
use crate::fft::stages::{bytes_of_a_row, end, forward, of_radix, Row, Stage};
use crate::lengths::radices;
use crate::plan::PLAN;
use crate::real::{twiddle, Scalar};

/// Rows of a vector (16 kB with AVX2, 32 kB with AVX-512) that fit the nearest cache together with other data.
const NEAR_ROWS: usize = 256;
/// Bytes of rows that fit the nearest cache without other data.
const NEAREST_CACHE: usize = 1 << 15;

/// The stages of one length.
pub(crate) struct Stages<T: Scalar> {
    /// The first stage, and the middle ones.
    pub first: Stage<T>,
    pub middle: Vec<Stage<T>>,
    /// The number of middle stages that process all rows at once. The others process parts of `part` rows.
    pub wide: usize,
    pub part: usize,
    /// The radix of the last stage.
    pub last: usize,
}

impl<T: Scalar> Stages<T> {
    /// Whether a length has stages: its only prime factors are 2, 3 and 5, and it needs more than one stage.
    pub fn exist(length: usize) -> bool {
        radices(length).is_some()
    }

    /// The stages of a length that has some.
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

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        std::iter::once(&self.first).chain(&self.middle).map(|stage| size_of_val(&stage.twiddles[..])).sum()
    }

    /// The length.
    pub fn length(&self) -> usize {
        self.first.radix * self.first.stride()
    }

    /// All forward stages except the first.
    #[inline(always)]
    pub fn forward_after_first<S: Simd>(&self, a: Arithmetic<T, S>, rows: &mut [Row<T, S>]) {
        let (wide, near) = self.middle.split_at(self.wide);
        for stage in wide {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        // The remaining stages process part by part, in the nearest cache.
        for rows in rows.chunks_exact_mut(self.part) {
            for stage in near {
                of_radix!(stage.radix, forward, a, stage, rows);
            }
            of_radix!(self.last, end, a, rows);
        }
    }

    /// The lowest bin of each block of the last stage: block b holds bins `lowest(b) + q length/last`.
    pub fn lowest_bins(&self) -> Result<Vec<usize>> {
        let blocks = self.length() / self.last;
        // lowest(b) is b with its digits reversed: the stages before the last alone are a transform of length `blocks`, with this bin in row b.
        let lowest = |b: usize| {
            let (mut rest, mut below, mut bin, mut weight) = (b, blocks, 0, 1);
            for stage in std::iter::once(&self.first).chain(&self.middle) {
                below /= stage.radix;
                bin += weight * (rest / below);
                rest %= below;
                weight *= stage.radix;
            }
            bin
        };
        collected((0..blocks).map(lowest), PLAN)
    }

    /// The bin of each row after the stages.
    pub fn bins(&self) -> Result<Vec<usize>> {
        let step = self.length() / self.last;
        let (lowest, mut bins) = (self.lowest_bins()?, zeros(self.length(), PLAN)?);
        for (bins, lowest) in bins.chunks_exact_mut(self.last).zip(lowest) {
            bins.iter_mut().enumerate().for_each(|(q, bin)| *bin = lowest + q * step);
        }
        Ok(bins)
    }
}

/// The number of middle stages that process all rows, and the rows of a part in the stages after them. Parts fit the nearest cache. A length that
/// fits as a whole is one part.
fn near_parts<T: Scalar>(middle: &[Stage<T>], length: usize, after_first: usize) -> (usize, usize) {
    if length * bytes_of_a_row::<T>() <= NEAREST_CACHE {
        return (0, length);
    }
    let after = |stages: usize| middle[..stages].last().map_or(after_first, Stage::stride);
    let wide = (0..middle.len()).find(|&stages| after(stages) <= NEAR_ROWS).unwrap_or(middle.len());
    (wide, after(wide))
}
