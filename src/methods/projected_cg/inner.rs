//! The iteration in either precision.

use super::{Cycle, End, Iteration};
use crate::contact::{AdmissibleSet, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::Real;
use crate::operator::{Operator, Precision};
use crate::progress::Goal;
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

    /// See [`Iteration::renew`].
    pub fn renew(
        &mut self,
        influence: &Coefficients,
        factor: f64,
        grid: &Grid,
        operator: Option<&Operator<f64>>,
    ) -> Result<()> {
        match self {
            Inner::Single(iteration) => iteration.renew(influence, factor, grid, operator),
            Inner::Double(iteration) => iteration.renew(influence, factor, grid, operator),
        }
    }

    pub fn correct<S: AdmissibleSet>(&mut self, state: &mut State, set: S) {
        match self {
            Inner::Single(iteration) => iteration.correct(state, set),
            Inner::Double(iteration) => iteration.correct(state, set),
        }
    }

    pub fn displace(&mut self, state: &mut State) {
        match self {
            Inner::Single(iteration) => iteration.displace(state),
            Inner::Double(iteration) => iteration.displace(state),
        }
    }

    pub fn run<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        goal: &Goal,
        after_cycle: impl FnMut(&Cycle) -> bool,
    ) -> End {
        match self {
            Inner::Single(iteration) => iteration.run(state, set, goal, after_cycle),
            Inner::Double(iteration) => iteration.run(state, set, goal, after_cycle),
        }
    }

    pub fn reserve_for_limits(&mut self) -> Result<()> {
        match self {
            Inner::Single(iteration) => iteration.reserve_for_limits(),
            Inner::Double(iteration) => iteration.reserve_for_limits(),
        }
    }

    pub fn rest(&mut self) {
        match self {
            Inner::Single(iteration) => iteration.rest(),
            Inner::Double(iteration) => iteration.rest(),
        }
    }

    pub fn wake(&mut self, n: usize) {
        match self {
            Inner::Single(iteration) => iteration.wake(n),
            Inner::Double(iteration) => iteration.wake(n),
        }
    }

    pub fn bytes(&self) -> usize {
        match self {
            Inner::Single(iteration) => iteration.bytes(),
            Inner::Double(iteration) => iteration.bytes(),
        }
    }
}
