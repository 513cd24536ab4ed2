//! Loops over fields of K numbers per element, in double or single precision, by several threads. Sums are taken in double precision, over blocks of
//! fixed length and in fixed order. So they have the same bits for any number of threads.

pub use crate::blocks::BLOCK;
use crate::error::Result;
use crate::memory::unwritten;
use crate::operator::fft::Real;
use crate::sums::Sums;
use crate::threads::Threads;

/// A pool of unused fields, which the next fields reuse. K is the number of values per element, by default 2 (vectors in the plane).
#[derive(Default)]
pub struct Fields<const K: usize = 2> {
    /// Unused fields in double precision.
    free: Vec<Vec<[f64; K]>>,
    /// Unused fields in single precision.
    single: Vec<Vec<[f32; K]>>,
    /// The threads that first touch new fields: the system clears each page when it is first touched, and threads do that in parallel.
    threads: Threads,
}

/// A precision in which fields are stored.
pub trait Stored: Real {
    /// Round-off of products and storage, relative to the largest value of a solution.
    const ROUND_OFF: f64;

    /// The unused fields of this precision in a pool.
    fn of_pool<const K: usize>(fields: &mut Fields<K>) -> &mut Vec<Vec<[Self; K]>>;

    /// Returns `factor` times `field` in this precision. If `field` is then no longer needed, it goes back to the pool.
    fn stored<const K: usize>(
        threads: &Threads,
        field: Vec<[f64; K]>,
        factor: f64,
        fields: &mut Fields<K>,
    ) -> Result<Vec<[Self; K]>>;
}

impl Stored for f64 {
    const ROUND_OFF: f64 = 1e-10;

    fn of_pool<const K: usize>(fields: &mut Fields<K>) -> &mut Vec<Vec<[f64; K]>> {
        &mut fields.free
    }

    fn stored<const K: usize>(
        threads: &Threads,
        mut field: Vec<[f64; K]>,
        factor: f64,
        _: &mut Fields<K>,
    ) -> Result<Vec<[f64; K]>> {
        scale(threads, &mut field, factor);
        Ok(field)
    }
}

impl Stored for f32 {
    const ROUND_OFF: f64 = 1e-6;

    fn of_pool<const K: usize>(fields: &mut Fields<K>) -> &mut Vec<Vec<[f32; K]>> {
        &mut fields.single
    }

    fn stored<const K: usize>(
        threads: &Threads,
        field: Vec<[f64; K]>,
        factor: f64,
        fields: &mut Fields<K>,
    ) -> Result<Vec<[f32; K]>> {
        let mut single = fields.take_of::<f32>(field.len())?;
        fill(threads, &mut single, |i| field[i].map(|value| (factor * value) as f32));
        fields.give(field);
        Ok(single)
    }
}

impl<const K: usize> Fields<K> {
    /// Creates an empty pool. Its new fields are first touched by these threads.
    pub fn touched_by(threads: &Threads) -> Fields<K> {
        Fields { threads: threads.clone(), ..Fields::default() }
    }

    /// Takes a field of n elements in double precision from the pool, or allocates it. Its values are undefined.
    pub fn take(&mut self, n: usize) -> Result<Vec<[f64; K]>> {
        self.take_of(n)
    }

    /// Returns a field in double precision to the pool.
    pub fn give(&mut self, field: Vec<[f64; K]>) {
        self.give_of(field);
    }

    /// Takes a field of n elements in the precision T from the pool, or allocates it. Its values are undefined.
    pub fn take_of<T: Stored>(&mut self, n: usize) -> Result<Vec<[T; K]>> {
        let mut field = T::of_pool(self).pop().unwrap_or_default();
        unwritten(&mut field, n, [T::nan(); K], "the iteration of Newton's method", &self.threads)?;
        Ok(field)
    }

    /// Takes a field from the pool, or allocates it, and sets it to 0.
    pub fn zeros<T: Stored>(&mut self, n: usize, threads: &Threads) -> Result<Vec<[T; K]>> {
        let mut field = self.take_of(n)?;
        fill(threads, &mut field, |_| [T::zero(); K]);
        Ok(field)
    }

