//! Computes the symbol of products by 2 x 2 matrices ([`vector_product`](crate::vector_product)).
//!
//! The computation is in double precision. The symbol is stored in the precision `T` of the product.

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

/// The index of xy among the components xx, yy, xy.
const XY: usize = 2;

/// The number of stored components: xx and yy and, if the two directions are coupled, xy.
fn plane_count(is_coupled: bool) -> usize {
    if is_coupled {
        3
    } else {
        2
    }
}

impl LaneTransforms<'_> {
    /// Computes the symbol of an [`EvenMatrix`]: xx and yy are even, xy is odd.
    pub(crate) fn of_even_matrix<T: Real, F, G>(
        &self,
        matrix: &EvenMatrix<F, G>,
        set_up: &mut SetUp,
    ) -> Result<VectorSymbol<T>>
    where
        F: Fn(usize, i64, &mut [f64]) + Sync + Send,
        G: Fn([f64; 3]) -> [f64; 3] + Sync + Send,
    {
        let (planes, values_per_plane) = (plane_count(matrix.is_coupled), BLOCK * self.plan.bins.len());
        let (blocks, values_per_block) = (self.rows.blocks(), planes * values_per_plane);
        let mut transformed = Vec::new();
        unwritten(&mut transformed, blocks * values_per_block, f64::NAN, SYMBOL, self.threads)?;
        for plane in 0..planes {
            let parity = if plane == XY { Parity::Odd } else { Parity::Even };
            let fill = |ky: i64, row: &mut [f64]| (matrix.fill)(plane, ky, row);
            let component = Even { given: matrix.given, fill, finish: |value| value };
            let place = (values_per_block, plane * values_per_plane);
            self.compute_plane((&component, parity), set_up, place, &mut transformed)?;
        }
        // `compute_plane` divides by px py, and `of_bins` divides again. `finish` gets values without normalisation, so they are multiplied here.
        let period_size = self.period_size();
        let symbol = self.of_bins(planes, |block, i| {
            let block = &transformed[block * values_per_block..][..values_per_block];
            // Without coupling there is no plane xy; its value is 0.
            let component = |plane: usize| block.get(plane * values_per_plane + i).map_or(0.0, |v| period_size * v);
            (matrix.finish)([0, 1, 2].map(component))
        });
        keep([&mut transformed]);
        symbol
    }

    /// Stores the symbol of an even matrix if its values are known. `values(bin_x, bin_y)` returns [xx, yy, xy] at the bins `0 ..= px/2`,
    /// `0 ..= py/2`, without the normalisation `1/(px py)`.
    pub(crate) fn of_waves<T: Real>(
        &self,
        is_coupled: bool,
        values: impl Fn(usize, usize) -> [f64; 3] + Sync + Send,
    ) -> Result<VectorSymbol<T>> {
        self.of_bins(plane_count(is_coupled), |block, i| {
            let row = i / BLOCK;
            let [xx, yy, xy] = values(block * BLOCK + i % BLOCK, self.plan.bins[row]);
            // A mirrored row is that of the bin py - k. xy is odd, so its sign changes.
            [xx, yy, if self.plan.mirrored[row] { -xy } else { xy }]
        })
    }

    /// Normalises and stores the symbol of an even matrix. `values(block, i)` returns [xx, yy, xy], without normalisation, of value i of the planes
    /// `[kept row][column]` of a block of columns.
    fn of_bins<T: Real>(
        &self,
        planes: usize,
        values: impl Fn(usize, usize) -> [f64; 3] + Sync + Send,
    ) -> Result<VectorSymbol<T>> {
        let (values_per_plane, columns, mut symbol) = (BLOCK * self.plan.bins.len(), self.rows.bins(), Vec::new());
        unwritten(&mut symbol, self.rows.blocks() * planes * values_per_plane, T::nan(), SYMBOL, self.threads)?;
        let period_size = self.period_size();
        self.threads.for_each_plain_row(&mut symbol, planes * values_per_plane, |block, symbol| {
            for i in 0..values_per_plane {
                // The last block may have columns beyond the last bin. They are set to 0.
                let is_defined = block * BLOCK + i % BLOCK < columns;
                let components = if is_defined { values(block, i) } else { [0.0; 3] };
                for (plane, component) in components.into_iter().enumerate().take(planes) {
                    symbol[plane * values_per_plane + i] = T::of(component / period_size);
                }
            }
        });
        Ok(VectorSymbol { values: symbol, planes, values_per_plane, is_even: true, factors: Vec::new() })
    }

    /// Computes the symbol of general coefficients. `fill(kx, ky, [xx, yy, xy])` fills three slices with the coefficients at the offsets `(kx, ky)`,
    /// `(kx + 1, ky)`, ... Without coupling the values of xy are ignored.
    ///
    /// The rows of coefficients are transformed in x first. The results are stored as `[plane][block of columns][row of coefficients][column]`, with
    /// the number of rows rounded up to whole groups of rows that are transformed together.
    pub(crate) fn of_general_matrix<T: Real>(
        &self,
        (mx, my): (usize, usize),
        is_coupled: bool,
        fill: impl Fn(i64, i64, [&mut [f64]; 3]) + Sync + Send,
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
    ) -> Result<VectorSymbol<T>> {
        let LaneTransforms { rows, plan, arch, threads, .. } = self;
        let ((px, py), planes, lanes) = (self.period(), plane_count(is_coupled), rows.at_a_time());
        let (values_per_plane, height) = (2 * BLOCK * py, (2 * my - 1).next_multiple_of(lanes) * BLOCK);
        let in_x_per_plane = rows.blocks() * height;
        // `split_in_three` needs three planes. Without coupling the third one stays unused.
        unwritten(in_x, 3 * in_x_per_plane, Complex::new(f64::NAN, f64::NAN), COEFFICIENTS, threads)?;
        pieces.resize_with(threads.count(), Default::default);
        let column = lanes * py + before_a_line::<f64>();
        pieces.iter_mut().try_for_each(|piece| piece.fit((3 * lanes * px, column, rows.scratch_length())))?;
        self.matrix_in_x((mx, my), planes, fill, split_in_three(in_x, in_x_per_plane), pieces);
        let mut values = Vec::new();
        unwritten(&mut values, rows.blocks() * planes * values_per_plane, T::nan(), SYMBOL, threads)?;
        let scale = 1.0 / self.period_size();
        threads.for_each_row(&mut values, values_per_plane, pieces, |i, out, piece| {
            let (block, plane) = (i / planes, i % planes);
            let in_x = parts(&in_x[plane * in_x_per_plane + block * height..][..height]);
            arch.dispatch(SymbolOfPlane { plan, in_x, my, scale, out, memory: &mut piece.column });
        });
        Ok(VectorSymbol { values, planes, values_per_plane, is_even: false, factors: Vec::new() })
    }

    /// Transforms all rows of coefficients in x, to `in_x`: first the rows at the offsets ky = 0 ..= my - 1, directly after them those at
    /// 1 - my ..= -1.
    fn matrix_in_x(
        &self,
        (mx, my): (usize, usize),
        planes: usize,
        fill: impl Fn(i64, i64, [&mut [f64]; 3]) + Sync + Send,
        in_x: [&mut [Complex<f64>]; 3],
        pieces: &mut [Piece],
    ) {
        let (rows, px, lanes, row_count) = (&self.rows, self.period().0, self.rows.at_a_time(), 2 * my - 1);
        let height = row_count.next_multiple_of(lanes) * BLOCK;
        let [xx, yy, xy] = in_x.map(|in_x| blocks_of(in_x, height, 0..height, lanes * BLOCK));
        self.threads.share(xx.zip(yy).zip(xy).enumerate(), pieces, |(group, ((xx, yy), xy)), piece| {
            let count = lanes.min(row_count - group * lanes);
            let mut components = split_in_three(&mut piece.row, lanes * px);
            for i in 0..count {
                let row = (group * lanes + i) as i64;
                let ky = if row < my as i64 { row } else { row - row_count as i64 };
                let mut period = components.each_mut().map(|rows| &mut rows[i * px..][..px]);
                fill(0, ky, period.each_mut().map(|period| &mut period[..mx]));
                fill(1 - mx as i64, ky, period.each_mut().map(|period| &mut period[px - (mx - 1)..]));
                period.iter_mut().for_each(|period| period[mx..px - (mx - 1)].fill(0.0));
            }
            for (mut out, component) in [xx, yy, xy].into_iter().zip(components).take(planes) {
                let (periods, bins, scratch) = (&component[..count * px], &mut out, &mut piece.rows[..]);
                f64::rows_forward(rows.arch, Forward { plan: &rows.plan, rows: periods, width: px, bins, scratch });
            }
        });
    }
}

