//! The y direction of a product by a matrix that is Toeplitz in x only: each pair of a loaded row jy and a displaced row iy has its coefficients.
//!
//! ```text
//! u^(iy, kx) = sum over jy of S_kx(jy, iy) p^(jy, kx),     ^: the transform in x
//! ```
//!
//! Each of the `px/2 + 1` bins kx has a matrix S_kx of my by my numbers. It is real if the coefficients are even in x, otherwise complex. All
//! matrices together have about `my^2 mx` real numbers, or twice as many. A product multiplies each of them, in the loaded rows, by a complex number.
//! Reading the matrices takes longer than the transforms.

use std::ops::Range;

use crate::block::for_each_block;
use crate::coefficients::Parity;
use crate::fft::row_transform::RowTransform;
use crate::passes::Real;
use crate::real::Complex;
use crate::rows::Rows;
use crate::set_up_columns::fill_period;
use crate::workspace::{Memory, Room};
use par::memory::{blank, computed, keep, zeros};
use par::threads::Threads;
use par::{OutOfMemory, Result};

/// The name of this memory in messages.
const MATRICES: &str = "the row tables' transforms";

/// The coefficients of a matrix that is Toeplitz in x only: the displacements of the elements in row iy by unit loads on the elements of row jy.
pub struct OfRows<F> {
    /// Whether the coefficients are even in x.
    pub are_even: bool,
    /// `fill(jy, iy, values)` fills `values` with the coefficients of the loaded row jy and the displaced row iy. Even coefficients are given at the
    /// offsets kx = 0 .. mx. Others are given over a period: offsets kx >= 0 first, negative offsets at the end, and 0 between.
    pub fill: F,
    /// A factor on all coefficients.
    pub factor: f64,
}

/// The matrices of all bins in x, including the normalisation `1/px`.
pub(crate) struct RowMatrices<T: Real> {
    /// The number of rows of the grid.
    my: usize,
    /// The number of real matrices that a bin has: 1 (real) or 2 (the real and the imaginary part).
    planes: usize,
    /// `[bin][plane][jy][iy]`.
    values: Vec<T>,
}

impl<T: Real> RowMatrices<T> {
    /// Computes the matrices of coefficients on a grid, with the period `px` in x.
    pub fn new<F: Fn(usize, usize, &mut [f64]) + Sync + Send>(
        (mx, my): (usize, usize),
        of: &OfRows<F>,
        px: usize,
        threads: &Threads,
    ) -> Result<RowMatrices<T>> {
        let rows = RowTransform::<f64>::new(px)?;
        let (nb, planes) = (rows.bins(), if of.are_even { 1 } else { 2 });
        let mut values = matrices(my, planes, nb)?;
        // The transforms in x of the coefficients of one loaded row, `[iy][bin]`.
        let mut bins_of_row: Vec<Complex<f64>> = zeros(my * nb, MATRICES)?;
        let piece = |_| Ok((zeros(px, MATRICES)?, rows.scratch()?));
        let mut pieces: Vec<(Vec<f64>, Vec<_>)> = (0..threads.count()).map(piece).collect::<Result<_>>()?;
        let scale = of.factor / px as f64;
        for jy in 0..my {
            threads.for_each_row(&mut bins_of_row, nb, &mut pieces, |iy, bins, (row, scratch)| {
                match of.are_even {
                    true => fill_period(0, mx, row, Parity::Even, |_, row| (of.fill)(jy, iy, row)),
                    false => (of.fill)(jy, iy, row),
                }
                rows.forward(row, bins, scratch);
            });
            let bins_of_row = &bins_of_row[..];
            threads.for_each_row(&mut values, planes * my * my, &mut pieces, |bin, matrices, _| {
                let column = bins_of_row[bin..].iter().step_by(nb);
                for plane in 0..planes {
                    let parts = column.clone().map(|value| if plane == 0 { value.re } else { value.im });
                    let row = &mut matrices[(plane * my + jy) * my..][..my];
                    row.iter_mut().zip(parts).for_each(|(value, part)| *value = T::of(scale * part));
                }
            });
        }
        Ok(RowMatrices { my, planes, values })
    }

