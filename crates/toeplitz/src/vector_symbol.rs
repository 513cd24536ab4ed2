//! The symbol of products of two components: a symmetric matrix `[xx, xy; xy, yy]` of each wave.
//!
//! ```text
//! xx, yy even in both directions, xy odd in both      all real; of the wave -ky: xx, yy, -xy. Half of each column is kept
//! the same, taken n elements further on in x          times exp(2 pi i n kx/px), one complex number for each column ([`Place`])
//! any other coefficients                              complex: whole columns are kept, in the order of the stages
//! ```

use std::f64::consts::PI;

use pulp::Simd;

use crate::block::BLOCK;
use crate::fft::lane_columns::{even_value, At, Blocks, EvenSymbol, Factor, LaneColumns};
use crate::fft::lanes::{lane_count, Arithmetic, Parts, C};
use crate::real::{Complex, Real};
use crate::symbol::{converted, SYMBOL};
use par::memory::{keep, unwritten};
use par::threads::Threads;
use par::Result;

/// The symbol, the normalisation folded in.
pub(crate) struct VectorSymbol<T: Real> {
    /// `[block of columns][plane]`, planes xx, yy and, where both are coupled, xy: even and odd ones `[kept row][column]`, others
    /// `[row][part][column]`.
    pub values: Vec<T>,
    pub planes: usize,
    /// Values of a plane of a block.
    pub of_plane: usize,
    pub is_even: bool,
    /// `[block of columns][part][column]`: what even and odd ones are multiplied by; empty: nothing.
    pub factors: Vec<T>,
}

impl<T: Real> Drop for VectorSymbol<T> {
    fn drop(&mut self) {
        keep([&mut self.values, &mut self.factors]);
    }
}

/// The part of the displacements that a product returns.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// Those so many elements further on in x: `exp(2 pi i n kx/px)`.
    FurtherOn(i64),
    /// Those of each element less those so many elements further on: `1 - exp(2 pi i n kx/px)`.
    LessFurtherOn(i64),
}

/// The factors of the symbol in the bins of each block.
pub(crate) fn factors<T: Real>(place: Place, px: usize, blocks: usize, threads: &Threads) -> Result<Vec<T>> {
    let mut factors = Vec::new();
    unwritten(&mut factors, 2 * BLOCK * blocks, T::nan(), SYMBOL, threads)?;
    let (Place::FurtherOn(n) | Place::LessFurtherOn(n)) = place;
    for (k, factor) in factors.chunks_exact_mut(2 * BLOCK).enumerate() {
        let (re, im) = factor.split_at_mut(BLOCK);
        for ((bin, re), im) in (k * BLOCK..).zip(re).zip(im) {
            let half = PI * ((bin as i64 * n).rem_euclid(px as i64)) as f64 / px as f64;
            let (sine, cosine) = (2.0 * half).sin_cos();
            (*re, *im) = match place {
                Place::FurtherOn(_) => (T::of(cosine), T::of(sine)),
                // 1 - cos(2 x) = 2 sin^2 x.
                Place::LessFurtherOn(_) => (T::of(2.0 * half.sin() * half.sin()), T::of(-sine)),
            };
        }
    }
    Ok(factors)
}

