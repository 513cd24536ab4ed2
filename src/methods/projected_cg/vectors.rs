//! The vectors of the iteration on one grid, its operator and its preconditioner.

use std::iter::once;

use super::deflation::Deflation;
use super::preconditioner::Preconditioner;
use super::segments::Segments;
use super::truncation::Truncation;
use crate::contact::State;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::{asleep, keep, rest, wake};
use crate::methods::extension::Extension;
use crate::operator::fft::Real;
use crate::operator::{Needs, Operator, SetUp, Workspace};
use crate::progress::Goal;
use crate::threads::Threads;

/// The additional quantities of an iteration with pressure limits (module `limits`).
#[derive(Default)]
pub(super) struct WithLimits {
    /// The missing part of a prescribed force, as a sum of pressures.
    pub(super) missing: f64,
    /// The change of the approach that restores the missing force.
    pub(super) shift: f64,
    /// The sum of e^2 over C in the last iteration.
    pub(super) residual: f64,
    /// Whether the last step was shortened to the least energy.
    pub(super) went_back: bool,
    /// The p for which u = A p: the pressures before this iteration, minus the deferred corrections.
    pub(super) known: Vec<f64>,
}

impl WithLimits {
    /// Whether the pressures carry the prescribed force, within the tolerance.
    pub(super) fn carries(&self, state: &State, goal: &Goal) -> bool {
        self.missing.abs() <= goal.tolerance * state.p.iter().sum::<f64>()
    }
}

/// What the operator and the preconditioner of an iteration are made of.
#[derive(Clone, Copy)]
pub(super) struct Inputs<'a> {
    pub(super) coefficients: &'a Coefficients,
    /// A factor on the coefficients.
    pub(super) factor: f64,
    /// The operator in double precision, if the window is the whole grid and this operator exists.
    pub(super) whole: Option<&'a Operator<f64>>,
    pub(super) threads: &'a Threads,
}

/// The name of the memory of directions in messages.
const DIRECTIONS: &str = "search directions";

/// Operator, preconditioner and vectors of the iteration on one grid. Module `iteration` has its formulas.
pub struct Iteration<T: Real> {
    pub(super) operator: Operator<T>,
    pub(super) preconditioner: Option<Preconditioner<T>>,
    pub(super) extension: Option<Extension<T, 1>>,
    /// The version of C for which the extension and the preconditioner are set up.
    pub(super) counted: Option<u64>,
    pub(super) workspace: Workspace<T>,
    /// The search direction.
    pub(super) t: Vec<T>,
    /// The product q = A t.
    pub(super) q: Vec<T>,
    /// In turn: the residual r, z = M r, and the product A d of a correction.
    pub(super) z: Vec<T>,
    /// The contact area, as groups of eight elements.
    pub(super) segments: Segments,
    /// The changes of p by truncation, whose displacements u does not contain yet.
    pub(super) truncation: Truncation,
    /// The deflation direction. A step along it takes no product.
    pub(super) deflation: Deflation<T>,
    /// On a line in plane strain: exterior elements with a smaller penetration than this do not enter C.
    pub(super) allowance: f64,
    /// If the approach is prescribed: whether p is scaled to the least energy after each step.
    pub(super) is_scaled: bool,
    /// Used if the scene has pressure limits.
    pub(super) limits: WithLimits,
    pub(super) threads: Threads,
}

impl<T: Real> Iteration<T> {
    /// Sets up the iteration on `grid`. It has no preconditioner if the circulant is not positive definite.
    pub(super) fn new(inputs: Inputs<'_>, grid: &Grid) -> Result<Iteration<T>> {
        let Inputs { coefficients, factor, whole, threads } = inputs;
        let operator = match whole {
            Some(whole) => whole.in_precision(factor)?,
            None => Operator::scaled(coefficients, factor, grid, threads)?,
        };
        let preconditioner = preconditioner(coefficients, factor, grid, threads)?;
        let n = grid.len();
        let threads = &threads.for_a_pass(n);
        let directions = || {
            let mut direction = Vec::new();
            asleep(&mut direction, n, T::nan(), DIRECTIONS, threads).map(|()| direction)
        };
        let mut truncation = Truncation::default();
        truncation.reserve(n)?;
        Ok(Iteration {
            workspace: workspace(&operator, &preconditioner)?,
            operator,
            preconditioner,
            extension: Extension::if_worthwhile(grid, threads)?,
            counted: None,
            t: directions()?,
            q: directions()?,
            z: directions()?,
            segments: Segments::new(grid, threads)?,
            truncation,
            deflation: Deflation::default(),
            allowance: 0.0,
            is_scaled: false,
            limits: WithLimits::default(),
            threads: threads.clone(),
        })
    }

