//! How the symbol of even coefficients is computed where products go through stages of our own: rows and columns in lanes.
//! The stages leave bins in the order in which products want them.
//!
//! Columns c and c + 8 of a block share a complex transform, one as its real and one as its imaginary part: so no bit depends on the length of
//! vectors.

use std::sync::Arc;

use pulp::{Simd, WithSimd};

use crate::block::{blocks_of, parts, parts_mut, Block, BLOCK};
use crate::coefficients::Even;
use crate::fft::even_plan::EvenPlan;
use crate::fft::lane_rows::LaneRows;
use crate::fft::lanes::{lane_count, Arithmetic, Lanes, Parts, C};
use crate::fft::stages::{before_a_line, first, inlined, of_radix, rows_of};
use crate::real::{Complex, Real};
use crate::set_up::{SetUp, COEFFICIENTS};
use crate::set_up_columns::fill_even;
use crate::symbol::{EvenOrder, SYMBOL};
use par::memory::unwritten;
use par::threads::Threads;
use par::Result;

/// Columns that are the real parts of a block's transforms.
const HALF: usize = BLOCK / 2;
/// Complex numbers in whose memory the real values of a row of a block stand.
const PLACE: usize = BLOCK / 2;

/// The transforms of both directions, and who does them.
pub(crate) struct LaneTransforms<'a> {
    rows: LaneRows<f64>,
    plan: Arc<EvenPlan<f64>>,
    px: usize,
    arch: pulp::Arch,
    threads: &'a Threads,
}

impl<'a> LaneTransforms<'a> {
    /// Of a period; None where this has no plan, or the machine no vectors.
    pub fn new(period: (usize, usize), threads: &'a Threads) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::on(pulp::Arch::new(), period, threads)
    }

    /// With the vectors of these instructions; no bit depends on them.
    fn on(arch: pulp::Arch, (px, py): (usize, usize), threads: &'a Threads) -> Result<Option<LaneTransforms<'a>>> {
        let both = LaneRows::on(arch, px)?.zip(EvenPlan::shared(py)?);
        Ok(both.map(|(rows, plan)| LaneTransforms { rows, plan, px, arch, threads }))
    }

    /// The symbol of even coefficients.
    pub fn of_even<T: Real, F, G>(
        &self,
        even: &Even<F, G>,
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        order: EvenOrder<'_, T>,
        symbol: &mut Vec<T>,
    ) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let LaneTransforms { rows, plan, px, arch, threads } = self;
        let (px, py, (row_given, rows_given)) = (*px, plan.stages.length(), even.given);
        let together = rows.at_a_time();
        let (nb, height) = (rows.blocks() * BLOCK, rows_given.next_multiple_of(together) * PLACE);
        let nan = Complex::new(f64::NAN, f64::NAN);
        unwritten(in_x, rows.blocks() * height, nan, COEFFICIENTS, threads)?;
        pieces.resize_with(threads.count(), Default::default);
        let column = (together * nb).max(HALF * py + before_a_line::<f64>());
        pieces.iter_mut().try_for_each(|piece| piece.fit((together * px, column, rows.scratch_length())))?;
        let groups = blocks_of(in_x, height, 0..height, together * PLACE).enumerate();
        threads.share(groups, pieces, |(k, mut out), piece| {
            let count = together.min(rows_given - k * together);
            for (i, row) in piece.row[..count * px].chunks_exact_mut(px).enumerate() {
                fill_even((k * together + i) as i64, row_given, row, &even.fill);
            }
            let bins = &mut piece.column[..together * nb];
            rows.forward(&piece.row[..count * px], px, &mut Block::of(bins, together * BLOCK), &mut piece.rows);
            // The real parts of blocks.
            for (b, block) in parts(bins).chunks_exact(together * 2 * BLOCK).enumerate() {
                out.prefetch(b + 1, (0, 1));
                let of_rows = block.chunks_exact(2 * BLOCK);
                for (out, of_row) in parts_mut(out.row_mut(b)).chunks_exact_mut(BLOCK).zip(of_rows) {
                    out.copy_from_slice(&of_row[..BLOCK]);
                }
            }
        });
        let scale = 1.0 / (px as f64 * py as f64);
        unwritten(symbol, order.len(), T::nan(), SYMBOL, threads)?;
        threads.for_each_row(symbol, order.block(), pieces, |k, out, piece| {
            let (in_x, memory) = ((parts(&in_x[k * height..][..height]), rows_given), &mut piece.column[..]);
            let (columns, value) = (rows.bins() - k * BLOCK, |value: f64| scale * (even.finish)(value));
            arch.dispatch(SymbolOfBlock { plan, in_x, columns, value, out, memory });
        });
        Ok(())
    }
}

/// The symbol of one block of columns, in double precision, kept in another.
struct SymbolOfBlock<'a, T, G> {
    plan: &'a EvenPlan<f64>,
    /// Coefficients transformed in x, `[ky][column]` at offsets ky >= 0; and how many rows there are.
    in_x: (&'a [f64], usize),
    /// Columns that mean something.
    columns: usize,
    /// What is kept of each value of these.
    value: G,
    /// `[kept row][column]`; zero in columns that mean nothing.
    out: &'a mut [T],
    memory: &'a mut [Complex<f64>],
}

impl<T: Real, G: Fn(f64) -> f64> WithSimd for SymbolOfBlock<'_, T, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SymbolOfBlock { plan, in_x: (in_x, given), columns, value, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<f64, S>::new(simd), lane_count::<f64, S>(), &plan.stages);
        let length = stages.length();
        let rows = &mut rows_of::<f64, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        for column in (0..HALF).step_by(n) {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<f64, S> {
                    // Offset -ky stands at py - ky.
                    let ky = row.min(length - row);
                    if ky >= given {
                        return zero;
                    }
                    let values = f64::vectors::<S>(&in_x[ky * BLOCK..][..BLOCK]);
                    Parts { re: values[column / n], im: values[(column + HALF) / n] }
                },
            );
            of_radix!(stages.first.radix, first, a, &stages.first, rows, load);
            stages.forward_after_first(a, rows);
            for (rows, kept) in rows.chunks_exact(stages.last).zip(&plan.kept).filter(|(_, kept)| kept.step > 0) {
                for (q, row) in rows.iter().enumerate() {
                    let values: &[f64] = pulp::bytemuck::cast_slice(row);
                    let out = &mut out[(kept.first + q) * BLOCK..][..BLOCK];
                    for (values, first) in values.chunks_exact(n).zip([column, column + HALF]) {
                        let (there, beyond) = out[first..][..n].split_at_mut(columns.saturating_sub(first).min(n));
                        there.iter_mut().zip(values).for_each(|(out, bin)| *out = T::of(value(*bin)));
                        beyond.fill(T::zero());
                    }
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/set_up.rs"]
mod tests;
