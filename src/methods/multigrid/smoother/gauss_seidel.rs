//! Lexicographic Gauss-Seidel with relaxation (x fastest), restricted to a set of elements.
//!
//! ```text
//! for I in the set, in order:  p_I += omega (b_I - sum_J A_IJ p_J) / A_II       with the values updated so far
//! ```
//!
//! By direct summation a sweep costs O(n^2). Let `r = b - A p` be the residual before the sweep, and `d` the changes of p by the sweep. Then the
//! expression in parentheses is `r_I - sum over J < I of A_IJ d_J`, a triangular block Toeplitz product. It is computed as follows:
//!
//! - The changes of each finished row are transformed in x once, and their effect on later rows is summed in transformed space.
//! - Within strips of 16 rows the effects are summed directly. In larger blocks the effect of the first half of the rows on the second half is a
//!   product by FFT in y (divide and conquer).
//! - Only the part within the current row is sequential.
//!
//! The iterates equal those of the direct sweep to round-off. The cost is O(n log^2 n), plus mx^2 my operations within the rows if the rows are not
//! [long](super::long_rows).

use super::long_rows::LongRows;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::fft::{good_length, ColumnTransform, Complex};
use crate::operator::row_transform::RowTransform;
use crate::operator::zeros;

/// The number of rows of a strip, whose mutual influence is summed directly.
const STRIP: usize = 16;

/// The number of bins (wave numbers in x) whose columns are transformed together. They are contiguous in memory.
const COLUMNS: usize = 8;

/// Gauss-Seidel on one grid.
pub struct GaussSeidel {
    pub(super) mx: usize,
    my: usize,
    /// The transform of rows in x, with padding.
    rows: RowTransform<f64>,
    /// The coefficients `c(k, 0)`, `k >= 0`, within a row.
    within_row: Vec<f64>,
    /// The sequential part, if rows are long.
    long_rows: Option<LongRows>,
    /// `[d][bin]`: the transformed coefficients between rows that are `d < STRIP` apart, normalised.
    between_rows: Vec<Complex<f64>>,
    /// For blocks of 2, 4, ... strips: the effect of the first half of the rows on the second half.
    halves: Vec<Half>,
    /// `[my][bins]`: the transformed changes of each finished row.
    changes: Vec<Complex<f64>>,
    /// `[my][bins]`: the transformed effect of finished rows on each later row.
    gathered: Vec<Complex<f64>>,
    /// Memory for one transformed row.
    bins: Vec<Complex<f64>>,
    /// Memory for columns of a block.
    columns: Vec<Complex<f64>>,
    /// The effect of finished rows on the current row; later the changes of the current row.
    row: Vec<f64>,
    scratch: Vec<Complex<f64>>,
}

/// The effect of the first half of a block of rows on its second half.
struct Half {
    transform: ColumnTransform<f64>,
    /// `[bin][row]`: the coefficients, transformed in x, and in y over the block.
    kernel: Vec<Complex<f64>>,
}

impl GaussSeidel {
    /// Sets up sweeps on `grid`.
    pub fn new(coefficients: &Coefficients, grid: &Grid) -> Result<GaussSeidel> {
        let (mx, my) = (grid.mx, grid.my);
        let px = good_length(2 * mx - 1);
        let rows = RowTransform::new(px)?;
        let nb = rows.bins();
        let mut row = zeros(px, "the smoother")?;
        let mut scratch = rows.scratch()?;

        // The coefficients between rows that are d apart are transformed in x, for every d.
        let mut kernels: Vec<Complex<f64>> = zeros(my * nb, "the smoother")?;
        let normalisation = 1.0 / px as f64;
        for (d, bins) in kernels.chunks_exact_mut(nb).enumerate() {
            row.fill(0.0);
            for kx in 1 - mx as i64..mx as i64 {
                row[kx.rem_euclid(px as i64) as usize] = normalisation * coefficients.at(kx, d as i64);
            }
            rows.forward(&row, bins, &mut scratch);
        }

        let mut halves = Vec::new();
        let mut block = 2 * STRIP;
        while block < 2 * my && my > STRIP {
            let transform = ColumnTransform::new(block)?;
            transform.fit(&mut scratch)?;
            let mut kernel: Vec<Complex<f64>> = zeros(nb * block, "the smoother")?;
            for (bin, column) in kernel.chunks_exact_mut(block).enumerate() {
                for d in 1..block.min(my) {
                    column[d] = kernels[d * nb + bin] / block as f64;
                }
                transform.forward(column, &mut scratch);
            }
            halves.push(Half { transform, kernel });
            block *= 2;
        }
        kernels.truncate(STRIP * nb);
        let longest = halves.last().map_or(0, |half| half.transform.length());
        let mut within_row = zeros(mx, "the smoother")?;
        coefficients.fill_row(0, 0, &mut within_row);
        Ok(GaussSeidel {
            mx,
            my,
            long_rows: LongRows::new(&within_row)?,
            within_row,
            between_rows: kernels,
            halves,
            changes: zeros(my * nb, "the smoother")?,
            gathered: zeros(my * nb, "the smoother")?,
            bins: zeros(nb, "the smoother")?,
            columns: zeros(COLUMNS * longest, "the smoother")?,
            row,
            scratch,
            rows,
        })
    }

