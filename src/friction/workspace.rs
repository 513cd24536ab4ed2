//! Memory of products of two components.

use crate::error::Result;
use crate::memory::{blank, keep, zeros};
use crate::operator::columns::BLOCK;
use crate::operator::fft::{Complex, Real};
use crate::threads::Threads;

/// What memory is for.
const WORKSPACE: &str = "the workspace of tangential products";

/// Memory of products.
#[derive(Default)]
pub struct Workspace<T: Real> {
    /// `[my][px]`.
    pub(super) bins: Vec<Complex<T>>,
    pub(super) pieces: Vec<Piece<T>>,
}

/// That of one piece of the work.
#[derive(Default)]
pub(super) struct Piece<T: Real> {
    pub(super) row: Vec<T>,
    pub(super) columns: Vec<Complex<T>>,
    pub(super) mirrored: Vec<Complex<T>>,
    pub(super) scratch: Vec<Complex<T>>,
}

impl<T: Real> Workspace<T> {
    /// For a grid of `my` rows in a period of `px x py`; transforms take `scratch` values.
    pub(super) fn new((px, py): (usize, usize), my: usize, scratch: usize, threads: &Threads) -> Result<Workspace<T>> {
        let nothing = Complex::new(T::nan(), T::nan());
        let columns = || blank(BLOCK * py, nothing, WORKSPACE);
        let piece = |_| {
            let (row, scratch) = (zeros(px, WORKSPACE)?, zeros(scratch, WORKSPACE)?);
            Ok(Piece { row, columns: columns()?, mirrored: columns()?, scratch })
        };
        let pieces = (0..threads.count()).map(piece).collect::<Result<_>>()?;
        Ok(Workspace { bins: blank(my * px, nothing, WORKSPACE)?, pieces })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let piece = |piece: &Piece<T>| {
            let Piece { row, columns, mirrored, scratch } = piece;
            size_of_val(&row[..]) + size_of_val(&columns[..]) + size_of_val(&mirrored[..]) + size_of_val(&scratch[..])
        };
        size_of_val(&self.bins[..]) + self.pieces.iter().map(piece).sum::<usize>()
    }
}

impl<T: Real> Drop for Workspace<T> {
    fn drop(&mut self) {
        keep([&mut self.bins]);
        self.pieces.iter_mut().for_each(|piece| keep([&mut piece.columns, &mut piece.mirrored]));
    }
}
