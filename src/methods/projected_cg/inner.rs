//! The iteration in either precision.

use super::vectors::Operators;
use super::Iteration;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::Real;
use crate::operator::{Operator, Precision};
use crate::threads::Threads;

/// Most kept operators of windows, and most elements of each. They are small compared with the operator of the whole grid.
const MOST_KEPT: usize = 8;
const LARGEST_KEPT: usize = 128 * 128;

/// The iteration in one of the precisions, and operators of other windows, the most recent last. Many small problems use the same few window sizes.
pub(super) enum Inner {
    Single(Iteration<f32>, Vec<(Grid, Operators<f32>)>),
    Double(Iteration<f64>, Vec<(Grid, Operators<f64>)>),
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
    fn operators<T: Real>(&self, grid: &Grid) -> Result<Operators<T>> {
        let MadeOf { coefficients, factor, whole, threads } = *self;
        let operator = match whole {
            Some(operator) => operator.in_precision(factor)?,
            None => Operator::scaled(coefficients, factor, grid, threads)?,
        };
        Operators::new(operator, coefficients, factor, grid, threads)
    }

    fn iteration<T: Real>(&self, grid: &Grid) -> Result<Iteration<T>> {
        Iteration::new(self.operators(grid)?, grid, self.threads)
    }

    /// Moves the iteration from one grid to another.
    fn turn<T: Real>(
        &self,
        iteration: &mut Iteration<T>,
        kept: &mut Vec<(Grid, Operators<T>)>,
        (from, to): (&Grid, &Grid),
    ) -> Result<()> {
        let operators = match kept.iter().position(|(grid, _)| grid == to) {
            Some(i) => kept.remove(i).1,
            None => self.operators(to)?,
        };
        let left = iteration.turn_to(operators, to, self.threads)?;
        if kept.len() == MOST_KEPT {
            kept.remove(0);
        }
        kept.push((*from, left));
        Ok(())
    }
}

impl Inner {
    /// The iteration on `grid`.
    pub fn new(from: MadeOf<'_>, grid: &Grid, precision: Precision) -> Result<Inner> {
        Ok(match precision {
            Precision::Double => Inner::Double(from.iteration(grid)?, Vec::new()),
            Precision::Auto | Precision::Mixed => Inner::Single(from.iteration(grid)?, Vec::new()),
        })
    }

    /// Whether the operators of a window are kept for later windows of the same size.
    pub fn keeps(grid: &Grid) -> bool {
        grid.len() <= LARGEST_KEPT
    }

    /// Moves from one grid to another. After an error the iteration must not be used.
    pub fn turn_to(&mut self, made_of: MadeOf<'_>, grids: (&Grid, &Grid)) -> Result<()> {
        match self {
            Inner::Single(iteration, kept) => made_of.turn(iteration, kept, grids),
            Inner::Double(iteration, kept) => made_of.turn(iteration, kept, grids),
        }
    }

    /// Takes other coefficients on the same grid. After an error the iteration must not be used.
    pub fn renew(&mut self, made_of: MadeOf<'_>, grid: &Grid) -> Result<()> {
        let MadeOf { coefficients, factor, whole, .. } = made_of;
        match self {
            Inner::Single(iteration, kept) => {
                kept.clear();
                iteration.renew(coefficients, factor, grid, whole)
            }
            Inner::Double(iteration, kept) => {
                kept.clear();
                iteration.renew(coefficients, factor, grid, whole)
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match self {
            Inner::Single(inner, kept) => inner.bytes() + kept.iter().map(|(_, kept)| kept.bytes()).sum::<usize>(),
            Inner::Double(inner, kept) => inner.bytes() + kept.iter().map(|(_, kept)| kept.bytes()).sum::<usize>(),
        }
    }
}

/// A call of the iteration in either precision.
macro_rules! in_either {
    ($inner:expr, $iteration:ident => $call:expr) => {
        match $inner {
            Inner::Single($iteration, _) => $call,
            Inner::Double($iteration, _) => $call,
        }
    };
}

pub(super) use in_either;
