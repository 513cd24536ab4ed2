//! The operator `u = A p`: a product by FFT, with the diagonal (of a layer) and the coupling between patches, if the coefficients have them.
//!
//! A is block Toeplitz, so it is a part of a block circulant, whose period module [`periods`](super::periods) chooses. The crate toeplitz multiplies
//! by the circulant. The diagonal is added while the product is transformed back.

use std::iter::once;

use toeplitz::fft::Real;
use toeplitz::{Even, Memory, OfRows, Product, SetUp};

use super::periods::{full_reach, periods, Reach};
use super::workspace::{Needs, Workspace};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{Coefficients, Patches};
use crate::memory::{computed, reserve};
use crate::threads::Threads;

/// The name of the memory of the diagonal in messages.
const DIAGONAL: &str = "the operator's diagonal";

/// The operator A of one grid, with the precision T for products.
pub struct Operator<T: Real> {
    product: Product<T>,
    /// Products are right for pressures within this reach. It is smaller than the grid only if the coefficients are even.
    reach: Reach,
    /// The diagonal that is added to the block Toeplitz matrix. Empty if there is none.
    diagonal: Vec<T>,
    /// The patches, with the factors on A between them.
    coupling: Option<Patches>,
}

impl<T: Real> Operator<T> {
    /// Sets up the operator on `grid` for any p. The symbol is computed in double precision, whatever T is.
    pub fn new(coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        Operator::scaled(coefficients, 1.0, grid, threads)
    }

    /// Sets up the operator of the coefficients times `factor`. A power of two changes no digit.
    pub fn scaled(coefficients: &Coefficients, factor: f64, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        let mut operator = Operator::of_period(grid, periods(coefficients, grid, full_reach(grid)), threads)?;
        operator.renew(coefficients, factor, grid, &mut SetUp::default())?;
        Ok(operator)
    }

    /// Sets up the operator for pressures within a reach.
    pub fn within(reach: Reach, coefficients: &Coefficients, grid: &Grid, threads: &Threads) -> Result<Operator<T>> {
        let mut operator = Operator::of_period(grid, periods(coefficients, grid, reach), threads)?;
        operator.reach = reach;
        operator.renew(coefficients, 1.0, grid, &mut SetUp::default())?;
        Ok(operator)
    }

    /// The reach of the pressures for which products are right.
    pub fn reach(&self) -> Reach {
        self.reach
    }

    /// An operator with the given period, whose symbol is still to be computed.
    fn of_period(grid: &Grid, period: (usize, usize), threads: &Threads) -> Result<Operator<T>> {
        Ok(Operator::by(Product::new((grid.mx, grid.my), period, threads)?, grid))
    }

    /// The operator that multiplies by `product`, without a diagonal and a coupling.
    pub(super) fn by(product: Product<T>, grid: &Grid) -> Operator<T> {
        Operator { product, reach: full_reach(grid), diagonal: Vec::new(), coupling: None }
    }

    /// The threads of the products.
    pub fn threads(&self) -> &Threads {
        self.product.threads()
    }

    /// Replaces the coefficients by others, times a factor, on the same `grid`. Plans and memory are kept if they fit. After an error, `renew` must
    /// succeed before the operator is used.
    pub fn renew(&mut self, coefficients: &Coefficients, factor: f64, grid: &Grid, set_up: &mut SetUp) -> Result<()> {
        let (period, threads) = (periods(coefficients, grid, self.reach), self.threads().clone());
        let elements = (grid.mx, grid.my);
        if let Some((tables, least)) = coefficients.row_tables() {
            let fill = |jy: usize, iy: usize, row: &mut [f64]| {
                tables.fill(jy, iy, row);
                if jy == iy {
                    row[0] += least;
                }
            };
            let of = OfRows { are_even: tables.is_even_in_x(), fill, factor };
            self.product = Product::per_row(elements, &of, period.0, &threads)?;
        } else {
            if self.product.period() != Some(period) {
                self.product = Product::new(elements, period, &threads)?;
            }
            set_symbol(&mut self.product, (coefficients, factor), (grid, self.reach), set_up)?;
        }
        let diagonal = coefficients.diagonal().unwrap_or_default();
        self.diagonal.clear();
        reserve(&mut self.diagonal, diagonal.len(), DIAGONAL)?;
        self.diagonal.extend(diagonal.iter().map(|d| T::of(factor * d)));
        self.coupling = coefficients.patches().cloned();
        Ok(())
    }

