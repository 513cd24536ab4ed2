//! The symbol S: the Fourier transform of the coefficients c. A product multiplies the transformed pressures by S.
//!
//! S is stored with the normalisation of F^-1, as `S = F c / (px py)`. It has one column for each bin in x. With an offset k = (kx, ky):
//!
//! | coefficients | symbol | stored |
//! |---|---|---|
//! | `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` | real and even | half of each column; with SIMD lanes in the order of [`LaneColumns`] |
//! | `c(k) = c(-k)` | real | whole columns |
//! | any other | complex | whole columns |
//!
//! A table of coefficients counts as symmetric if `c(k)` and `c(-k)` differ by at most [`SYMMETRY`] times the largest coefficient. The rounding error
//! of single precision is as large as that. So in single precision the symmetric part `(c(k) + c(-k))/2` replaces the table. The symbol of the
//! symmetric part is the real part of S.

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

/// The number of values that one piece of a conversion to another precision has.
const PIECE: usize = 1 << 12;

/// The symbol, including the normalisation. Without lanes, columns of a real symbol are computed in pairs. If their number is odd, the last one is
/// stored twice.
pub(crate) enum Symbol<T: Real> {
    /// S is real and even. With lanes: blocks of columns in the order of [`LaneColumns`]. Without: `py/2 + 1` values of each column.
    Even(Vec<T>),
    /// S is real: `py` values of each column.
    Symmetric(Vec<T>),
    /// S is complex: `py` values of each column. The second item tells whether the imaginary parts are only the asymmetry that a symmetric table may
    /// have.
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

/// Whether the precision T is so coarse that its rounding exceeds the asymmetry [`SYMMETRY`] of a symmetric table.
pub(crate) fn is_coarse<T: Real>() -> bool {
    T::epsilon().to_double() >= SYMMETRY
}

/// The order in which an even symbol is stored.
#[derive(Clone, Copy)]
pub(crate) struct EvenOrder<'a, T: Real> {
    /// The transforms of columns in lanes, if the product uses lanes.
    pub by_lanes: Option<&'a LaneColumns<T>>,
    /// The number of columns, px/2 + 1.
    pub columns: usize,
    /// The period in y.
    pub py: usize,
}

impl<T: Real> EvenOrder<'_, T> {
    /// The number of stored values of a column, if there are no lanes: the bins 0 ..= py/2.
    pub fn half(&self) -> usize {
        self.py / 2 + 1
    }

    /// The number of stored values of a block of columns.
    pub fn block(&self) -> usize {
        BLOCK * self.by_lanes.map_or(self.half(), LaneColumns::kept_rows)
    }

    /// The number of values of the symbol. With lanes it is that of whole blocks. Without, it is that of an even number of columns, so the last
    /// column may be stored twice.
    pub fn len(&self) -> usize {
        match self.by_lanes {
            Some(_) => self.columns.div_ceil(BLOCK) * self.block(),
            None => (self.columns + self.columns % 2) * self.half(),
        }
    }
}

impl<T: Real> Symbol<T> {
    /// Converts the symbol to another precision, and multiplies it by a factor.
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

    /// The bytes of the symbol's values.
    pub fn bytes(&self) -> usize {
        match self {
            Symbol::Even(s) | Symbol::Symmetric(s) => size_of_val(&s[..]),
            Symbol::General(s, _) => size_of_val(&s[..]),
        }
    }

    /// Takes the memory of this symbol, if it is real, for another real symbol.
    pub fn take_real(&mut self) -> Vec<T> {
        match self {
            Symbol::Even(values) | Symbol::Symmetric(values) => take(values),
            Symbol::General(..) => Vec::new(),
        }
    }

    /// Takes the memory of this symbol, if it is complex, for another complex symbol.
    pub fn take_complex(&mut self) -> Vec<Complex<T>> {
        match self {
            Symbol::Even(_) | Symbol::Symmetric(_) => Vec::new(),
            Symbol::General(values, _) => take(values),
        }
    }

    /// Multiplies transformed columns, each of length py, by the symbol. The first column belongs to bin `first` in x. An even symbol is stored
    /// without lanes.
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

/// Multiplies a column by a real symbol. pulp compiles the work for the vector instructions of this machine. No bit of the result depends on these
/// instructions.
struct Multiply<'a, T: Real> {
    /// The bins whose value of the symbol is stored.
    lower: &'a mut [Complex<T>],
    /// The mirrored bins: the last one has the same value as bin 1. Empty if the symbol is not even.
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

/// Converts all values of a symbol. `mark` fills new memory before the values are written.
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
