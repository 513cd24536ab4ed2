//! The y direction of a spectrum of even coefficients, as vectors of columns: two of them share a complex transform, one as its real
//! and one as its imaginary part, and the stages leave bins in the order in which products want them.

use pulp::{Simd, WithSimd};

use super::columns::BLOCK;
use super::even_plan::EvenPlan;
use super::fft::{Complex, Real};
use super::lanes::{places, Arithmetic, Lanes, Parts, C};
use super::stages::{end, first, forward, inlined, of_radix, rows_of};

/// Of what is transformed.
type T = f64;

/// The spectrum of one block of columns, in double precision, kept in another.
pub(super) struct SpectrumOfBlock<'a, O, G> {
    pub(super) plan: &'a EvenPlan<f64>,
    /// Coefficients transformed in x, of this block on: rows at offsets ky >= 0, and values from one row to the next.
    pub(super) in_x: &'a [f64],
    pub(super) rows: usize,
    pub(super) width: usize,
    /// Columns that mean something, and what is kept of each value of these; zero of others.
    pub(super) columns: usize,
    pub(super) value: G,
    /// `[kept row][column]`.
    pub(super) out: &'a mut [O],
    pub(super) memory: &'a mut [Complex<f64>],
}

impl<O: Real, G: Fn(f64) -> f64> WithSimd for SpectrumOfBlock<'_, O, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SpectrumOfBlock { plan, in_x, rows: given, width, columns, value, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<T, S>::new(simd), places::<T, S>(), &plan.stages);
        let length = stages.length();
        let rows = &mut rows_of::<T, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        for column in (0..BLOCK).step_by(2 * n) {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<T, S> {
                    // Offset -ky stands at py - ky.
                    let ky = row.min(length - row);
                    if ky >= given {
                        return zero;
                    }
                    let values = T::vectors::<S>(&in_x[ky * width + column..][..2 * n]);
                    Parts { re: values[0], im: values[1] }
                },
            );
            of_radix!(stages.first.radix, first, a, &stages.first, rows, load);
            let (wide, near) = stages.middle.split_at(stages.wide);
            for stage in wide {
                of_radix!(stage.radix, forward, a, stage, rows);
            }
            for rows in rows.chunks_exact_mut(stages.part) {
                for stage in near {
                    of_radix!(stage.radix, forward, a, stage, rows);
                }
                of_radix!(stages.last, end, a, rows);
            }
            for (rows, kept) in rows.chunks_exact(stages.last).zip(&plan.kept).filter(|(_, kept)| kept.step > 0) {
                for (q, row) in rows.iter().enumerate() {
                    let values: &[f64] = pulp::bytemuck::cast_slice(row);
                    let out = &mut out[(kept.first + q) * BLOCK + column..][..2 * n];
                    let (there, beyond) = out.split_at_mut(columns.saturating_sub(column).min(2 * n));
                    there.iter_mut().zip(values).for_each(|(out, bin)| *out = O::of(value(*bin)));
                    beyond.fill(O::zero());
                }
            }
        }
    }
}
