//! `u = A p`: a product by FFT, with the diagonal and the coupling that the coefficients may have.
//!
//! A is block Toeplitz, so it is a part of a block circulant, of the period that [`periods`](super::periods) chooses.
//!
//! The product is fused and pruned: transforms in x of those rows only that hold pressures ([`Rows`]); in y a [`Convolution`], or where
//! A is Toeplitz in x only a product by matrices ([`PerRow`]); transforms back in x, to which a diagonal is added.

use std::iter::once;
use std::ops::Range;

use super::convolution::Convolution;
use super::fft::{room_for_plans, Complex, Real};
use super::lane_rows::LaneRows;
use super::periods::{full_reach, periods, Reach};
use super::row_tables::PerRow;
use super::row_transform::RowTransform;
use super::rows::{Product, Rows};
use super::set_up::{Even, SetUp};
use super::workspace::Workspace;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{Coefficients, Patches};
use crate::memory::{computed, reserve, wake};
use crate::threads::Threads;

/// What memory is for.
const DIAGONAL: &str = "the operator's diagonal";

/// The y direction.
pub(super) enum Columns<T: Real> {
    Convolution(Convolution<T>),
    PerRow(PerRow<T>),
}

/// The operator of one grid.
pub struct Operator<T: Real> {
    pub(super) rows: Rows<T>,
    pub(super) columns: Columns<T>,
    /// Products with pressures that reach farther are wrong. Only even coefficients make use of it.
    reach: Reach,
    /// What A has on its diagonal beyond the coefficients; empty: nothing.
    diagonal: Vec<T>,
    /// Patches between which A is scaled.
    pub(super) coupling: Option<Patches>,
}

impl<T: Real> Operator<T> {
    /// Sets up products on `grid`; the spectrum is computed in double precision for either `T`.
    pub fn new(coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        Operator::scaled(coefficients, 1.0, grid, threads)
    }

    /// Of coefficients times a factor, a power of two: no digit changes.
    pub fn scaled(coefficients: &Coefficients, factor: f64, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        let mut operator = Operator::of_period(grid, periods(coefficients, grid, full_reach(grid)), threads)?;
        operator.renew(coefficients, factor, grid, &mut SetUp::default())?;
        Ok(operator)
    }

    /// For products with pressures within a reach.
    pub fn within(reach: Reach, coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        let mut operator = Operator::of_period(grid, periods(coefficients, grid, reach), threads)?;
        operator.reach = reach;
        operator.renew(coefficients, 1.0, grid, &mut SetUp::default())?;
        Ok(operator)
    }

    /// See [`Reach`].
    pub fn reach(&self) -> Reach {
        self.reach
    }

    /// Plans of a period; the spectrum is still to be computed.
    pub(super) fn of_period(grid: &Grid, (px, py): (usize, usize), threads: &Threads) -> Result<Operator<T>> {
        room_for_plans::<T>(&[px, py])?;
        room_for_plans::<f64>(&[px, py])?;
        Ok(Operator {
            rows: Rows::new(grid.mx, grid.my, px, threads),
            columns: Columns::Convolution(Convolution::new((px, py))),
            reach: full_reach(grid),
            diagonal: Vec::new(),
            coupling: None,
        })
    }

    /// The threads of its products.
    pub fn threads(&self) -> &Threads {
        &self.rows.threads
    }

    /// The periods.
    pub(super) fn periods(&self) -> (usize, usize) {
        let in_y = match &self.columns {
            Columns::Convolution(convolution) => convolution.columns.length(),
            Columns::PerRow(_) => self.rows.my,
        };
        (self.rows.transform.length(), in_y)
    }

