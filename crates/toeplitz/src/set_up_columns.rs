//! Columns in the computation of a symbol: gathers them from a matrix of rows, and converts them to the precision of products.

use std::ops::Range;

use crate::block::BLOCK;
use crate::coefficients::Parity;
use crate::passes::Real;
use crate::real::Complex;

/// The number of columns that are gathered at a time: complex columns, or pairs of real ones. They are whole cache lines of each row.
pub(crate) const PAIRS: usize = BLOCK / 2;

/// Writes a column times a factor to `out`, in another precision. pulp compiles the loop for the vectors of this machine.
pub(crate) struct Scaled<'a, T> {
    pub(crate) column: &'a [Complex<f64>],
    pub(crate) scale: f64,
    pub(crate) out: &'a mut [Complex<T>],
}

impl<T: Real> pulp::NullaryFnOnce for Scaled<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Scaled { column, scale, out } = self;
        for (value, bin) in out.iter_mut().zip(column) {
            *value = Complex::new(T::of(scale * bin.re), T::of(scale * bin.im));
        }
    }
}

/// Writes the real and the imaginary parts of a column, times a factor, to `re` and `im`, in another precision. pulp compiles the loop for the
/// vectors of this machine.
pub(crate) struct Parts<'a, T> {
    pub(crate) column: &'a [Complex<f64>],
    pub(crate) scale: f64,
    pub(crate) re: &'a mut [T],
    pub(crate) im: &'a mut [T],
}

impl<T: Real> pulp::NullaryFnOnce for Parts<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Parts { column, scale, re, im } = self;
        for ((bin, re), im) in column.iter().zip(re).zip(im) {
            (*re, *im) = (T::of(scale * bin.re), T::of(scale * bin.im));
        }
    }
}

/// Copies a part of a matrix to a block of columns. The matrix is given with its width `nb`, the block with the length `py` of its columns. The part
/// has the rows `rows`, and as many columns as the block, from column `first` on. Row `rows.start` of the matrix becomes row `to` of the block.
pub(crate) fn gather<V: Copy>(
    matrix: (&[V], usize),
    rows: Range<usize>,
    first: usize,
    (block, py): (&mut [V], usize),
    to: usize,
) {
    // With a constant number of columns the compiler unrolls the loop over them.
    match block.len() / py {
        PAIRS => copy_columns(matrix, rows, (first, PAIRS), (block, py), to),
        count => copy_columns(matrix, rows, (first, count), (block, py), to),
    }
}

/// [`gather`] of `count` columns.
#[inline(always)]
fn copy_columns<V: Copy>(
    (matrix, nb): (&[V], usize),
    rows: Range<usize>,
    (first, count): (usize, usize),
    (block, py): (&mut [V], usize),
    to: usize,
) {
    for (row, y) in rows.zip(to..) {
        let row = &matrix[row * nb + first..][..count];
        for c in 0..count {
            block[c * py + y] = row[c];
        }
    }
}

/// Fills a row of one period with even or odd coefficients at the offset ky. `fill` gives those at the offsets kx = 0 .. `given`; the mirrored ones
/// at -kx follow from the parity, and all others are 0.
pub(crate) fn fill_period(ky: i64, given: usize, row: &mut [f64], parity: Parity, fill: impl Fn(i64, &mut [f64])) {
    let px = row.len();
    row.fill(0.0);
    fill(ky, &mut row[..given]);
    for kx in 1..given {
        row[px - kx] = match parity {
            Parity::Even => row[kx],
            Parity::Odd => -row[kx],
        };
    }
}

/// Fills each column of a block with a pair of neighbouring columns of a matrix, from column `first` on.
///
/// The matrix is given with its width `nb`; it has `rows` rows, ky = 0 .. `rows`. The block is given with the length `py` of its columns. If a pair
/// has the values a and b in row ky, `values(a, b)` returns the values of the block in the rows ky and -ky. Other rows of the block are 0. If the
/// number of columns is odd, the last one is paired with itself.
pub(crate) fn fill_pairs<V: Copy>(
    matrix: (&[V], usize),
    rows: usize,
    first: usize,
    (block, py): (&mut [Complex<f64>], usize),
    values: impl Fn(V, V) -> [Complex<f64>; 2],
) {
    for column in block.chunks_exact_mut(py) {
        column[rows..(py + 1 - rows).max(rows)].fill(Complex::default());
    }
    match (block.len() / py, (matrix.1 - first).min(2 * PAIRS)) {
        (PAIRS, count) if count == 2 * PAIRS => join_columns(matrix, rows, (first, 2 * PAIRS), (block, py), values),
        (_, count) => join_columns(matrix, rows, (first, count), (block, py), values),
    }
}

/// The part of [`fill_pairs`] that writes the rows ky and -ky, from `count` columns of the matrix.
#[inline(always)]
fn join_columns<V: Copy>(
    (matrix, nb): (&[V], usize),
    rows: usize,
    (first, count): (usize, usize),
    (block, py): (&mut [Complex<f64>], usize),
    values: impl Fn(V, V) -> [Complex<f64>; 2],
) {
    for ky in 0..rows {
        let (row, mirrored_ky) = (&matrix[ky * nb + first..][..count], if ky == 0 { 0 } else { py - ky });
        for pair in 0..count.div_ceil(2) {
            let [value, mirrored_value] = values(row[2 * pair], row[(2 * pair + 1).min(count - 1)]);
            // At ky = 0 both rows are the same one, which keeps `value`.
            block[pair * py + mirrored_ky] = mirrored_value;
            block[pair * py + ky] = value;
        }
    }
}