    /// Makes one sweep over the elements for which `in_set` holds. `residual` is `b - A p` before, and is overwritten.
    pub fn sweep(
        &mut self,
        p: &mut [f64],
        residual: &mut [f64],
        relaxation: f64,
        in_set: impl Fn(usize) -> bool + Copy,
    ) {
        let mx = self.mx;
        let used = |iy: &usize| (iy * mx..(iy + 1) * mx).any(in_set);
        let Some(first) = (0..self.my).find(used) else { return };
        let end = (0..self.my).rfind(used).map_or(first, |last| last + 1);
        let nb = self.rows.bins();
        self.gathered[first * nb..end * nb].fill(Complex::default());
        // A block has 2^level strips. The smallest block that contains all rows of the set is swept.
        let level = (0..).find(|&level| STRIP << level >= end - first).unwrap_or(0);
        self.block(first, end, level, &mut Sweep { p, residual, relaxation, in_set });
    }

    /// Sweeps the rows of a block of `STRIP << level` rows, which begins with `first`, up to the row before `end`.
    fn block<S: Fn(usize) -> bool + Copy>(&mut self, first: usize, end: usize, level: usize, sweep: &mut Sweep<'_, S>) {
        if level == 0 {
            for iy in first..end.min(first + STRIP) {
                self.gather_within_strip(first, iy);
                self.sweep_row(iy, sweep);
            }
            return;
        }
        let middle = first + (STRIP << (level - 1));
        self.block(first, end, level - 1, sweep);
        if middle < end {
            self.gather_from_first_half(first, middle, end.min(first + (STRIP << level)), level);
            self.block(middle, end, level - 1, sweep);
        }
    }

    /// Adds the effect of the finished rows `first..iy` of the same strip on row `iy`.
    fn gather_within_strip(&mut self, first: usize, iy: usize) {
        let nb = self.rows.bins();
        let to = &mut self.gathered[iy * nb..(iy + 1) * nb];
        for jy in first..iy {
            let kernel = &self.between_rows[(iy - jy) * nb..(iy - jy + 1) * nb];
            let changes = &self.changes[jy * nb..(jy + 1) * nb];
            for ((value, k), change) in to.iter_mut().zip(kernel).zip(changes) {
                *value += k * change;
            }
        }
    }

    /// Adds the effect of the finished rows `first..middle` on the rows `middle..end`.
    fn gather_from_first_half(&mut self, first: usize, middle: usize, end: usize, level: usize) {
        let nb = self.rows.bins();
        let half = &self.halves[level - 1];
        let block = half.transform.length();
        for bin in (0..nb).step_by(COLUMNS) {
            let count = COLUMNS.min(nb - bin);
            let columns = &mut self.columns[..count * block];
            for (row, jy) in (first..middle).enumerate() {
                for (c, change) in self.changes[jy * nb + bin..][..count].iter().enumerate() {
                    columns[c * block + row] = *change;
                }
            }
            for column in columns.chunks_exact_mut(block) {
                column[middle - first..].fill(Complex::default());
            }
            half.transform.forward(columns, &mut self.scratch);
            for (value, k) in columns.iter_mut().zip(&half.kernel[bin * block..]) {
                *value *= k;
            }
            half.transform.inverse(columns, &mut self.scratch);
            for iy in middle..end {
                for (c, gathered) in self.gathered[iy * nb + bin..][..count].iter_mut().enumerate() {
                    *gathered += columns[c * block + iy - first];
                }
            }
        }
    }

    /// Sweeps the elements of one row, one after the other: the sequential part.
    fn sweep_row<S: Fn(usize) -> bool + Copy>(&mut self, iy: usize, sweep: &mut Sweep<'_, S>) {
        let (mx, nb) = (self.mx, self.rows.bins());
        let elements = iy * mx..(iy + 1) * mx;
        let in_set = sweep.in_set;
        let changes = &mut self.changes[iy * nb..(iy + 1) * nb];
        let (Some(start), Some(last)) = (elements.clone().find(|&i| in_set(i)), elements.clone().rfind(|&i| in_set(i)))
        else {
            changes.fill(Complex::default());
            return;
        };
        self.bins.copy_from_slice(&self.gathered[iy * nb..(iy + 1) * nb]);
        self.rows.inverse(&mut self.bins, &mut self.row, &mut self.scratch);
        let residual = &mut sweep.residual[elements.clone()];
        let p = &mut sweep.p[elements.clone()];
        residual.iter_mut().zip(&self.row).for_each(|(r, gathered)| *r -= gathered);
        self.row.fill(0.0);
        let (start, end) = (start - elements.start, last - elements.start + 1);
        let factor = sweep.relaxation / self.within_row[0];
        if let Some(long_rows) = &mut self.long_rows {
            let changed = &mut self.row[start..end];
            long_rows.sweep(&mut residual[start..end], changed, factor, |ix| in_set(elements.start + start + ix));
            p[start..end].iter_mut().zip(&*changed).for_each(|(p, change)| *p += change);
            return self.rows.forward(&self.row, changes, &mut self.scratch);
        }
        for ix in start..end {
            if !in_set(elements.start + ix) {
                continue;
            }
            let change = factor * residual[ix];
            p[ix] += change;
            self.row[ix] = change;
            for (r, c) in residual[ix + 1..end].iter_mut().zip(&self.within_row[1..]) {
                *r -= c * change;
            }
        }
        self.rows.forward(&self.row, changes, &mut self.scratch);
    }
}

/// The arrays and parameters of one sweep.
struct Sweep<'a, S> {
    p: &'a mut [f64],
    residual: &'a mut [f64],
    relaxation: f64,
    in_set: S,
}