    /// Takes other coefficients, times a factor, on the same `grid`: plans and memory are kept where they fit. Not to be used after an
    /// error, before it is renewed again.
    pub fn renew(&mut self, coefficients: &Coefficients, factor: f64, grid: &Grid, set_up: &mut SetUp) -> Result<()> {
        let (px, py) = periods(coefficients, grid, self.reach);
        let threads = self.rows.threads.clone();
        let is_new = px != self.rows.transform.length();
        if is_new {
            self.rows = Rows::new(grid.mx, grid.my, px, &threads);
        }
        if let Some((tables, least)) = coefficients.row_tables() {
            let per_row = PerRow::new(tables, (least, factor), &RowTransform::new(px), &threads)?;
            self.columns = Columns::PerRow(per_row);
        } else {
            match &self.columns {
                Columns::Convolution(convolution) if !is_new && convolution.columns.length() == py => {}
                _ => self.columns = Columns::Convolution(Convolution::new((px, py))),
            }
            self.set_spectrum(coefficients, factor, grid, set_up)?;
        }
        let diagonal = coefficients.diagonal().unwrap_or_default();
        self.diagonal.clear();
        reserve(&mut self.diagonal, diagonal.len(), DIAGONAL)?;
        self.diagonal.extend(diagonal.iter().map(|d| T::of(factor * d)));
        self.coupling = coefficients.patches().cloned();
        Ok(())
    }

    fn set_spectrum(
        &mut self,
        coefficients: &Coefficients,
        factor: f64,
        grid: &Grid,
        set_up: &mut SetUp,
    ) -> Result<()> {
        if coefficients.is_even(grid) {
            let repeats = coefficients.repeats(grid);
            let given = |m: usize, reach: usize, repeats: bool| if repeats { m / 2 + 1 } else { reach + 1 };
            let even = Even {
                given: (given(grid.mx, self.reach.0, repeats.0), given(grid.my, self.reach.1, repeats.1)),
                fill: |ky, row: &mut [f64]| coefficients.fill_row(0, ky, row),
                finish: |value| factor * value,
            };
            return self.set_even(&even, set_up);
        }
        let Operator { rows, columns: Columns::Convolution(convolution), .. } = self else { return Ok(()) };
        convolution.set_uneven((coefficients, factor), grid, rows.transform.length(), &rows.threads, set_up)
    }

