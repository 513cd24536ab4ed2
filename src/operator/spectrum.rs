//! The transform of the coefficients, by which a product multiplies.
//!
//! ```text
//! S = F c / (px py),   one column of it per x bin,    k an offset (kx, ky)
//!
//! c(kx, ky) = c(-kx, ky) = c(kx, -ky)    S real and even: a half of each column is kept, of groups of columns in another order
//! c(k) = c(-k)                           S real
//! any other c                            S complex
//! ```
//!
//! A table may be symmetric to within round-off only ([`is_symmetric`](crate::influence::Coefficients::is_symmetric)). In single precision, the rounding of which
//! is as large, its symmetric part `(c(k) + c(-k))/2`, the spectrum of which is the real part of S, serves in its place.

use std::mem::take;

use super::even_columns::{EvenColumns, GROUP};
use super::fft::{Complex, Real};
use crate::error::Result;
use crate::influence::SYMMETRY;
use crate::memory::{keep, unwritten};
use crate::threads::Threads;

/// What memory is for.
pub(super) const SPECTRUM: &str = "the operator's spectrum";

/// Values that are converted at a time.
const PIECE: usize = 1 << 12;

/// The spectrum, the normalisation folded in. Real ones have an even number of columns: the last may be there twice.
pub(super) enum Spectrum<T: Real> {
    /// Groups of columns as [`EvenColumns`] have them, then `py/2 + 1` values a column.
    Even(Vec<T>),
    /// `py` values a column.
    Symmetric(Vec<T>),
    /// `py` complex values a column, and whether their imaginary parts are no more than the round-off of a symmetric table.
    General(Vec<Complex<T>>, bool),
}

impl<T: Real> Drop for Spectrum<T> {
    fn drop(&mut self) {
        match self {
            Spectrum::Even(values) | Spectrum::Symmetric(values) => keep([values]),
            Spectrum::General(values, _) => keep([values]),
        }
    }
}

/// Whether what a table may lack of symmetry is less than the rounding of T.
pub(super) fn is_coarse<T: Real>() -> bool {
    T::epsilon().to_double() >= SYMMETRY
}

/// How the columns of an even spectrum are kept: `columns` in all, of period py.
#[derive(Clone, Copy)]
pub(super) struct EvenOrder<'a, T: Real> {
    pub groups: Option<&'a EvenColumns<T>>,
    pub columns: usize,
    pub py: usize,
}

impl<T: Real> EvenOrder<'_, T> {
    /// Values of a column that is in no group.
    pub fn half(&self) -> usize {
        self.py / 2 + 1
    }

    /// Values of a group, or of as many columns where there are none.
    pub fn group(&self) -> usize {
        GROUP * self.groups.map_or(self.half(), EvenColumns::kept_rows)
    }

    /// Columns in groups.
    pub fn grouped(&self) -> usize {
        self.groups.map_or(0, |_| EvenColumns::<T>::grouped(self.columns))
    }

    /// Where the values of a column begin that is in no group.
    pub fn of_column(&self, column: usize) -> usize {
        self.grouped() / GROUP * self.group() + (column - self.grouped()) * self.half()
    }

    /// Values in all. The columns in no group are an even number: the last may be there twice.
    pub fn len(&self) -> usize {
        self.of_column(self.columns + self.columns % 2)
    }
}

