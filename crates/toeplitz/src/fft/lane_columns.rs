//! The y direction of products, a vector of columns at a time, one column in each place.
//!
//! ```text
//! columns <- F^-1 (S . F columns)          of one component: S real, S_k = S_(py-k) to within rounding, one for each column
//! ```
//!
//! The first stage of F reads the rows of the grid, the last stage of its inverse writes them; the last stage of F, the product by S and
//! the first stage of the inverse are one pass. Blocks of columns are as [`LaneRows`](crate::fft::lane_rows::LaneRows) write them,
//! `[row][part][column]`; a vector of columns is prefetched while the one before is worked on. S is kept as
//! `[block of columns][kept row][column]` ([`even_plan`](crate::fft::even_plan)).
//!
//! Of several components S is a matrix, and all are worked on together ([`Factor`]).

use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

use par::Result;
use pulp::{Simd, WithSimd};

use crate::block::{parts, parts_mut, prefetch, BLOCK};
use crate::fft::even_plan::{EvenPlan, Kept};
use crate::fft::lanes::{lane_count, Arithmetic, Parts, C};
use crate::fft::stages::{backwards, first, forward, inlined, last, multiply, of_radix, rows_of, Row};
use crate::real::{Complex, Real};

/// Products of columns of one length.
pub(crate) struct LaneColumns<T: Real> {
    plan: Arc<EvenPlan<T>>,
    arch: pulp::Arch,
}

impl<T: Real> LaneColumns<T> {
    /// None where the length has no plan.
    pub fn new(length: usize) -> Result<Option<LaneColumns<T>>> {
        LaneColumns::on(pulp::Arch::new(), length)
    }

    /// With the vectors of these instructions; no bit depends on them.
    fn on(arch: pulp::Arch, length: usize) -> Result<Option<LaneColumns<T>>> {
        Ok(EvenPlan::shared(length)?.map(|plan| LaneColumns { plan, arch }))
    }

    /// The length.
    pub fn length(&self) -> usize {
        self.plan.stages.length()
    }

    /// Kept rows of the symbol of a block.
    pub fn kept_rows(&self) -> usize {
        self.plan.bins.len()
    }

    /// Writes the symbol of a block, of `value(column, bin)` of the columns that there are; zero for the others.
    pub fn write(&self, block: &mut [T], columns: usize, value: impl Fn(usize, usize) -> T) {
        for (row, &bin) in block.chunks_exact_mut(BLOCK).zip(&self.plan.bins) {
            let (there, beyond) = row.split_at_mut(columns.min(BLOCK));
            there.iter_mut().enumerate().for_each(|(column, to)| *to = value(column, bin));
            beyond.fill(T::zero());
        }
    }

    /// Multiplies the columns of a block, `columns` of which mean something and rows `loaded` of which hold values, by its symbol, in memory
    /// for them. `next` is where the next block stands, of as many rows.
    pub fn multiply(
        &self,
        (block, columns): (&mut [Complex<T>], usize),
        next: *const Complex<T>,
        loaded: Range<usize>,
        symbol: &[T],
        memory: &mut [Complex<T>],
    ) {
        assert_eq!(symbol.len(), BLOCK * self.kept_rows());
        let blocks = Blocks { blocks: [block], columns, next: [next], loaded: [loaded] };
        self.multiply_all(blocks, &EvenSymbol(symbol), memory);
    }

    /// The same of K components.
    pub fn multiply_all<const K: usize>(
        &self,
        blocks: Blocks<'_, T, K>,
        factor: &impl Factor<T, K>,
        memory: &mut [Complex<T>],
    ) {
        for (block, loaded) in blocks.blocks.iter().zip(&blocks.loaded) {
            let rows = block.len() / BLOCK;
            assert!(rows <= self.plan.stages.length() && loaded.end <= rows && block.len() % BLOCK == 0);
        }
        self.arch.dispatch(Multiply { plan: &self.plan, blocks, factor, memory });
    }
}

/// The same block of columns of K components.
pub(crate) struct Blocks<'a, T, const K: usize> {
    pub blocks: [&'a mut [Complex<T>]; K],
    /// Columns that mean something.
    pub columns: usize,
    /// Where the next blocks stand, of as many rows.
    pub next: [*const Complex<T>; K],
    /// Rows that hold values.
    pub loaded: [Range<usize>; K],
}

/// Where values of a block of columns are: value q of a block of the last stage, whose first row is `row`, in a vector of columns.
#[derive(Clone, Copy)]
pub(crate) struct At<'a> {
    pub kept: &'a Kept,
    pub row: usize,
    pub q: usize,
    pub vector: usize,
}

/// The symbol of a block of columns of K components.
pub(crate) trait Factor<T: Real, const K: usize> {
    /// The product of some values by it.
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, x: [C<T, S>; K]) -> [C<T, S>; K];
}

/// Real values, `[kept row][column]`, of one component.
pub(crate) struct EvenSymbol<'a, T>(pub &'a [T]);

impl<T: Real> Factor<T, 1> for EvenSymbol<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x]: [C<T, S>; 1]) -> [C<T, S>; 1] {
        [a.scale(x, even_value::<T, S>(self.0, at))]
    }
}

/// The values of an even symbol, `[kept row][column]`.
#[inline(always)]
pub(crate) fn even_value<T: Real, S: Simd>(symbol: &[T], At { kept, q, vector, .. }: At<'_>) -> T::Vector<S> {
    T::vectors::<S>(symbol)[kept.row(q) * (BLOCK / lane_count::<T, S>()) + vector]
}

/// One pass over the columns of a block.
struct Multiply<'a, T: Real, F, const K: usize> {
    plan: &'a EvenPlan<T>,
    blocks: Blocks<'a, T, K>,
    factor: &'a F,
    memory: &'a mut [Complex<T>],
}

impl<T: Real, F: Factor<T, K>, const K: usize> WithSimd for Multiply<'_, T, F, K> {
    type Output = ();

    /// One vector of columns after the other: what is worked on stays in the nearest cache.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let vectors = self.blocks.columns.min(BLOCK).div_ceil(lane_count::<T, S>());
        for vector in 0..vectors {
            let here = self.blocks.blocks.each_ref().map(|block| block.as_ptr());
            let next = if vector + 1 < vectors { (here, vector + 1) } else { (self.blocks.next, 0) };
            self.one_vector(simd, vector, next);
        }
    }
}

impl<T: Real, F: Factor<T, K>, const K: usize> Multiply<'_, T, F, K> {
    /// The columns of one vector of the blocks; then comes vector `next` of `next_blocks`.
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

/// The stages between the first and the last, and the product: what `product(kept rows of a block, its first row, value of the block, values)`
/// makes of the values. `prefetch_part(part, count)` is called for each part of what is needed next.
#[inline(always)]
fn between<T: Real, S: Simd, const K: usize>(
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
    // Then part by part, in the nearest cache.
    let blocks = stages.part / stages.last;
    let (mut part, parts) = (0, stages.length() / stages.part * (2 * near.len() + 1));
    let mut prefetch_next = inlined(
        #[inline(always)]
        || {
            prefetch_part(part, parts);
            part += 1;
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

#[cfg(test)]
#[path = "../../tests/unit/lane_columns.rs"]
mod tests;
