//! The y direction of a product where A is block Toeplitz, and the spectrum of both directions.
//!
//! ```text
//! u_I = sum_J c(ix - jx, iy - jy) p_J = [F^-1 (S . F p)]_I,    S = F c,  p padded with zeros to px * py
//! ```
//!
//! Per block of eight columns: gather, transform, multiply, transform back, scatter. Even coefficients have a real, even spectrum: a
//! quarter of it is kept. Two columns of it share one complex transform, one as its real and one as its imaginary part.

use std::mem::take;
use std::ops::Range;

use super::columns::for_each_block;
use super::fft::{ColumnTransform, Complex, Real};
use super::row_transform::RowTransform;
use super::rows::{Product, Rows};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::{computed, keep, unwritten};
use crate::threads::Threads;

/// What memory is for.
const COEFFICIENTS: &str = "the influence coefficients";
const SPECTRUM: &str = "the operator's spectrum";

/// Columns of complex numbers, or pairs of real ones, that are gathered at a time in a set-up: a cache line.
const PAIRS: usize = 4;

/// Columns of so many values stand apart by [`GAP`] more: at a distance of a power of two they would share few lines of the nearest cache.
const LONG: usize = 512;
const GAP: usize = 8;

/// Values from the beginning of a column in a block to that of the next.
pub(super) fn room_of_column(length: usize) -> usize {
    if length < LONG {
        length
    } else {
        length + GAP
    }
}

/// The transform of the coefficients, with the normalisation `1/(px py)` folded in, one column of it per x bin.
enum Spectrum<T: Real> {
    /// Even coefficients: real, `py/2 + 1` values a column.
    Even(Vec<T>),
    /// General coefficients: `py` complex values a column.
    General(Vec<Complex<T>>),
}

impl<T: Real> Drop for Spectrum<T> {
    fn drop(&mut self) {
        match self {
            Spectrum::Even(values) => keep([values]),
            Spectrum::General(values) => keep([values]),
        }
    }
}

/// Transforms in y, and the spectrum.
pub(super) struct Convolution<T: Real> {
    pub columns: ColumnTransform<T>,
    spectrum: Spectrum<T>,
}

/// Even coefficients of both directions.
pub(super) struct Even<F, G> {
    /// Coefficients that are not zero: offsets less than that.
    pub given: (usize, usize),
    /// `fill(ky, row)` gives the coefficients at offsets `(0.., ky)`.
    pub fill: F,
    /// What is kept of each value of the spectrum, but for the normalisation.
    pub finish: G,
}

/// Memory that a spectrum is computed in. An operator whose coefficients change often keeps it.
#[derive(Default)]
pub struct SetUp {
    real: Vec<f64>,
    complex: Vec<Complex<f64>>,
    pieces: Vec<Piece>,
}

impl Drop for SetUp {
    fn drop(&mut self) {
        keep([&mut self.real]);
        keep([&mut self.complex]);
    }
}

/// That of one piece of the work.
#[derive(Default)]
struct Piece {
    row: Vec<f64>,
    column: Vec<Complex<f64>>,
    rows: Vec<Complex<f64>>,
    columns: Vec<Complex<f64>>,
}

impl Piece {
    /// Pieces that suit transforms of both directions.
    fn suit(
        pieces: &mut Vec<Piece>,
        threads: &Threads,
        rows: &RowTransform<f64>,
        columns: &ColumnTransform<f64>,
    ) -> Result<()> {
        pieces.resize_with(threads.count(), Piece::default);
        for piece in pieces {
            piece.row.resize(rows.length(), 0.0);
            let length = rows.bins().max(PAIRS * columns.length());
            unwritten(&mut piece.column, length, Complex::default(), COEFFICIENTS)?;
            rows.fit(&mut piece.rows);
            columns.fit(&mut piece.columns);
        }
        Ok(())
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        keep([&mut self.column]);
    }
}

impl<T: Real> Convolution<T> {
    /// Transforms of period py; the spectrum is still to be computed.
    pub fn new(py: usize) -> Convolution<T> {
        Convolution { columns: ColumnTransform::new(py), spectrum: Spectrum::Even(Vec::new()) }
    }