    /// Returns the same operator in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Operator<S>> {
        let diagonal = computed(self.diagonal.iter().map(|d| S::of(factor * d.to_double())), DIAGONAL)?;
        let (product, coupling) = (self.product.in_precision(factor)?, self.coupling.clone());
        Ok(Operator { product, reach: self.reach, diagonal, coupling })
    }

    /// Allocates memory for products by this operator.
    pub fn workspace(&self) -> Result<Workspace<T>> {
        Workspace::new(once(self))
    }

    /// The number of elements of the grid.
    pub fn elements(&self) -> usize {
        let (mx, my) = self.product.grid();
        mx * my
    }

    /// Whether a diagonal is added to the block Toeplitz matrix.
    pub fn has_diagonal(&self) -> bool {
        !self.diagonal.is_empty()
    }

    /// Bytes of the symbol and of the diagonal.
    pub fn bytes(&self) -> usize {
        self.product.bytes() + size_of_val(&self.diagonal[..])
    }

    /// The sizes of the memory that products need. Operators with the same needs can share a workspace.
    pub fn needs(&self) -> Needs {
        let masked = self.coupling.as_ref().map_or(0, |_| self.elements());
        Needs { room: self.product.room(), masked }
    }

    /// Computes `u = A p`.
    pub fn apply(&self, p: &[T], u: &mut [T], workspace: &mut Workspace<T>) {
        let Workspace { memory, masked, .. } = workspace;
        if let Some(patches) = &self.coupling {
            return self.apply_coupled(patches, p, u, (memory, masked));
        }
        self.product.forward(p, memory);
        self.back(p, u, memory);
    }

    /// Replaces p by A p.
    pub fn apply_in_place(&self, p: &mut [T], workspace: &mut Workspace<T>) {
        let Workspace { memory, masked, given } = workspace;
        if let Some(patches) = &self.coupling {
            given.copy_from_slice(p);
            return self.apply_coupled(patches, given, p, (memory, masked));
        }
        self.product.forward(p, memory);
        if self.diagonal.is_empty() {
            return self.product.back(p, memory);
        }
        self.product.back_with(p, memory, |first, p, values| {
            for ((p, value), d) in p.iter_mut().zip(values).zip(&self.diagonal[first..]) {
                *p = *value + *d * *p;
            }
        });
    }

    /// Transforms a product back to u, and adds the diagonal times p.
    fn back(&self, p: &[T], u: &mut [T], memory: &mut Memory<T>) {
        if self.diagonal.is_empty() {
            return self.product.back(u, memory);
        }
        self.product.back_with(u, memory, |first, u, values| {
            for (((u, value), d), p) in u.iter_mut().zip(values).zip(&self.diagonal[first..]).zip(&p[first..]) {
                *u = *value + *d * *p;
            }
        });
    }

    /// Computes `u = A p` with patches, by one product without factors for each patch a:
    ///
    /// ```text
    /// u on patch a = A (sum over patches b of F(a, b) p on b)
    /// ```
    fn apply_coupled(
        &self,
        patches: &Patches,
        p: &[T],
        u: &mut [T],
        (memory, [scaled, product]): (&mut Memory<T>, &mut [Vec<T>; 2]),
    ) {
        for a in 0..patches.count {
            for ((scaled, p), &b) in scaled.iter_mut().zip(p).zip(&*patches.patch) {
                *scaled = *p * T::of(patches.factor(a, b.into()));
            }
            self.product.forward(scaled, memory);
            self.back(scaled, product, memory);
            for ((u, product), &b) in u.iter_mut().zip(&*product).zip(&*patches.patch) {
                if usize::from(b) == a {
                    *u = *product;
                }
            }
        }
    }
}

/// Coefficients and their grid, as the crate toeplitz reads them.
struct OnGrid<'a>(&'a Coefficients, &'a Grid);

impl toeplitz::Coefficients for OnGrid<'_> {
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.0.fill_row(kx, ky, out);
    }

    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.0.fill_symmetric_row(kx, ky, out);
    }

    fn are_symmetric(&self) -> bool {
        self.0.is_symmetric(self.1)
    }
}

/// Computes the symbol of the coefficients times a factor, for pressures within a reach.
fn set_symbol<T: Real>(
    product: &mut Product<T>,
    (coefficients, factor): (&Coefficients, f64),
    (grid, reach): (&Grid, Reach),
    set_up: &mut SetUp,
) -> Result<()> {
    if !coefficients.is_even(grid) {
        return Ok(product.set_uneven((&OnGrid(coefficients, grid), factor), set_up)?);
    }
    let repeats = coefficients.repeats(grid);
    let given = |m: usize, reach: usize, repeats: bool| if repeats { m / 2 + 1 } else { reach + 1 };
    let even = Even {
        given: (given(grid.mx, reach.0, repeats.0), given(grid.my, reach.1, repeats.1)),
        fill: |ky, row: &mut [f64]| coefficients.fill_row(0, ky, row),
        finish: |value| factor * value,
    };
    Ok(product.set_even(&even, set_up)?)
}

impl<T: Real> Workspace<T> {
    /// Allocates memory for products by any of these operators.
    pub fn new<'a>(operators: impl Iterator<Item = &'a Operator<T>> + Clone) -> Result<Workspace<T>>
    where
        T: 'a,
    {
        let needs = operators.clone().map(Operator::needs).fold(Needs::default(), Needs::max);
        Workspace::of(needs, operators.map(Operator::threads).next().unwrap_or(&Threads::One))
    }
}