    /// Computes a spectrum of even coefficients, of the period that there is.
    pub(super) fn set_even<F, G>(&mut self, even: &Even<F, G>, set_up: &mut SetUp) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let Operator { rows, columns: Columns::Convolution(convolution), .. } = self else { return Ok(()) };
        convolution.set_even(even, rows.transform.length(), &rows.threads, set_up)
    }

    /// A spectrum of even coefficients that is known: `value(x, y)` of bins >= 0.
    pub(super) fn set_values(&mut self, value: impl Fn(usize, usize) -> f64) -> Result<()> {
        let Operator { rows, columns: Columns::Convolution(convolution), .. } = self else { return Ok(()) };
        convolution.set_values((rows.transform.bins(), rows.transform.length()), value)
    }

    /// The same operator in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Operator<S>> {
        let diagonal = computed(self.diagonal.iter().map(|d| S::of(factor * d.to_double())), DIAGONAL)?;
        Ok(Operator {
            rows: Rows::new(self.rows.mx, self.rows.my, self.rows.transform.length(), &self.rows.threads),
            columns: match &self.columns {
                Columns::Convolution(convolution) => {
                    let px = self.rows.transform.length();
                    Columns::Convolution(convolution.in_precision(px, factor, &self.rows.threads)?)
                }
                Columns::PerRow(per_row) => Columns::PerRow(per_row.in_precision(factor)?),
            },
            reach: self.reach,
            diagonal,
            coupling: self.coupling.clone(),
        })
    }

    /// Memory for products by this operator.
    pub fn workspace(&self) -> Result<Workspace<T>> {
        Workspace::new(once(self))
    }

    /// Elements of the grid.
    pub fn elements(&self) -> usize {
        self.rows.mx * self.rows.my
    }

    /// Whether A has more on its diagonal than the coefficients.
    pub fn has_diagonal(&self) -> bool {
        !self.diagonal.is_empty()
    }

    /// Bytes held by the operator.
    pub fn bytes(&self) -> usize {
        let columns = match &self.columns {
            Columns::Convolution(convolution) => convolution.bytes(),
            Columns::PerRow(per_row) => per_row.bytes(),
        };
        columns + size_of_val(&self.diagonal[..])
    }

    /// `u = A p`.
    pub fn apply(&self, p: &[T], u: &mut [T], workspace: &mut Workspace<T>) {
        let n = self.rows.mx * self.rows.my;
        assert!(p.len() == n && u.len() == n);
        let Workspace { product, masked, .. } = workspace;
        match &self.coupling {
            None => self.without_coupling(p, u, product),
            Some(coupling) => apply_coupled(coupling, p, u, masked, |p, u| self.without_coupling(p, u, product)),
        }
    }

    /// `p = A p`.
    pub fn apply_in_place(&self, p: &mut [T], workspace: &mut Workspace<T>) {
        assert!(p.len() == self.rows.mx * self.rows.my);
        let Workspace { product, masked, given, .. } = workspace;
        if let Some(coupling) = &self.coupling {
            given.copy_from_slice(p);
            return apply_coupled(coupling, given, p, masked, |p, u| self.without_coupling(p, u, product));
        }
        let loaded = self.forward(p, product);
        self.convolve(loaded, product);
        if self.diagonal.is_empty() {
            return self.rows.back(p, product, self.lanes());
        }
        self.rows.back_with(p, product, self.lanes(), |first, p, values| {
            for ((p, value), d) in p.iter_mut().zip(values).zip(&self.diagonal[first..]) {
                *p = *value + *d * *p;
            }
        });
    }

    fn without_coupling(&self, p: &[T], u: &mut [T], product: &mut Product<T>) {
        let loaded = self.forward(p, product);
        self.convolve(loaded, product);
        if self.diagonal.is_empty() {
            return self.rows.back(u, product, self.lanes());
        }
        self.rows.back_with(u, product, self.lanes(), |first, u, values| {
            for (((u, value), d), p) in u.iter_mut().zip(values).zip(&self.diagonal[first..]).zip(&p[first..]) {
                *u = *value + *d * *p;
            }
        });
    }

    /// Transforms the rows that hold pressures; returns which.
    fn forward(&self, p: &[T], product: &mut Product<T>) -> Range<usize> {
        let n = product.bins.len().max(self.bins());
        wake(&mut product.bins, n, Complex::new(T::nan(), T::nan()), self.threads());
        self.rows.forward(p, product, self.lanes())
    }

    /// The transforms of rows in the places of vectors; None: rows go by themselves.
    pub(super) fn lanes(&self) -> Option<&LaneRows<T>> {
        match &self.columns {
            Columns::Convolution(convolution) => convolution.lanes(),
            Columns::PerRow(_) => None,
        }
    }

    fn convolve(&self, loaded: Range<usize>, product: &mut Product<T>) {
        match &self.columns {
            Columns::Convolution(convolution) => convolution.apply(&self.rows, loaded, product),
            Columns::PerRow(per_row) => per_row.apply(&self.rows, loaded, product),
        }
    }
}

/// `u = A p` with patches, by products `multiply(p, u)` without factors: one for each patch,
///
/// ```text
/// u on patch a = A (sum over patches b of F(a, b) p on b)
/// ```
fn apply_coupled<T: Real>(
    patches: &Patches,
    p: &[T],
    u: &mut [T],
    [scaled, product]: &mut [Vec<T>; 2],
    mut multiply: impl FnMut(&[T], &mut [T]),
) {
    for a in 0..patches.count {
        for ((scaled, p), &b) in scaled.iter_mut().zip(p).zip(&*patches.patch) {
            *scaled = *p * T::of(patches.factor(a, b.into()));
        }
        multiply(scaled, product);
        for ((u, product), &b) in u.iter_mut().zip(&*product).zip(&*patches.patch) {
            if usize::from(b) == a {
                *u = *product;
            }
        }
    }
}
