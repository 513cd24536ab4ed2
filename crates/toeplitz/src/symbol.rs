//! The transform of the coefficients. A product multiplies by it.
//!
//! ```text
//! S = F c / (px py),   one column of it per x bin,    k an offset (kx, ky)
//!
//! c(kx, ky) = c(-kx, ky) = c(kx, -ky)    S real and even: half of each column is stored; columns in vectors have another order
//! c(k) = c(-k)                           S real
//! any other c                            S complex
//! ```
//!
//! A table counts as symmetric if `c(k)` and `c(-k)` differ by at most [`SYMMETRY`] of the largest coefficient. The rounding error of single
//! precision is as large as that. There the symmetric part `(c(k) + c(-k))/2` replaces the table. Its symbol is the real part of S.

use std::mem::take;

use crate::block::BLOCK;
use crate::coefficients::SYMMETRY;
use crate::fft::lane_columns::LaneColumns;
use crate::passes::Real;
use crate::real::Complex;
use par::memory::{keep, unwritten};
use par::threads::Threads;
use par::Result;

/// The name of this memory in messages.
pub(crate) const SYMBOL: &str = "the operator's spectrum";

/// Values that are converted at a time.
const PIECE: usize = 1 << 12;

/// The symbol, including the normalisation. A real symbol has an even number of columns, so the last column may be stored twice.
pub(crate) enum Symbol<T: Real> {
    /// Blocks of columns in the order of [`LaneColumns`]. Without lanes, `py/2 + 1` values a column.
    Even(Vec<T>),
    /// `py` values a column.
    Symmetric(Vec<T>),
    /// `py` complex values a column, and whether their imaginary parts are only the round-off of a symmetric table.
    General(Vec<Complex<T>>, bool),
}

impl<T: Real> Drop for Symbol<T> {
    fn drop(&mut self) {
        match self {
            Symbol::Even(values) | Symbol::Symmetric(values) => keep([values]),
            Symbol::General(values, _) => keep([values]),
        }
    }
}

/// Whether the admissible asymmetry of a table is below the rounding of T.
pub(crate) fn is_coarse<T: Real>() -> bool {
    T::epsilon().to_double() >= SYMMETRY
}

/// The order of an even symbol of `columns` columns, of period py.
#[derive(Clone, Copy)]
pub(crate) struct EvenOrder<'a, T: Real> {
    pub by_lanes: Option<&'a LaneColumns<T>>,
    pub columns: usize,
    pub py: usize,
}

impl<T: Real> EvenOrder<'_, T> {
    /// Values of a column without lanes.
    pub fn half(&self) -> usize {
        self.py / 2 + 1
    }

    /// Values of a block of columns.
    pub fn block(&self) -> usize {
        BLOCK * self.by_lanes.map_or(self.half(), LaneColumns::kept_rows)
    }

    /// The number of values: of whole blocks, or of an even number of columns. The last column may be stored twice.
    pub fn len(&self) -> usize {
        match self.by_lanes {
            Some(_) => self.columns.div_ceil(BLOCK) * self.block(),
            None => (self.columns + self.columns % 2) * self.half(),
        }
    }
}

impl<T: Real> Symbol<T> {
    /// The symbol in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64, threads: &Threads) -> Result<Symbol<S>> {
        let convert = |value: T| S::of(factor * value.to_double());
        let real = |from: &[T]| converted(from, |from| convert(*from), S::nan(), threads);
        Ok(match self {
            Symbol::Even(from) => Symbol::Even(real(from)?),
            Symbol::Symmetric(from) => Symbol::Symmetric(real(from)?),
            Symbol::General(from, true) if is_coarse::<S>() => {
                Symbol::Symmetric(converted(from, |from| convert(from.re), S::nan(), threads)?)
            }
            Symbol::General(from, symmetric) => {
                let convert = |from: &Complex<T>| Complex::new(convert(from.re), convert(from.im));
                Symbol::General(converted(from, convert, Complex::new(S::nan(), S::nan()), threads)?, *symmetric)
            }
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match self {
            Symbol::Even(s) | Symbol::Symmetric(s) => size_of_val(&s[..]),
            Symbol::General(s, _) => size_of_val(&s[..]),
        }
    }

    /// Takes the memory for another real symbol.
    pub fn take_real(&mut self) -> Vec<T> {
        match self {
            Symbol::Even(values) | Symbol::Symmetric(values) => take(values),
            Symbol::General(..) => Vec::new(),
        }
    }

    /// Takes the memory for another complex symbol.
    pub fn take_complex(&mut self) -> Vec<Complex<T>> {
        match self {
            Symbol::Even(_) | Symbol::Symmetric(_) => Vec::new(),
            Symbol::General(values, _) => take(values),
        }
    }

    /// Multiplies transformed columns of length py without lanes. The first has x bin `first`.
    pub fn multiply(&self, first: usize, order: EvenOrder<'_, T>, columns: &mut [Complex<T>]) {
        let py = order.py;
        for (column, bin) in columns.chunks_exact_mut(py).zip(first..) {
            match self {
                Symbol::Even(s) => {
                    let s = &s[bin * order.half()..][..order.half()];
                    let (lower, upper) = column.split_at_mut(order.half());
                    pulp::Arch::new().dispatch(Multiply { lower, upper, s });
                }
                Symbol::Symmetric(s) => {
                    let s = &s[bin * py..(bin + 1) * py];
                    pulp::Arch::new().dispatch(Multiply { lower: column, upper: &mut [], s });
                }
                Symbol::General(s, _) => {
                    for (value, &factor) in column.iter_mut().zip(&s[bin * py..]) {
                        *value = *value * factor;
                    }
                }
            }
        }
    }
}

/// A column times its symbol: the bins with a stored value, and the mirrored bins. Compiled for the vector instructions of this machine. No bit of
/// the result depends on them.
struct Multiply<'a, T: Real> {
    lower: &'a mut [Complex<T>],
    upper: &'a mut [Complex<T>],
    s: &'a [T],
}

impl<T: Real> pulp::NullaryFnOnce for Multiply<'_, T> {
    type Output = ();

    // The slices of one loop have the same length, so that the compiler vectorises it.
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

/// A symbol converted from another one.
pub(crate) fn converted<A: Sync, B: Copy + Send + Sync + 'static>(
    from: &[A],
    convert: impl Fn(&A) -> B + Sync + Send,
    mark: B,
    threads: &Threads,
) -> Result<Vec<B>> {
    let mut converted = Vec::new();
    unwritten(&mut converted, from.len(), mark, SYMBOL, threads)?;
    threads.for_a_pass(from.len()).for_each_plain_row(
        &mut converted,
        PIECE,
        #[inline(always)]
        |k, piece| piece.iter_mut().zip(&from[k * PIECE..]).for_each(|(to, from)| *to = convert(from)),
    );
    Ok(converted)
}