    /// Replaces the coefficients on the same grid. Plans and memory are kept if they fit. After an error the iteration must not be used.
    pub(super) fn renew(&mut self, inputs: Inputs<'_>, grid: &Grid) -> Result<()> {
        let Inputs { coefficients, factor, whole, .. } = inputs;
        let before = self.needs();
        match whole {
            Some(whole) => self.operator = whole.in_precision(factor)?,
            None => self.operator.renew(coefficients, factor, grid, &mut SetUp::default())?,
        }
        // Dropped first, so that the new preconditioner reuses the memory of the old one.
        self.preconditioner = None;
        self.preconditioner = preconditioner(coefficients, factor, grid, self.operator.threads())?;
        self.counted = None;
        if self.needs() != before {
            self.workspace = workspace(&self.operator, &self.preconditioner)?;
        }
        Ok(())
    }

    /// The sizes of workspaces that the operator needs, and the preconditioner if there is one.
    fn needs(&self) -> [Option<Needs>; 2] {
        let inverse = self.preconditioner.as_ref().map(|m| m.inverse().needs());
        [Some(self.operator.needs()), inverse]
    }

    /// Releases the memory of vectors and products until the next [`Iteration::wake`].
    pub fn rest(&mut self) {
        self.workspace.rest();
        self.extension.iter_mut().for_each(Extension::rest);
        [&mut self.t, &mut self.q, &mut self.z].into_iter().for_each(rest);
    }

    /// Makes the vectors usable after [`Iteration::rest`], for a grid of n elements.
    pub fn wake(&mut self, n: usize) {
        self.extension.iter_mut().for_each(Extension::wake);
        let threads = &self.threads;
        [&mut self.t, &mut self.q, &mut self.z].into_iter().for_each(|values| wake(values, n, T::nan(), threads));
    }

    /// Bytes of operator, preconditioner, extension and vectors.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, Preconditioner::bytes);
        let n = self.operator.elements();
        let directions = 3 * n * size_of::<T>();
        let products = self.operator.bytes() + preconditioner + self.workspace.bytes();
        let extension = self.extension.as_ref().map_or(0, Extension::bytes);
        products + extension + directions + self.deflation.bytes()
    }

    /// Sets t = q = 0: the next direction is then not conjugate to an earlier one.
    pub(super) fn forget_directions(&mut self, mx: usize) {
        let clear = |_, t: &mut [T], q: &mut [T]| {
            t.fill(T::zero());
            q.fill(T::zero());
        };
        self.threads.for_each_row_pair((&mut self.t, mx), (&mut self.q, mx), clear);
    }

    /// Computes `u = A p` in the precision T. Overwrites t and q.
    pub fn displace(&mut self, state: &mut State) {
        let (mx, p, t) = (state.grid.mx, &state.p, &mut self.t);
        self.threads.for_each_plain_row(t, mx, |y, t| {
            t.iter_mut().zip(&p[y * mx..]).for_each(|(t, p)| *t = T::of(*p));
        });
        self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
        let q = &self.q;
        self.threads.for_each_plain_row(&mut state.u, mx, |y, u| {
            u.iter_mut().zip(&q[y * mx..]).for_each(|(u, q)| *u = q.to_double());
        });
    }
}

/// Allocates memory for products by the operator and by the preconditioner.
fn workspace<T: Real>(operator: &Operator<T>, preconditioner: &Option<Preconditioner<T>>) -> Result<Workspace<T>> {
    Workspace::new(once(operator).chain(preconditioner.as_ref().map(Preconditioner::inverse)))
}

/// Sets up the preconditioner; None, with a message in the log, if the circulant is not positive definite.
fn preconditioner<T: Real>(
    coefficients: &Coefficients,
    factor: f64,
    grid: &Grid,
    threads: &Threads,
) -> Result<Option<Preconditioner<T>>> {
    let preconditioner = Preconditioner::new(coefficients, factor, grid, threads)?;
    if preconditioner.is_none() {
        log::info!("the circulant of the influence coefficients is not positive: no preconditioner");
    }
    Ok(preconditioner)
}

impl<T: Real> Drop for Iteration<T> {
    fn drop(&mut self) {
        keep([&mut self.t, &mut self.q, &mut self.z]);
        self.deflation.keep();
        self.truncation.keep();
        keep([&mut self.limits.known]);
    }
}
