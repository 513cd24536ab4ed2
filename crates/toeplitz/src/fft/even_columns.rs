//! The y direction of products by even coefficients, a vector of columns at a time, one column in each place.
//!
//! ```text
//! columns <- F^-1 (S . F columns)          S real, S_k = S_(py-k) to within rounding, one for each column
//! ```
//!
//! The first stage of F reads the rows of the grid, the last stage of its inverse writes them; the last stage of F, the product by S and
//! the first stage of the inverse are one pass. Blocks of columns are as [`LaneRows`](crate::fft::lane_rows::LaneRows) write them,
//! `[row][part][column]`; a vector of columns is prefetched while the one before is worked on. S is kept as
//! `[block of columns][kept row][column]` ([`even_plan`](crate::fft::even_plan)).

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
pub(crate) struct EvenColumns<T: Real> {
    plan: Arc<EvenPlan<T>>,
    arch: pulp::Arch,
}

impl<T: Real> EvenColumns<T> {
    /// None where the length has no plan.
    pub fn new(length: usize) -> Result<Option<EvenColumns<T>>> {
        EvenColumns::on(pulp::Arch::new(), length)
    }

    /// With the vectors of these instructions; no bit depends on them.
    fn on(arch: pulp::Arch, length: usize) -> Result<Option<EvenColumns<T>>> {
        Ok(EvenPlan::shared(length)?.map(|plan| EvenColumns { plan, arch }))
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
        let rows = block.len() / BLOCK;
        assert!(rows <= self.plan.stages.length() && loaded.end <= rows && block.len() % BLOCK == 0);
        assert_eq!(symbol.len(), BLOCK * self.kept_rows());
        self.arch.dispatch(Multiply { plan: &self.plan, columns, block, next, loaded, symbol, memory });
    }
}

/// One pass over the columns of a block.
struct Multiply<'a, T: Real> {
    plan: &'a EvenPlan<T>,
    columns: usize,
    block: &'a mut [Complex<T>],
    next: *const Complex<T>,
    loaded: Range<usize>,
    symbol: &'a [T],
    memory: &'a mut [Complex<T>],
}

impl<T: Real> WithSimd for Multiply<'_, T> {
    type Output = ();

    /// One vector of columns after the other: what is worked on stays in the nearest cache.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let vectors = self.columns.min(BLOCK).div_ceil(lane_count::<T, S>());
        for vector in 0..vectors {
            let next = if vector + 1 < vectors { (self.block.as_ptr(), vector + 1) } else { (self.next, 0) };
            self.one_vector(simd, vector, next);
        }
    }
}

impl<T: Real> Multiply<'_, T> {
    /// The columns of one vector of the block; then comes vector `next` of `next_block`.
    #[inline(always)]
    fn one_vector<S: Simd>(&mut self, simd: S, vector: usize, (next_block, next): (*const Complex<T>, usize)) {
        let Multiply { plan, block, loaded, symbol, memory, .. } = self;
        let (a, vectors, stages) = (Arithmetic::<T, S>::new(simd), BLOCK / lane_count::<T, S>(), &plan.stages);
        let rows = &mut rows_of::<T, S>(memory)[..stages.length()];
        let zero = Parts { re: a.splat(T::zero()), im: a.splat(T::zero()) };
        let (my, values) = (block.len() / BLOCK, T::vectors::<S>(parts(block)));
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
        let symbol = &T::vectors::<S>(symbol)[..plan.bins.len() * vectors];
        let factor = inlined(
            #[inline(always)]
            |kept: &Kept, q: usize| symbol[kept.row(q) * vectors + vector],
        );
        let prefetch_part = inlined(
            #[inline(always)]
            |part: usize, count: usize| {
                let (first, per_part) = (next_block.cast::<T::Vector<S>>().wrapping_add(next), my.div_ceil(count));
                for row in part * per_part..my.min((part + 1) * per_part) {
                    let at = first.wrapping_add(2 * vectors * row);
                    prefetch(at, 1);
                    prefetch(at.wrapping_add(vectors), 1);
                }
            },
        );
        between(a, plan, rows, factor, prefetch_part);
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

/// The stages between the first and the last, and the product by `factor(kept rows of a block, value of the block)`. `prefetch_part(part, count)`
/// is called for each part of what is needed next.
#[inline(always)]
fn between<T: Real, S: Simd>(
    a: Arithmetic<T, S>,
    plan: &EvenPlan<T>,
    rows: &mut [Row<T, S>],
    factor: impl Fn(&Kept, usize) -> T::Vector<S>,
    prefetch_part: impl Fn(usize, usize),
) {
    let stages = &plan.stages;
    let (wide, near) = stages.middle.split_at(stages.wide);
    for stage in wide {
        of_radix!(stage.radix, forward, a, stage, rows);
    }
    // Then part by part, in the nearest cache.
    let blocks = stages.part / stages.last;
    let (mut part, parts) = (0, rows.len() / stages.part * (2 * near.len() + 1));
    let mut prefetch_next = inlined(
        #[inline(always)]
        || {
            prefetch_part(part, parts);
            part += 1;
        },
    );
    for (rows, kept) in rows.chunks_exact_mut(stages.part).zip(plan.kept.chunks_exact(blocks)) {
        for stage in near {
            prefetch_next();
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        let factor = inlined(
            #[inline(always)]
            |b: usize, q: usize| factor(&kept[b], q),
        );
        prefetch_next();
        of_radix!(stages.last, multiply, a, rows, factor);
        for stage in near.iter().rev() {
            prefetch_next();
            of_radix!(stage.radix, backwards, a, stage, rows);
        }
    }
    for stage in wide.iter().rev() {
        of_radix!(stage.radix, backwards, a, stage, rows);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/even_columns.rs"]
mod tests;