/// Splits the first `3 * length` values in three parts of `length` values each.
fn split_in_three<A>(values: &mut [A], length: usize) -> [&mut [A]; 3] {
    let (a, rest) = values.split_at_mut(length);
    let (b, rest) = rest.split_at_mut(length);
    [a, b, &mut rest[..length]]
}

/// Computes one plane (xx, yy or xy) of a general symbol in one block of columns, in double precision, and stores it as `T`.
struct SymbolOfPlane<'a, T> {
    /// The transform in y. Its period is at least 2 my - 1.
    plan: &'a EvenPlan<f64>,
    /// Coefficients transformed in x, `[ky][part][column]`, at the offsets ky = 0 ..= my - 1, then 1 - my ..= -1.
    in_x: &'a [f64],
    /// The number of rows of the grid, and of offsets ky >= 0.
    my: usize,
    /// The normalisation, `1/(px py)`.
    scale: f64,
    /// The plane, `[bin in y, in the order of the stages][part][column]`.
    out: &'a mut [T],
    /// Memory for one vector of columns.
    memory: &'a mut [Complex<f64>],
}

impl<T: Real> WithSimd for SymbolOfPlane<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let SymbolOfPlane { plan, in_x, my, scale, out, memory } = self;
        let (a, n, stages) = (Arithmetic::<f64, S>::new(simd), lane_count::<f64, S>(), &plan.stages);
        let (length, vectors) = (stages.length(), BLOCK / n);
        let rows = &mut rows_of::<f64, S>(memory)[..length];
        let zero = Parts { re: a.splat(0.0), im: a.splat(0.0) };
        let values = f64::vectors::<S>(in_x);
        for vector in 0..vectors {
            let load = inlined(
                #[inline(always)]
                |row: usize| -> C<f64, S> {
                    // Row py - k of the period has the offset ky = -k. The rows between positive and negative offsets are zero.
                    let minus_ky = length - row;
                    let row = if row < my {
                        row
                    } else if minus_ky < my {
                        2 * my - 1 - minus_ky
                    } else {
                        return zero;
                    };
                    let first = 2 * vectors * row + vector;
                    Parts { re: values[first], im: values[first + vectors] }
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
