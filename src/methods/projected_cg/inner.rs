//! The iteration in single or double precision, chosen when it is set up.

use super::vectors::{Inputs, Iteration};
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::Precision;

/// The iteration, with its search directions in single or in double precision.
pub(super) enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

impl Inner {
    /// Sets up the iteration on `grid`: in double precision if this is asked for, otherwise in single.
    pub fn new(inputs: Inputs<'_>, grid: &Grid, precision: Precision) -> Result<Inner> {
        Ok(match precision {
            Precision::Double => Inner::Double(Iteration::new(inputs, grid)?),
            Precision::Auto | Precision::Mixed => Inner::Single(Iteration::new(inputs, grid)?),
        })
    }

    /// Replaces the coefficients on the same grid. After an error the iteration must not be used.
    pub fn renew(&mut self, inputs: Inputs<'_>, grid: &Grid) -> Result<()> {
        in_either!(self, inner => inner.renew(inputs, grid))
    }

    /// Bytes of the iteration.
    pub fn bytes(&self) -> usize {
        in_either!(self, inner => inner.bytes())
    }
}

/// Calls a method of the iteration, in whichever precision it is.
macro_rules! in_either {
    ($inner:expr, $iteration:ident => $call:expr) => {
        match $inner {
            Inner::Single($iteration) => $call,
            Inner::Double($iteration) => $call,
        }
    };
}

pub(super) use in_either;
