//! Computes the symbol of a product, in double precision whatever the precision of the product.
//!
//! All rows of coefficients are transformed in x, then blocks of columns in y. Two columns with real transforms become the real and the imaginary
//! part of one complex column. This module transforms rows and columns without SIMD lanes; [`set_up_lanes`](crate::set_up_lanes) computes the symbol
//! of even coefficients in lanes.

use crate::coefficients::{Coefficients, Even, Parity};
use crate::fft::any_length::ColumnTransform;
use crate::fft::row_transform::RowTransform;
use crate::passes::Real;
use crate::real::Complex;
use crate::set_up_columns::{fill_pairs, fill_period, gather, Parts, Scaled, PAIRS};
use crate::symbol::SYMBOL;
use par::memory::{keep, unwritten};
use par::threads::Threads;
use par::Result;

/// The name of this memory in messages.
pub(crate) const COEFFICIENTS: &str = "the influence coefficients";

/// The memory of a symbol's computation. Operators whose coefficients change often keep it for the next computation.
#[derive(Default)]
pub struct SetUp {
    /// Even coefficients transformed in x, without lanes.
    real: Vec<f64>,
    /// Coefficients transformed in x: any others, and even ones in lanes.
    pub(crate) complex: Vec<Complex<f64>>,
    /// The buffers of the threads.
    pub(crate) pieces: Vec<Piece>,
}

impl Drop for SetUp {
    fn drop(&mut self) {
        keep([&mut self.real]);
        keep([&mut self.complex]);
    }
}

/// The buffers of one thread.
#[derive(Default)]
pub(crate) struct Piece {
    /// Values of the rows that are transformed together.
    pub(crate) row: Vec<f64>,
    /// A block of columns, or the bins of rows.
    pub(crate) column: Vec<Complex<f64>>,
    /// Scratch of the transforms of rows.
    pub(crate) rows: Vec<Complex<f64>>,
    /// Scratch of the transforms of columns.
    columns: Vec<Complex<f64>>,
}

impl Piece {
    /// Allocates `row` values of rows, `column` values of columns, and `rows` values of scratch for rows.
    pub(crate) fn fit(&mut self, (row, column, rows): (usize, usize, usize)) -> Result<()> {
        unwritten(&mut self.row, row, f64::NAN, COEFFICIENTS, &Threads::One)?;
        unwritten(&mut self.column, column, Complex::default(), COEFFICIENTS, &Threads::One)?;
        unwritten(&mut self.rows, rows, Complex::default(), COEFFICIENTS, &Threads::One)
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        keep([&mut self.row]);
        keep([&mut self.column, &mut self.rows]);
    }
}

/// The transforms of a symbol's computation in x and y without lanes, and their threads.
pub(crate) struct Transforms<'a> {
    rows: RowTransform<f64>,
    columns: ColumnTransform<f64>,
    threads: &'a Threads,
}

impl<'a> Transforms<'a> {
    /// Makes the transforms of a period.
    pub fn new((px, py): (usize, usize), threads: &'a Threads) -> Result<Transforms<'a>> {
        Ok(Transforms { rows: RowTransform::new(px)?, columns: ColumnTransform::new(py)?, threads })
    }

    /// The period in x and y.
    fn period(&self) -> (usize, usize) {
        (self.rows.length(), self.columns.length())
    }

    /// The normalisation of the symbol, `1/(px py)`.
    fn scale(&self) -> f64 {
        let (px, py) = self.period();
        1.0 / (px as f64 * py as f64)
    }

    /// Makes one piece for each thread, with the memory that these transforms need.
    fn fit_pieces(&self, pieces: &mut Vec<Piece>) -> Result<()> {
        let (px, py) = self.period();
        pieces.resize_with(self.threads.count(), Piece::default);
        for piece in pieces {
            let length = self.rows.bins().max(PAIRS * py);
            piece.fit((self.rows.at_a_time() * px, length, self.rows.scratch_length()))?;
            self.columns.fit(&mut piece.columns)?;
        }
        Ok(())
    }

    /// Computes the symbol of even coefficients: the bins 0 ..= py/2 of each column. An odd number of columns is padded by repeating the last.
    pub fn of_even<T: Real, F, G>(
        &self,
        even: &Even<F, G>,
        SetUp { real: in_x, pieces, .. }: &mut SetUp,
        symbol: &mut Vec<T>,
    ) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let ((px, py), nb, (given_x, given_y)) = (self.period(), self.rows.bins(), even.given);
        unwritten(in_x, given_y * nb, f64::NAN, COEFFICIENTS, self.threads)?;
        self.fit_pieces(pieces)?;
        self.threads.for_each_row(in_x, nb, pieces, |ky, out, piece| {
            let row = &mut piece.row[..px];
            fill_period(ky as i64, given_x, row, Parity::Even, &even.fill);
            self.rows.forward(row, &mut piece.column[..nb], &mut piece.rows);
            // The transform of an even row is real.
            out.iter_mut().zip(&piece.column).for_each(|(value, bin)| *value = bin.re);
        });
        let scale = self.scale();
        let (half, value) = (py / 2 + 1, |value: f64| T::of(scale * (even.finish)(value)));
        unwritten(symbol, (nb + nb % 2) * half, T::nan(), SYMBOL, self.threads)?;
        self.threads.for_each_row(symbol, 2 * PAIRS * half, pieces, |b, out, piece| {
            let first = 2 * PAIRS * b;
            let columns = (nb - first).min(2 * PAIRS);
            let block = &mut piece.column[..columns.div_ceil(2) * py];
            fill_pairs((in_x, nb), given_y, first, (block, py), |re, im| [Complex::new(re, im); 2]);
            self.columns.forward(block, &mut piece.columns);
            for (column, out) in block.chunks_exact(py).zip(out.chunks_exact_mut(2 * half)) {
                let (re, im) = out.split_at_mut(half);
                for ((bin, re), im) in column.iter().zip(re).zip(im) {
                    (*re, *im) = (value(bin.re), value(bin.im));
                }
            }
        });
        Ok(())
    }

