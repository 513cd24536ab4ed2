//! The iteration in either precision.

use super::Iteration;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::Real;
use crate::operator::{Operator, Precision};
use crate::threads::Threads;

/// The iteration in one of the precisions.
pub(super) enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

/// The inputs of the operators of a window: the coefficients, a factor on them, and the operator in double precision if the window is the whole grid.
#[derive(Clone, Copy)]
pub(super) struct MadeOf<'a> {
    pub(super) coefficients: &'a Coefficients,
    pub(super) factor: f64,
    pub(super) whole: Option<&'a Operator<f64>>,
    pub(super) threads: &'a Threads,
}

impl MadeOf<'_> {
    fn iteration<T: Real>(&self, grid: &Grid) -> Result<Iteration<T>> {
        let MadeOf { coefficients, factor, whole, threads } = *self;
        let operator = match whole {
            Some(operator) => operator.in_precision(factor)?,
            None => Operator::scaled(coefficients, factor, grid, threads)?,
        };
        Iteration::new(operator, (coefficients, factor), grid, threads)
    }
}

impl Inner {
    /// The iteration on `grid`.
    pub fn new(from: MadeOf<'_>, grid: &Grid, precision: Precision) -> Result<Inner> {
        Ok(match precision {
            Precision::Double => Inner::Double(from.iteration(grid)?),
            Precision::Auto | Precision::Mixed => Inner::Single(from.iteration(grid)?),
        })
    }

    /// Takes other coefficients on the same grid. After an error the iteration must not be used.
    pub fn renew(&mut self, made_of: MadeOf<'_>, grid: &Grid) -> Result<()> {
        let MadeOf { coefficients, factor, whole, .. } = made_of;
        in_either!(self, inner => inner.renew(coefficients, factor, grid, whole))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        in_either!(self, inner => inner.bytes())
    }
}

/// A call of the iteration in either precision.
macro_rules! in_either {
    ($inner:expr, $iteration:ident => $call:expr) => {
        match $inner {
            Inner::Single($iteration) => $call,
            Inner::Double($iteration) => $call,
        }
    };
}

pub(super) use in_either;
