//! The y direction of products by even coefficients, [`GROUP`] columns at a time, as vectors (one column in each place).
//!
//! ```text
//! columns <- F^-1 (S . F columns)          S real, S_k = S_(py-k), one for each column
//! ```
//!
//! The first stage of F reads the rows of the grid, the last stage of its inverse writes them; the last stage of F, the product by S and
//! the first stage of the inverse are one pass. S is kept as `[group][kept row][place]` ([`even_plan`](super::even_plan)).

use std::ops::Range;
use std::sync::Arc;

use pulp::{Simd, WithSimd};

use super::columns::{parts, parts_mut, Block};
use super::even_plan::{EvenPlan, Kept};
use super::even_stages::{backwards, first, forward, inlined, last, multiply, of_radix, rows_of, Row};
use super::fft::{even_plan, Complex, Real};
use super::lanes::{places, Arithmetic, Parts, C};

/// Columns of a group.
pub(super) const GROUP: usize = 8;

/// Products of groups of columns of one length.
pub(super) struct EvenColumns<T: Real> {
    plan: Arc<EvenPlan<T>>,
    /// The column, of a group, in each place.
    column_in: [usize; GROUP],
}

impl<T: Real> EvenColumns<T> {
    /// None where the machine has no vectors, or longer ones than a group, or the length no plan.
    pub fn new(length: usize) -> Option<EvenColumns<T>> {
        let column_in = pulp::Arch::new().dispatch(ColumnIn::<T>(std::marker::PhantomData))?;
        Some(EvenColumns { plan: even_plan(length)?, column_in })
    }

    /// Kept rows of a group's spectrum.
    pub fn kept_rows(&self) -> usize {
        self.plan.bins.len()
    }

    /// The columns, of `bins`, that are in groups.
    pub fn grouped(bins: usize) -> usize {
        bins - bins % GROUP
    }

    /// Writes a group's spectrum, of `value(column, bin)`.
    pub fn write(&self, group: &mut [T], value: impl Fn(usize, usize) -> T) {
        for (row, &bin) in group.chunks_exact_mut(GROUP).zip(&self.plan.bins) {
            row.iter_mut().zip(&self.column_in).for_each(|(to, &column)| *to = value(column, bin));
        }
    }

    /// The place here of what is in each place there.
    pub fn places_in<S: Real>(&self, there: &EvenColumns<S>) -> [usize; GROUP] {
        there.column_in.map(|column| self.column_in.iter().position(|&c| c == column).unwrap_or_default())
    }

    /// Multiplies the groups of a block, rows `loaded` of which hold values, in memory for its columns. Returns how many columns they are.
    pub fn multiply(
        &self,
        block: &mut Block<'_, T>,
        loaded: Range<usize>,
        spectrum: &[T],
        memory: &mut [Complex<T>],
    ) -> usize {
        let length = self.plan.kept.len() * self.plan.last;
        assert!(block.rows() <= length && loaded.end <= block.rows());
        let (columns, at) = (EvenColumns::<T>::grouped(block.columns()), block.first());
        if columns > 0 {
            let spectrum = &spectrum[at * self.kept_rows()..][..columns * self.kept_rows()];
            pulp::Arch::new().dispatch(Multiply { plan: &self.plan, columns, block, loaded, spectrum, memory });
        }
        columns
    }
}

/// The column of a group in each place of this machine's vectors; the same answer for no vectors in either precision.
struct ColumnIn<T>(std::marker::PhantomData<T>);

impl<T: Real> WithSimd for ColumnIn<T> {
    type Output = Option<[usize; GROUP]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        if S::F64_LANES < 2 || S::F32_LANES > GROUP {
            return None;
        }
        let mut columns: [Complex<T>; GROUP] = std::array::from_fn(|c| Complex::new(T::of(c as f64), T::zero()));
        for pair in T::vectors_mut::<S>(parts_mut(&mut columns)).chunks_exact_mut(2) {
            let parts = T::part(simd, [pair[0], pair[1]]);
            pair.copy_from_slice(&parts);
        }
        // Of each vector all real parts, then all imaginary ones.
        let (values, n) = (parts(&columns), places::<T, S>());
        Some(std::array::from_fn(|place| values[place / n * 2 * n + place % n].to_double() as usize))
    }
}

