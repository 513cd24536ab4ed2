//! The box around C, on which the operators are, and products between the centres of its elements.

use super::plane::Vector;
use super::row_product::RowProduct;
use super::row_tables::RowTables;
use super::toeplitz::Toeplitz;
use super::Tangential;
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::threads::Threads;
use toeplitz::Memory;

/// A box of elements: the first column and row, and behind the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub x: (usize, usize),
    pub y: (usize, usize),
}

impl Window {
    /// Around the elements that are `inside`; none if there is none.
    pub fn around(
        grid: &Grid,
        threads: &Threads,
        inside: impl Fn(usize) -> bool + Sync + Send,
    ) -> Result<Option<Window>> {
        let mut ends: Vec<Option<(usize, usize)>> = zeros(grid.my, "the box around the contact area")?;
        threads.for_each(&mut ends, |iy, ends| {
            let row = iy * grid.mx;
            let first = (0..grid.mx).find(|ix| inside(row + ix));
            let last = || (0..grid.mx).rfind(|ix| inside(row + ix));
            *ends = first.and_then(|first| Some((first, last()? + 1)));
        });
        let rows = ends.iter().enumerate().filter_map(|(iy, ends)| ends.map(|x| Window { x, y: (iy, iy + 1) }));
        Ok(rows.reduce(|a, b| Window { x: (a.x.0.min(b.x.0), a.x.1.max(b.x.1)), y: (a.y.0, b.y.1) }))
    }

    /// Its grid.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { mx: self.x.1 - self.x.0, my: self.y.1 - self.y.0, ..*grid }
    }

    /// Of row iy of the window the indices on the whole grid.
    pub fn row(&self, grid: &Grid, iy: usize) -> std::ops::Range<usize> {
        let start = (self.y.0 + iy) * grid.mx;
        start + self.x.0..start + self.x.1
    }

    /// Of each element of the window in row iy of the whole grid its index, and its column there.
    pub fn columns(&self, iy: usize) -> impl Iterator<Item = (usize, usize)> {
        let width = self.x.1 - self.x.0;
        let row = (self.y.0..self.y.1).contains(&iy).then(|| (iy - self.y.0) * width);
        let columns = self.x.0..self.x.1;
        row.into_iter().flat_map(move |first| (first..).zip(columns.clone()))
    }

    /// Of each element of the window its index, and that on the whole grid.
    pub fn elements(self, grid: &Grid) -> impl Iterator<Item = (usize, usize)> {
        let (mx, width) = (grid.mx, self.x.1 - self.x.0);
        let row = move |y: usize| (0..width).map(move |x| (y * width + x, (self.y.0 + y) * mx + self.x.0 + x));
        (0..self.y.1 - self.y.0).flat_map(row)
    }
}

/// `A q` at places between the centres.
pub struct Displaced {
    by: (f64, f64),
    grid: Grid,
    /// The first row, of tables per loaded row.
    first: Option<usize>,
    product: Product,
}

enum Product {
    Toeplitz(Box<Toeplitz<f64>>, Memory<f64>),
    ByRow(Box<RowProduct>),
}

impl Displaced {
    /// The displacements.
    pub fn apply(&mut self, q: &[Vector], u: &mut [Vector]) {
        match &mut self.product {
            Product::Toeplitz(operator, workspace) => operator.apply(q, 1.0, u, workspace),
            Product::ByRow(product) => product.apply(q, u),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match &self.product {
            Product::Toeplitz(operator, workspace) => {
                operator.bytes() + workspace.bytes() + workspace.bytes_of_pieces()
            }
            Product::ByRow(product) => product.bytes(),
        }
    }
}

/// Products displaced by so many elements, set up where they are not there.
pub fn displaced<'a>(
    kept: &'a mut Option<Displaced>,
    tangential: &Tangential,
    grid: Grid,
    by: (f64, f64),
    threads: &Threads,
) -> Result<&'a mut Displaced> {
    let (rows, threads) = (tangential.rows(), &threads.suited_to(grid.len()));
    let first = rows.map(RowTables::first);
    if !kept.as_ref().is_some_and(|kept| kept.by == by && kept.grid == grid && kept.first == first) {
        *kept = None;
        let product = match rows {
            Some(rows) => Product::ByRow(Box::new(RowProduct::displaced(tangential, rows, &grid, by.0, threads)?)),
            None => {
                let operator = Box::new(Toeplitz::displaced(tangential, &grid, by, threads)?);
                let workspace = operator.workspace()?;
                Product::Toeplitz(operator, workspace)
            }
        };
        *kept = Some(Displaced { by, grid, first, product });
    }
    match kept {
        Some(kept) => Ok(kept),
        None => invalid("no displaced operator".into()),
    }
}