    /// The same in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Convolution<S>> {
        let convert = |value: T| S::of(factor * value.to_double());
        let spectrum = match &self.spectrum {
            Spectrum::Even(from) => Spectrum::Even(computed(from.iter().map(|from| convert(*from)), SPECTRUM)?),
            Spectrum::General(from) => {
                let convert = |from: &Complex<T>| Complex::new(convert(from.re), convert(from.im));
                Spectrum::General(computed(from.iter().map(convert), SPECTRUM)?)
            }
        };
        Ok(Convolution { columns: ColumnTransform::new(self.columns.length()), spectrum })
    }

    pub fn bytes(&self) -> usize {
        match &self.spectrum {
            Spectrum::Even(s) => size_of_val(&s[..]),
            Spectrum::General(s) => size_of_val(&s[..]),
        }
    }

    /// Transforms in y, multiplies by the spectrum and transforms back; rows `loaded` hold pressures.
    pub fn apply(&self, rows: &Rows<T>, loaded: Range<usize>, product: &mut Product<T>) {
        let Product { bins, pieces } = product;
        let (nb, length) = (rows.transform.bins(), self.columns.length());
        let room = room_of_column(length);
        for_each_block(&mut bins[..rows.my * nb], nb, &rows.threads, pieces, |block, piece| {
            let columns = &mut piece.columns[..block.columns() * room];
            block.gather(loaded.clone(), room, columns);
            // Long columns one by one, in the nearest cache.
            let (together, used) = if room > length { (room, length) } else { (columns.len(), columns.len()) };
            for (c, columns) in columns.chunks_exact_mut(together).enumerate() {
                let columns = &mut columns[..used];
                self.columns.forward(columns, &mut piece.scratch);
                self.multiply(block.first() + c, columns);
                self.columns.inverse(columns, &mut piece.scratch);
            }
            block.scatter(0..rows.my, room, columns);
        });
    }

    /// Multiplies the transformed columns of a block, the first of which has x bin `first`, by the spectrum.
    fn multiply(&self, first: usize, block: &mut [Complex<T>]) {
        #[cfg(feature = "test-panics")]
        crate::panics::at_a_block();
        let py = self.columns.length();
        for (c, column) in block.chunks_exact_mut(py).enumerate() {
            match &self.spectrum {
                Spectrum::Even(s) => {
                    let s = &s[(first + c) * (py / 2 + 1)..(first + c + 1) * (py / 2 + 1)];
                    let (lower, upper) = column.split_at_mut(py / 2 + 1);
                    pulp::Arch::new().dispatch(Multiply { lower, upper, s });
                }
                Spectrum::General(s) => {
                    for (value, &factor) in column.iter_mut().zip(&s[(first + c) * py..]) {
                        *value = *value * factor;
                    }
                }
            }
        }
    }

    /// Computes the spectrum of even coefficients, in the memory that there is.
    pub fn set_even<F, G>(&mut self, even: &Even<F, G>, px: usize, threads: &Threads, set_up: &mut SetUp) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let py = self.columns.length();
        let (row_given, rows_given) = even.given;
        let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
        let nb = rows.bins();
        let SetUp { real: in_x, pieces, .. } = set_up;
        unwritten(in_x, rows_given * nb, f64::NAN, COEFFICIENTS)?;
        Piece::suit(pieces, threads, &rows, &columns)?;
        threads.for_each_row(in_x, nb, pieces, |ky, out, piece| {
            let row = &mut piece.row;
            row.fill(0.0);
            (even.fill)(ky as i64, &mut row[..row_given]);
            for kx in 1..row_given {
                row[px - kx] = row[kx];
            }
            rows.forward(row, &mut piece.column[..nb], &mut piece.rows);
            out.iter_mut().zip(&piece.column).for_each(|(value, bin)| *value = bin.re);
        });
        let half = py / 2 + 1;
        let mut spectrum = match &mut self.spectrum {
            Spectrum::Even(spectrum) => take(spectrum),
            Spectrum::General(_) => Vec::new(),
        };
        unwritten(&mut spectrum, (nb + nb % 2) * half, T::nan(), SPECTRUM)?;
        let scale = 1.0 / (px as f64 * py as f64);
        threads.for_each_row(&mut spectrum, PAIRS * 2 * half, pieces, |block, out, piece| {
            let (first, pairs) = (PAIRS * block, out.len() / (2 * half));
            let block = &mut piece.column[..pairs * py];
            block.fill(Complex::default());
            for ky in 0..rows_given {
                let row = &in_x[ky * nb..(ky + 1) * nb];
                for (pair, column) in block.chunks_exact_mut(py).enumerate() {
                    let bin = 2 * (first + pair);
                    let value = Complex::new(row[bin], row[(bin + 1).min(nb - 1)]);
                    column[ky] = value;
                    if ky > 0 {
                        column[py - ky] = value;
                    }
                }
            }
            columns.forward(block, &mut piece.columns);
            for (column, out) in block.chunks_exact(py).zip(out.chunks_exact_mut(2 * half)) {
                let (re, im) = out.split_at_mut(half);
                for ((bin, re), im) in column.iter().zip(re).zip(im) {
                    *re = T::of(scale * (even.finish)(bin.re));
                    *im = T::of(scale * (even.finish)(bin.im));
                }
            }
        });
        self.spectrum = Spectrum::Even(spectrum);
        Ok(())
    }

    /// Takes a spectrum of even coefficients, `value(x, y)` of the bins >= 0; `px` is the period in x.
    pub fn set_values(&mut self, (nb, px): (usize, usize), value: impl Fn(usize, usize) -> f64) -> Result<()> {
        let py = self.columns.length();
        let half = py / 2 + 1;
        let scale = 1.0 / (px as f64 * py as f64);
        let mut spectrum = Vec::new();
        unwritten(&mut spectrum, (nb + nb % 2) * half, T::nan(), SPECTRUM)?;
        for (i, out) in spectrum[..nb * half].iter_mut().enumerate() {
            *out = T::of(scale * value(i / half, i % half));
        }
        self.spectrum = Spectrum::Even(spectrum);
        Ok(())
    }

    /// Computes the spectrum of coefficients that are not even, of which period px is kept in x.
    pub fn set_general(
        &mut self,
        coefficients: &Coefficients,
        grid: &Grid,
        (px, factor): (usize, f64),
        threads: &Threads,
        set_up: &mut SetUp,
    ) -> Result<()> {
        let py = self.columns.length();
        let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
        let nb = rows.bins();
        let (mx, my) = (grid.mx, grid.my);
        let SetUp { complex: in_x, pieces, .. } = set_up;
        unwritten(in_x, (2 * my - 1) * nb, Complex::new(f64::NAN, 0.0), COEFFICIENTS)?;
        Piece::suit(pieces, threads, &rows, &columns)?;
        threads.for_each_row(in_x, nb, pieces, |i, out, piece| {
            let row = &mut piece.row;
            row.fill(0.0);
            let ky = i as i64 - (my as i64 - 1);
            coefficients.fill_row(0, ky, &mut row[..mx]);
            coefficients.fill_row(1 - mx as i64, ky, &mut row[px - (mx - 1)..]);
            rows.forward(row, out, &mut piece.rows);
        });
        let mut spectrum = match &mut self.spectrum {
            Spectrum::General(spectrum) => take(spectrum),
            Spectrum::Even(_) => Vec::new(),
        };
        unwritten(&mut spectrum, nb * py, Complex::new(T::nan(), T::nan()), SPECTRUM)?;
        let scale = factor / (px as f64 * py as f64);
        threads.for_each_row(&mut spectrum, PAIRS * py, pieces, |block, out, piece| {
            let (first, count) = (PAIRS * block, out.len() / py);
            let block = &mut piece.column[..count * py];
            block.fill(Complex::default());
            for (i, row) in in_x.chunks_exact(nb).enumerate() {
                let ky = (i + py - (my - 1)) % py;
                block[ky..].iter_mut().step_by(py).zip(&row[first..]).for_each(|(value, bin)| *value = *bin);
            }
            columns.forward(block, &mut piece.columns);
            for (value, bin) in out.iter_mut().zip(&*block) {
                *value = Complex::new(T::of(scale * bin.re), T::of(scale * bin.im));
            }
        });
        self.spectrum = Spectrum::General(spectrum);
        Ok(())
    }
}

/// A column times its spectrum: bins up to py/2, and those beyond. Compiled for the vectors of this machine; no bit depends on them.
struct Multiply<'a, T: Real> {
    lower: &'a mut [Complex<T>],
    upper: &'a mut [Complex<T>],
    s: &'a [T],
}

impl<T: Real> pulp::NullaryFnOnce for Multiply<'_, T> {
    type Output = ();

    // Loops over slices of one length, which the compiler can vectorise.
    #[inline(always)]
    fn call(self) {
        let Multiply { lower, upper, s } = self;
        let (n, m) = (lower.len(), upper.len());
        for (value, &factor) in lower.iter_mut().zip(&s[..n]) {
            *value = Complex::new(value.re * factor, value.im * factor);
        }
        let mirrored = &s[1..=m];
        for k in 0..m {
            let (value, factor) = (upper[k], mirrored[m - 1 - k]);
            upper[k] = Complex::new(value.re * factor, value.im * factor);
        }
    }
}
