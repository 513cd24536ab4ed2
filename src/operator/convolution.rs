//! The y direction of a product where A is block Toeplitz.
//!
//! ```text
//! u_I = sum_J c(ix - jx, iy - jy) p_J = [F^-1 (S . F p)]_I,    S = F c,  p padded with zeros to px * py
//! ```
//!
//! Per block of columns: groups of columns by even coefficients as [`EvenColumns`] have them; the others are gathered, transformed, multiplied,
//! transformed back and scattered.

use std::ops::Range;

use super::columns::for_each_block;
use super::even_columns::{EvenColumns, GROUP};
use super::fft::{ColumnTransform, Real};
use super::rows::{Product, Rows};
use super::set_up::{Even, SetUp, Transforms};
use super::spectrum::{is_coarse, EvenOrder, Spectrum, SPECTRUM};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::unwritten;
use crate::threads::Threads;

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

/// Transforms in y, and the spectrum.
pub(super) struct Convolution<T: Real> {
    pub columns: ColumnTransform<T>,
    /// Of groups of columns, by an even spectrum.
    even: Option<EvenColumns<T>>,
    spectrum: Spectrum<T>,
}

impl<T: Real> Convolution<T> {
    /// Transforms of period py; the spectrum is still to be computed.
    pub fn new(py: usize) -> Convolution<T> {
        Convolution {
            columns: ColumnTransform::new(py),
            even: EvenColumns::new(py),
            spectrum: Spectrum::Even(Vec::new()),
        }
    }

    /// How an even spectrum of so many columns is kept.
    fn order(&self, columns: usize) -> EvenOrder<'_, T> {
        EvenOrder { groups: self.even.as_ref(), columns, py: self.columns.length() }
    }

    /// The same in another precision, times a factor, of `nb` columns.
    pub fn in_precision<S: Real>(&self, nb: usize, factor: f64, threads: &Threads) -> Result<Convolution<S>> {
        let mut other = Convolution::new(self.columns.length());
        other.spectrum = self.spectrum.in_precision((self.order(nb), other.order(nb)), factor, threads)?;
        Ok(other)
    }

    pub fn bytes(&self) -> usize {
        self.spectrum.bytes()
    }

    /// Transforms in y, multiplies by the spectrum and transforms back; rows `loaded` hold pressures.
    pub fn apply(&self, rows: &Rows<T>, loaded: Range<usize>, product: &mut Product<T>) {
        let Product { bins, pieces } = product;
        let (nb, length) = (rows.transform.bins(), self.columns.length());
        let (room, order) = (room_of_column(length), self.order(nb));
        for_each_block(&mut bins[..rows.my * nb], nb, &rows.threads, pieces, |block, piece| {
            #[cfg(feature = "test-panics")]
            crate::panics::at_a_block();
            let mut together = 0;
            if let (Some(even), Spectrum::Even(values)) = (&self.even, &self.spectrum) {
                together = even.multiply(block, loaded.clone(), values, &mut piece.columns);
            }
            let mut block = block.tail(together);
            if block.columns() == 0 {
                return;
            }
            let columns = &mut piece.columns[..block.columns() * room];
            block.gather(loaded.clone(), room, columns);
            // Long columns one by one, in the nearest cache.
            let (together, used) = if room > length { (room, length) } else { (columns.len(), columns.len()) };
            for (c, columns) in columns.chunks_exact_mut(together).enumerate() {
                let columns = &mut columns[..used];
                self.columns.forward(columns, &mut piece.scratch);
                self.spectrum.multiply(block.first() + c, order, columns);
                self.columns.inverse(columns, &mut piece.scratch);
            }
            block.scatter(0..rows.my, room, columns);
        });
    }

    /// Computes the spectrum of even coefficients, in the memory that there is; `px` is the period in x.
    pub fn set_even<F, G>(&mut self, even: &Even<F, G>, px: usize, threads: &Threads, set_up: &mut SetUp) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let mut values = self.spectrum.take_real();
        let transforms = Transforms::new((px, self.columns.length()), threads);
        transforms.of_even(even, set_up, self.even.as_ref(), &mut values)?;
        self.spectrum = Spectrum::Even(values);
        Ok(())
    }

    /// Takes a spectrum of even coefficients, `value(x, y)` of the bins >= 0; `px` is the period in x.
    pub fn set_values(&mut self, (nb, px): (usize, usize), value: impl Fn(usize, usize) -> f64) -> Result<()> {
        let (py, order) = (self.columns.length(), self.order(nb));
        let scale = 1.0 / (px as f64 * py as f64);
        let value = |x: usize, y: usize| T::of(scale * value(x, y));
        let mut spectrum = Vec::new();
        unwritten(&mut spectrum, order.len(), T::nan(), SPECTRUM, &Threads::One)?;
        let (grouped, half) = (order.of_column(order.grouped()), order.half());
        if let Some(groups) = order.groups {
            for (k, group) in spectrum[..grouped].chunks_exact_mut(order.group()).enumerate() {
                groups.write(group, |column, bin| value(k * GROUP + column, bin));
            }
        }
        for (x, column) in (order.grouped()..nb).zip(spectrum[grouped..].chunks_exact_mut(half)) {
            column.iter_mut().enumerate().for_each(|(y, out)| *out = value(x, y));
        }
        self.spectrum = Spectrum::Even(spectrum);
        Ok(())
    }

    /// Computes the spectrum of coefficients that are not even, times a factor.
    pub fn set_uneven(
        &mut self,
        (coefficients, factor): (&Coefficients, f64),
        grid: &Grid,
        px: usize,
        threads: &Threads,
        set_up: &mut SetUp,
    ) -> Result<()> {
        let transforms = Transforms::new((px, self.columns.length()), threads);
        let symmetric = coefficients.is_symmetric(grid);
        self.spectrum = if symmetric && is_coarse::<T>() {
            let mut values = self.spectrum.take_real();
            transforms.of_symmetric((coefficients, factor), grid, set_up, &mut values)?;
            Spectrum::Symmetric(values)
        } else {
            let mut values = self.spectrum.take_complex();
            transforms.of_general((coefficients, factor), grid, set_up, &mut values)?;
            Spectrum::General(values, symmetric)
        };
        Ok(())
    }
}
