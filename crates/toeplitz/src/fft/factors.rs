//! The symbols by which a block of columns is multiplied, other than an even one of one component.

use pulp::Simd;

use crate::block::BLOCK;
use crate::fft::column_pass::{even_value, At, Factor};
use crate::fft::lanes::{lane_count, Arithmetic, Parts, C};
use crate::real::Scalar;

/// xx, yy and xy of a block of columns, `[kept row][column]`.
pub struct RealMatrix<'a, T>(pub [&'a [T]; 3]);

impl<T: Scalar> Factor<T, 2> for RealMatrix<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x, y]: [C<T, S>; 2]) -> [C<T, S>; 2] {
        let [xx, yy, xy] = self.0;
        let (xx, yy, xy) = (even_value::<T, S>(xx, at), even_value::<T, S>(yy, at), even_value::<T, S>(xy, at));
        let (by_x, by_y) = (a.scale(x, xy), a.scale(y, xy));
        let (x, y) = (a.scale(x, xx), a.scale(y, yy));
        // Mirror images of kept blocks have -xy.
        if at.kept.step > 0 {
            [a.add(x, by_y), a.add(y, by_x)]
        } else {
            [a.sub(x, by_y), a.sub(y, by_x)]
        }
    }
}

/// A symbol, and a complex factor for each of its columns: `[real or imaginary part][column]`.
pub struct Displaced<'a, T, F> {
    pub of: F,
    pub factors: &'a [T],
}

impl<T: Scalar, F: Factor<T, K>, const K: usize> Factor<T, K> for Displaced<'_, T, F> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, x: [C<T, S>; K]) -> [C<T, S>; K] {
        let by = complex_value::<T, S>(self.factors, 0, at.vector);
        let mut values = self.of.times(a, at, x);
        for value in &mut values {
            *value = a.mul(*value, by);
        }
        values
    }
}

/// Complex values of a block of columns, `[row][real or imaginary part][column]`.
pub struct ComplexSymbol<'a, T>(pub &'a [T]);

impl<T: Scalar> Factor<T, 1> for ComplexSymbol<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x]: [C<T, S>; 1]) -> [C<T, S>; 1] {
        [a.mul(x, complex_value::<T, S>(self.0, at.row + at.q, at.vector))]
    }
}

/// Complex values of xx, yy and xy of a block of columns.
pub struct ComplexMatrix<'a, T>(pub [&'a [T]; 3]);

impl<T: Scalar> Factor<T, 2> for ComplexMatrix<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x, y]: [C<T, S>; 2]) -> [C<T, S>; 2] {
        let ([xx, yy, xy], row) = (self.0, at.row + at.q);
        let (xx, yy) = (complex_value::<T, S>(xx, row, at.vector), complex_value::<T, S>(yy, row, at.vector));
        let xy = complex_value::<T, S>(xy, row, at.vector);
        [a.add(a.mul(x, xx), a.mul(y, xy)), a.add(a.mul(y, yy), a.mul(x, xy))]
    }
}

/// Vector number `vector` of the columns in a row of complex values, `[row][real or imaginary part][column]`.
#[inline(always)]
fn complex_value<T: Scalar, S: Simd>(values: &[T], row: usize, vector: usize) -> C<T, S> {
    let per_part = BLOCK / lane_count::<T, S>();
    let row = &T::vectors::<S>(values)[2 * per_part * row..][..2 * per_part];
    Parts { re: row[vector], im: row[per_part + vector] }
}
