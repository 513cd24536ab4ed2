//! The kernel of the fused product: blocks of columns of a row-major matrix, gathered, worked on and scattered by
//! several threads at once. The only file with unsafe code outside `ffi/`.

use std::marker::PhantomData;

use super::fft::{Complex, Real};

/// Columns in a block: 8 double-precision complex numbers are two cache lines.
pub const BLOCK: usize = 8;

/// A row-major complex matrix whose column blocks may be read and written by different threads.
pub struct Columns<'a, T> {
    data: *mut Complex<T>,
    rows: usize,
    width: usize,
    owner: PhantomData<&'a mut [Complex<T>]>,
}

// SAFETY: the matrix is borrowed exclusively for 'a, and `Columns` gives access to it only by block; callers of the
// unsafe methods promise that no two threads work on the same block.
unsafe impl<T: Send> Sync for Columns<'_, T> {}

impl<'a, T: Real> Columns<'a, T> {
    /// The matrix `data`, `rows` by `width`.
    pub fn new(data: &'a mut [Complex<T>], width: usize) -> Columns<'a, T> {
        assert_eq!(data.len() % width, 0);
        Columns { rows: data.len() / width, width, data: data.as_mut_ptr(), owner: PhantomData }
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.width.div_ceil(BLOCK)
    }

    /// Columns in block `b`: all but the last have [`BLOCK`].
    pub fn columns(&self, b: usize) -> usize {
        (self.width - b * BLOCK).min(BLOCK)
    }

    /// Copies rows `rows` of block `b` to `out`, whose columns are `length` long and zero elsewhere.
    ///
    /// # Safety
    /// No other thread may be writing block `b`.
    pub unsafe fn gather(&self, b: usize, rows: std::ops::Range<usize>, length: usize, out: &mut [Complex<T>]) {
        let columns = self.columns(b);
        assert!(b * BLOCK < self.width && rows.end <= self.rows.min(length) && out.len() >= columns * length);
        for column in out.chunks_exact_mut(length).take(columns) {
            column[..rows.start].fill(Complex::default());
            column[rows.end..].fill(Complex::default());
        }
        for row in rows {
            // SAFETY: row < self.rows and the block lies within the row, so the slice is inside the matrix that this
            // value borrows; nobody writes it meanwhile, by the caller's promise.
            let from = unsafe { std::slice::from_raw_parts(self.data.add(row * self.width + b * BLOCK), columns) };
            for (c, &value) in from.iter().enumerate() {
                out[c * length + row] = value;
            }
        }
    }

    /// Copies the columns in `from`, each `length` long, to rows `rows` of block `b`.
    ///
    /// # Safety
    /// No other thread may be reading or writing block `b`.
    pub unsafe fn scatter(&self, b: usize, rows: std::ops::Range<usize>, length: usize, from: &[Complex<T>]) {
        let columns = self.columns(b);
        assert!(b * BLOCK < self.width && rows.end <= self.rows.min(length) && from.len() >= columns * length);
        for row in rows {
            // SAFETY: as in `gather`; exclusive by the caller's promise.
            let to = unsafe { std::slice::from_raw_parts_mut(self.data.add(row * self.width + b * BLOCK), columns) };
            for (c, value) in to.iter_mut().enumerate() {
                *value = from[c * length + row];
            }
        }
    }
}
