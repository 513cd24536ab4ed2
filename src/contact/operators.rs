//! The operators of `u = A p` on one grid, in double precision. u is computed on every element, but often few elements carry pressure. Then shorter
//! periods of the FFT suffice:
//!
//! ```text
//! p on elements s..e of a row of m      offsets -(e - 1) .. m - 1 - s occur,    reach = max(e - 1, m - 1 - s)
//! period = 2 reach                      m + (e - s) - 2 for contact in the middle of the grid, 2 m - 2 for any p
//! ```
//!
//! If the contact area covers 0.6 of each side in the middle of the grid, a product takes three quarters of the time that it takes with the full
//! periods, and so does the set-up of its symbol. The choice of the operator depends on p alone. So no bit of a product depends on earlier products.

use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

use super::values::presses;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::{even_periods, Needs, Operator, Reach, SetUp, Workspace};
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// Grids of at most this many elements use direct summation, which needs no set-up. A first call with direct summation takes 0.64 of the time of one
/// with an FFT for one element, and 0.68 for 2 x 2 elements (measured).
const DIRECT_SUMMATION: usize = 4;
/// Grids of fewer elements use one operator for all products. There is little to save, and many small problems with many contact areas would set up
/// many operators.
const SMALLEST_GRID: usize = 128 * 128;
/// A [`Reach`] gets a separate operator if its periods px py are at most this fraction of the full periods.
const LARGEST_PERIODS: f64 = 0.8;

/// What the operators of a grid are made of.
#[derive(Clone, Copy)]
pub(super) struct MadeOf<'a> {
    pub coefficients: &'a Coefficients,
    pub grid: &'a Grid,
    pub threads: &'a Threads,
}

/// The operators of one grid: one for any p, and one for p on a part of the grid. Each is set up when it is first needed.
#[derive(Default)]
pub(super) struct Operators {
    /// The entries of A, row by row, on grids with direct summation.
    matrix: Option<[f64; DIRECT_SUMMATION * DIRECT_SUMMATION]>,
    /// The operator for any p.
    whole: Option<Arc<Operator<f64>>>,
    /// The last operator for p on a part of the grid. The flag is false if the coefficients have changed since its symbol was computed.
    part: Option<(Operator<f64>, bool)>,
    /// The workspace of the last product, and the sizes that it has.
    workspace: Option<(Needs, Workspace<f64>)>,
    /// Memory for the computation of symbols, reused by the next one.
    set_up: SetUp,
}

impl Operators {
    /// Operators of a grid whose operator for any p exists already.
    pub fn with(whole: Arc<Operator<f64>>) -> Operators {
        Operators { whole: Some(whole), ..Operators::default() }
    }

    /// Returns the operator for any p, and sets it up at the first call.
    pub fn whole(&mut self, of: MadeOf<'_>) -> Result<&Arc<Operator<f64>>> {
        let whole = match self.whole.take() {
            Some(whole) => whole,
            None => Arc::new(Operator::new(of.coefficients, of.grid, &of.threads.suited_to(of.grid.len()))?),
        };
        Ok(self.whole.insert(whole))
    }

    /// Returns the entries of A on grids with direct summation, None on larger grids.
    fn matrix(
        &mut self,
        MadeOf { coefficients, grid, .. }: MadeOf<'_>,
    ) -> Option<&[f64; DIRECT_SUMMATION * DIRECT_SUMMATION]> {
        let n = grid.len();
        let fill = || from_fn(|k| if k < n * n { coefficients.entry(grid, k / n, k % n) } else { 0.0 });
        (n <= DIRECT_SUMMATION).then(|| &*self.matrix.get_or_insert_with(fill))
    }

    /// Sets up the operator for any p and its workspace, if all products use it.
    pub fn prepare(&mut self, of: MadeOf<'_>) -> Result<()> {
        if of.is_for_parts() || self.matrix(of).is_some() {
            return Ok(());
        }
        let whole = self.whole(of)?.clone();
        fit(&mut self.workspace, &whole).map(drop)
    }

    /// Replaces the coefficients. An operator that all products need gets its new symbol now, and keeps its plans and its memory if nobody else holds
    /// the operator. Other operators get their symbols when they are needed. After an error, `renew` must succeed before the next product.
    pub fn renew(&mut self, of: MadeOf<'_>) -> Result<()> {
        let is_for_parts = of.is_for_parts();
        self.matrix = None;
        self.part = self.part.take().filter(|_| is_for_parts).map(|(part, _)| (part, false));
        match self.whole.as_mut().and_then(Arc::get_mut) {
            Some(operator) if !is_for_parts => operator.renew(of.coefficients, 1.0, of.grid, &mut self.set_up)?,
            _ => self.whole = None,
        }
        self.prepare(of)
    }

    /// Returns the operator for any p if the product with `p` uses it, otherwise None.
    pub fn whole_if_needed(&mut self, of: MadeOf<'_>, p: &[f64]) -> Result<Option<Arc<Operator<f64>>>> {
        match of.grid.len() > DIRECT_SUMMATION && of.reach_of(p).is_none() {
            true => Ok(Some(self.whole(of)?.clone())),
            false => Ok(None),
        }
    }

