//! Blocks of columns of a row-major matrix, which threads read and write at the same time, and prefetches. This is the only file of the crate with
//! unsafe code.

use std::marker::PhantomData;
use std::ops::Range;

use crate::real::{Complex, Scalar};
use par::threads::Threads;

/// The number of columns in a block. A row of a block of complex numbers has four cache lines in double precision, two in single.
pub const BLOCK: usize = 16;
/// The number of rows that are gathered at a time.
const TILE: usize = 8;

/// The least length of columns that have a gap of [`GAP`] values behind them. Without a gap the starts of columns could be a power of two apart. Then
/// they would share few lines of the first-level cache.
const LONG: usize = 512;
/// The gap behind a long column, in values.
const GAP: usize = 8;

/// The distance between the starts of two neighbouring columns of this length, in values.
pub fn room_of_column(length: usize) -> usize {
    if length < LONG {
        length
    } else {
        length + GAP
    }
}

/// Complex values as a slice of real numbers, in which real and imaginary parts alternate.
pub fn parts<T: Scalar>(values: &[Complex<T>]) -> &[T] {
    // SAFETY: a Complex is two values of T in the order of C (`repr(C)`), so the slice holds twice as many of them.
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), 2 * values.len()) }
}

/// [`parts`] of mutable values.
pub fn parts_mut<T: Scalar>(values: &mut [Complex<T>]) -> &mut [T] {
    // SAFETY: as above; the values are borrowed mutably.
    unsafe { std::slice::from_raw_parts_mut(values.as_mut_ptr().cast(), 2 * values.len()) }
}

/// Bytes of a cache line, and of the longest vector. On machines with longer lines each line is prefetched more than once.
pub(crate) const LINE: usize = 64;

/// Tells the processor to load `count` values from `first` on into the cache, while it does other work. Any address is allowed. If `first` is not at
/// the start of a line, the last line is left out.
#[inline(always)]
pub fn prefetch<V>(first: *const V, count: usize) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..count * size_of::<V>()).step_by(LINE) {
        let line = first.cast::<i8>().wrapping_add(line);
        // SAFETY: nothing is read, whatever the address; each x86_64 has the instruction.
        unsafe { core::arch::x86_64::_mm_prefetch::<{ core::arch::x86_64::_MM_HINT_T1 }>(line) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (first, count, LINE);
}

/// One block of columns of a row-major matrix, which it borrows mutably. Blocks do not overlap.
pub struct Block<'a, T> {
    /// The matrix.
    data: *mut Complex<T>,
    /// The rows of the matrix.
    rows: usize,
    /// The columns of the matrix.
    width: usize,
    /// The first column of the block.
    first: usize,
    /// The number of columns of the block.
    columns: usize,
    owner: PhantomData<&'a mut [Complex<T>]>,
}

// SAFETY: a block is a mutable borrow of its columns, which no other block has.
unsafe impl<T: Send> Send for Block<'_, T> {}

/// Cuts the columns `columns` of the matrix `data`, which is `width` columns wide, into blocks of `count` columns. The last block may have fewer.
pub fn blocks_of<'a, T: Scalar>(
    data: &'a mut [Complex<T>],
    width: usize,
    columns: Range<usize>,
    count: usize,
) -> impl DoubleEndedIterator<Item = Block<'a, T>> + ExactSizeIterator + Send {
    assert!(columns.end <= width);
    let (matrix, end) = (Block::of(data, width), columns.end);
    columns.step_by(count).map(move |first| matrix.part(first, count.min(end - first)))
}

/// Calls `work(block, scratch)` on each block of [`BLOCK`] columns of the matrix `data`, which is `width` columns wide. `scratch` is that of the
/// thread that calls it.
pub fn for_each_block<T: Scalar, S: Send>(
    data: &mut [Complex<T>],
    width: usize,
    threads: &Threads,
    scratch: &mut [S],
    work: impl Fn(&mut Block<'_, T>, &mut S) + Sync + Send,
) {
    threads.share(blocks_of(data, width, 0..width, BLOCK), scratch, |mut block, s| work(&mut block, s));
}

impl<'a, T: Scalar> Block<'a, T> {
    /// The block of all columns of a matrix, which is `width` columns wide.
    pub fn of(data: &'a mut [Complex<T>], width: usize) -> Block<'a, T> {
        assert_eq!(data.len() % width, 0);
        Block { rows: data.len() / width, data: data.as_mut_ptr(), width, first: 0, columns: width, owner: PhantomData }
    }

    /// The block of a part of these columns. Callers give each column to one block only, and do not use this block itself.
    fn part(&self, first: usize, columns: usize) -> Block<'a, T> {
        assert!(first >= self.first && first + columns <= self.first + self.columns);
        Block { first, columns, ..*self }
    }

    /// The first column of the block in the matrix.
    pub fn first(&self) -> usize {
        self.first
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Copies the rows `rows` of the block to `out`, column after column. The columns of `out` are `length` long, and zero in all other rows.
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

    /// Copies the values of the rows `rows` from the columns in `from` to the block. There are at most [`BLOCK`] columns, each `length` long.
    pub fn scatter(&mut self, rows: Range<usize>, length: usize, from: &[Complex<T>]) {
        let columns = self.columns();
        assert!(columns <= BLOCK && rows.end <= self.rows.min(length) && from.len() >= columns * length);
        // TILE rows at a time: the reads of each column are neighbours.
        let mut row = rows.start;
        let mut tile = [[Complex::default(); BLOCK]; TILE];
        while row + TILE <= rows.end {
            for (c, column) in from.chunks_exact(length).take(columns).enumerate() {
                for (to, value) in tile.iter_mut().zip(&column[row..row + TILE]) {
                    to[c] = *value;
                }
            }
            for (k, values) in tile.iter().enumerate() {
                self.row_mut(row + k).copy_from_slice(&values[..columns]);
            }
            row += TILE;
        }
        for row in row..rows.end {
            for (value, column) in self.row_mut(row).iter_mut().zip(from.chunks_exact(length)) {
                *value = column[row];
            }
        }
    }

    /// The block's part of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> &[Complex<T>] {
        assert!(row < self.rows);
        // SAFETY: the row is one of the matrix, and the block lies within it: the slice is inside the matrix, which those who make
        // blocks borrow exclusively, and no other block overlaps this one.
        unsafe { std::slice::from_raw_parts(self.data.add(row * self.width + self.first), self.columns()) }
    }

    /// Prefetches one of n equal parts, number k, of the block's part of a row. Does nothing if there is no such row.
    #[inline(always)]
    pub fn prefetch(&self, row: usize, (k, n): (usize, usize)) {
        if row < self.rows {
            let count = self.columns / n;
            prefetch(self.data.wrapping_add(row * self.width + self.first + k * count), count);
        }
    }

    /// The block's mutable part of a row.
    #[inline(always)]
    pub fn row_mut(&mut self, row: usize) -> &mut [Complex<T>] {
        assert!(row < self.rows);
        // SAFETY: as in `row`; this block is borrowed mutably.
        unsafe { std::slice::from_raw_parts_mut(self.data.add(row * self.width + self.first), self.columns()) }
    }
}

#[cfg(test)]
#[path = "../tests/unit/block.rs"]
mod tests;
