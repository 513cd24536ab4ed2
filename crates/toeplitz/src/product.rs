//! `u = A p` on a grid: transforms in x of the rows with values, the y direction, and transforms back in x.
//!
//! In y, A is Toeplitz as well, or there is a matrix for each bin in x.

use par::threads::Threads;
use par::Result;

use crate::coefficients::{Coefficients, Even};
use crate::convolution::Convolution;
use crate::fft::lane_rows::LaneRows;
use crate::lengths::{good_length, have_stages, length_for_stages};
use crate::passes::Real;
use crate::row_matrices::{OfRows, RowMatrices};
use crate::rows::Rows;
use crate::set_up::SetUp;
use crate::workspace::{Memory, Room};

/// Products by one block Toeplitz matrix on a grid of `mx * my` elements, or by one that is Toeplitz in x only. Arrays are `[my][mx]`, x fastest.
pub struct Product<T: Real> {
    rows: Rows<T>,
    columns: Columns<T>,
}

/// The transform in y.
enum Columns<T: Real> {
    Toeplitz(Convolution<T>),
    PerRow(RowMatrices<T>),
}

impl<T: Real> Product<T> {
    /// Makes the plans for a period that is at least as long as the grid in either direction. The symbol is not set. Fails if memory is short.
    pub fn new(grid: (usize, usize), period: (usize, usize), threads: &Threads) -> Result<Product<T>> {
        let columns = Columns::Toeplitz(Convolution::new(period)?);
        Ok(Product { rows: Rows::new(grid, period.0, threads)?, columns })
    }

    /// A product by coefficients of each loaded row and each row, with a period in x that keeps the offsets apart.
    pub fn per_row<F: Fn(usize, usize, &mut [f64]) + Sync + Send>(
        grid: (usize, usize),
        of: &OfRows<F>,
        px: usize,
        threads: &Threads,
    ) -> Result<Product<T>> {
        let columns = Columns::PerRow(RowMatrices::new(grid, of, px, threads)?);
        Ok(Product { rows: Rows::new(grid, px, threads)?, columns })
    }

    /// A complete product of even coefficients, `c(kx, ky) = c(-kx, ky) = c(kx, -ky)`, given at offsets >= 0.
    pub fn even(
        (mx, my): (usize, usize),
        c: impl Fn(usize, usize) -> f64 + Sync + Send,
        threads: &Threads,
    ) -> Result<Product<T>> {
        let mut product = Product::new((mx, my), even_period((mx, my)), threads)?;
        let fill =
            |ky: i64, row: &mut [f64]| row.iter_mut().enumerate().for_each(|(kx, value)| *value = c(kx, ky as usize));
        product.set_even(&Even { given: (mx, my), fill, finish: |value| value }, &mut SetUp::default())?;
        Ok(product)
    }

    /// A complete product of any coefficients.
    pub fn uneven(grid: (usize, usize), coefficients: &impl Coefficients, threads: &Threads) -> Result<Product<T>> {
        let period = (good_length(2 * grid.0 - 1), good_length(2 * grid.1 - 1));
        let mut product = Product::new(grid, period, threads)?;
        product.set_uneven((coefficients, 1.0), &mut SetUp::default())?;
        Ok(product)
    }

    /// Elements in x and y.
    pub fn grid(&self) -> (usize, usize) {
        (self.rows.mx, self.rows.my)
    }

    /// The periods in x and y; None if A is Toeplitz in x only.
    pub fn period(&self) -> Option<(usize, usize)> {
        match &self.columns {
            Columns::Toeplitz(columns) => Some((self.rows.transform.length(), columns.columns.length())),
            Columns::PerRow(_) => None,
        }
    }

    /// The threads of the products.
    pub fn threads(&self) -> &Threads {
        &self.rows.threads
    }

    /// Bytes of the symbol.
    pub fn bytes(&self) -> usize {
        match &self.columns {
            Columns::Toeplitz(columns) => columns.bytes(),
            Columns::PerRow(matrices) => matrices.bytes(),
        }
    }

    /// The sizes of the products' memory, which do not depend on the coefficients.
    pub fn room(&self) -> Room {
        match &self.columns {
            Columns::Toeplitz(columns) => {
                let y = &columns.columns;
                self.rows.room_with(columns.lanes_of_even_symbol(), y.length(), y.scratch_length())
            }
            Columns::PerRow(matrices) => matrices.room(&self.rows),
        }
    }