    /// Computes `u = A p`.
    pub fn displace(&mut self, of: MadeOf<'_>, p: &[f64], u: &mut [f64]) -> Result<()> {
        if !p.chunks_exact(of.grid.mx).any(presses) {
            u.fill(0.0);
            return Ok(());
        }
        if let Some(matrix) = self.matrix(of) {
            let dot = |row: &[f64]| row.iter().zip(p).map(|(a, p)| a * p).sum();
            u.iter_mut().zip(matrix.chunks_exact(p.len())).for_each(|(u, row)| *u = dot(row));
            return Ok(());
        }
        self.with_operator(of.reach_of(p), of, |operator, workspace| operator.apply(p, u, workspace))
    }

    /// Replaces p by A p.
    pub fn displace_in_place(&mut self, of: MadeOf<'_>, p: &mut [f64]) -> Result<()> {
        if p.len() <= DIRECT_SUMMATION {
            let given = p.to_vec();
            return self.displace(of, &given, p);
        }
        if !p.chunks_exact(of.grid.mx).any(presses) {
            p.fill(0.0);
            return Ok(());
        }
        let reach = of.reach_of(p);
        self.with_operator(reach, of, |operator, workspace| operator.apply_in_place(p, workspace))
    }

    /// Calls `multiply` with the operator of a reach (None: the operator for any p) and a fitting workspace.
    fn with_operator(
        &mut self,
        reach: Option<Reach>,
        of: MadeOf<'_>,
        multiply: impl FnOnce(&Operator<f64>, &mut Workspace<f64>),
    ) -> Result<()> {
        // The workspace is taken out of `self` during the product.
        let mut workspace = self.workspace.take();
        let operator = match reach {
            Some(reach) => self.part(reach, of)?,
            None => self.whole(of)?,
        };
        let fitting = fit(&mut workspace, operator)?;
        multiply(operator, fitting);
        fitting.rest();
        self.workspace = workspace;
        Ok(())
    }

    /// Returns the operator for pressures within a reach. It is set up if the last one has another reach.
    fn part(&mut self, reach: Reach, MadeOf { coefficients, grid, threads }: MadeOf<'_>) -> Result<&Operator<f64>> {
        let part = match self.part.take().filter(|(part, _)| part.reach() == reach) {
            Some((part, true)) => part,
            Some((mut part, false)) => {
                part.renew(coefficients, 1.0, grid, &mut self.set_up)?;
                part
            }
            None => Operator::within(reach, coefficients, grid, &threads.suited_to(grid.len()))?,
        };
        Ok(&self.part.insert((part, true)).0)
    }

    /// Releases the workspace until the next product.
    pub fn rest(&mut self) {
        self.workspace = None;
    }

    /// Bytes of the operator for any p.
    pub fn bytes_of_whole(&self) -> usize {
        self.whole.as_ref().map_or(0, |operator| operator.bytes())
    }

    /// Bytes of both operators and of the workspace.
    pub fn bytes(&self) -> usize {
        let whole = self.bytes_of_whole();
        let part = self.part.as_ref().map_or(0, |(part, _)| part.bytes());
        whole + part + self.workspace.as_ref().map_or(0, |(_, workspace)| workspace.bytes())
    }
}

impl MadeOf<'_> {
    /// Whether p on a part of the grid may get a separate operator: the grid is large enough, and A is Toeplitz with even coefficients, without
    /// periods and tables of rows.
    fn is_for_parts(&self) -> bool {
        let MadeOf { coefficients, grid, .. } = self;
        let is_toeplitz = coefficients.row_tables().is_none() && coefficients.repeats(grid) == (false, false);
        grid.len() >= SMALLEST_GRID && is_toeplitz && coefficients.is_even(grid)
    }

    /// The reach of p if p gets a separate operator, otherwise None.
    fn reach_of(&self, p: &[f64]) -> Option<Reach> {
        if !self.is_for_parts() {
            return None;
        }
        let Grid { mx, my, .. } = *self.grid;
        let Rectangle { x, y } = loaded(p, self.grid, self.threads)?;
        // Few lengths have a fast transform, so neighbouring reaches have the same period. A contact area that moves in small steps keeps its
        // operator over many steps.
        let farthest = |loaded: Range<usize>, m: usize| loaded.end.max(m - loaded.start).max(m.div_ceil(2) + 1) - 1;
        let periods = |x: usize, y: usize| even_periods(self.coefficients, self.grid, (2 * x, 2 * y));
        let ((px, py), (full_x, full_y)) = (periods(farthest(x, mx), farthest(y, my)), periods(mx - 1, my - 1));
        let reach = ((px / 2).min(mx - 1), (py / 2).min(my - 1));
        ((px * py) as f64 <= LARGEST_PERIODS * (full_x * full_y) as f64).then_some(reach)
    }
}

/// Returns a workspace for products by an operator: the existing one if it has the right sizes, otherwise a new one.
fn fit<'a>(
    workspace: &'a mut Option<(Needs, Workspace<f64>)>,
    operator: &Operator<f64>,
) -> Result<&'a mut Workspace<f64>> {
    let needs = operator.needs();
    let fitting = match workspace.take().filter(|(of, _)| *of == needs) {
        Some(fitting) => fitting,
        None => (needs, operator.workspace()?),
    };
    Ok(&mut workspace.insert(fitting).1)
}

/// The smallest rectangle outside of which p is 0. None if p is 0 everywhere.
fn loaded(p: &[f64], grid: &Grid, threads: &Threads) -> Option<Rectangle> {
    Rectangle::around_values(p, grid, threads, presses)
}

#[cfg(test)]
#[path = "../../tests/unit/operators.rs"]
mod tests;