    /// Returns a field in the precision T to the pool.
    pub fn give_of<T: Stored>(&mut self, field: Vec<[T; K]>) {
        T::of_pool(self).push(field);
    }

    /// Frees the unused fields with room for fewer than n elements. A field of n elements is then allocated anew, which is cheaper than to enlarge
    /// one.
    pub fn leave_smaller(&mut self, n: usize) {
        self.free.retain(|field| field.capacity() >= n);
        self.single.retain(|field| field.capacity() >= n);
    }

    /// Bytes of the unused fields.
    pub fn bytes(&self) -> usize {
        bytes_of(&self.free) + bytes_of(&self.single)
    }
}

fn bytes_of<T>(fields: &[Vec<T>]) -> usize {
    fields.iter().map(|field| field.capacity() * size_of::<T>()).sum()
}

/// The inner product `v . w`.
pub fn dot<const K: usize, T: Real>(threads: &Threads, v: &[[T; K]], w: &[[T; K]]) -> f64 {
    let mut sums = vec![0.0; v.len().div_ceil(BLOCK)];
    threads.for_each_plain_row(&mut sums, 1, |k, sum| {
        let block = k * BLOCK..((k + 1) * BLOCK).min(v.len());
        sum[0] = dot_of_block(&v[block.clone()], &w[block]);
    });
    sums.iter().sum()
}

/// Adds `a v` to `to`, and returns the inner product of the new `to` with `w`, or with itself if `w` is None.
pub fn add_and_dot<const K: usize, T: Real>(
    threads: &Threads,
    to: &mut [[T; K]],
    a: f64,
    v: &[[T; K]],
    w: Option<&[[T; K]]>,
) -> f64 {
    let mut sums = vec![0.0; v.len().div_ceil(BLOCK)];
    threads.for_each_row_pair((to, BLOCK), (&mut sums[..], 1), |k, to, sum| {
        let start = k * BLOCK;
        to.iter_mut().zip(&v[start..]).for_each(|(to, v)| *to = plus_of(*to, a, *v));
        sum[0] = dot_of_block(to, w.map_or(&*to, |w| &w[start..start + to.len()]));
    });
    sums.iter().sum()
}

/// Adds `sum of a_j v_j` to `to`, in one loop over the elements.
pub fn add_all<const K: usize, S: Real, T: Real>(threads: &Threads, to: &mut [[S; K]], terms: &[(f64, &[[T; K]])]) {
    threads.for_each_plain_row(to, BLOCK, |k, to| {
        for (a, v) in terms {
            let v = &v[k * BLOCK..k * BLOCK + to.len()];
            to.iter_mut().zip(v).for_each(|(to, v)| *to = plus_of(*to, *a, *v));
        }
    });
}

/// Multiplies `to` by a.
pub fn scale<const K: usize, T: Real>(threads: &Threads, to: &mut [[T; K]], a: f64) {
    threads.for_each_plain_row(to, BLOCK, |_, to| {
        to.iter_mut().for_each(|to| *to = to.map(|value| T::of(a * value.to_double())));
    });
}

/// Sets `to = f(i, to)` for each element i.
pub fn map<const K: usize, T: Real>(
    threads: &Threads,
    to: &mut [[T; K]],
    f: impl Fn(usize, [T; K]) -> [T; K] + Sync + Send,
) {
    threads.for_each_plain_row(to, BLOCK, |k, to| {
        to.iter_mut().enumerate().for_each(|(i, to)| *to = f(k * BLOCK + i, *to));
    });
}

/// Sets `to = f(i)` for each element i.
pub fn fill<const K: usize, T: Real>(threads: &Threads, to: &mut [[T; K]], f: impl Fn(usize) -> [T; K] + Sync + Send) {
    threads.for_each_plain_row(to, BLOCK, |k, to| {
        to.iter_mut().enumerate().for_each(|(i, to)| *to = f(k * BLOCK + i));
    });
}

