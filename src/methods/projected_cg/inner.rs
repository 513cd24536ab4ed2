//! The iteration in either precision.

use super::vectors::{Inputs, Iteration};
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::Precision;

/// The iteration in one of the precisions.
pub(super) enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

impl Inner {
    /// The iteration on `grid`.
    pub fn new(inputs: Inputs<'_>, grid: &Grid, precision: Precision) -> Result<Inner> {
        Ok(match precision {
            Precision::Double => Inner::Double(Iteration::new(inputs, grid)?),
            Precision::Auto | Precision::Mixed => Inner::Single(Iteration::new(inputs, grid)?),
        })
    }

    /// Takes other coefficients on the same grid. After an error the iteration must not be used.
    pub fn renew(&mut self, inputs: Inputs<'_>, grid: &Grid) -> Result<()> {
        in_either!(self, inner => inner.renew(inputs, grid))
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
