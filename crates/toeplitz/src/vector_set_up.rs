//! Set-up of the symbol for products of two components, in double precision for both precisions of the product.

use pulp::{Simd, WithSimd};

use crate::block::{blocks_of, parts, BLOCK};
use crate::coefficients::{Even, EvenMatrix, Parity};
use crate::fft::even_plan::EvenPlan;
use crate::fft::lanes::{lane_count, Arithmetic, Lanes, Parts, C};
use crate::fft::row_pass::Forward;
use crate::fft::stages::{before_a_line, first, inlined, of_radix, rows_of};
use crate::passes::Real;
use crate::real::Complex;
use crate::set_up::{Piece, SetUp, COEFFICIENTS};
use crate::set_up_lanes::LaneTransforms;
use crate::symbol::SYMBOL;
use crate::vector_symbol::VectorSymbol;
use par::memory::{keep, unwritten};
use par::Result;

/// Components xx, yy, xy.
const XY: usize = 2;

impl LaneTransforms<'_> {
    /// The symbol of coefficients that are even or odd.
    pub(crate) fn of_even_matrix<T: Real, F, G>(
        &self,
        of: &EvenMatrix<F, G>,
        set_up: &mut SetUp,
    ) -> Result<VectorSymbol<T>>
    where
        F: Fn(usize, i64, &mut [f64]) + Sync + Send,
        G: Fn([f64; 3]) -> [f64; 3] + Sync + Send,
    {
        let (planes, of_plane) = (if of.is_coupled { 3 } else { 2 }, BLOCK * self.plan.bins.len());
        let (blocks, of_block) = (self.rows.blocks(), planes * of_plane);
        let mut transformed = Vec::new();
        unwritten(&mut transformed, blocks * of_block, f64::NAN, SYMBOL, self.threads)?;
        for plane in 0..planes {
            let parity = if plane == XY { Parity::Odd } else { Parity::Even };
            let fill = |ky: i64, row: &mut [f64]| (of.fill)(plane, ky, row);
            let even = Even { given: of.given, fill, finish: |value| value };
            self.of_plane((&even, parity), set_up, (of_block, plane * of_plane), &mut transformed)?;
        }
        // Each transform contains 1/(px py). The stored symbol contains it once.
        let (px, py) = self.period();
        let scale = px as f64 * py as f64;
        let symbol = self.of_bins(planes, |block, k| {
            let from = &transformed[block * of_block..][..of_block];
            let at = |plane: usize| from.get(plane * of_plane + k).map_or(0.0, |value| scale * value);
            (of.finish)([0, 1, 2].map(at))
        });
        keep([&mut transformed]);
        symbol
    }

    /// Sets the symbol of coefficients that are even or odd from its values: `of(kx, ky)` gives its [xx, yy, xy] at bins that are not negative.
    pub(crate) fn of_waves<T: Real>(
        &self,
        is_coupled: bool,
        of: impl Fn(usize, usize) -> [f64; 3] + Sync + Send,
    ) -> Result<VectorSymbol<T>> {
        self.of_bins(if is_coupled { 3 } else { 2 }, |block, k| {
            let row = k / BLOCK;
            let [xx, yy, xy] = of(block * BLOCK + k % BLOCK, self.plan.bins[row]);
            [xx, yy, if self.plan.mirrored[row] { -xy } else { xy }]
        })
    }

    /// The symbol from the values at place k of each block.
    fn of_bins<T: Real>(
        &self,
        planes: usize,
        at: impl Fn(usize, usize) -> [f64; 3] + Sync + Send,
    ) -> Result<VectorSymbol<T>> {
        let (of_plane, columns, mut values) = (BLOCK * self.plan.bins.len(), self.rows.bins(), Vec::new());
        unwritten(&mut values, self.rows.blocks() * planes * of_plane, T::nan(), SYMBOL, self.threads)?;
        let (px, py) = self.period();
        let scale = px as f64 * py as f64;
        self.threads.for_each_plain_row(&mut values, planes * of_plane, |block, values| {
            for k in 0..of_plane {
                let is_there = block * BLOCK + k % BLOCK < columns;
                let kept = if is_there { at(block, k) } else { [0.0; 3] };
                for (plane, kept) in kept.into_iter().enumerate().take(planes) {
                    values[plane * of_plane + k] = T::of(kept / scale);
                }
            }
        });
        Ok(VectorSymbol { values, planes, of_plane, is_even: true, factors: Vec::new() })
    }

    /// The symbol of general coefficients. `fill(kx, ky, [xx, yy, xy])` sets those of the offsets `(kx, ky)`, `(kx + 1, ky)`, ... xy is used if the
    /// components are coupled.
    pub(crate) fn of_general_matrix<T: Real>(
        &self,
        (mx, my): (usize, usize),
        is_coupled: bool,
        fill: impl Fn(i64, i64, [&mut [f64]; 3]) + Sync + Send,
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
    ) -> Result<VectorSymbol<T>> {
        let LaneTransforms { rows, plan, arch, threads, .. } = self;
        let ((px, py), planes, together) = (self.period(), if is_coupled { 3 } else { 2 }, rows.at_a_time());
        let (of_plane, height) = (2 * BLOCK * py, (2 * my - 1).next_multiple_of(together) * BLOCK);
        let in_x_of_plane = rows.blocks() * height;
        unwritten(in_x, 3 * in_x_of_plane, Complex::new(f64::NAN, f64::NAN), COEFFICIENTS, threads)?;
        pieces.resize_with(threads.count(), Default::default);
        let column = together * py + before_a_line::<f64>();
        pieces.iter_mut().try_for_each(|piece| piece.fit((3 * together * px, column, rows.scratch_length())))?;
        self.matrix_in_x((mx, my), planes, fill, split_in_three(in_x, in_x_of_plane), pieces);
        let mut values = Vec::new();
        unwritten(&mut values, rows.blocks() * planes * of_plane, T::nan(), SYMBOL, threads)?;
        let scale = 1.0 / (px as f64 * py as f64);
        threads.for_each_row(&mut values, of_plane, pieces, |k, out, piece| {
            let (block, plane) = (k / planes, k % planes);
            let in_x = parts(&in_x[plane * in_x_of_plane + block * height..][..height]);
            arch.dispatch(GeneralColumns { plan, in_x: (in_x, my), scale, out, memory: &mut piece.column });
        });
        Ok(VectorSymbol { values, planes, of_plane, is_even: false, factors: Vec::new() })
    }

    /// The transforms in x of all rows of coefficients: rows 0 .. my, then 1 - my .. -1, as in a period.
    fn matrix_in_x(
        &self,
        (mx, my): (usize, usize),
        planes: usize,
        fill: impl Fn(i64, i64, [&mut [f64]; 3]) + Sync + Send,
        in_x: [&mut [Complex<f64>]; 3],
        pieces: &mut [Piece],
    ) {
        let (rows, px, together, given) = (&self.rows, self.period().0, self.rows.at_a_time(), 2 * my - 1);
        let height = given.next_multiple_of(together) * BLOCK;
        let [xx, yy, xy] = in_x.map(|in_x| blocks_of(in_x, height, 0..height, together * BLOCK));
        self.threads.share(xx.zip(yy).zip(xy).enumerate(), pieces, |(k, ((xx, yy), xy)), piece| {
            let count = together.min(given - k * together);
            let mut periods = split_in_three(&mut piece.row, together * px);
            for i in 0..count {
                let row = (k * together + i) as i64;
                let ky = if row < my as i64 { row } else { row - given as i64 };
                let mut period = periods.each_mut().map(|periods| &mut periods[i * px..][..px]);
                fill(0, ky, period.each_mut().map(|period| &mut period[..mx]));
                fill(1 - mx as i64, ky, period.each_mut().map(|period| &mut period[px - (mx - 1)..]));
                period.iter_mut().for_each(|period| period[mx..px - (mx - 1)].fill(0.0));
            }
            for (mut out, periods) in [xx, yy, xy].into_iter().zip(periods).take(planes) {
                let (given, bins, scratch) = (&periods[..count * px], &mut out, &mut piece.rows[..]);
                f64::rows_forward(rows.arch, Forward { plan: &rows.plan, rows: given, width: px, bins, scratch });
            }
        });
    }
}

