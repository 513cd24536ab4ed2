//! Products `u = A p` on a grid. A is Toeplitz in x, so a product transforms the rows with values in x, multiplies each bin in x by a matrix in y,
//! and transforms all rows back.
//!
//! If A is Toeplitz in y as well, the matrix of a bin is a convolution ([`convolution`](crate::convolution)). Otherwise the matrix is stored
//! ([`row_matrices`](crate::row_matrices)).

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

/// Products by one matrix A on a grid of `mx * my` elements. A is block Toeplitz, or Toeplitz in x only. Arrays are `[my][mx]`, x fastest.
pub struct Product<T: Real> {
    rows: Rows<T>,
    columns: Columns<T>,
}

/// How a product multiplies the bins in x, which are columns of values in y.
enum Columns<T: Real> {
    /// A is Toeplitz in y: by a transform in y.
    Toeplitz(Convolution<T>),
    /// A is Toeplitz in x only: by one matrix for each bin in x.
    PerRow(RowMatrices<T>),
}

impl<T: Real> Product<T> {
    /// Makes the plans for a period, which is at least as long as the grid in either direction. The symbol is not set: call a `set_` function before
    /// a product. Fails if memory is short.
    pub fn new(grid: (usize, usize), period: (usize, usize), threads: &Threads) -> Result<Product<T>> {
        let columns = Columns::Toeplitz(Convolution::new(period)?);
        Ok(Product { rows: Rows::new(grid, period.0, threads)?, columns })
    }

    /// The product by a matrix that is Toeplitz in x only: each pair of a loaded row and a displaced row has its coefficients. The period `px` in x
    /// keeps all offsets apart.
    pub fn per_row<F: Fn(usize, usize, &mut [f64]) + Sync + Send>(
        grid: (usize, usize),
        of: &OfRows<F>,
        px: usize,
        threads: &Threads,
    ) -> Result<Product<T>> {
        let columns = Columns::PerRow(RowMatrices::new(grid, of, px, threads)?);
        Ok(Product { rows: Rows::new(grid, px, threads)?, columns })
    }

    /// The product by even coefficients, `c(kx, ky) = c(-kx, ky) = c(kx, -ky)`, given at offsets >= 0. Its symbol is set.
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

    /// The product by any coefficients. Its symbol is set.
    pub fn uneven(grid: (usize, usize), coefficients: &impl Coefficients, threads: &Threads) -> Result<Product<T>> {
        let period = (good_length(2 * grid.0 - 1), good_length(2 * grid.1 - 1));
        let mut product = Product::new(grid, period, threads)?;
        product.set_uneven((coefficients, 1.0), &mut SetUp::default())?;
        Ok(product)
    }

    /// The numbers of elements in x and y.
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

    /// The threads that the products use.
    pub fn threads(&self) -> &Threads {
        &self.rows.threads
    }

    /// The bytes of the symbol, or of the matrices of the bins.
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

    /// Allocates the memory of products.
    pub fn memory(&self) -> Result<Memory<T>> {
        Memory::new(self.room(), self.threads())
    }

    /// Computes the symbol of even coefficients. After an error, set the symbol again before the next product.
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

    /// Sets an even symbol from its values: `value(bin_x, bin_y)` at the bins `0 ..= px/2`, `0 ..= py/2`, without the normalisation `1/(px py)`.
    pub fn set_values(&mut self, value: impl Fn(usize, usize) -> f64) -> Result<()> {
        toeplitz(&mut self.columns).set_values((self.rows.transform.bins(), self.rows.transform.length()), value)
    }

    /// The product in another precision, by A times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Product<S>> {
        let (px, threads) = (self.rows.transform.length(), &self.rows.threads);
        let columns = match &self.columns {
            Columns::Toeplitz(columns) => Columns::Toeplitz(columns.in_precision(px, factor, threads)?),
            Columns::PerRow(matrices) => Columns::PerRow(matrices.in_precision(factor)?),
        };
        Ok(Product { rows: Rows::new(self.grid(), px, threads)?, columns })
    }

    /// Computes `u = A p`.
    pub fn apply(&self, p: &[T], u: &mut [T], memory: &mut Memory<T>) {
        self.forward(p, memory);
        self.back(u, memory);
    }

    /// The first half of a product: computes the bins in x of A p, and leaves them in `memory`.
    pub fn forward(&self, p: &[T], memory: &mut Memory<T>) {
        assert_eq!(p.len(), self.rows.mx * self.rows.my, "values of another grid");
        memory.wake(self.room().bins, self.threads());
        let loaded = self.rows.forward(p, memory, self.lanes());
        match &self.columns {
            Columns::Toeplitz(columns) => columns.apply(&self.rows, loaded, memory),
            Columns::PerRow(matrices) => matrices.apply(&self.rows, loaded, memory),
        }
    }

    /// The second half of a product: transforms the bins in `memory` back to u.
    pub fn back(&self, u: &mut [T], memory: &mut Memory<T>) {
        assert_eq!(u.len(), self.rows.mx * self.rows.my, "values of another grid");
        self.rows.back(u, memory, self.lanes());
    }

    /// The second half of a product, for a caller that writes u. Calls `write(first element, values of u, values of A p)` for each group of rows: the
    /// index of the group's first element, the group's part of `u`, and the values of A p there.
    pub fn back_with(&self, u: &mut [T], memory: &mut Memory<T>, write: impl Fn(usize, &mut [T], &[T]) + Sync + Send) {
        assert_eq!(u.len(), self.rows.mx * self.rows.my, "values of another grid");
        self.rows.back_with(u, memory, self.lanes(), write);
    }

    /// The transforms of rows in lanes, if the product uses lanes.
    fn lanes(&self) -> Option<&LaneRows<T>> {
        match &self.columns {
            Columns::Toeplitz(columns) => columns.lanes(),
            Columns::PerRow(_) => None,
        }
    }
}

/// The convolution of a product whose symbol can be set.
fn toeplitz<T: Real>(columns: &mut Columns<T>) -> &mut Convolution<T> {
    match columns {
        Columns::Toeplitz(columns) => columns,
        Columns::PerRow(_) => unreachable!("a symbol of a product that has none"),
    }
}

/// The shortest fast period for even coefficients, in x and y. It is at least `2 m - 2` for m elements: the offsets `m - 1` and `-(m - 1)` may
/// coincide, because their coefficients are equal.
pub fn even_period((mx, my): (usize, usize)) -> (usize, usize) {
    let period = |length: fn(usize) -> usize| (length(2 * mx - 2), length(2 * my - 2));
    let for_stages = period(length_for_stages);
    if have_stages(for_stages) {
        for_stages
    } else {
        period(good_length)
    }
}