    /// Memory for the products.
    pub fn memory(&self) -> Result<Memory<T>> {
        Memory::new(self.room(), self.threads())
    }

    /// Computes the symbol of even coefficients. After an error the product must be set again before use.
    pub fn set_even<F, G>(&mut self, even: &Even<F, G>, set_up: &mut SetUp) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let px = self.rows.transform.length();
        toeplitz(&mut self.columns).set_even(even, px, &self.rows.threads, set_up)
    }

    /// Computes the symbol of any coefficients, times a factor.
    pub fn set_uneven(&mut self, by: (&impl Coefficients, f64), set_up: &mut SetUp) -> Result<()> {
        let (grid, px) = (self.grid(), self.rows.transform.length());
        toeplitz(&mut self.columns).set_general(by, grid, px, &self.rows.threads, set_up)
    }

    /// Takes a known even symbol `value(x, y)` at the bins `0 ..= px/2`, `0 ..= py/2`, without the normalisation `1/(px py)`.
    pub fn set_values(&mut self, value: impl Fn(usize, usize) -> f64) -> Result<()> {
        toeplitz(&mut self.columns).set_values((self.rows.transform.bins(), self.rows.transform.length()), value)
    }

    /// The product in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Product<S>> {
        let (px, threads) = (self.rows.transform.length(), &self.rows.threads);
        let columns = match &self.columns {
            Columns::Toeplitz(columns) => Columns::Toeplitz(columns.in_precision(px, factor, threads)?),
            Columns::PerRow(matrices) => Columns::PerRow(matrices.in_precision(factor)?),
        };
        Ok(Product { rows: Rows::new(self.grid(), px, threads)?, columns })
    }

    /// `u = A p`.
    pub fn apply(&self, p: &[T], u: &mut [T], memory: &mut Memory<T>) {
        self.forward(p, memory);
        self.back(u, memory);
    }

    /// The first half of a product: A p, transformed in x.
    pub fn forward(&self, p: &[T], memory: &mut Memory<T>) {
        assert_eq!(p.len(), self.rows.mx * self.rows.my, "values of another grid");
        memory.wake(self.room().bins, self.threads());
        let loaded = self.rows.forward(p, memory, self.lanes());
        match &self.columns {
            Columns::Toeplitz(columns) => columns.apply(&self.rows, loaded, memory),
            Columns::PerRow(matrices) => matrices.apply(&self.rows, loaded, memory),
        }
    }

    /// The second half of a product: u.
    pub fn back(&self, u: &mut [T], memory: &mut Memory<T>) {
        assert_eq!(u.len(), self.rows.mx * self.rows.my, "values of another grid");
        self.rows.back(u, memory, self.lanes());
    }

    /// The second half of a product: `write(first element, values of u, values of A p)` gets some rows at a time.
    pub fn back_with(&self, u: &mut [T], memory: &mut Memory<T>, write: impl Fn(usize, &mut [T], &[T]) + Sync + Send) {
        assert_eq!(u.len(), self.rows.mx * self.rows.my, "values of another grid");
        self.rows.back_with(u, memory, self.lanes(), write);
    }

    fn lanes(&self) -> Option<&LaneRows<T>> {
        match &self.columns {
            Columns::Toeplitz(columns) => columns.lanes(),
            Columns::PerRow(_) => None,
        }
    }
}

/// The convolution, whose symbol is to be set.
fn toeplitz<T: Real>(columns: &mut Columns<T>) -> &mut Convolution<T> {
    match columns {
        Columns::Toeplitz(columns) => columns,
        Columns::PerRow(_) => unreachable!("a symbol of a product that has none"),
    }
}

/// The shortest fast period of even coefficients, for which offsets `m - 1` and `-(m - 1)` coincide.
pub fn even_period((mx, my): (usize, usize)) -> (usize, usize) {
    let of = |length: fn(usize) -> usize| (length(2 * mx - 2), length(2 * my - 2));
    let by_stages = of(length_for_stages);
    if have_stages(by_stages) {
        by_stages
    } else {
        of(good_length)
    }
}