    /// Converts the matrices to another precision, and multiplies them by a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<RowMatrices<S>> {
        let values = computed(self.values.iter().map(|value| S::of(factor * value.to_double())), MATRICES)?;
        Ok(RowMatrices { my: self.my, planes: self.planes, values })
    }

    /// The bytes of the matrices.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }

    /// The sizes of the products' memory.
    pub fn room(&self, rows: &Rows<T>) -> Room {
        let room = rows.room(self.my, 0);
        Room { row: room.row.max(2 * self.my), ..room }
    }

    /// Multiplies the bins of rows by the matrices. Only the rows `loaded` hold values before.
    pub fn apply(&self, rows: &Rows<T>, loaded: Range<usize>, memory: &mut Memory<T>) {
        let Memory { bins, pieces, .. } = memory;
        let (nb, length) = (rows.transform.bins(), self.my);
        for_each_block(&mut bins[..length * nb], nb, &rows.threads, pieces, |block, piece| {
            #[cfg(feature = "test-panics")]
            crate::panics::at_a_block();
            let columns = &mut piece.columns[..block.columns() * length];
            block.gather(loaded.clone(), length, columns);
            for (c, column) in columns.chunks_exact_mut(length).enumerate() {
                self.multiply(block.first() + c, loaded.clone(), column, &mut piece.row);
            }
            block.scatter(0..length, length, columns);
        });
    }

    /// Multiplies one column, that of bin `bin` in x, by its matrix. Only the rows `loaded` hold values before. `sums` is scratch.
    fn multiply(&self, bin: usize, loaded: Range<usize>, column: &mut [Complex<T>], sums: &mut [T]) {
        let my = self.my;
        let (re, im) = sums[..2 * my].split_at_mut(my);
        re.fill(T::zero());
        im.fill(T::zero());
        let matrices = &self.values[bin * self.planes * my * my..][..self.planes * my * my];
        add(&matrices[..my * my], loaded.clone(), |jy| column[jy], re, im);
        if self.planes == 2 {
            // The imaginary matrix times i p.
            add(&matrices[my * my..], loaded, |jy| Complex::new(-column[jy].im, column[jy].re), re, im);
        }
        for ((value, re), im) in column.iter_mut().zip(&*re).zip(&*im) {
            *value = Complex::new(*re, *im);
        }
    }
}

impl<T: Real> Drop for RowMatrices<T> {
    fn drop(&mut self) {
        keep([&mut self.values]);
    }
}

/// Allocates memory for the matrices. The caller writes each value before it is read.
fn matrices<T: Real>(my: usize, planes: usize, bins: usize) -> Result<Vec<T>> {
    let size = (my * my).checked_mul(planes * bins);
    let size = size.ok_or_else(|| OutOfMemory(format!("no memory for {my} * {my} * {bins} values of {MATRICES}")))?;
    blank(size, T::nan(), MATRICES)
}

/// Adds the product of a real matrix and complex values p to the sums `re` and `im`. Row jy of `matrix` belongs to the loaded row jy; `p(jy)` is its
/// value. Four rows are added at a time.
fn add<T: Real>(matrix: &[T], loaded: Range<usize>, p: impl Fn(usize) -> Complex<T>, re: &mut [T], im: &mut [T]) {
    let my = re.len();
    let row = |jy: usize| &matrix[jy * my..(jy + 1) * my];
    let fours = loaded.end - (loaded.end - loaded.start) % 4;
    for jy in (loaded.start..fours).step_by(4) {
        let p: [Complex<T>; 4] = std::array::from_fn(|k| p(jy + k));
        let rows = row(jy).iter().zip(row(jy + 1)).zip(row(jy + 2)).zip(row(jy + 3));
        for ((re, im), (((a, b), c), d)) in re.iter_mut().zip(&mut *im).zip(rows) {
            *re += *a * p[0].re + *b * p[1].re + (*c * p[2].re + *d * p[3].re);
            *im += *a * p[0].im + *b * p[1].im + (*c * p[2].im + *d * p[3].im);
        }
    }
    for jy in fours..loaded.end {
        let p = p(jy);
        for ((re, im), m) in re.iter_mut().zip(&mut *im).zip(row(jy)) {
            *re += *m * p.re;
            *im += *m * p.im;
        }
    }
}
