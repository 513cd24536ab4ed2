//! The stages of the transforms of several columns at a time, one in each SIMD lane (Cooley and Tukey 1965). Real rows are transformed likewise, one
//! in each lane. Here a row is one complex value of all these columns.
//!
//! A stage of radix R cuts a transform of `n = R m` rows into R transforms of m rows, with `w = exp(-2 pi i/n)`:
//!
//! ```text
//! forward     x_(j + q m) <- w^(q j) sum_k x_(j + k m) exp(-2 pi i q k/R)      bins q, q + R, q + 2 R .. are now in rows q m .. (q + 1) m
//! backwards   x_(j + k m) <- sum_q w^(q j) x_(j + q m) exp(-2 pi i q k/R)
//! ```
//!
//! Transforms are in place, and the bins stay in the order in which the stages write them. The stages backwards take values in this order and
//! leave bins in natural order. They apply the same transform, not its inverse. For the inverse, real and imaginary parts are swapped before and
//! after it.
//!
//! Loops use indices of slices that have one length; iterators take 3 to 7 % longer.
#![allow(clippy::needless_range_loop)]

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use crate::block::{parts_mut, LINE};
use crate::fft::butterflies::butterfly;
use crate::fft::lanes::{lane_count, Arithmetic, Lanes, Parts, C};
use crate::lengths::LONGEST;
use crate::real::{Complex, Scalar};

/// One row of a vector of columns: the vector of real parts, and that of imaginary parts.
pub(crate) type Row<T, S> = [<T as Lanes>::Vector<S>; 2];

/// A stage of radix R.
pub(crate) struct Stage<T: Scalar> {
    /// R.
    pub radix: usize,
    /// `w^(q j)`, as `[j][q]` with j = 0 .. m and q = 1 .. R.
    pub twiddles: Vec<Complex<T>>,
}

impl<T: Scalar> Stage<T> {
    /// The stride m: the number of rows of each of the R transforms.
    pub fn stride(&self) -> usize {
        self.twiddles.len() / (self.radix - 1)
    }
}

/// The largest number of complex values before the first start of a cache line in memory.
pub(crate) const fn before_a_line<T>() -> usize {
    LINE / size_of::<Complex<T>>() - 1
}

/// The part of memory from its first start of a cache line on. Access to a vector of 64 bytes that straddles two lines takes twice as long.
#[inline(always)]
pub(crate) fn from_a_line<T>(memory: &mut [Complex<T>]) -> &mut [Complex<T>] {
    let before = memory.as_ptr().align_offset(LINE).min(before_a_line::<T>());
    &mut memory[before..]
}

/// Memory as rows of vectors, from its first start of a cache line on.
#[inline(always)]
pub(crate) fn rows_of<T: Scalar, S: Simd>(memory: &mut [Complex<T>]) -> &mut [Row<T, S>] {
    let values = parts_mut(from_a_line(memory));
    let whole = values.len() - values.len() % lane_count::<T, S>();
    pulp::as_arrays_mut::<2, _>(T::vectors_mut::<S>(&mut values[..whole])).0
}

/// Returns its argument. A closure that is an argument may have the attribute `inline(always)`; one that is assigned may not.
#[inline(always)]
pub(crate) fn inlined<F>(closure: F) -> F {
    closure
}

/// The bytes of a row of vectors on this machine.
pub(crate) fn bytes_of_a_row<T: Scalar>() -> usize {
    pulp::Arch::new().dispatch(BytesOfARow::<T>(PhantomData))
}

/// The work of [`bytes_of_a_row`], which needs the machine's instruction set.
struct BytesOfARow<T>(PhantomData<T>);

impl<T: Scalar> WithSimd for BytesOfARow<T> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        size_of::<Row<T, S>>()
    }
}

/// Calls a stage with its radix as a constant.
macro_rules! of_radix {
    ($radix:expr, $stage:ident of $k:ident, $($argument:expr),*) => {
        match $radix {
            2 => $stage::<_, S, 2, $k>($($argument),*),
            3 => $stage::<_, S, 3, $k>($($argument),*),
            4 => $stage::<_, S, 4, $k>($($argument),*),
            _ => $stage::<_, S, 5, $k>($($argument),*),
        }
    };
    ($radix:expr, $stage:ident, $($argument:expr),*) => {
        match $radix {
            2 => $stage::<_, S, 2>($($argument),*),
            3 => $stage::<_, S, 3>($($argument),*),
            4 => $stage::<_, S, 4>($($argument),*),
            _ => $stage::<_, S, 5>($($argument),*),
        }
    };
}
pub(crate) use of_radix;

/// A row as a vector of complex numbers.
#[inline(always)]
pub(crate) fn get<T: Scalar, S: Simd>(row: &Row<T, S>) -> C<T, S> {
    Parts { re: row[0], im: row[1] }
}

/// Writes a vector of complex numbers to a row.
#[inline(always)]
pub(crate) fn put<T: Scalar, S: Simd>(row: &mut Row<T, S>, value: C<T, S>) {
    (row[0], row[1]) = (value.re, value.im);
}

/// Cuts `R m` rows into R parts of m rows. The other parts of the result are empty.
#[inline(always)]
pub(crate) fn cut<A, const R: usize>(rows: &mut [A], m: usize) -> [&mut [A]; LONGEST] {
    let mut cut: [&mut [A]; LONGEST] = [&mut [], &mut [], &mut [], &mut [], &mut []];
    let mut rest = &mut rows[..R * m];
    for k in 0..R {
        let (part, behind) = rest.split_at_mut(m);
        (cut[k], rest) = (&mut part[..m], behind);
    }
    cut
}

