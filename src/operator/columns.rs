//! The kernel of the fused product: blocks of columns of a row-major matrix, gathered, worked on and scattered by
//! several threads at once. The only file with unsafe code outside `ffi/`.

use std::marker::PhantomData;
use std::ops::Range;

use super::fft::{Complex, Real};
use crate::threads::Threads;

/// Columns in a block: 8 double-precision complex numbers are two cache lines.
pub const BLOCK: usize = 8;
/// Rows that are gathered at a time.
const TILE: usize = 4;

/// One block of columns of a row-major matrix: no two of them overlap.
pub struct Block<'a, T> {
    data: *mut Complex<T>,
    rows: usize,
    width: usize,
    first: usize,
    owner: PhantomData<&'a mut [Complex<T>]>,
}

/// A pointer that several threads may hold: each derives blocks of its own from it.
struct Shared<T>(*mut Complex<T>);

// SAFETY: `for_each_block` is the only user, and gives each block of the matrix behind it to one thread at a time.
unsafe impl<T: Send> Sync for Shared<T> {}

impl<T> Shared<T> {
    fn pointer(&self) -> *mut Complex<T> {
        self.0
    }
}

/// Calls `work` on each block of columns of the matrix `data`, `width` columns wide, a run of blocks per piece of scratch.
pub fn for_each_block<T: Real, S: Send>(
    data: &mut [Complex<T>],
    width: usize,
    threads: &Threads,
    scratch: &mut [S],
    work: impl Fn(&mut Block<'_, T>, &mut S) + Sync + Send,
) {
    assert_eq!(data.len() % width, 0);
    let (rows, shared) = (data.len() / width, Shared(data.as_mut_ptr()));
    let blocks = width.div_ceil(BLOCK);
    let blocks_per_piece = blocks.div_ceil(scratch.len());
    threads.for_each(scratch, |k, s| {
        for b in k * blocks_per_piece..((k + 1) * blocks_per_piece).min(blocks) {
            let block = &mut Block { data: shared.pointer(), rows, width, first: b * BLOCK, owner: PhantomData };
            work(block, s);
        }
    });
}

impl<T: Real> Block<'_, T> {
    /// The first column.
    pub fn first(&self) -> usize {
        self.first
    }

    /// Number of columns: all blocks but the last have [`BLOCK`].
    pub fn columns(&self) -> usize {
        (self.width - self.first).min(BLOCK)
    }

    /// Copies rows `rows` to `out`, whose columns are `length` long and zero elsewhere.
    pub fn gather(&self, rows: Range<usize>, length: usize, out: &mut [Complex<T>]) {
        let columns = self.columns();
        assert!(rows.end <= self.rows.min(length) && out.len() >= columns * length);
        for column in out.chunks_exact_mut(length).take(columns) {
            column[..rows.start].fill(Complex::default());
            column[rows.end..].fill(Complex::default());
        }
        // TILE rows at a time: the writes to each column are neighbours.
        let mut row = rows.start;
        while row + TILE <= rows.end {
            let from: [&[Complex<T>]; TILE] = std::array::from_fn(|k| self.row(row + k));
            for (c, column) in out.chunks_exact_mut(length).take(columns).enumerate() {
                for (value, from) in column[row..row + TILE].iter_mut().zip(from) {
                    *value = from[c];
                }
            }
            row += TILE;
        }
        for row in row..rows.end {
            for (column, &value) in out.chunks_exact_mut(length).zip(self.row(row)) {
                column[row] = value;
            }
        }
    }

    /// Copies the columns in `from`, each `length` long, to rows `rows`.
    pub fn scatter(&mut self, rows: Range<usize>, length: usize, from: &[Complex<T>]) {
        let columns = self.columns();
        assert!(rows.end <= self.rows.min(length) && from.len() >= columns * length);
        for row in rows {
            for (value, column) in self.row_mut(row).iter_mut().zip(from.chunks_exact(length)) {
                *value = column[row];
            }
        }
    }

    /// The block's part of a row.
    fn row(&self, row: usize) -> &[Complex<T>] {
        assert!(row < self.rows);
        // SAFETY: the row is one of the matrix, and the block lies within it: the slice is inside the matrix, which
        // `for_each_block` borrows exclusively, and no other block overlaps this one.
        unsafe { std::slice::from_raw_parts(self.data.add(row * self.width + self.first), self.columns()) }
    }

    fn row_mut(&mut self, row: usize) -> &mut [Complex<T>] {
        assert!(row < self.rows);
        // SAFETY: as in `row`; this block is borrowed mutably.
        unsafe { std::slice::from_raw_parts_mut(self.data.add(row * self.width + self.first), self.columns()) }
    }
}