    /// Transforms `count` rows of coefficients in x, to `in_x`. `fill(kx, i, values)` fills `values` with the coefficients of row i at the offsets
    /// kx, kx + 1, ...
    fn rows_in_x(
        &self,
        count: usize,
        in_x: &mut Vec<Complex<f64>>,
        pieces: &mut [Piece],
        mx: usize,
        fill: impl Fn(i64, usize, &mut [f64]) + Sync + Send,
    ) -> Result<()> {
        let (px, nb, together) = (self.rows.length(), self.rows.bins(), self.rows.at_a_time());
        unwritten(in_x, count * nb, Complex::new(f64::NAN, 0.0), COEFFICIENTS, self.threads)?;
        self.threads.for_each_row(in_x, together * nb, pieces, |group, out, piece| {
            let rows = &mut piece.row[..out.len() / nb * px];
            for (i, row) in rows.chunks_exact_mut(px).enumerate() {
                let i = group * together + i;
                fill(0, i, &mut row[..mx]);
                row[mx..px - (mx - 1)].fill(0.0);
                fill(1 - mx as i64, i, &mut row[px - (mx - 1)..]);
            }
            self.rows.forward_together(rows, px, out, &mut piece.rows);
        });
        Ok(())
    }

    /// Computes the symbol of the symmetric part `(c(k) + c(-k))/2` of coefficients, times a factor. Only rows ky >= 0 are transformed in x: the
    /// transform of row -ky is the conjugate of that of row ky.
    pub fn of_symmetric<T: Real>(
        &self,
        (coefficients, factor): (&impl Coefficients, f64),
        (mx, my): (usize, usize),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        symbol: &mut Vec<T>,
    ) -> Result<()> {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        self.fit_pieces(pieces)?;
        self.rows_in_x(my, in_x, pieces, mx, |kx, ky, row| coefficients.fill_symmetric_row(kx, ky as i64, row))?;
        unwritten(symbol, (nb + nb % 2) * py, T::nan(), SYMBOL, self.threads)?;
        let scale = factor * self.scale();
        self.threads.for_each_row(symbol, PAIRS * 2 * py, pieces, |b, out, piece| {
            let first = PAIRS * 2 * b;
            let block = &mut piece.column[..out.len() / 2];
            // Two columns a and b make the complex column a + i b: in row ky from a and b, in row -ky from their conjugates.
            fill_pairs((in_x, nb), my, first, (block, py), |a: Complex<f64>, b: Complex<f64>| {
                [Complex::new(a.re - b.im, a.im + b.re), Complex::new(a.re + b.im, b.re - a.im)]
            });
            for (column, out) in block.chunks_exact_mut(py).zip(out.chunks_exact_mut(2 * py)) {
                self.columns.forward(column, &mut piece.columns);
                let (re, im) = out.split_at_mut(py);
                pulp::Arch::new().dispatch(Parts { column, scale, re, im });
            }
        });
        Ok(())
    }

    /// Computes the symbol of any coefficients, times a factor.
    pub fn of_general<T: Real>(
        &self,
        (coefficients, factor): (&impl Coefficients, f64),
        (mx, my): (usize, usize),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        symbol: &mut Vec<Complex<T>>,
    ) -> Result<()> {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        self.fit_pieces(pieces)?;
        // First the rows at the offsets ky = 0 ..= my - 1, directly after them those at 1 - my ..= -1.
        self.rows_in_x(2 * my - 1, in_x, pieces, mx, |kx, i, row| {
            let ky = if i < my { i as i64 } else { i as i64 - (2 * my as i64 - 1) };
            coefficients.fill_row(kx, ky, row);
        })?;
        unwritten(symbol, nb * py, Complex::new(T::nan(), T::nan()), SYMBOL, self.threads)?;
        let (scale, gap) = (factor * self.scale(), py - (2 * my - 1));
        self.threads.for_each_row(symbol, PAIRS * py, pieces, |b, out, piece| {
            let first = PAIRS * b;
            let block = &mut piece.column[..out.len()];
            // In a period there is a gap of zeros between the offsets ky >= 0 and those < 0.
            for (rows, to) in [(0..my, 0), (my..2 * my - 1, my + gap)] {
                gather((in_x, nb), rows, first, (block, py), to);
            }
            for (column, out) in block.chunks_exact_mut(py).zip(out.chunks_exact_mut(py)) {
                column[my..my + gap].fill(Complex::default());
                self.columns.forward(column, &mut piece.columns);
                pulp::Arch::new().dispatch(Scaled { column, scale, out });
            }
        });
        Ok(())
    }
}
