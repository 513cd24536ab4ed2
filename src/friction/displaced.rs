//! Displacements at points between the centres of the elements of a box: transient rolling needs those at the places where particles were before the
//! step.

use super::plane::Vector;
use super::row_product::RowProduct;
use super::row_tables::RowTables;
use super::toeplitz::Toeplitz;
use super::Tangential;
use crate::error::Result;
use crate::grid::Grid;
use crate::threads::Threads;
use toeplitz::Memory;

/// The product that returns the displacements by q at one point per element, each at the same offset from the element's centre.
pub struct Displaced {
    /// The offset of the points from the centres, in elements.
    by: (f64, f64),
    grid: Grid,
    /// The first row of the grid in tables per loaded row; none without such tables.
    first: Option<usize>,
    product: Product,
}

enum Product {
    Toeplitz(Box<Toeplitz<f64>>, Memory<f64>),
    ByRow(Box<RowProduct>),
}

impl Displaced {
    /// Computes the displacements u at the points, by tractions q.
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

/// Returns the product for points at the offset `by` from the centres, in elements. `kept` holds the last such product. It is set up anew for another
/// offset, another grid or another first row.
pub fn displaced<'a>(
    kept: &'a mut Option<Displaced>,
    tangential: &Tangential,
    grid: Grid,
    by: (f64, f64),
    threads: &Threads,
) -> Result<&'a mut Displaced> {
    let (rows, threads) = (tangential.rows(), &threads.suited_to(grid.len()));
    let first = rows.map(RowTables::first);
    if let Some(known) = kept.take().filter(|kept| kept.by == by && kept.grid == grid && kept.first == first) {
        return Ok(kept.insert(known));
    }
    let product = match rows {
        Some(rows) => Product::ByRow(Box::new(RowProduct::displaced(tangential, rows, &grid, by.0, threads)?)),
        None => {
            let operator = Box::new(Toeplitz::displaced(tangential, &grid, by, threads)?);
            let workspace = operator.workspace()?;
            Product::Toeplitz(operator, workspace)
        }
    };
    Ok(kept.insert(Displaced { by, grid, first, product }))
}
