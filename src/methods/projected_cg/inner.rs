//! The iteration in either precision.

use super::Iteration;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::Real;
use crate::operator::{Operator, Precision};
use crate::threads::Threads;

/// The iteration in the precision asked for.
pub(super) enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

impl Inner {
    /// On `grid`, of which `operator` is the one in double precision if that is known. Coefficients are taken times `factor`.
    pub fn new(
        influence: &Coefficients,
        grid: &Grid,
        operator: Option<&Operator<f64>>,
        factor: f64,
        precision: Precision,
        threads: &Threads,
    ) -> Result<Inner> {
        fn iteration<T: Real>(
            influence: &Coefficients,
            grid: &Grid,
            operator: Option<&Operator<f64>>,
            factor: f64,
            threads: &Threads,
        ) -> Result<Iteration<T>> {
            let operator = match operator {
                Some(operator) => operator.in_precision(factor)?,
                None => Operator::scaled(influence, factor, grid, threads)?,
            };
            Iteration::new(operator, influence, factor, grid, threads)
        }
        let threads = &threads.suited_to(grid.len());
        Ok(match precision {
            Precision::Double => Inner::Double(iteration(influence, grid, operator, factor, threads)?),
            Precision::Auto | Precision::Mixed => Inner::Single(iteration(influence, grid, operator, factor, threads)?),
        })
    }
}

/// The same call of the iteration in either precision.
macro_rules! in_either {
    ($inner:expr, $iteration:ident => $call:expr) => {
        match $inner {
            Inner::Single($iteration) => $call,
            Inner::Double($iteration) => $call,
        }
    };
}

pub(super) use in_either;
