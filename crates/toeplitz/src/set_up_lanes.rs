//! The computation of the symbol of even or odd coefficients for products by stages of this crate: rows and columns in lanes. The stages leave bins
//! in the order of the products.
//!
//! Columns c and c + 8 of a block share a complex transform, as its real and imaginary parts: no bit depends on the length of
//! vectors. Odd coefficients have imaginary transforms in either direction: with a and b real and odd, `F(a + i b) = i F_a - F_b`, both of them
//! real.

use std::sync::Arc;

use pulp::{Simd, WithSimd};

use crate::block::{blocks_of, parts, parts_mut, Block, BLOCK};
use crate::coefficients::{Even, Parity};
use crate::fft::even_plan::EvenPlan;
use crate::fft::lane_rows::LaneRows;
use crate::fft::lanes::{lane_count, Arithmetic, Lanes, Parts, C};
use crate::fft::row_pass::Forward;
use crate::fft::stages::{before_a_line, first, inlined, of_radix, rows_of};
use crate::passes::Real;
use crate::real::Complex;
use crate::set_up::{SetUp, COEFFICIENTS};
use crate::set_up_columns::fill_period;
use crate::symbol::{EvenOrder, SYMBOL};
use par::memory::unwritten;
use par::threads::Threads;
use par::Result;

/// Columns that are the real parts of a block's transforms.
const HALF: usize = BLOCK / 2;
/// Complex numbers whose memory holds the real values of a row of a block.
const PLACE: usize = BLOCK / 2;

/// The transforms of both directions, and their threads.
pub(crate) struct LaneTransforms<'a> {
    pub(crate) rows: LaneRows<f64>,
    pub(crate) plan: Arc<EvenPlan<f64>>,
    px: usize,
    pub(crate) arch: pulp::Arch,
    pub(crate) threads: &'a Threads,
}

impl<'a> LaneTransforms<'a> {
    /// The transforms of a period; None if it has no plan, or the machine no vectors.
    pub fn new(period: (usize, usize), threads: &'a Threads) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::on(pulp::Arch::new(), period, threads)
    }

    /// [`LaneTransforms::new`] for an instruction set. Results have the same bits with any of them.
    pub(crate) fn on(
        arch: pulp::Arch,
        (px, py): (usize, usize),
        threads: &'a Threads,
    ) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::with(arch, LaneRows::on(arch, px)?, (px, py), threads)
    }

    /// [`LaneTransforms::new`] also for machines without vectors.
    pub fn of_any(
        arch: pulp::Arch,
        (px, py): (usize, usize),
        threads: &'a Threads,
    ) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::with(arch, LaneRows::of_any(arch, px)?, (px, py), threads)
    }

    fn with(
        arch: pulp::Arch,
        rows: Option<LaneRows<f64>>,
        (px, py): (usize, usize),
        threads: &'a Threads,
    ) -> Result<Option<LaneTransforms<'a>>> {
        let both = rows.zip(EvenPlan::shared(py)?);
        Ok(both.map(|(rows, plan)| LaneTransforms { rows, plan, px, arch, threads }))
    }

    pub(crate) fn period(&self) -> (usize, usize) {
        (self.px, self.plan.stages.length())
    }

    /// The symbol of even coefficients.
    pub fn of_even<T: Real, F, G>(
        &self,
        even: &Even<F, G>,
        set_up: &mut SetUp,
        order: EvenOrder<'_, T>,
        symbol: &mut Vec<T>,
    ) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        unwritten(symbol, order.len(), T::nan(), SYMBOL, self.threads)?;
        self.of_plane((even, Parity::Even), set_up, (order.block(), 0), symbol)
    }

    /// Computes the symbol of even or odd coefficients. In each block of `of_block` values it is stored from value `place` on.
    pub fn of_plane<T: Real, F, G>(
        &self,
        (even, parity): (&Even<F, G>, Parity),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        (of_block, place): (usize, usize),
        symbol: &mut [T],
    ) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let LaneTransforms { rows, plan, arch, threads, .. } = self;
        let ((px, py), (row_given, rows_given)) = (self.period(), even.given);
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
                fill_period((k * together + i) as i64, row_given, row, parity, &even.fill);
            }
            let bins = &mut piece.column[..together * nb];
            let (given, scratch) = (&piece.row[..count * px], &mut piece.rows[..]);
            let of_rows = &mut Block::of(bins, together * BLOCK);
            f64::rows_forward(rows.arch, Forward { plan: &rows.plan, rows: given, width: px, bins: of_rows, scratch });
            // The real parts of blocks, or the imaginary ones.
            let part = parity.swapped() * BLOCK;
            for (b, block) in parts(bins).chunks_exact(together * 2 * BLOCK).enumerate() {
                out.prefetch(b + 1, (0, 1));
                let of_rows = block.chunks_exact(2 * BLOCK);
                for (out, of_row) in parts_mut(out.row_mut(b)).chunks_exact_mut(BLOCK).zip(of_rows) {
                    out.copy_from_slice(&of_row[part..][..BLOCK]);
                }
            }
        });
        let scale = 1.0 / (px as f64 * py as f64);
        let kept = BLOCK * plan.bins.len();
        threads.for_each_row(symbol, of_block, pieces, |k, out, piece| {
            let out = &mut out[place..place + kept];
            let (in_x, memory) = ((parts(&in_x[k * height..][..height]), rows_given), &mut piece.column[..]);
            let (columns, value) = (rows.bins() - k * BLOCK, |value: f64| scale * (even.finish)(value));
            arch.dispatch(SymbolOfBlock { plan, parity, in_x, columns, value, out, memory });
        });
        Ok(())
    }
}

