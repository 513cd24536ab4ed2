//! The memory of products.

use super::columns::BLOCK;
use super::convolution::room_of_column;
use super::fft::{Complex, Real};
use super::operator::{Columns, Operator};
use super::rows::{Piece, Product};
use crate::error::Result;
use crate::memory::{asleep, blank, keep, rest, zeros};
use crate::threads::Threads;

/// What memory is for.
const WORKSPACE: &str = "the product's workspace";

/// Memory that a product needs, so that it allocates nothing.
pub struct Workspace<T: Real> {
    pub(super) product: Product<T>,
    /// Those that a product needs, at rest or not.
    bins: usize,
    /// With patches: p scaled for one of them, and its product.
    pub(super) masked: [Vec<T>; 2],
    /// And p, where u takes its place.
    pub(super) given: Vec<T>,
}

impl<T: Real> Workspace<T> {
    /// Memory for products by any of these operators.
    pub fn new<'a>(operators: impl Iterator<Item = &'a Operator<T>> + Clone) -> Result<Workspace<T>>
    where
        T: 'a,
    {
        let nan = Complex::new(T::nan(), T::nan());
        let most = |room: fn(&Operator<T>) -> usize| operators.clone().map(room).max().unwrap_or(0);
        let (row, columns, masked) = (most(Operator::row_room), most(Operator::column_room), most(Operator::masked));
        let piece = |_| {
            let mut scratch = Vec::new();
            operators.clone().for_each(|operator| operator.fit_scratch(&mut scratch));
            Ok(Piece { row: zeros(row, WORKSPACE)?, columns: blank(columns, nan, WORKSPACE)?, scratch })
        };
        let memory = |n| zeros(n, WORKSPACE);
        let (bins, mut product_bins) = (most(Operator::bins), Vec::new());
        let threads = operators.clone().next().map_or(&Threads::One, Operator::threads);
        asleep(&mut product_bins, bins, nan, WORKSPACE, threads)?;
        Ok(Workspace {
            bins,
            product: Product {
                bins: product_bins,
                pieces: (0..most(Operator::pieces)).map(piece).collect::<Result<_>>()?,
            },
            masked: [memory(masked)?, memory(masked)?],
            given: memory(masked)?,
        })
    }

    /// It is not needed for a while.
    pub fn rest(&mut self) {
        rest(&mut self.product.bins);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.bins * size_of::<Complex<T>>() + 3 * size_of_val(&self.given[..])
    }
}

impl<T: Real> Drop for Workspace<T> {
    fn drop(&mut self) {
        keep([&mut self.product.bins]);
        self.product.pieces.iter_mut().for_each(|piece| keep([&mut piece.columns]));
        let [scaled, product] = &mut self.masked;
        keep([scaled, product, &mut self.given]);
    }
}

/// What a product needs.
impl<T: Real> Operator<T> {
    /// Bins of all rows.
    pub(super) fn bins(&self) -> usize {
        self.rows.my * self.rows.transform.bins()
    }

    /// Values of rows, or sums of a column.
    fn row_room(&self) -> usize {
        let sums = match &self.columns {
            Columns::Convolution(_) => 0,
            Columns::PerRow(_) => 2 * self.rows.my,
        };
        (self.rows.transform.at_a_time() * self.rows.mx).max(sums)
    }

    /// Values of a block of columns.
    fn column_room(&self) -> usize {
        BLOCK * room_of_column(self.periods().1)
    }

    /// Elements of a grid with patches.
    fn masked(&self) -> usize {
        self.coupling.as_ref().map_or(0, |_| self.rows.mx * self.rows.my)
    }

    /// Pieces of the work.
    fn pieces(&self) -> usize {
        self.rows.threads.count()
    }

    fn fit_scratch(&self, scratch: &mut Vec<Complex<T>>) {
        self.rows.transform.fit(scratch);
        if let Columns::Convolution(convolution) = &self.columns {
            convolution.columns.fit(scratch);
        }
    }
}