/// Applies the first stage forward to rows that `load(row)` returns, and writes the result to `rows`.
#[inline(always)]
pub(crate) fn first<T: Scalar, S: Simd, const R: usize>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
    load: impl Fn(usize) -> C<T, S>,
) {
    let m = stage.stride();
    let rows = cut::<_, R>(rows, m);
    for j in 0..m {
        let w = &stage.twiddles[j * (R - 1)..][..R - 1];
        let mut x = [load(j); LONGEST];
        for k in 1..R {
            x[k] = load(j + k * m);
        }
        butterfly::<T, S, R>(a, &mut x);
        put::<T, S>(&mut rows[0][j], x[0]);
        for q in 1..R {
            put::<T, S>(&mut rows[q][j], a.twiddle(x[q], w[q - 1]));
        }
    }
}

/// Applies a stage forward to each `R m` rows, in place.
#[inline(always)]
pub(crate) fn forward<T: Scalar, S: Simd, const R: usize>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
) {
    let m = stage.stride();
    for rows in rows.chunks_exact_mut(R * m) {
        let rows = cut::<_, R>(rows, m);
        for j in 0..m {
            let w = &stage.twiddles[j * (R - 1)..][..R - 1];
            let mut x = [get::<T, S>(&rows[0][j]); LONGEST];
            for k in 1..R {
                x[k] = get::<T, S>(&rows[k][j]);
            }
            butterfly::<T, S, R>(a, &mut x);
            put::<T, S>(&mut rows[0][j], x[0]);
            for q in 1..R {
                put::<T, S>(&mut rows[q][j], a.twiddle(x[q], w[q - 1]));
            }
        }
    }
}

/// Applies the last stage forward to K components, multiplies the bins by a symbol, and applies the same stage backwards, all for one block of R rows
/// after the other. `product(b, q, values)` returns the products of the values of all components in row q of block b. Between both stages real and
/// imaginary parts are swapped, because the inverse transform follows.
#[inline(always)]
pub(crate) fn multiply<T: Scalar, S: Simd, const R: usize, const K: usize>(
    a: Arithmetic<T, S>,
    components: [&mut [Row<T, S>]; K],
    product: impl Fn(usize, usize, [C<T, S>; K]) -> [C<T, S>; K],
) {
    for b in 0..components[0].len() / R {
        let mut x = [[get::<T, S>(&components[0][b * R]); LONGEST]; K];
        for component in 0..K {
            let rows = &components[component][b * R..][..R];
            for k in 0..R {
                x[component][k] = get::<T, S>(&rows[k]);
            }
            butterfly::<T, S, R>(a, &mut x[component]);
        }
        for q in 0..R {
            let mut values = [x[0][q]; K];
            for component in 1..K {
                values[component] = x[component][q];
            }
            let y = product(b, q, values);
            for component in 0..K {
                x[component][q] = Parts { re: y[component].im, im: y[component].re };
            }
        }
        for component in 0..K {
            let rows = &mut components[component][b * R..][..R];
            butterfly::<T, S, R>(a, &mut x[component]);
            for k in 0..R {
                put::<T, S>(&mut rows[k], x[component][k]);
            }
        }
    }
}

/// Applies the last stage forward to each R rows, in place. It has no twiddles, so it is also the first stage backwards.
#[inline(always)]
pub(crate) fn end<T: Scalar, S: Simd, const R: usize>(a: Arithmetic<T, S>, rows: &mut [Row<T, S>]) {
    for rows in rows.chunks_exact_mut(R) {
        let mut x = [get::<T, S>(&rows[0]); LONGEST];
        for k in 1..R {
            x[k] = get::<T, S>(&rows[k]);
        }
        butterfly::<T, S, R>(a, &mut x);
        for k in 0..R {
            put::<T, S>(&mut rows[k], x[k]);
        }
    }
}

/// The rows j, j + m, j + 2 m, ... of a stage backwards. `rows` has the R parts of m rows.
#[inline(always)]
fn column_backwards<T: Scalar, S: Simd, const R: usize>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &[&mut [Row<T, S>]; LONGEST],
    j: usize,
) -> [C<T, S>; LONGEST] {
    let w = &stage.twiddles[j * (R - 1)..][..R - 1];
    let mut x = [get::<T, S>(&rows[0][j]); LONGEST];
    for q in 1..R {
        x[q] = a.twiddle(get::<T, S>(&rows[q][j]), w[q - 1]);
    }
    butterfly::<T, S, R>(a, &mut x);
    x
}

/// Applies a stage backwards to each `R m` rows, in place.
#[inline(always)]
pub(crate) fn backwards<T: Scalar, S: Simd, const R: usize>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
) {
    let m = stage.stride();
    for rows in rows.chunks_exact_mut(R * m) {
        let rows = cut::<_, R>(rows, m);
        for j in 0..m {
            let x = column_backwards::<T, S, R>(a, stage, &rows, j);
            for k in 0..R {
                put::<T, S>(&mut rows[k][j], x[k]);
            }
        }
    }
}

/// Applies the last stage backwards, whose radix is that of the first stage forward. Swaps real and imaginary parts, and calls `store(row, value)`
/// with the results.
#[inline(always)]
pub(crate) fn last<T: Scalar, S: Simd, const R: usize>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
    mut store: impl FnMut(usize, C<T, S>),
) {
    let m = stage.stride();
    let rows = cut::<_, R>(rows, m);
    for j in 0..m {
        let x = column_backwards::<T, S, R>(a, stage, &rows, j);
        for k in 0..R {
            store(j + k * m, Parts { re: x[k].im, im: x[k].re });
        }
    }
}
