//! The memory of products.

use par::memory::{asleep, blank, keep, rest, wake, zeros};
use par::threads::Threads;
use par::Result;

use crate::passes::Real;
use crate::real::Complex;

/// The name of this memory in messages.
const WORKSPACE: &str = "the product's workspace";

/// The sizes of a product's memory. Memory of these sizes also serves products that need less.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// The number of bins of all rows.
    pub bins: usize,
    /// The number of real values of rows that each thread has room for.
    pub row: usize,
    /// The number of complex values of a block of columns that each thread has room for.
    pub columns: usize,
    /// The number of complex values of scratch that each thread has.
    pub scratch: usize,
    /// The number of threads, each of which has its own buffers.
    pub pieces: usize,
}

impl Room {
    /// The larger one of both rooms, for each size.
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

/// The memory of a product. A product that has its memory allocates nothing.
pub struct Memory<T: Real> {
    /// The rows, transformed in x: `[my][px/2 + 1]`. With SIMD lanes: blocks of columns, `[block][row][real or imaginary part][column]`.
    pub bins: Vec<Complex<T>>,
    /// The buffers of the threads.
    pub pieces: Vec<Piece<T>>,
    /// The length of `bins` for the largest product. While the memory [rests](Memory::rest), `bins` is empty.
    most: usize,
}

/// The buffers of one thread.
pub struct Piece<T: Real> {
    /// The number of the last block of columns that this thread multiplied.
    pub(crate) block: usize,
    /// Room for the values of the rows that are transformed together.
    pub row: Vec<T>,
    /// Room for a block of columns.
    pub columns: Vec<Complex<T>>,
    /// The scratch of transforms.
    pub scratch: Vec<Complex<T>>,
}

impl<T: Real> Memory<T> {
    /// Allocates memory for products of at most these sizes. If `bins` is large, it rests until the first product.
    pub fn new(room: Room, threads: &Threads) -> Result<Memory<T>> {
        let piece = |_| {
            let (columns, scratch) = (blank(room.columns, nan(), WORKSPACE)?, blank(room.scratch, nan(), WORKSPACE)?);
            Ok(Piece { block: 0, row: zeros(room.row, WORKSPACE)?, columns, scratch })
        };
        let mut bins = Vec::new();
        asleep(&mut bins, room.bins, nan(), WORKSPACE, threads)?;
        Ok(Memory { bins, pieces: (0..room.pieces).map(piece).collect::<Result<_>>()?, most: room.bins })
    }

    /// Makes `bins` at least `least` values long again, if it rested. The values are unspecified.
    pub(crate) fn wake(&mut self, least: usize, threads: &Threads) {
        let n = self.bins.len().max(least);
        wake(&mut self.bins, n, nan(), threads);
    }

    /// Returns the pages of large bins to the system until the next product. Their addresses stay reserved.
    pub fn rest(&mut self) {
        rest(&mut self.bins);
    }

    /// The bytes of bins while they do not rest.
    pub fn bytes(&self) -> usize {
        self.most * size_of::<Complex<T>>()
    }

    /// The bytes of the threads' buffers.
    pub fn bytes_of_pieces(&self) -> usize {
        let bytes = |Piece { row, columns, scratch, .. }: &Piece<T>| {
            size_of_val(&row[..]) + size_of_val(&columns[..]) + size_of_val(&scratch[..])
        };
        self.pieces.iter().map(bytes).sum()
    }
}

impl<T: Real> Piece<T> {
    /// Guesses which block this thread multiplies after block b, and returns its address. Only prefetches use the guess.
    ///
    /// There are `count` blocks of `length` values, and block b is at the address `b_at`. A thread that moved from block a to block b probably goes
    /// on to block `2 b - a`. If b is a, or if there is no such block, the guess is the neighbour of b away from the nearer end.
    pub(crate) fn next_block(
        &self,
        b_at: *const Complex<T>,
        b: usize,
        length: usize,
        count: usize,
    ) -> *const Complex<T> {
        let as_far_again = (2 * b).wrapping_sub(self.block);
        let next = if as_far_again != b && as_far_again < count {
            as_far_again
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