impl Parity {
    /// 1 if real coefficients have an imaginary transform, else 0.
    fn swapped(self) -> usize {
        usize::from(self == Parity::Odd)
    }
}

/// The symbol of one block of columns, computed in double precision and stored as `T`.
struct SymbolOfBlock<'a, T, G> {
    plan: &'a EvenPlan<f64>,
    parity: Parity,
    /// Coefficients transformed in x, `[ky][column]` at offsets ky >= 0, and the number of rows.
    in_x: (&'a [f64], usize),
    /// Number of defined columns.
    columns: usize,
    /// Applied to each value of the symbol.
    value: G,
    /// `[kept row][column]`; zero in undefined columns.
    out: &'a mut [T],
    memory: &'a mut [Complex<f64>],
}

impl<T: Real, G: Fn(f64) -> f64> WithSimd for SymbolOfBlock<'_, T, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SymbolOfBlock { plan, parity, in_x: (in_x, given), columns, value, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<f64, S>::new(simd), lane_count::<f64, S>(), &plan.stages);
        let length = stages.length();
        let rows = &mut rows_of::<f64, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        for column in (0..HALF).step_by(n) {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<f64, S> {
                    // Offset -ky is at py - ky.
                    let ky = row.min(length - row);
                    if ky >= given {
                        return zero;
                    }
                    let values = f64::vectors::<S>(&in_x[ky * BLOCK..][..BLOCK]);
                    let value = Parts { re: values[column / n], im: values[(column + HALF) / n] };
                    if parity == Parity::Odd && row != ky {
                        return a.sub(zero, value);
                    }
                    value
                },
            );
            of_radix!(stages.first.radix, first, a, &stages.first, rows, load);
            stages.forward_after_first(a, rows);
            for (rows, kept) in rows.chunks_exact(stages.last).zip(&plan.kept).filter(|(_, kept)| kept.step > 0) {
                for (q, row) in rows.iter().enumerate() {
                    let values: &[f64] = pulp::bytemuck::cast_slice(row);
                    let out = &mut out[(kept.first + q) * BLOCK..][..BLOCK];
                    // Odd coefficients: `i F_a - F_b`, times i for the direction x.
                    let (first, signs) = match parity {
                        Parity::Even => ([column, column + HALF], [1.0, 1.0]),
                        Parity::Odd => ([column + HALF, column], [1.0, -1.0]),
                    };
                    for ((values, first), sign) in values.chunks_exact(n).zip(first).zip(signs) {
                        let (there, beyond) = out[first..][..n].split_at_mut(columns.saturating_sub(first).min(n));
                        there.iter_mut().zip(values).for_each(|(out, bin)| *out = T::of(value(sign * *bin)));
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
