//! The sequential part of Gauss-Seidel in rows of many elements.
//!
//! The changes of earlier elements displace the later elements of a row. These displacements are the product of a triangular Toeplitz matrix with the
//! changes. Within strips of [`STRIP`] elements the product is a direct sum. In larger blocks the influence of the first half on the second is a
//! product by FFT. So a row of m elements takes O(m log^2 m) operations instead of m^2.

use crate::error::Result;
use crate::operator::fft::Complex;
use crate::operator::row_transform::RowTransform;
use crate::operator::zeros;

/// The number of elements of a strip, whose mutual influence is summed directly.
const STRIP: usize = 512;
/// In rows of at most this many elements the influence is summed directly.
pub const SHORT: usize = 4096;

/// The sequential part of rows of one length.
pub struct LongRows {
    /// The coefficients `c(k, 0)`, `k >= 0`, within a strip.
    within_row: Vec<f64>,
    /// For blocks of 2, 4, ... strips: the effect of the first half of the elements on the second half.
    halves: Vec<Half>,
    row: Vec<f64>,
    bins: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// The effect of the first half of a block of elements on its second half.
struct Half {
    transform: RowTransform<f64>,
    /// The coefficients, transformed over the length of the block.
    kernel: Vec<Complex<f64>>,
}

impl LongRows {
    /// Sets up the sequential part for rows with the coefficients `within_row`; None if the rows are short.
    pub fn new(within_row: &[f64]) -> Result<Option<LongRows>> {
        let mx = within_row.len();
        if mx <= SHORT {
            return Ok(None);
        }
        let (mut halves, mut scratch, mut block) = (Vec::new(), Vec::new(), 2 * STRIP);
        let mut row = Vec::new();
        while block < 2 * mx {
            let transform = RowTransform::new(block)?;
            let mut kernel = zeros(transform.bins(), "the smoother")?;
            row = zeros(block, "the smoother")?;
            let known = block.min(mx);
            row[1..known].iter_mut().zip(&within_row[1..]).for_each(|(to, c)| *to = c / block as f64);
            transform.fit(&mut scratch)?;
            transform.forward(&row, &mut kernel, &mut scratch);
            halves.push(Half { transform, kernel });
            block *= 2;
        }
        let bins = zeros(row.len() / 2 + 1, "the smoother")?;
        Ok(Some(LongRows { within_row: within_row[..STRIP].to_vec(), halves, row, bins, scratch }))
    }

    /// Sweeps the elements of a row: overwrites `residual`, and writes the changes of p on elements of the set to `changes`. Elsewhere `changes`
    /// keeps its values.
    pub fn sweep(
        &mut self,
        residual: &mut [f64],
        changes: &mut [f64],
        factor: f64,
        in_set: impl Fn(usize) -> bool + Copy,
    ) {
        let level = (0..).find(|&level| STRIP << level >= residual.len()).unwrap_or(0);
        self.block(0, level, &mut Sweep { residual, changes, factor, in_set });
    }

    /// Sweeps the block of up to `STRIP << level` elements from `first` on.
    fn block<S: Fn(usize) -> bool + Copy>(&mut self, first: usize, level: usize, sweep: &mut Sweep<'_, S>) {
        let end = sweep.residual.len().min(first + (STRIP << level));
        if level == 0 {
            for i in (first..end).filter(|&i| (sweep.in_set)(i)) {
                let change = sweep.factor * sweep.residual[i];
                sweep.changes[i] = change;
                for (r, c) in sweep.residual[i + 1..end].iter_mut().zip(&self.within_row[1..]) {
                    *r -= c * change;
                }
            }
            return;
        }
        let middle = first + (STRIP << (level - 1));
        self.block(first, level - 1, sweep);
        if middle >= end {
            return;
        }
        let changes = &sweep.changes[first..middle];
        if changes.iter().any(|change| *change != 0.0) {
            let Half { transform, kernel } = &self.halves[level - 1];
            let (row, bins) = (&mut self.row[..STRIP << level], &mut self.bins[..kernel.len()]);
            row[..changes.len()].copy_from_slice(changes);
            row[changes.len()..].fill(0.0);
            transform.forward(row, bins, &mut self.scratch);
            bins.iter_mut().zip(kernel).for_each(|(bin, k)| *bin *= k);
            transform.inverse(bins, row, &mut self.scratch);
            let later = sweep.residual[middle..end].iter_mut();
            later.zip(&row[middle - first..]).for_each(|(r, sum)| *r -= sum);
        }
        self.block(middle, level - 1, sweep);
    }
}

/// The arrays and parameters of one sweep.
struct Sweep<'a, S> {
    residual: &'a mut [f64],
    changes: &'a mut [f64],
    factor: f64,
    in_set: S,
}
