//! Sums over the elements of slices of one length, and the smallest of values.
//!
//! Each sum is computed as several partial sums, the lanes, which are added at the end. So the compiler can use SIMD vectors. The number of lanes
//! depends neither on the threads nor on the vectors of the machine, so the bits of the sums do not either. The functions are inlined: if a caller is
//! compiled for the vectors of the machine (by `pulp`), so are they.

use std::array::from_fn;

/// The number of lanes of each sum of [`Sums`]. With several lanes an addition does not wait for the previous one.
const LANES: usize = 4;
/// The number of lanes of [`sum_where`] and [`least`].
const WIDE: usize = 8;

/// The round-off of a sum of up to 2^31 terms, in any order of this module, relative to the sum of their absolute values.
pub const ROUND_OFF: f64 = 1e-12;

/// The number of terms of a block of [`in_blocks`].
const BLOCK: usize = 512;

/// Values that are converted to double precision and added.
pub trait Value: Copy {
    /// This value in double precision.
    fn to_double(self) -> f64;
}

macro_rules! value {
    ($($t:ty),*) => {
        $(impl Value for $t {
            #[inline(always)]
            fn to_double(self) -> f64 {
                f64::from(self)
            }
        })*
    };
}
value!(f32, f64, bool);

/// K sums over elements, each in lanes.
pub struct Sums<const K: usize>([[f64; LANES]; K]);

impl<const K: usize> Default for Sums<K> {
    fn default() -> Sums<K> {
        Sums::new()
    }
}

impl<const K: usize> Sums<K> {
    /// K sums without terms, which are 0.
    pub fn new() -> Sums<K> {
        Sums([[0.0; LANES]; K])
    }

    /// Adds the K terms `terms(values of a, values of b)` of each element. `a` and `b` are slices of equal length, at least one in all.
    ///
    /// The values of all lanes are loaded before the terms are computed. Otherwise the compiler could not prove that the indices are in range of all
    /// slices, and would not vectorise the loop, which would take 3.5 times as long.
    #[inline(always)]
    pub fn add<T: Value, const A: usize, const B: usize>(
        &mut self,
        a: [&[f64]; A],
        b: [&[T]; B],
        terms: impl Fn([f64; A], [f64; B]) -> [f64; K],
    ) {
        let n = a.first().map_or_else(|| b[0].len(), |a| a.len());
        let a = a.map(|a| pulp::as_arrays::<LANES, f64>(&a[..n]));
        let b = b.map(|b| pulp::as_arrays::<LANES, T>(&b[..n]));
        let mut sums = self.0;
        for i in 0..n / LANES {
            let x: [[f64; LANES]; A] = from_fn(|k| a[k].0[i]);
            let y: [[f64; LANES]; B] = from_fn(|k| b[k].0[i].map(Value::to_double));
            for lane in 0..LANES {
                let terms = terms(from_fn(|k| x[k][lane]), from_fn(|k| y[k][lane]));
                for k in 0..K {
                    sums[k][lane] += terms[k];
                }
            }
        }
        for lane in 0..n % LANES {
            let terms = terms(from_fn(|k| a[k].1[lane]), from_fn(|k| b[k].1[lane].to_double()));
            sums.iter_mut().zip(terms).for_each(|(sum, term)| sum[lane] += term);
        }
        self.0 = sums;
    }

    /// The values of the K sums.
    pub fn values(&self) -> [f64; K] {
        self.0.map(|lanes| lanes.iter().sum())
    }
}

/// The sum of `a - from + b` over the elements for which `counts` is true, and the number of these elements. The compiler vectorises the loop.
#[inline(always)]
pub fn sum_where((a, from): (&[f64], f64), b: &[f64], counts: &[bool]) -> (f64, u64) {
    let term = |a: f64, b: f64, counts: bool| if counts { a - from + b } else { 0.0 };
    let (a, rest_of_a) = pulp::as_arrays::<WIDE, f64>(a);
    let (b, rest_of_b) = pulp::as_arrays::<WIDE, f64>(b);
    let (lanes, rest) = pulp::as_arrays::<WIDE, bool>(counts);
    let mut sums = [0.0; WIDE];
    for ((a, b), counts) in a.iter().zip(b).zip(lanes) {
        sums = from_fn(|lane| sums[lane] + term(a[lane], b[lane], counts[lane]));
    }
    let of_rest = rest_of_a.iter().zip(rest_of_b).zip(rest).map(|((a, b), counts)| term(*a, *b, *counts));
    let count = counts.iter().fold(0, |count, &counts| count + u64::from(counts));
    (sums.iter().sum::<f64>() + of_rest.sum::<f64>(), count)
}

/// The sum of the values of an iterator: adds the sums of blocks of values. One running sum of 262144 equal terms would have a relative error of
/// 4e-12.
pub fn in_blocks(mut values: impl Iterator<Item = f64>) -> f64 {
    let (mut total, mut next) = (0.0, values.next());
    while let Some(first) = next {
        total += values.by_ref().take(BLOCK - 1).fold(first, |sum, value| sum + value);
        next = values.next();
    }
    total
}

/// The sum of the products a_i b_i, added one after the other.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The mean of values; NaN if there are none.
pub fn mean(values: &[f64]) -> f64 {
    in_blocks(values.iter().copied()) / values.len() as f64
}

/// The smaller of two values. It is b if both are equal (also for zeros of different signs), or if one is NaN.
#[inline(always)]
pub fn lesser(a: f64, b: f64) -> f64 {
    if a < b {
        a
    } else {
        b
    }
}

/// The smallest of all values that are not NaN; infinite if there are none. The compiler vectorises the loop.
#[inline(always)]
pub fn least(values: &[f64]) -> f64 {
    let (lanes, rest) = pulp::as_arrays::<WIDE, f64>(values);
    let mut least = [f64::INFINITY; WIDE];
    for values in lanes {
        least = from_fn(|lane| lesser(values[lane], least[lane]));
    }
    rest.iter().chain(&least).fold(f64::INFINITY, |least, value| lesser(*value, least))
}

#[cfg(test)]
#[path = "../tests/unit/sums.rs"]
mod tests;