/// The first three parts of `length` values each.
fn split_in_three<A>(values: &mut [A], length: usize) -> [&mut [A]; 3] {
    let (a, rest) = values.split_at_mut(length);
    let (b, rest) = rest.split_at_mut(length);
    [a, b, &mut rest[..length]]
}

/// The symbol of one block of columns, computed in double precision and stored in T.
struct GeneralColumns<'a, T> {
    plan: &'a EvenPlan<f64>,
    /// Coefficients transformed in x, `[ky][part][column]` at offsets ky >= 0, then < 0. The second value is the number of offsets ky >= 0.
    in_x: (&'a [f64], usize),
    scale: f64,
    /// `[row][part][column]`.
    out: &'a mut [T],
    memory: &'a mut [Complex<f64>],
}

impl<T: Real> WithSimd for GeneralColumns<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let GeneralColumns { plan, in_x: (in_x, my), scale, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<f64, S>::new(simd), lane_count::<f64, S>(), &plan.stages);
        let (length, vectors) = (stages.length(), BLOCK / n);
        let rows = &mut rows_of::<f64, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        let values = f64::vectors::<S>(in_x);
        for vector in 0..vectors {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<f64, S> {
                    // Offset -ky has index py - ky.
                    let row = match length - row {
                        _ if row < my => row,
                        negative if negative < my => 2 * my - 1 - negative,
                        _ => return zero,
                    };
                    let at = 2 * vectors * row + vector;
                    Parts { re: values[at], im: values[at + vectors] }
                },
            );
            of_radix!(stages.first.radix, first, a, &stages.first, rows, load);
            stages.forward_after_first(a, rows);
            for (row, out) in rows.iter().zip(out.chunks_exact_mut(2 * BLOCK)) {
                let values: &[f64] = pulp::bytemuck::cast_slice(row);
                for (part, values) in values.chunks_exact(n).enumerate() {
                    let out = &mut out[part * BLOCK + vector * n..][..n];
                    out.iter_mut().zip(values).for_each(|(out, value)| *out = T::of(scale * value));
                }
            }
        }
    }
}
