//! Which stages a transform of one length has, and the order in which they leave bins.

use pulp::Simd;

use super::butterflies::LONGEST;
use super::fft::{length_of_least_work, twiddle, Real};
use super::lanes::Arithmetic;
use super::stages::{bytes_of_a_row, end, forward, of_radix, Row, Stage};

/// Rows of a vector (16 kB with AVX2, 32 kB with AVX-512) that the nearest cache holds beside what else is read.
const NEAR: usize = 256;
/// Bytes of rows that it holds if there is nothing else.
const NEAREST_CACHE: usize = 1 << 15;

/// The stages of one length.
pub(super) struct Stages<T: Real> {
    /// The first, and those in the middle.
    pub first: Stage<T>,
    pub middle: Vec<Stage<T>>,
    /// Of those in the middle, how many go over all rows; the others go over parts of so many rows.
    pub wide: usize,
    pub part: usize,
    /// The radix of the last.
    pub last: usize,
}

/// The length for stages of our own: the even `2^a 3^b 5^c >= n` of which products go through them fastest. Measured: a stage of 3 takes as long as two of 2, one of
/// 5 as three of 2, and what goes between memory and vectors as ten.
pub fn length_for_stages(n: usize) -> usize {
    length_of_least_work(n, |twos, threes, fives| f64::from(10 + twos + 2 * threes + 3 * fives))
}

/// Whether products of these periods go through stages of our own, in both directions, on a machine that has vectors.
pub(super) fn have_stages((px, py): (usize, usize)) -> bool {
    px % 2 == 0 && has_stages(px / 2) && has_stages(py)
}

/// Whether there are stages for a length: none up to the longest radix, which are one stage.
fn has_stages(length: usize) -> bool {
    length > LONGEST && radices(length).is_some()
}

impl<T: Real> Stages<T> {
    /// None for lengths of other factors than 2, 3 and 5, or of one stage.
    pub fn new(length: usize) -> Option<Stages<T>> {
        let radices = radices(length)?;
        let (&last, rest) = radices.split_last()?;
        let mut n = length;
        let mut stage = |&radix: &usize| {
            let m = n / radix;
            let of_row = |j: usize| (1..radix).map(move |q| twiddle(j * q, n));
            let stage = Stage { radix, twiddles: (0..m).flat_map(of_row).collect() };
            n = m;
            stage
        };
        let (first, middle) = rest.split_first()?;
        let (first, middle): (_, Vec<_>) = (stage(first), middle.iter().map(&mut stage).collect());
        let (wide, part) = near_parts(&middle, length, first.stride());
        Some(Stages { first, middle, wide, part, last })
    }

    /// The length.
    pub fn length(&self) -> usize {
        self.first.radix * self.first.stride()
    }

    /// All stages forward but the first.
    #[inline(always)]
    pub fn forward_after_first<S: Simd>(&self, a: Arithmetic<T, S>, rows: &mut [Row<T, S>]) {
        let (wide, near) = self.middle.split_at(self.wide);
        for stage in wide {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        // Then part by part, in the nearest cache.
        for rows in rows.chunks_exact_mut(self.part) {
            for stage in near {
                of_radix!(stage.radix, forward, a, stage, rows);
            }
            of_radix!(self.last, end, a, rows);
        }
    }

    /// The lowest bin of each block that the last stage leaves: block b holds bins `lowest(b) + q length/last`.
    pub fn lowest_bins(&self) -> Vec<usize> {
        let blocks = self.length() / self.last;
        // Row b of the stages before the last holds bin lowest(b) of a transform of their length: digits from behind.
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
        (0..blocks).map(lowest).collect()
    }

    /// The bin of each row that the stages leave.
    pub fn bins(&self) -> Vec<usize> {
        let step = self.length() / self.last;
        self.lowest_bins().iter().flat_map(|bin| (0..self.last).map(move |q| bin + q * step)).collect()
    }
}

/// Factors of a length: a four first, the other fours last, what else there is between them.
fn radices(length: usize) -> Option<Vec<usize>> {
    let (mut rest, mut fours, mut others) = (length, 0, Vec::new());
    while rest > 0 && rest % 4 == 0 {
        (rest, fours) = (rest / 4, fours + 1);
    }
    for radix in [5, 3, 2] {
        while rest > 0 && rest % radix == 0 {
            rest /= radix;
            others.push(radix);
        }
    }
    let first = fours.min(1);
    let radices = [vec![4; first], others, vec![4; fours - first]].concat();
    (rest == 1 && radices.len() > 1).then_some(radices)
}

/// The stages in the middle that go over all rows, until what they leave are parts that the nearest cache holds, and the rows of these.
/// What still fits by itself is one part.
fn near_parts<T: Real>(middle: &[Stage<T>], length: usize, after_first: usize) -> (usize, usize) {
    if length * bytes_of_a_row::<T>() <= NEAREST_CACHE {
        return (0, length);
    }
    let after = |stages: usize| middle[..stages].last().map_or(after_first, Stage::stride);
    let wide = (0..middle.len()).find(|&stages| after(stages) <= NEAR).unwrap_or(middle.len());
    (wide, after(wide))
}

#[cfg(test)]
#[path = "../../tests/unit/stage_plan.rs"]
mod tests;