impl<T: Real> VectorSymbol<T> {
    /// The same in another precision.
    pub fn in_precision<S: Real>(&self, threads: &Threads) -> Result<VectorSymbol<S>> {
        let convert = |from: &[T]| converted(from, |value| S::of(value.to_double()), S::nan(), threads);
        let VectorSymbol { planes, of_plane, is_even, .. } = *self;
        let (values, factors) = (convert(&self.values)?, convert(&self.factors)?);
        Ok(VectorSymbol { values, planes, of_plane, is_even, factors })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.factors[..])
    }

    /// Whether a component displaces in its own direction only.
    pub fn is_uncoupled(&self) -> bool {
        self.planes < 3
    }

    fn plane(&self, block: usize, plane: usize) -> &[T] {
        &self.values[(block * self.planes + plane) * self.of_plane..][..self.of_plane]
    }

    /// Multiplies a block of columns of both components, which are coupled.
    pub fn multiply(&self, columns: &LaneColumns<T>, block: usize, of: Blocks<'_, T, 2>, memory: &mut [Complex<T>]) {
        let planes = [0, 1, 2].map(|plane| self.plane(block, plane));
        match self.is_even {
            true => self.multiply_by(columns, block, of, RealMatrix(planes), memory),
            false => columns.multiply_all(of, &ComplexMatrix(planes), memory),
        }
    }

    /// The same of one component alone.
    pub fn multiply_one(
        &self,
        columns: &LaneColumns<T>,
        (block, component): (usize, usize),
        of: Blocks<'_, T, 1>,
        memory: &mut [Complex<T>],
    ) {
        let plane = self.plane(block, component);
        match self.is_even {
            true => self.multiply_by(columns, block, of, EvenSymbol(plane), memory),
            false => columns.multiply_all(of, &ComplexSymbol(plane), memory),
        }
    }

    fn multiply_by<F: Factor<T, K>, const K: usize>(
        &self,
        columns: &LaneColumns<T>,
        block: usize,
        of: Blocks<'_, T, K>,
        factor: F,
        memory: &mut [Complex<T>],
    ) {
        match self.factors.chunks_exact(2 * BLOCK).nth(block) {
            Some(factors) => columns.multiply_all(of, &Displaced { of: factor, factors }, memory),
            None => columns.multiply_all(of, &factor, memory),
        }
    }
}

/// xx, yy and xy of a block of columns, `[kept row][column]`.
struct RealMatrix<'a, T>([&'a [T]; 3]);

impl<T: Real> Factor<T, 2> for RealMatrix<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x, y]: [C<T, S>; 2]) -> [C<T, S>; 2] {
        let [xx, yy, xy] = self.0;
        let (xx, yy, xy) = (even_value::<T, S>(xx, at), even_value::<T, S>(yy, at), even_value::<T, S>(xy, at));
        let (by_x, by_y) = (a.scale(x, xy), a.scale(y, xy));
        let (x, y) = (a.scale(x, xx), a.scale(y, yy));
        // A block that is kept as its mirror image has -xy.
        if at.kept.step > 0 {
            [a.add(x, by_y), a.add(y, by_x)]
        } else {
            [a.sub(x, by_y), a.sub(y, by_x)]
        }
    }
}

/// A symbol, and what its columns are multiplied by, `[part][column]`.
struct Displaced<'a, T, F> {
    of: F,
    factors: &'a [T],
}

impl<T: Real, F: Factor<T, K>, const K: usize> Factor<T, K> for Displaced<'_, T, F> {
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

/// Complex values of a block of columns, `[row][part][column]`.
struct ComplexSymbol<'a, T>(&'a [T]);

impl<T: Real> Factor<T, 1> for ComplexSymbol<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x]: [C<T, S>; 1]) -> [C<T, S>; 1] {
        [a.mul(x, complex_value::<T, S>(self.0, at.row + at.q, at.vector))]
    }
}

/// The same of xx, yy and xy.
struct ComplexMatrix<'a, T>([&'a [T]; 3]);

impl<T: Real> Factor<T, 2> for ComplexMatrix<'_, T> {
    #[inline(always)]
    fn times<S: Simd>(&self, a: Arithmetic<T, S>, at: At<'_>, [x, y]: [C<T, S>; 2]) -> [C<T, S>; 2] {
        let ([xx, yy, xy], row) = (self.0, at.row + at.q);
        let (xx, yy) = (complex_value::<T, S>(xx, row, at.vector), complex_value::<T, S>(yy, row, at.vector));
        let xy = complex_value::<T, S>(xy, row, at.vector);
        [a.add(a.mul(x, xx), a.mul(y, xy)), a.add(a.mul(y, yy), a.mul(x, xy))]
    }
}

/// A vector of columns of a row of complex values, `[row][part][column]`.
#[inline(always)]
fn complex_value<T: Real, S: Simd>(values: &[T], row: usize, vector: usize) -> C<T, S> {
    let per_part = BLOCK / lane_count::<T, S>();
    let row = &T::vectors::<S>(values)[2 * per_part * row..][..2 * per_part];
    Parts { re: row[vector], im: row[per_part + vector] }
}
