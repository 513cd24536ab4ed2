//! The product of a block of columns by the symbol, `F^-1 (S . F columns)`, with the transforms of
//! [`LaneColumns`](crate::fft::lane_columns::LaneColumns).
//!
//! The first stage of F reads the rows of the grid, and the last stage of F^-1 writes them. The last stage of F, the product by S and the first stage
//! of F^-1 are one pass over memory. While one vector of columns is transformed, the next one is prefetched.

use std::array::from_fn;
use std::ops::Range;

use pulp::{Simd, WithSimd};

use crate::block::{parts, parts_mut, prefetch, BLOCK};
use crate::fft::even_plan::{EvenPlan, Kept};
use crate::fft::lanes::{lane_count, Arithmetic, Parts, C};
use crate::fft::stages::{backwards, first, forward, inlined, last, multiply, of_radix, rows_of, Row};
use crate::real::{Complex, Scalar};

/// One block of columns, for each of K components.
pub struct Blocks<'a, T, const K: usize> {
    /// The values, `[row][part][column]`.
    pub blocks: [&'a mut [Complex<T>]; K],
    /// The number of columns from the first of the block to the last bin in x. Columns of the block beyond it are undefined.
    pub columns: usize,
    /// The addresses of the blocks that are probably multiplied next. Only prefetches use them.
    pub next: [*const Complex<T>; K],
    /// The rows that hold values. All others count as zero.
    pub loaded: [Range<usize>; K],
}

/// The place of one vector of values in a block of columns: bin number q of a block of the last stage, in one vector of columns.
#[derive(Clone, Copy)]
pub struct At<'a> {
    /// The kept rows of an even symbol for this block of the last stage.
    pub kept: &'a Kept,
    /// The first row of this block of the last stage.
    pub row: usize,
    /// The number of the bin in this block of the last stage.
    pub q: usize,
    /// The number of the vector among those of the block's columns.
    pub vector: usize,
}

/// A symbol in a block of columns, which multiplies K components.
pub trait Factor<T: Scalar, const K: usize> {
    /// Returns the product of the symbol at the place `at` and the values x of all components there.
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, x: [C<T, S>; K]) -> [C<T, S>; K];
}

/// The even symbol of one component in a block of columns, `[kept row][column]`.
pub struct EvenSymbol<'a, T>(pub &'a [T]);

impl<T: Scalar> Factor<T, 1> for EvenSymbol<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x]: [C<T, S>; 1]) -> [C<T, S>; 1] {
        [a.scale(x, even_value::<T, S>(self.0, at))]
    }
}

/// The values of a real symbol, `[kept row][column]`, at the place `at`.
#[inline(always)]
pub fn even_value<T: Scalar, S: Simd>(symbol: &[T], At { kept, q, vector, .. }: At<'_>) -> T::Vector<S> {
    T::vectors::<S>(symbol)[kept.row(q) * (BLOCK / lane_count::<T, S>()) + vector]
}

/// Transforms a block of columns of K components, multiplies it by the symbol `factor` and transforms it back, in place.
pub struct Multiply<'a, T: Scalar, F, const K: usize> {
    pub plan: &'a EvenPlan<T>,
    pub blocks: Blocks<'a, T, K>,
    pub factor: &'a F,
    /// Memory for one vector of columns of each component.
    pub memory: &'a mut [Complex<T>],
}

impl<T: Scalar, F: Factor<T, K>, const K: usize> WithSimd for Multiply<'_, T, F, K> {
    type Output = ();

    /// Multiplies one vector of columns after the other, so that its values stay in the first-level cache.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for (block, loaded) in self.blocks.blocks.iter().zip(&self.blocks.loaded) {
            let rows = block.len() / BLOCK;
            assert!(rows <= self.plan.stages.length() && loaded.end <= rows && block.len() % BLOCK == 0);
        }
        let vectors = self.blocks.columns.min(BLOCK).div_ceil(lane_count::<T, S>());
        for vector in 0..vectors {
            let here = self.blocks.blocks.each_ref().map(|block| block.as_ptr());
            let next = if vector + 1 < vectors { (here, vector + 1) } else { (self.blocks.next, 0) };
            self.one_vector(simd, vector, next);
        }
    }
}

