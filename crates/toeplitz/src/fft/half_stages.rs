//! Stages of radix 4 of which half of the rows are zero, or are not wanted: the outermost ones of a transform that is padded.
#![allow(clippy::needless_range_loop)] // as in `stages`

use pulp::Simd;

use crate::fft::lanes::{Arithmetic, Parts, C};
use crate::fft::stages::{cut, get, put, Row, Stage};
use crate::real::Real;

impl<T: Real> Stage<T> {
    /// Whether the functions here do its work where the rows from `rows` on are zero, or not wanted.
    pub fn is_of_half(&self, rows: usize) -> bool {
        self.radix == 4 && rows <= 2 * self.stride()
    }
}

/// Values q = 0 .. 3 of the first stage forward, of radix 4, where the second half of the rows is zero.
#[inline(always)]
fn of_half<T: Real, S: Simd>(a: Arithmetic<T, S>, stage: &Stage<T>, j: usize, [x, next]: [C<T, S>; 2]) -> [C<T, S>; 4] {
    let w = &stage.twiddles[j * 3..][..3];
    [a.add(x, next), a.turn(a.sub_i(x, next), w[0]), a.turn(a.sub(x, next), w[1]), a.turn(a.add_i(x, next), w[2])]
}

/// Rows k = 0, 1 of the last stage backwards, of radix 4, where the second half of the rows is not wanted.
#[inline(always)]
fn to_half<T: Real, S: Simd>(a: Arithmetic<T, S>, stage: &Stage<T>, j: usize, x: [C<T, S>; 4]) -> [C<T, S>; 2] {
    let w = &stage.twiddles[j * 3..][..3];
    let (first, second, third) = (a.turn(x[1], w[0]), a.turn(x[2], w[1]), a.turn(x[3], w[2]));
    [a.add(a.add(x[0], second), a.add(first, third)), a.sub_i(a.sub(x[0], second), a.sub(first, third))]
}

/// The first stage forward, of radix 4, where the second half of the rows is zero: it is not read.
#[inline(always)]
pub(crate) fn forward_of_half<T: Real, S: Simd>(a: Arithmetic<T, S>, stage: &Stage<T>, rows: &mut [Row<T, S>]) {
    let rows = cut::<_, 4>(rows, stage.stride());
    for j in 0..stage.stride() {
        let given = [get::<T, S>(&rows[0][j]), get::<T, S>(&rows[1][j])];
        let values = of_half(a, stage, j, given);
        for q in 0..4 {
            put::<T, S>(&mut rows[q][j], values[q]);
        }
    }
}

/// The same, of rows that `load(row)` gives.
#[inline(always)]
pub(crate) fn first_of_half<T: Real, S: Simd>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
    load: impl Fn(usize) -> C<T, S>,
) {
    let m = stage.stride();
    let rows = cut::<_, 4>(rows, m);
    for j in 0..m {
        let values = of_half(a, stage, j, [load(j), load(j + m)]);
        for q in 0..4 {
            put::<T, S>(&mut rows[q][j], values[q]);
        }
    }
}

/// The last stage backwards, of radix 4, where the second half of the rows is not wanted: it is not written.
#[inline(always)]
pub(crate) fn backwards_to_half<T: Real, S: Simd>(a: Arithmetic<T, S>, stage: &Stage<T>, rows: &mut [Row<T, S>]) {
    let rows = cut::<_, 4>(rows, stage.stride());
    for j in 0..stage.stride() {
        let mut x = [get::<T, S>(&rows[0][j]); 4];
        for q in 1..4 {
            x[q] = get::<T, S>(&rows[q][j]);
        }
        let values = to_half(a, stage, j, x);
        for k in 0..2 {
            put::<T, S>(&mut rows[k][j], values[k]);
        }
    }
}

/// The same, to `store(row, value)`.
#[inline(always)]
pub(crate) fn last_to_half<T: Real, S: Simd>(
    a: Arithmetic<T, S>,
    stage: &Stage<T>,
    rows: &mut [Row<T, S>],
    mut store: impl FnMut(usize, C<T, S>),
) {
    let m = stage.stride();
    let rows = cut::<_, 4>(rows, m);
    for j in 0..m {
        let mut x = [get::<T, S>(&rows[0][j]); 4];
        for q in 1..4 {
            x[q] = get::<T, S>(&rows[q][j]);
        }
        let values = to_half(a, stage, j, x);
        for k in 0..2 {
            store(j + k * m, Parts { re: values[k].im, im: values[k].re });
        }
    }
}