/// One pass over the groups of a block.
struct Multiply<'a, 'b, T: Real> {
    plan: &'a EvenPlan<T>,
    columns: usize,
    block: &'a mut Block<'b, T>,
    loaded: Range<usize>,
    spectrum: &'a [T],
    memory: &'a mut [Complex<T>],
}

impl<T: Real> WithSimd for Multiply<'_, '_, T> {
    type Output = ();

    /// One vector of columns after the other: what is worked on stays in the nearest cache.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for column in (0..self.columns).step_by(places::<T, S>()) {
            self.one_vector(simd, column);
        }
    }
}

impl<T: Real> Multiply<'_, '_, T> {
    /// The columns of one vector, from the given one of the block on.
    #[inline(always)]
    fn one_vector<S: Simd>(&mut self, simd: S, column: usize) {
        let Multiply { plan, block, loaded, spectrum, memory, .. } = self;
        let (a, places) = (Arithmetic::<T, S>::new(simd), places::<T, S>());
        let values = 2 * column..2 * (column + places);
        let rows = &mut rows_of::<T, S>(memory)[..plan.kept.len() * plan.last];
        let zero = Parts { re: a.splat(T::zero()), im: a.splat(T::zero()) };
        let load = inlined(
            #[inline(always)]
            |row: usize| -> C<T, S> {
                if !loaded.contains(&row) {
                    return zero;
                }
                let values = T::vectors::<S>(&parts(block.row(row))[values.clone()]);
                let [re, im] = T::part(simd, [values[0], values[1]]);
                Parts { re, im }
            },
        );
        of_radix!(plan.first.radix, first, a, &plan.first, rows, load);
        let group = plan.bins.len() * GROUP;
        let spectrum = T::vectors::<S>(&spectrum[column / GROUP * group..][..group]);
        let (vectors, vector) = (GROUP / places, column % GROUP / places);
        let factor = inlined(
            #[inline(always)]
            |kept: &Kept, q: usize| spectrum[kept.row(q) * vectors + vector],
        );
        between(a, plan, rows, factor);
        let my = block.rows();
        let store = inlined(
            #[inline(always)]
            |row: usize, value: C<T, S>| {
                if row < my {
                    let values = T::vectors_mut::<S>(&mut parts_mut(block.row_mut(row))[values.clone()]);
                    [values[0], values[1]] = T::join(simd, [value.re, value.im]);
                }
            },
        );
        of_radix!(plan.first.radix, last, a, &plan.first, rows, store);
    }
}

/// The stages between the first and the last, and the product by `factor(kept rows of a block, value of the block)`.
#[inline(always)]
fn between<T: Real, S: Simd>(
    a: Arithmetic<T, S>,
    plan: &EvenPlan<T>,
    rows: &mut [Row<T, S>],
    factor: impl Fn(&Kept, usize) -> T::Vector<S>,
) {
    let (wide, near) = plan.middle.split_at(plan.wide);
    for stage in wide {
        of_radix!(stage.radix, forward, a, stage, rows);
    }
    // Then part by part, in the nearest cache.
    let blocks = plan.part / plan.last;
    for (rows, kept) in rows.chunks_exact_mut(plan.part).zip(plan.kept.chunks_exact(blocks)) {
        for stage in near {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        let factor = inlined(
            #[inline(always)]
            |b: usize, q: usize| factor(&kept[b], q),
        );
        of_radix!(plan.last, multiply, a, rows, factor);
        for stage in near.iter().rev() {
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