impl<T: Real> Spectrum<T> {
    /// The same in another precision, in its `order`, times a factor.
    pub fn in_precision<S: Real>(
        &self,
        (here, there): (EvenOrder<'_, T>, EvenOrder<'_, S>),
        factor: f64,
        threads: &Threads,
    ) -> Result<Spectrum<S>> {
        let convert = |value: T| S::of(factor * value.to_double());
        let real = |from: &[T]| converted(from, |from| convert(*from), S::nan(), threads);
        Ok(match self {
            Spectrum::Even(from) => {
                let mut values = real(from)?;
                if let (Some(here), Some(there), grouped) = (here.groups, there.groups, here.of_column(here.grouped()))
                {
                    let places = here.places_in(there);
                    threads.for_a_pass(grouped).for_each_plain_row(&mut values[..grouped], PIECE, |_, values| {
                        for row in values.chunks_exact_mut(GROUP) {
                            let given: [S; GROUP] = std::array::from_fn(|place| row[places[place]]);
                            row.copy_from_slice(&given);
                        }
                    });
                }
                Spectrum::Even(values)
            }
            Spectrum::Symmetric(from) => Spectrum::Symmetric(real(from)?),
            Spectrum::General(from, true) if is_coarse::<S>() => {
                Spectrum::Symmetric(converted(from, |from| convert(from.re), S::nan(), threads)?)
            }
            Spectrum::General(from, symmetric) => {
                let convert = |from: &Complex<T>| Complex::new(convert(from.re), convert(from.im));
                Spectrum::General(converted(from, convert, Complex::new(S::nan(), S::nan()), threads)?, *symmetric)
            }
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match self {
            Spectrum::Even(s) | Spectrum::Symmetric(s) => size_of_val(&s[..]),
            Spectrum::General(s, _) => size_of_val(&s[..]),
        }
    }

    /// Memory for another real one.
    pub fn take_real(&mut self) -> Vec<T> {
        match self {
            Spectrum::Even(values) | Spectrum::Symmetric(values) => take(values),
            Spectrum::General(..) => Vec::new(),
        }
    }

    /// Memory for another complex one.
    pub fn take_complex(&mut self) -> Vec<Complex<T>> {
        match self {
            Spectrum::Even(_) | Spectrum::Symmetric(_) => Vec::new(),
            Spectrum::General(values, _) => take(values),
        }
    }

    /// Multiplies transformed columns in no group, of length py, the first of which has x bin `first`.
    pub fn multiply(&self, first: usize, order: EvenOrder<'_, T>, columns: &mut [Complex<T>]) {
        let py = order.py;
        for (column, bin) in columns.chunks_exact_mut(py).zip(first..) {
            match self {
                Spectrum::Even(s) => {
                    let s = &s[order.of_column(bin)..][..order.half()];
                    let (lower, upper) = column.split_at_mut(order.half());
                    pulp::Arch::new().dispatch(Multiply { lower, upper, s });
                }
                Spectrum::Symmetric(s) => {
                    let s = &s[bin * py..(bin + 1) * py];
                    pulp::Arch::new().dispatch(Multiply { lower: column, upper: &mut [], s });
                }
                Spectrum::General(s, _) => {
                    for (value, &factor) in column.iter_mut().zip(&s[bin * py..]) {
                        *value = *value * factor;
                    }
                }
            }
        }
    }
}

/// A column times its spectrum: bins of which that is kept, and those beyond, mirrored. Compiled for the vectors of this machine; no bit
/// depends on them.
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
        if m == 0 {
            return;
        }
        let mirrored = &s[1..=m];
        for k in 0..m {
            let (value, factor) = (upper[k], mirrored[m - 1 - k]);
            upper[k] = Complex::new(value.re * factor, value.im * factor);
        }
    }
}

/// A spectrum made of another one.
fn converted<A: Sync, B: Copy + Send + Sync + 'static>(
    from: &[A],
    convert: impl Fn(&A) -> B + Sync + Send,
    mark: B,
    threads: &Threads,
) -> Result<Vec<B>> {
    let mut converted = Vec::new();
    unwritten(&mut converted, from.len(), mark, SPECTRUM, threads)?;
    threads.for_a_pass(from.len()).for_each_plain_row(
        &mut converted,
        PIECE,
        #[inline(always)]
        |k, piece| piece.iter_mut().zip(&from[k * PIECE..]).for_each(|(to, from)| *to = convert(from)),
    );
    Ok(converted)
}
