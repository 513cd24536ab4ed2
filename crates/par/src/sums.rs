//! Sums over elements in lanes, for passes over slices of one length, and the least of values.
//!
//! Each sum is taken in lanes. Neither the lanes nor the bits of the sums depend on the threads or on the vectors of the machine. The functions are
//! inlined. So a pass that is compiled for these vectors (`pulp`) includes them.

use std::array::from_fn;

/// Lanes of each sum, so that an addition does not wait for the previous one.
const LANES: usize = 4;
/// Lanes of single sums and of comparisons.
const WIDE: usize = 8;

/// Round-off of a sum of up to 2^31 terms in any order, relative to the sum of their absolute values.
pub const ROUND_OFF: f64 = 1e-12;

/// Terms of a block.
const BLOCK: usize = 512;

/// Terms that are added in double precision.
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

/// Sums over elements, in lanes.
pub struct Sums<const K: usize>([[f64; LANES]; K]);

impl<const K: usize> Default for Sums<K> {
    fn default() -> Sums<K> {
        Sums::new()
    }
}

impl<const K: usize> Sums<K> {
    /// Sums of no terms.
    pub fn new() -> Sums<K> {
        Sums([[0.0; LANES]; K])
    }

    /// Adds `terms(values of a, values of b)` of all elements of one or more slices of equal length. Lanes are loaded first: the compiler cannot
    /// prove that indices into several slices are in range, and would not vectorise (3.5 times the time).
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

    /// The values of the sums.
    pub fn values(&self) -> [f64; K] {
        self.0.map(|lanes| lanes.iter().sum())
    }
}

/// The sum of `a - from + b` over the elements that count, and their number, in lanes that the compiler vectorises.
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

/// The sum of the values of an iterator, in blocks whose sums are added. A single running sum of 262144 equal terms would have an error of 4e-12.
pub fn in_blocks(mut values: impl Iterator<Item = f64>) -> f64 {
    let (mut all, mut next) = (0.0, values.next());
    while let Some(first) = next {
        all += values.by_ref().take(BLOCK - 1).fold(first, |sum, value| sum + value);
        next = values.next();
    }
    all
}

/// The sum of products, one after the other.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The mean of values.
pub fn mean(values: &[f64]) -> f64 {
    in_blocks(values.iter().copied()) / values.len() as f64
}

/// The lesser of two values; the second if they are equal, for any sign of zero.
#[inline(always)]
pub fn lesser(a: f64, b: f64) -> f64 {
    if a < b {
        a
    } else {
        b
    }
}

/// The least of some values that are not NaN; infinite if there are none. In lanes that the compiler vectorises.
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