impl<T: Scalar, F: Factor<T, K>, const K: usize> Multiply<'_, T, F, K> {
    /// Multiplies the columns of vector number `vector` of the blocks. Meanwhile it prefetches vector number `next` of `next_blocks`.
    #[inline(always)]
    fn one_vector<S: Simd>(&mut self, simd: S, vector: usize, (next_blocks, next): ([*const Complex<T>; K], usize)) {
        let Multiply { plan, blocks: Blocks { blocks, loaded, .. }, factor, memory } = self;
        let (a, vectors, stages) = (Arithmetic::<T, S>::new(simd), BLOCK / lane_count::<T, S>(), &plan.stages);
        let mut memory = rows_of::<T, S>(memory)[..K * stages.length()].chunks_exact_mut(stages.length());
        let mut components: [&mut [Row<T, S>]; K] = from_fn(|_| memory.next().unwrap_or_default());
        let zero = Parts { re: a.splat(T::zero()), im: a.splat(T::zero()) };
        let my = blocks[0].len() / BLOCK;
        for ((rows, block), loaded) in components.iter_mut().zip(&*blocks).zip(&*loaded) {
            let values = T::vectors::<S>(parts(block));
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<T, S> {
                    if !loaded.contains(&row) {
                        return zero;
                    }
                    let at = 2 * vectors * row + vector;
                    Parts { re: values[at], im: values[at + vectors] }
                },
            );
            of_radix!(stages.first.radix, first, a, &stages.first, rows, load);
        }
        let product = inlined(
            #[inline(always)]
            |kept: &Kept, row: usize, q: usize, x: [C<T, S>; K]| factor.times::<S>(a, At { kept, row, q, vector }, x),
        );
        let prefetch_part = inlined(
            #[inline(always)]
            |part: usize, count: usize| {
                for block in next_blocks {
                    let (first, per_part) = (block.cast::<T::Vector<S>>().wrapping_add(next), my.div_ceil(count));
                    for row in part * per_part..my.min((part + 1) * per_part) {
                        let at = first.wrapping_add(2 * vectors * row);
                        prefetch(at, 1);
                        prefetch(at.wrapping_add(vectors), 1);
                    }
                }
            },
        );
        between(a, plan, &mut components, product, prefetch_part);
        for (rows, block) in components.iter_mut().zip(blocks) {
            let values = T::vectors_mut::<S>(parts_mut(block));
            let store = inlined(
                #[inline(always)]
                |row: usize, value: C<T, S>| {
                    if row < my {
                        let at = 2 * vectors * row + vector;
                        (values[at], values[at + vectors]) = (value.re, value.im);
                    }
                },
            );
            of_radix!(stages.first.radix, last, a, &stages.first, rows, store);
        }
    }
}

/// Applies all stages of both transforms except the first of F and the last of F^-1, and the product by the symbol between both. `product(kept, row,
/// q, x)` multiplies the values x of bin q in a block of the last stage, with the kept rows `kept` and the first row `row`. `prefetch_part(part,
/// count)` prefetches part number `part` of `count` parts of the next vector.
#[inline(always)]
fn between<T: Scalar, S: Simd, const K: usize>(
    a: Arithmetic<T, S>,
    plan: &EvenPlan<T>,
    components: &mut [&mut [Row<T, S>]; K],
    product: impl Fn(&Kept, usize, usize, [C<T, S>; K]) -> [C<T, S>; K],
    prefetch_part: impl Fn(usize, usize),
) {
    let stages = &plan.stages;
    let (wide, near) = stages.middle.split_at(stages.wide);
    for rows in components.iter_mut() {
        for stage in wide {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
    }
    // The other stages process one part of the rows after the other: a part fits in the first-level cache.
    let blocks = stages.part / stages.last;
    let (mut step, steps) = (0, stages.length() / stages.part * (2 * near.len() + 1));
    let mut prefetch_next = inlined(
        #[inline(always)]
        || {
            prefetch_part(step, steps);
            step += 1;
        },
    );
    for (first, kept) in (0..stages.length()).step_by(stages.part).zip(plan.kept.chunks_exact(blocks)) {
        for stage in near {
            prefetch_next();
            for rows in components.iter_mut() {
                let rows = &mut rows[first..][..stages.part];
                of_radix!(stage.radix, forward, a, stage, rows);
            }
        }
        let product = inlined(
            #[inline(always)]
            |b: usize, q: usize, x: [C<T, S>; K]| product(&kept[b], first + b * stages.last, q, x),
        );
        prefetch_next();
        let rows = components.each_mut().map(|rows| &mut rows[first..][..stages.part]);
        of_radix!(stages.last, multiply of K, a, rows, product);
        for stage in near.iter().rev() {
            prefetch_next();
            for rows in components.iter_mut() {
                let rows = &mut rows[first..][..stages.part];
                of_radix!(stage.radix, backwards, a, stage, rows);
            }
        }
    }
    for rows in components.iter_mut() {
        for stage in wide.iter().rev() {
            of_radix!(stage.radix, backwards, a, stage, rows);
        }
    }
}
