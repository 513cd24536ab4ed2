//! The symbol of products of two components: a symmetric matrix `[xx, xy; xy, yy]` for each bin (kx, ky) of the Fourier transform.
//!
//! | coefficients | symbol | stored |
//! |---|---|---|
//! | xx and yy even in both directions, xy odd in both | real; at the bin -ky: xx, yy, -xy | half of each column |
//! | the same, n elements further on in x ([`Place`]) | times `exp(2 pi i n kx/px)` | in addition one complex factor for each column |
//! | any other | complex | whole columns, in the order of the stages |

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

/// The symbol of products of two components, including the normalisation 1/(px py).
pub(crate) struct VectorSymbol<T: Real> {
    /// `[block of columns][plane]`, where the planes are xx, yy and, if the components are coupled, xy. If `is_even`, a plane is
    /// `[kept row][column]`, otherwise `[row][part][column]`.
    pub values: Vec<T>,
    /// The number of planes: 3 if the components are coupled, otherwise 2.
    pub planes: usize,
    /// The number of values of one plane in one block.
    pub values_per_plane: usize,
    /// Whether xx and yy are even and xy is odd: the symbol is real.
    pub is_even: bool,
    /// `[block of columns][part][column]`: complex factors on an even symbol (see [`Place`]). If empty, all factors are 1.
    pub factors: Vec<T>,
}

impl<T: Real> Drop for VectorSymbol<T> {
    fn drop(&mut self) {
        keep([&mut self.values, &mut self.factors]);
    }
}

/// Where in x a product returns displacements, and the factor on its symbol.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// For each element the displacement n elements further on in x. The factor is `exp(2 pi i n kx/px)`.
    FurtherOn(i64),
    /// For each element its displacement minus that n elements further on in x. The factor is `1 - exp(2 pi i n kx/px)`.
    LessFurtherOn(i64),
}

/// Computes the factors of a [`Place`] at all bins kx, `[block of columns][part][column]`.
pub(crate) fn factors<T: Real>(place: Place, px: usize, blocks: usize, threads: &Threads) -> Result<Vec<T>> {
    let mut factors = Vec::new();
    unwritten(&mut factors, 2 * BLOCK * blocks, T::nan(), SYMBOL, threads)?;
    let (Place::FurtherOn(n) | Place::LessFurtherOn(n)) = place;
    for (block, factor) in factors.chunks_exact_mut(2 * BLOCK).enumerate() {
        let (re, im) = factor.split_at_mut(BLOCK);
        for ((bin, re), im) in (block * BLOCK..).zip(re).zip(im) {
            let half_angle = PI * ((bin as i64 * n).rem_euclid(px as i64)) as f64 / px as f64;
            let (sine, cosine) = (2.0 * half_angle).sin_cos();
            (*re, *im) = match place {
                Place::FurtherOn(_) => (T::of(cosine), T::of(sine)),
                // `1 - cos(2 x) = 2 sin^2 x` has no cancellation for small x.
                Place::LessFurtherOn(_) => (T::of(2.0 * half_angle.sin() * half_angle.sin()), T::of(-sine)),
            };
        }
    }
    Ok(factors)
}

impl<T: Real> VectorSymbol<T> {
    /// Converts the symbol to another precision.
    pub fn in_precision<S: Real>(&self, threads: &Threads) -> Result<VectorSymbol<S>> {
        let convert = |from: &[T]| converted(from, |value| S::of(value.to_double()), S::nan(), threads);
        let VectorSymbol { planes, values_per_plane, is_even, .. } = *self;
        let (values, factors) = (convert(&self.values)?, convert(&self.factors)?);
        Ok(VectorSymbol { values, planes, values_per_plane, is_even, factors })
    }

    /// The bytes of the symbol's values and factors.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.factors[..])
    }

    /// Whether xy is 0: each component of q causes displacements in its own direction only.
    pub fn is_uncoupled(&self) -> bool {
        self.planes < 3
    }

    /// The values of xx (plane 0), yy (1) or xy (2) in a block of columns.
    fn plane(&self, block: usize, plane: usize) -> &[T] {
        &self.values[(block * self.planes + plane) * self.values_per_plane..][..self.values_per_plane]
    }

    /// Transforms a block of columns of two coupled components in y, multiplies it by the symbol and transforms it back.
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
                let factor = &Displaced { symbol: RealMatrix(planes), factors };
                T::by_matrix_displaced(*arch, Multiply { plan, blocks, factor, memory });
            }
            (false, _) => {
                T::by_complex_matrix(*arch, Multiply { plan, blocks, factor: &ComplexMatrix(planes), memory });
            }
        }
    }

    /// Transforms a block of columns of one component in y, multiplies it by xx or yy and transforms it back.
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
                let factor = &Displaced { symbol: EvenSymbol(plane), factors };
                T::by_even_displaced(*arch, Multiply { plan, blocks, factor, memory });
            }
            (false, _) => T::by_complex(*arch, Multiply { plan, blocks, factor: &ComplexSymbol(plane), memory }),
        }
    }

    /// The factors on the columns of a block; None if all factors are 1.
    fn factors_of(&self, block: usize) -> Option<&[T]> {
        self.factors.chunks_exact(2 * BLOCK).nth(block)
    }
}