/// Sets `(a, b) = f(i)` for each element i, in one loop over the elements.
pub fn fill_both<const K: usize, T: Real>(
    threads: &Threads,
    (a, b): (&mut [[T; K]], &mut [[T; K]]),
    f: impl Fn(usize) -> [[T; K]; 2] + Sync + Send,
) {
    threads.for_each_row_pair((a, BLOCK), (b, BLOCK), |k, a, b| {
        for ((a, b), i) in a.iter_mut().zip(b).zip(k * BLOCK..) {
            [*a, *b] = f(i);
        }
    });
}

/// The K sums of `f(i)` over n elements.
pub fn sum<const K: usize>(threads: &Threads, n: usize, f: impl Fn(usize) -> [f64; K] + Sync + Send) -> [f64; K] {
    let add = |sums: [f64; K], terms: [f64; K]| std::array::from_fn(|k| sums[k] + terms[k]);
    let mut sums = vec![[0.0; K]; n.div_ceil(BLOCK)];
    threads.for_each_plain_row(&mut sums, 1, |k, sum| {
        sum[0] = (k * BLOCK..((k + 1) * BLOCK).min(n)).map(&f).fold([0.0; K], add);
    });
    sums.into_iter().fold([0.0; K], add)
}

/// The largest `f(i)` over n elements, or 0 if none is positive.
pub fn largest(threads: &Threads, n: usize, f: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
    let mut largest = vec![0.0; n.div_ceil(BLOCK)];
    threads.for_each_plain_row(&mut largest, 1, |k, largest| {
        largest[0] = (k * BLOCK..((k + 1) * BLOCK).min(n)).map(&f).fold(0.0, f64::max);
    });
    largest.into_iter().fold(0.0, f64::max)
}

/// Calls `work(first element, block)` for each block of elements, and adds up the results. A block has the parts of several fields.
pub fn over<B: Send, const K: usize>(
    threads: &Threads,
    blocks: impl Iterator<Item = B>,
    work: impl Fn(usize, &mut B) -> [f64; K] + Sync + Send,
) -> [f64; K] {
    let added = |all: [f64; K], sums: [f64; K]| std::array::from_fn(|k| all[k] + sums[k]);
    if threads.count() == 1 {
        let one = |(k, mut block): (usize, B)| pulp::Arch::new().dispatch(|| work(k * BLOCK, &mut block));
        return blocks.enumerate().map(one).fold([0.0; K], added);
    }
    let mut blocks: Vec<(B, [f64; K])> = blocks.map(|block| (block, [0.0; K])).collect();
    threads.for_each(&mut blocks, |k, (block, sums)| *sums = work(k * BLOCK, block));
    blocks.into_iter().map(|(_, sums)| sums).fold([0.0; K], added)
}

/// The inner product `v . w` over one block, in several partial sums: in a single sum each addition would wait for the one before.
#[inline(always)]
fn dot_of_block<const K: usize, T: Real>(v: &[[T; K]], w: &[[T; K]]) -> f64 {
    let mut sums = Sums::new();
    sums.add::<T, 0, 2>([], [v.as_flattened(), w.as_flattened()], |[], [v, w]| [v * w]);
    let [sum] = sums.values();
    sum
}

/// The inner product `v . w` of one element's values.
#[inline]
pub fn dot_one<const K: usize>(v: &[f64; K], w: &[f64; K]) -> f64 {
    (1..K).fold(v[0] * w[0], |sum, k| sum + v[k] * w[k])
}

/// `v + a w` for one element.
#[inline]
pub fn plus<const K: usize>(v: [f64; K], a: f64, w: [f64; K]) -> [f64; K] {
    std::array::from_fn(|k| v[k] + a * w[k])
}

/// `v + a w` for one element, in the precision of v.
#[inline(always)]
fn plus_of<const K: usize, S: Real, T: Real>(v: [S; K], a: f64, w: [T; K]) -> [S; K] {
    std::array::from_fn(|k| S::of(v[k].to_double() + a * w[k].to_double()))
}
