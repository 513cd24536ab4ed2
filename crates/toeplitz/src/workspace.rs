//! The memory of products.

use par::memory::{asleep, blank, keep, rest, wake, zeros};
use par::threads::Threads;
use par::Result;

use crate::passes::Real;
use crate::real::Complex;

/// The name of this memory in messages.
const WORKSPACE: &str = "the product's workspace";

/// The sizes of a product's memory. The memory also serves products with smaller sizes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// Bins of all rows.
    pub bins: usize,
    /// Real values of rows, for each thread.
    pub row: usize,
    /// Complex values of a block of columns, for each thread.
    pub columns: usize,
    /// Complex values of scratch, for each thread.
    pub scratch: usize,
    /// The number of threads; each has a `Piece`.
    pub pieces: usize,
}

impl Room {
    /// The larger of both sizes.
    #[must_use]
    pub fn max(self, other: Room) -> Room {
        Room {
            bins: self.bins.max(other.bins),
            row: self.row.max(other.row),
            columns: self.columns.max(other.columns),
            scratch: self.scratch.max(other.scratch),
            pieces: self.pieces.max(other.pieces),
        }
    }
}

/// The memory of a product. The product itself allocates nothing.
pub struct Memory<T: Real> {
    /// `[my][px/2 + 1]`: the rows, transformed in x. In lanes: blocks of columns, `[block][row][real or imaginary part][column]`.
    pub bins: Vec<Complex<T>>,
    /// One for each thread.
    pub pieces: Vec<Piece<T>>,
    /// The bins of the largest product. `bins` is empty while it rests.
    most: usize,
}

/// The buffers of one thread.
pub struct Piece<T: Real> {
    /// The number of the last block of columns that this thread multiplied.
    pub(crate) block: usize,
    /// Values of rows.
    pub row: Vec<T>,
    /// A block of columns.
    pub columns: Vec<Complex<T>>,
    /// Scratch of transforms.
    pub scratch: Vec<Complex<T>>,
}

impl<T: Real> Memory<T> {
    /// Memory for products of at most these sizes.
    pub fn new(room: Room, threads: &Threads) -> Result<Memory<T>> {
        let piece = |_| {
            let (columns, scratch) = (blank(room.columns, nan(), WORKSPACE)?, blank(room.scratch, nan(), WORKSPACE)?);
            Ok(Piece { block: 0, row: zeros(room.row, WORKSPACE)?, columns, scratch })
        };
        let mut bins = Vec::new();
        asleep(&mut bins, room.bins, nan(), WORKSPACE, threads)?;
        Ok(Memory { bins, pieces: (0..room.pieces).map(piece).collect::<Result<_>>()?, most: room.bins })
    }

    /// Wakes at least this number of bins.
    pub(crate) fn wake(&mut self, least: usize, threads: &Threads) {
        let n = self.bins.len().max(least);
        wake(&mut self.bins, n, nan(), threads);
    }

    /// Releases the memory of bins until the next product.
    pub fn rest(&mut self) {
        rest(&mut self.bins);
    }

    /// Bytes held in bins.
    pub fn bytes(&self) -> usize {
        self.most * size_of::<Complex<T>>()
    }

    /// Bytes of the threads' buffers.
    pub fn bytes_of_pieces(&self) -> usize {
        let of = |Piece { row, columns, scratch, .. }: &Piece<T>| {
            size_of_val(&row[..]) + size_of_val(&columns[..]) + size_of_val(&scratch[..])
        };
        self.pieces.iter().map(of).sum()
    }
}

impl<T: Real> Piece<T> {
    /// Guesses the address of the next block after block b, whose address is `b_at`. Blocks have `length` values. A thread that has advanced by some
    /// blocks advances by as many again. If it did not move, or if that is beyond the ends, the guess is the neighbour of b away from the nearer end.
    /// Used to prefetch only.
    pub(crate) fn next_block(
        &self,
        b_at: *const Complex<T>,
        b: usize,
        length: usize,
        count: usize,
    ) -> *const Complex<T> {
        let on = (2 * b).wrapping_sub(self.block);
        let next = if on != b && on < count {
            on
        } else if 2 * b < count {
            b + 1
        } else {
            b.wrapping_sub(1)
        };
        b_at.wrapping_add(next.wrapping_sub(b).wrapping_mul(length))
    }
}

/// A value with NaN in both parts.
fn nan<T: Real>() -> Complex<T> {
    Complex::new(T::nan(), T::nan())
}

impl<T: Real> Drop for Memory<T> {
    fn drop(&mut self) {
        keep([&mut self.bins]);
        self.pieces.iter_mut().for_each(|piece| keep([&mut piece.columns, &mut piece.scratch]));
    }
}
