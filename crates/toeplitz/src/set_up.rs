//! The computation of a symbol, in double precision for either precision of the operator: transforms in x of all rows of coefficients, then in y
//! of blocks of columns. Two columns with real transforms share a complex one, as its real and imaginary parts. Here rows and columns are
//! transformed one by one; [`set_up_lanes`](crate::set_up_lanes) does even coefficients in lanes.

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

/// The memory of a symbol's computation, kept by operators whose coefficients change often.
#[derive(Default)]
pub struct SetUp {
    real: Vec<f64>,
    pub(crate) complex: Vec<Complex<f64>>,
    pub(crate) pieces: Vec<Piece>,
}

impl Drop for SetUp {
    fn drop(&mut self) {
        keep([&mut self.real]);
        keep([&mut self.complex]);
    }
}

/// The memory of one piece of the work.
#[derive(Default)]
pub(crate) struct Piece {
    pub(crate) row: Vec<f64>,
    pub(crate) column: Vec<Complex<f64>>,
    pub(crate) rows: Vec<Complex<f64>>,
    columns: Vec<Complex<f64>>,
}

impl Piece {
    /// Allocates memory for values of rows, for a column or the bins of rows, and for scratch of rows.
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

/// The transforms of both directions, and their threads.
pub(crate) struct Transforms<'a> {
    rows: RowTransform<f64>,
    columns: ColumnTransform<f64>,
    threads: &'a Threads,
}

impl<'a> Transforms<'a> {
    /// The transforms of a period.
    pub fn new((px, py): (usize, usize), threads: &'a Threads) -> Result<Transforms<'a>> {
        Ok(Transforms { rows: RowTransform::new(px)?, columns: ColumnTransform::new(py)?, threads })
    }

    fn period(&self) -> (usize, usize) {
        (self.rows.length(), self.columns.length())
    }

    fn scale(&self) -> f64 {
        let (px, py) = self.period();
        1.0 / (px as f64 * py as f64)
    }

    /// Fits pieces to the transforms of both directions.
    fn suit(&self, pieces: &mut Vec<Piece>) -> Result<()> {
        let (px, py) = self.period();
        pieces.resize_with(self.threads.count(), Piece::default);
        for piece in pieces {
            let length = self.rows.bins().max(PAIRS * py);
            piece.fit((self.rows.at_a_time() * px, length, self.rows.scratch_length()))?;
            self.columns.fit(&mut piece.columns)?;
        }
        Ok(())
    }

    /// The symbol of even coefficients: half of each column. Columns are padded to an even number by repeating the last.
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
        let ((px, py), nb, (row_given, rows_given)) = (self.period(), self.rows.bins(), even.given);
        unwritten(in_x, rows_given * nb, f64::NAN, COEFFICIENTS, self.threads)?;
        self.suit(pieces)?;
        self.threads.for_each_row(in_x, nb, pieces, |ky, out, piece| {
            let row = &mut piece.row[..px];
            fill_period(ky as i64, row_given, row, Parity::Even, &even.fill);
            self.rows.forward(row, &mut piece.column[..nb], &mut piece.rows);
            out.iter_mut().zip(&piece.column).for_each(|(value, bin)| *value = bin.re);
        });
        let scale = self.scale();
        let (half, value) = (py / 2 + 1, |value: f64| T::of(scale * (even.finish)(value)));
        unwritten(symbol, (nb + nb % 2) * half, T::nan(), SYMBOL, self.threads)?;
        self.threads.for_each_row(symbol, 2 * PAIRS * half, pieces, |k, out, piece| {
            let first = 2 * PAIRS * k;
            let columns = (nb - first).min(2 * PAIRS);
            let block = &mut piece.column[..columns.div_ceil(2) * py];
            fill_pairs((in_x, nb), rows_given, first, (block, py), |re, im| [Complex::new(re, im); 2]);
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

    /// The transforms in x of some rows of coefficients; `fill(kx, i, values)` gives those of row i from offset kx on.
    fn of_rows(
        &self,
        count: usize,
        in_x: &mut Vec<Complex<f64>>,
        pieces: &mut [Piece],
        mx: usize,
        fill: impl Fn(i64, usize, &mut [f64]) + Sync + Send,
    ) -> Result<()> {
        let (px, nb, together) = (self.rows.length(), self.rows.bins(), self.rows.at_a_time());
        unwritten(in_x, count * nb, Complex::new(f64::NAN, 0.0), COEFFICIENTS, self.threads)?;
        self.threads.for_each_row(in_x, together * nb, pieces, |k, out, piece| {
            let rows = &mut piece.row[..out.len() / nb * px];
            for (i, row) in rows.chunks_exact_mut(px).enumerate() {
                let i = k * together + i;
                fill(0, i, &mut row[..mx]);
                row[mx..px - (mx - 1)].fill(0.0);
                fill(1 - mx as i64, i, &mut row[px - (mx - 1)..]);
            }
            self.rows.forward_together(rows, px, out, &mut piece.rows);
        });
        Ok(())
    }

    /// The symbol of the symmetric part of coefficients. The transform of row -ky is the conjugate of that of row ky.
    pub fn of_symmetric<T: Real>(
        &self,
        (coefficients, factor): (&impl Coefficients, f64),
        (mx, my): (usize, usize),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        symbol: &mut Vec<T>,
    ) -> Result<()> {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        self.suit(pieces)?;
        self.of_rows(my, in_x, pieces, mx, |kx, ky, row| coefficients.fill_symmetric_row(kx, ky as i64, row))?;
        unwritten(symbol, (nb + nb % 2) * py, T::nan(), SYMBOL, self.threads)?;
        let scale = factor * self.scale();
        self.threads.for_each_row(symbol, PAIRS * 2 * py, pieces, |block, out, piece| {
            let first = PAIRS * 2 * block;
            let block = &mut piece.column[..out.len() / 2];
            // The values of a + i b in the rows ky and -ky.
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

    /// The symbol of any coefficients.
    pub fn of_general<T: Real>(
        &self,
        (coefficients, factor): (&impl Coefficients, f64),
        (mx, my): (usize, usize),
        SetUp { complex: in_x, pieces, .. }: &mut SetUp,
        symbol: &mut Vec<Complex<T>>,
    ) -> Result<()> {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        self.suit(pieces)?;
        // Rows 0..my, then 1-my..=-1, as in a period.
        self.of_rows(2 * my - 1, in_x, pieces, mx, |kx, i, row| {
            let ky = if i < my { i as i64 } else { i as i64 - (2 * my as i64 - 1) };
            coefficients.fill_row(kx, ky, row);
        })?;
        unwritten(symbol, nb * py, Complex::new(T::nan(), T::nan()), SYMBOL, self.threads)?;
        let (scale, gap) = (factor * self.scale(), py - (2 * my - 1));
        self.threads.for_each_row(symbol, PAIRS * py, pieces, |block, out, piece| {
            let first = PAIRS * block;
            let block = &mut piece.column[..out.len()];
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
