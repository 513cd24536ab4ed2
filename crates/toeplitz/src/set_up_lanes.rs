//! Computes the symbol of even or odd coefficients with the stages of this crate, one row or column in each SIMD lane.
//!
//! Products use the same stages, so the bins of the symbol already have the order that products need. After the transform in x the coefficients are
//! real numbers. Columns c and c + 8 of a block become the real and the imaginary part of one complex column. This pairing is the same for all
//! lengths of vectors, and so are all bits of the symbol.
//!
//! Odd coefficients have imaginary transforms in either direction. If a and b are real and odd, with the transforms `i F_a` and `i F_b`, then
//! `F(a + i b) = i F_a - F_b`, where F_a and F_b are real.

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

/// Complex columns of a block: each joins two of its real columns.
const HALF: usize = BLOCK / 2;
/// Complex numbers that take as much memory as the real values of a row of a block.
const COMPLEX_PER_ROW: usize = BLOCK / 2;

/// The transforms of a symbol's computation in x and y, and their threads.
pub(crate) struct LaneTransforms<'a> {
    /// The transforms in x.
    pub(crate) rows: LaneRows<f64>,
    /// The transforms in y, and which bins in y the symbol keeps.
    pub(crate) plan: Arc<EvenPlan<f64>>,
    px: usize,
    pub(crate) arch: pulp::Arch,
    pub(crate) threads: &'a Threads,
}

impl<'a> LaneTransforms<'a> {
    /// Makes the transforms of a period. Returns None if the period has no stages, or the machine has no SIMD vectors.
    pub fn new(period: (usize, usize), threads: &'a Threads) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::on(pulp::Arch::new(), period, threads)
    }

    /// [`LaneTransforms::new`] for a given instruction set. All instruction sets give the same bits.
    pub(crate) fn on(
        arch: pulp::Arch,
        (px, py): (usize, usize),
        threads: &'a Threads,
    ) -> Result<Option<LaneTransforms<'a>>> {
        LaneTransforms::with(arch, LaneRows::on(arch, px)?, (px, py), threads)
    }

    /// [`LaneTransforms::new`], also for machines without SIMD vectors.
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
        let rows_and_plan = rows.zip(EvenPlan::shared(py)?);
        Ok(rows_and_plan.map(|(rows, plan)| LaneTransforms { rows, plan, px, arch, threads }))
    }

    /// The period in x and y.
    pub(crate) fn period(&self) -> (usize, usize) {
        (self.px, self.plan.stages.length())
    }

    /// `px py`, the number of values of a period: the normalisation of F^-1 divides by it.
    pub(crate) fn period_size(&self) -> f64 {
        let (px, py) = self.period();
        px as f64 * py as f64
    }

    /// Computes the symbol of even coefficients, in the order `order`.
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
        self.compute_plane((even, Parity::Even), set_up, (order.block(), 0), symbol)
    }

    /// Computes the symbol of one component, whose coefficients are even or odd. `symbol` has blocks of `values_per_block` values. In each block the
    /// component begins at value `offset`.
    pub fn compute_plane<T: Real, F, G>(
        &self,
        (component, parity): (&Even<F, G>, Parity),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        (values_per_block, offset): (usize, usize),
        symbol: &mut [T],
    ) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let LaneTransforms { rows, plan, arch, threads, .. } = self;
        let ((px, py), (given_x, given_y)) = (self.period(), component.given);
        let lanes = rows.at_a_time();
        let (nb, height) = (rows.blocks() * BLOCK, given_y.next_multiple_of(lanes) * COMPLEX_PER_ROW);
        let nan = Complex::new(f64::NAN, f64::NAN);
        unwritten(in_x, rows.blocks() * height, nan, COEFFICIENTS, threads)?;
        pieces.resize_with(threads.count(), Default::default);
        // A piece's column holds the bins of a group of rows first, and the complex columns of a block afterwards.
        let column = (lanes * nb).max(HALF * py + before_a_line::<f64>());
        pieces.iter_mut().try_for_each(|piece| piece.fit((lanes * px, column, rows.scratch_length())))?;
        let groups = blocks_of(in_x, height, 0..height, lanes * COMPLEX_PER_ROW).enumerate();
        threads.share(groups, pieces, |(group, mut out), piece| {
            let count = lanes.min(given_y - group * lanes);
            for (i, row) in piece.row[..count * px].chunks_exact_mut(px).enumerate() {
                fill_period((group * lanes + i) as i64, given_x, row, parity, &component.fill);
            }
            let bins = &mut piece.column[..lanes * nb];
            let (periods, scratch) = (&piece.row[..count * px], &mut piece.rows[..]);
            let all = &mut Block::of(bins, lanes * BLOCK);
            f64::rows_forward(rows.arch, Forward { plan: &rows.plan, rows: periods, width: px, bins: all, scratch });
            // Even coefficients have real bins, odd ones imaginary bins. The other part is round-off, and is dropped.
            let kept_part = if parity == Parity::Odd { BLOCK } else { 0 };
            for (b, block) in parts(bins).chunks_exact(lanes * 2 * BLOCK).enumerate() {
                out.prefetch(b + 1, (0, 1));
                let bins_of_rows = block.chunks_exact(2 * BLOCK);
                for (out, bins_of_row) in parts_mut(out.row_mut(b)).chunks_exact_mut(BLOCK).zip(bins_of_rows) {
                    out.copy_from_slice(&bins_of_row[kept_part..][..BLOCK]);
                }
            }
        });
        let scale = 1.0 / self.period_size();
        let values_per_plane = BLOCK * plan.bins.len();
        threads.for_each_row(symbol, values_per_block, pieces, |b, out, piece| {
            let out = &mut out[offset..offset + values_per_plane];
            let (in_x, memory) = (parts(&in_x[b * height..][..height]), &mut piece.column[..]);
            let (columns, value) = (rows.bins() - b * BLOCK, |value: f64| scale * (component.finish)(value));
            arch.dispatch(SymbolOfBlock { plan, parity, in_x, given_y, columns, value, out, memory });
        });
        Ok(())
    }
}

