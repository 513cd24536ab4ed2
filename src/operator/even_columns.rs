//! The y direction of products by even coefficients, [`GROUP`] columns at a time, as vectors (one column in each place).
//!
//! ```text
//! columns <- F^-1 (S . F columns)          S real, S_k = S_(py-k), one for each column
//! ```
//!
//! The first stage of F reads the rows of the grid, the last stage of its inverse writes them; the last stage of F, the product by S and
//! the first stage of the inverse are one pass. Between them bins stay in the order in which the stages leave them
//! ([`even_stages`](super::even_stages)): of each block of bins that comes out of the last stage the mirror image, the bins py - k, is a
//! block too, from behind, so one of the two is kept of S: `[group][kept row][place]`.

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use pulp::{Simd, WithSimd};

use super::columns::{parts, parts_mut, Block};
use super::even_stages::{backwards, first, forward, last, multiply, Row, Stage};
use super::fft::{even_plan, Complex, Real};
use super::lanes::{places, Arithmetic, Parts, C};

/// Columns of a group.
pub(super) const GROUP: usize = 8;

/// The stages of one length.
pub struct EvenPlan<T: Real> {
    /// The first, and those in the middle.
    first: Stage<T>,
    middle: Vec<Stage<T>>,
    /// The radix of the last.
    last: usize,
    /// Where S is kept, for each block of the last stage.
    kept: Vec<Kept>,
    /// The bin of each kept row, at most py/2.
    bins: Vec<usize>,
}

/// The kept rows of a block: the first, and the step to the next.
#[derive(Clone, Copy)]
struct Kept {
    first: usize,
    step: isize,
}

impl<T: Real> EvenPlan<T> {
    /// None for lengths of other factors than 2, 3 and 5, or of one stage.
    pub fn new(length: usize) -> Option<EvenPlan<T>> {
        let radices = radices(length)?;
        let (&last, rest) = radices.split_last()?;
        let mut n = length;
        let mut stage = |&radix: &usize| {
            let m = n / radix;
            let angle = |j: usize, q: usize| -2.0 * PI * (j * q) as f64 / n as f64;
            let of_row = |j: usize| (1..radix).map(move |q| angle(j, q));
            let twiddles = (0..m).flat_map(of_row).map(|angle| Complex::new(T::of(angle.cos()), T::of(angle.sin())));
            let stage = Stage { radix, twiddles: twiddles.collect() };
            n = m;
            stage
        };
        let (first, middle) = rest.split_first()?;
        let (first, middle) = (stage(first), middle.iter().map(&mut stage).collect());
        let (kept, bins) = kept_rows(length, rest, last);
        Some(EvenPlan { first, middle, last, kept, bins })
    }
}

/// Factors of a length, the largest number of fours at both ends.
fn radices(length: usize) -> Option<Vec<usize>> {
    let (mut rest, mut fours, mut others) = (length, 0, Vec::new());
    while rest % 4 == 0 {
        (rest, fours) = (rest / 4, fours + 1);
    }
    for radix in [5, 3, 2] {
        while rest % radix == 0 {
            rest /= radix;
            others.push(radix);
        }
    }
    let first = fours.min(1);
    let radices = [vec![4; first], others, vec![4; fours - first]].concat();
    (rest == 1 && radices.len() > 1).then_some(radices)
}

/// Where S is kept of each block of the last stage, and the bin of each kept row. Block b holds bins `lowest(b) + q length/last`.
fn kept_rows(length: usize, before: &[usize], last: usize) -> (Vec<Kept>, Vec<usize>) {
    let blocks = length / last;
    // Row b of the stages before the last holds bin lowest(b) of a transform of their length: digits from behind.
    let lowest = |b: usize| {
        let (mut rest, mut below, mut bin) = (b, blocks, 0);
        let mut weight = 1;
        for radix in before {
            below /= radix;
            bin += weight * (rest / below);
            rest %= below;
            weight *= radix;
        }
        bin
    };
    let lowest: Vec<usize> = (0..blocks).map(lowest).collect();
    let (mut block_of, mut bins) = (vec![0; blocks], Vec::new());
    let is_kept = |bin: usize| 2 * bin <= blocks;
    for &bin in lowest.iter().filter(|&&bin| is_kept(bin)) {
        block_of[bin] = bins.len();
        bins.extend((0..last).map(|q| bin + q * blocks).map(|bin| bin.min(length - bin)));
    }
    let kept = lowest.iter().map(|&bin| match is_kept(bin) {
        true => Kept { first: block_of[bin], step: 1 },
        false => Kept { first: block_of[blocks - bin] + last - 1, step: -1 },
    });
    (kept.collect(), bins)
}

/// Products of groups of columns of one length.
#[derive(Clone)]
pub(super) struct EvenColumns<T: Real> {
    plan: Arc<EvenPlan<T>>,
    /// The column, of a group, in each place.
    column_in: [usize; GROUP],
}

impl<T: Real> EvenColumns<T> {
    /// None where the machine has no vectors, or the length no plan.
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

    /// One vector of columns after the other: so a column of [`LONG`](super::convolution::LONG) values stays in the nearest cache.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for column in (0..self.columns).step_by(places::<T, S>()) {
            self.one_vector(simd, column);
        }
    }
}

/// Calls a stage of the radix that there is.
macro_rules! of_radix {
    ($radix:expr, $stage:ident, $($argument:expr),*) => {
        match $radix {
            2 => $stage::<T, S, 2>($($argument),*),
            3 => $stage::<T, S, 3>($($argument),*),
            4 => $stage::<T, S, 4>($($argument),*),
            _ => $stage::<T, S, 5>($($argument),*),
        }
    };
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
        for stage in &plan.middle {
            of_radix!(stage.radix, forward, a, stage, rows);
        }
        let group = plan.bins.len() * GROUP;
        let spectrum = T::vectors::<S>(&spectrum[column / GROUP * group..][..group]);
        let (vectors, vector) = (GROUP / places, column % GROUP / places);
        let factor = inlined(
            #[inline(always)]
            |b: usize, q: usize| {
                let Kept { first, step } = plan.kept[b];
                spectrum[first.wrapping_add_signed(step * q as isize) * vectors + vector]
            },
        );
        of_radix!(plan.last, multiply, a, rows, factor);
        for stage in plan.middle.iter().rev() {
            of_radix!(stage.radix, backwards, a, stage, rows);
        }
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

/// A closure with an attribute, which expressions alone may not have.
#[inline(always)]
fn inlined<F>(closure: F) -> F {
    closure
}

/// Rows of vectors.
#[inline(always)]
fn rows_of<T: Real, S: Simd>(memory: &mut [Complex<T>]) -> &mut [Row<T, S>] {
    let values = parts_mut(memory);
    let whole = values.len() - values.len() % places::<T, S>();
    pulp::as_arrays_mut::<2, _>(T::vectors_mut::<S>(&mut values[..whole])).0
}

#[cfg(test)]
#[path = "../../tests/unit/even_columns.rs"]
mod tests;
