//! The memory of products.

use super::columns::BLOCK;
use super::convolution::room_of_column;
use super::fft::{Complex, Real};
use super::lane_rows::LaneRows;
use super::operator::{Columns, Operator};
use super::rows::{Piece, Product};
use super::stages::before_a_line;
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
        let scratch = most(Operator::scratch_room);
        let piece = |_| {
            let (columns, scratch) = (blank(columns, nan, WORKSPACE)?, blank(scratch, nan, WORKSPACE)?);
            Ok(Piece { block: 0, row: zeros(row, WORKSPACE)?, columns, scratch })
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
        self.product.pieces.iter_mut().for_each(|piece| keep([&mut piece.columns, &mut piece.scratch]));
        let [scaled, product] = &mut self.masked;
        keep([scaled, product, &mut self.given]);
    }
}

/// Numbers of values that the products of an operator need.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Needs([usize; 5]);

impl<T: Real> Operator<T> {
    /// What its products need: the workspace of one operator serves another of the same needs.
    pub fn needs(&self) -> Needs {
        Needs([self.bins(), self.row_room(), self.column_room(), self.scratch_room(), self.masked()])
    }

    /// Transforms of rows by which products go if the coefficients are even, which may change.
    fn lanes_if_even(&self) -> Option<&LaneRows<T>> {
        match &self.columns {
            Columns::Convolution(convolution) => convolution.lanes_if_even(),
            Columns::PerRow(_) => None,
        }
    }

    /// Bins of all rows.
    pub(super) fn bins(&self) -> usize {
        self.rows.room(self.lanes_if_even())
    }

    /// Values of rows, or sums of a column.
    fn row_room(&self) -> usize {
        let sums = match &self.columns {
            Columns::Convolution(_) => 0,
            Columns::PerRow(_) => 2 * self.rows.my,
        };
        let together = self.rows.at_a_time(self.lanes_if_even()).max(self.rows.transform.at_a_time());
        (together * self.rows.mx).max(sums)
    }

    /// Values of a block of columns.
    fn column_room(&self) -> usize {
        BLOCK * room_of_column(self.periods().1) + before_a_line::<T>()
    }

    /// Elements of a grid with patches.
    fn masked(&self) -> usize {
        self.coupling.as_ref().map_or(0, |_| self.rows.mx * self.rows.my)
    }

    /// Pieces of the work.
    fn pieces(&self) -> usize {
        self.rows.threads.count()
    }

    /// Values of scratch.
    fn scratch_room(&self) -> usize {
        let of_columns = match &self.columns {
            Columns::Convolution(convolution) => convolution.columns.scratch_length(),
            Columns::PerRow(_) => 0,
        };
        self.rows.scratch_length(self.lanes_if_even()).max(of_columns)
    }
}