/// Computes the symbol of one component in one block of columns, in double precision, and stores it as `T`.
struct SymbolOfBlock<'a, T, G> {
    /// The transform in y, and which of its bins are kept.
    plan: &'a EvenPlan<f64>,
    parity: Parity,
    /// Coefficients transformed in x, `[ky][column]`, at the offsets ky = 0 .. `given_y`.
    in_x: &'a [f64],
    given_y: usize,
    /// The number of columns from the first of the block to the last bin in x. Columns of the block beyond it are undefined.
    columns: usize,
    /// Applied to each value of the symbol: normalises it, and applies [`Even::finish`].
    value: G,
    /// The symbol, `[kept row][column]`; zero in undefined columns.
    out: &'a mut [T],
    /// Memory for one vector of complex columns.
    memory: &'a mut [Complex<f64>],
}

impl<T: Real, G: Fn(f64) -> f64> WithSimd for SymbolOfBlock<'_, T, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SymbolOfBlock { plan, parity, in_x, given_y, columns, value, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<f64, S>::new(simd), lane_count::<f64, S>(), &plan.stages);
        let length = stages.length();
        let rows = &mut rows_of::<f64, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        for column in (0..HALF).step_by(n) {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<f64, S> {
                    // Row py - k of the period has the offset ky = -k, whose coefficients are those at k or, if odd, their negatives.
                    let ky = row.min(length - row);
                    if ky >= given_y {
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
                    // The real part of a bin belongs to column c, the imaginary part to column c + 8. Odd coefficients have bins `i F_a - F_b`, and
                    // their transform in x has a factor i that `in_x` leaves out. So their symbols are -F_a in column c and -F_b in column c + 8.
                    let (first, signs) = match parity {
                        Parity::Even => ([column, column + HALF], [1.0, 1.0]),
                        Parity::Odd => ([column + HALF, column], [1.0, -1.0]),
                    };
                    for ((values, first), sign) in values.chunks_exact(n).zip(first).zip(signs) {
                        let (defined, undefined) = out[first..][..n].split_at_mut(columns.saturating_sub(first).min(n));
                        defined.iter_mut().zip(values).for_each(|(out, bin)| *out = T::of(value(sign * *bin)));
                        undefined.fill(T::zero());
                    }
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/set_up.rs"]
mod tests;
