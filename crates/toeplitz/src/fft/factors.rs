//! The kinds of symbols that multiply a block of columns, except the even symbol of one component
//! ([`EvenSymbol`](crate::fft::column_pass::EvenSymbol)).

use pulp::Simd;

use crate::block::BLOCK;
use crate::fft::column_pass::{even_value, At, Factor};
use crate::fft::lanes::{lane_count, Arithmetic, Parts, C};
use crate::real::Scalar;

/// The real symbol of two components: xx, yy and xy in a block of columns, each `[kept row][column]`.
pub struct RealMatrix<'a, T>(pub [&'a [T]; 3]);

impl<T: Scalar> Factor<T, 2> for RealMatrix<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x, y]: [C<T, S>; 2]) -> [C<T, S>; 2] {
        let [xx, yy, xy] = self.0;
        let (xx, yy, xy) = (even_value::<T, S>(xx, at), even_value::<T, S>(yy, at), even_value::<T, S>(xy, at));
        let (by_x, by_y) = (a.scale(x, xy), a.scale(y, xy));
        let (x, y) = (a.scale(x, xx), a.scale(y, yy));
        // xy is odd: the mirror image of a kept block has -xy.
        if at.kept.step > 0 {
            [a.add(x, by_y), a.add(y, by_x)]
        } else {
            [a.sub(x, by_y), a.sub(y, by_x)]
        }
    }
}

/// A symbol times a complex factor for each column, for displacements further on in x.
pub struct Displaced<'a, T, F> {
    /// The symbol.
    pub symbol: F,
    /// The factors, `[real or imaginary part][column]`.
    pub factors: &'a [T],
}

impl<T: Scalar, F: Factor<T, K>, const K: usize> Factor<T, K> for Displaced<'_, T, F> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, x: [C<T, S>; K]) -> [C<T, S>; K] {
        let factor = complex_value::<T, S>(self.factors, 0, at.vector);
        let mut values = self.symbol.times(a, at, x);
        for value in &mut values {
            *value = a.mul(*value, factor);
        }
        values
    }
}

/// The complex symbol of one component in a block of columns, `[row][real or imaginary part][column]`.
pub struct ComplexSymbol<'a, T>(pub &'a [T]);

impl<T: Scalar> Factor<T, 1> for ComplexSymbol<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x]: [C<T, S>; 1]) -> [C<T, S>; 1] {
        [a.mul(x, complex_value::<T, S>(self.0, at.row + at.q, at.vector))]
    }
}

/// The complex symbol of two components: xx, yy and xy in a block of columns, each `[row][real or imaginary part][column]`.
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

/// The complex values `[row][real or imaginary part][column]` in one row, for vector number `vector` of the columns.
#[inline(always)]
fn complex_value<T: Scalar, S: Simd>(values: &[T], row: usize, vector: usize) -> C<T, S> {
    let per_part = BLOCK / lane_count::<T, S>();
    let row = &T::vectors::<S>(values)[2 * per_part * row..][..2 * per_part];
    Parts { re: row[vector], im: row[per_part + vector] }
}
