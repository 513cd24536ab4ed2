//! The symbol of products of two components: a symmetric matrix `[xx, xy; xy, yy]` of each wave.
//!
//! ```text
//! xx, yy even in both directions, xy odd in both      all real; for the wave -ky: xx, yy, -xy. Half of each column is kept
//! the same, n elements further on in x                times exp(2 pi i n kx/px), one complex number for each column ([`Place`])
//! any other coefficients                              complex: whole columns are kept, in the order of the stages
//! ```

use std::f64::consts::PI;

use crate::block::BLOCK;
use crate::fft::column_pass::{Blocks, EvenSymbol, Multiply};
use crate::fft::factors::{ComplexMatrix, ComplexSymbol, Displaced, RealMatrix};
use crate::fft::lane_columns::LaneColumns;
use crate::passes::Real;
use crate::real::Complex;
use crate::symbol::{converted, SYMBOL};
use par::memory::{keep, unwritten};
use par::threads::Threads;
use par::Result;

/// The symbol, with the normalisation.
pub(crate) struct VectorSymbol<T: Real> {
    /// `[block of columns][plane]`, planes xx, yy and, if coupled, xy: even and odd ones `[kept row][column]`, others `[row][part][column]`.
    pub values: Vec<T>,
    pub planes: usize,
    /// Values of a plane of a block.
    pub of_plane: usize,
    pub is_even: bool,
    /// `[block of columns][part][column]`: factors on even and odd planes; empty: none.
    pub factors: Vec<T>,
}

impl<T: Real> Drop for VectorSymbol<T> {
    fn drop(&mut self) {
        keep([&mut self.values, &mut self.factors]);
    }
}

/// The displacements that a product returns.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// Displacements n elements further on in x: `exp(2 pi i n kx/px)`.
    FurtherOn(i64),
    /// Displacements of each element less those n elements further on: `1 - exp(2 pi i n kx/px)`.
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
    /// The symbol in another precision.
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

    /// Multiplies a block of columns of both coupled components.
    pub fn multiply(
        &self,
        LaneColumns { plan, arch }: &LaneColumns<T>,
        block: usize,
        blocks: Blocks<'_, T, 2>,
        memory: &mut [Complex<T>],
    ) {
        let planes = [0, 1, 2].map(|plane| self.plane(block, plane));
        match (self.is_even, self.factors_of(block)) {
            (true, None) => T::by_matrix(*arch, Multiply { plan, blocks, factor: &RealMatrix(planes), memory }),
            (true, Some(factors)) => {
                let factor = &Displaced { of: RealMatrix(planes), factors };
                T::by_matrix_displaced(*arch, Multiply { plan, blocks, factor, memory });
            }
            (false, _) => {
                T::by_complex_matrix(*arch, Multiply { plan, blocks, factor: &ComplexMatrix(planes), memory });
            }
        }
    }

    /// Multiplies a block of columns of one component.
    pub fn multiply_one(
        &self,
        LaneColumns { plan, arch }: &LaneColumns<T>,
        (block, component): (usize, usize),
        blocks: Blocks<'_, T, 1>,
        memory: &mut [Complex<T>],
    ) {
        let plane = self.plane(block, component);
        match (self.is_even, self.factors_of(block)) {
            (true, None) => T::by_even(*arch, Multiply { plan, blocks, factor: &EvenSymbol(plane), memory }),
            (true, Some(factors)) => {
                let factor = &Displaced { of: EvenSymbol(plane), factors };
                T::by_even_displaced(*arch, Multiply { plan, blocks, factor, memory });
            }
            (false, _) => T::by_complex(*arch, Multiply { plan, blocks, factor: &ComplexSymbol(plane), memory }),
        }
    }

    /// The factors of the columns of a block, if they are displaced.
    fn factors_of(&self, block: usize) -> Option<&[T]> {
        self.factors.chunks_exact(2 * BLOCK).nth(block)
    }
}
