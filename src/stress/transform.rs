//! Transforms of two real rows at a time, and of the tables of kernels.
//!
//! Two real rows a, b make one complex row `a + i b`, so that rows are transformed at half the price. A kernel that is even in both
//! directions has a real, even spectrum S; each direction in which it is odd makes that a factor i, and S odd in this direction.

use crate::error::Result;
use crate::memory::zeros;
use crate::operator::fft::{ColumnTransform, Complex};

/// Columns that are transformed at a time: as many values side by side as two cache lines hold.
pub const BLOCK: usize = 8;

/// What memory is for.
const STRESS: &str = "the stresses of a depth";

/// Transforms of one period.
pub struct Transforms {
    rows: ColumnTransform<f64>,
    columns: ColumnTransform<f64>,
}

/// Memory for them.
pub struct Memory {
    /// Of one kernel: transforms in x, `[ky][bin in x]`.
    in_x: Vec<f64>,
    row: Vec<Complex<f64>>,
    pub columns: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Transforms {
    /// Plans for `px` by `py` values.
    pub fn new(px: usize, py: usize) -> Result<Transforms> {
        Ok(Transforms { rows: ColumnTransform::new(px)?, columns: ColumnTransform::new(py)? })
    }

    /// Values of a period in x and in y.
    pub fn lengths(&self) -> (usize, usize) {
        (self.rows.length(), self.columns.length())
    }

    /// Bins in x and in y, none of them negative.
    pub fn bins(&self) -> (usize, usize) {
        (self.rows.length() / 2 + 1, self.columns.length() / 2 + 1)
    }

    /// Memory for tables of `rows` rows.
    pub fn memory(&self, rows: usize) -> Result<Memory> {
        let (px, py) = self.lengths();
        let mut scratch = self.rows.scratch()?;
        self.columns.fit(&mut scratch)?;
        Ok(Memory {
            in_x: zeros(rows * self.bins().0.next_multiple_of(2), STRESS)?,
            row: zeros(px, STRESS)?,
            columns: zeros(BLOCK * py, STRESS)?,
            scratch,
        })
    }

    /// The transform of a load `[my][mx]` over `scale`, padded with zeros, times a factor: `[bin in x >= 0][bin in y]`.
    pub fn of_load(&self, load: &[f64], mx: usize, scale: f64, factor: f64) -> Result<Vec<Complex<f64>>> {
        let ((px, py), nb) = (self.lengths(), self.bins().0);
        let mut spectrum = zeros(nb * py, "the transform of a load")?;
        let Memory { mut row, mut scratch, .. } = self.memory(0)?;
        for (two, load) in load.chunks(2 * mx).enumerate() {
            let (one, other) = load.split_at(mx);
            row.fill(Complex::default());
            row.iter_mut().zip(one).for_each(|(value, load)| value.re = load / scale * factor);
            row.iter_mut().zip(other).for_each(|(value, load)| value.im = load / scale * factor);
            self.rows.forward(&mut row, &mut scratch);
            for bin in 0..nb {
                // What is even of its real part and odd of its imaginary one is the first row's.
                let (value, mirrored) = (row[bin], row[(px - bin) % px].conj());
                let (sum, difference) = (0.5 * (value + mirrored), 0.5 * (value - mirrored));
                spectrum[bin * py + 2 * two] = sum;
                if !other.is_empty() {
                    spectrum[bin * py + 2 * two + 1] = Complex::new(difference.im, -difference.re);
                }
            }
        }
        self.columns.forward(&mut spectrum, &mut scratch);
        Ok(spectrum)
    }

    /// S, `[bin in x][bin in y]`, both >= 0, of the kernel tabulated at offsets `[ky][kx] >= 0`, `mx` in a row: those of a whole period.
    pub fn of_kernel(
        &self,
        table: &[f64],
        mx: usize,
        (odd_x, odd_y): (bool, bool),
        memory: &mut Memory,
        spectrum: &mut [f64],
    ) {
        let ((px, py), (nb, half)) = (self.lengths(), self.bins());
        let width = nb.next_multiple_of(2);
        let my = table.len() / mx;
        let Memory { in_x, row, columns, scratch } = memory;
        for (two, in_x) in table.chunks(2 * mx).zip(in_x.chunks_mut(2 * width)) {
            let (one, other) = two.split_at(mx);
            row[gap(mx, px)].fill(Complex::default());
            for (kx, re) in one.iter().enumerate() {
                let value = Complex::new(*re, other.get(kx).copied().unwrap_or(0.0));
                put(row, kx, value, odd_x);
            }
            close(row, mx, odd_x);
            self.rows.forward(row, scratch);
            let (first, second) = in_x.split_at_mut(width);
            for (bin, value) in row[..nb].iter().enumerate() {
                let (a, b) = both(*value, odd_x);
                first[bin] = a;
                if let Some(second) = second.get_mut(bin) {
                    *second = b;
                }
            }
        }
        for first in (0..nb).step_by(2 * BLOCK) {
            let pairs = BLOCK.min((width - first) / 2);
            let columns = &mut columns[..pairs * py];
            columns.chunks_exact_mut(py).for_each(|column| column[gap(my, py)].fill(Complex::default()));
            for (ky, in_x) in in_x.chunks_exact(width).take(my).enumerate() {
                for (column, two) in columns.chunks_exact_mut(py).zip(in_x[first..].chunks_exact(2)) {
                    let value = Complex::new(two[0], two[1]);
                    put(column, ky, value, odd_y);
                }
            }
            columns.chunks_exact_mut(py).for_each(|column| close(column, my, odd_y));
            self.columns.forward(columns, scratch);
            let spectra = spectrum[first * half..].chunks_mut(2 * half);
            for (column, two) in columns.chunks_exact(py).zip(spectra) {
                let (one, other) = two.split_at_mut(half);
                for (k, value) in column[..half].iter().enumerate() {
                    let (a, b) = both(*value, odd_y);
                    one[k] = a;
                    if let Some(other) = other.get_mut(k) {
                        *other = b;
                    }
                }
            }
        }
    }

    /// Back in y, in place: whole columns.
    pub fn columns_back(&self, columns: usize, memory: &mut Memory) {
        self.columns.inverse(&mut memory.columns[..columns * self.columns.length()], &mut memory.scratch);
    }

    /// Back in x: rows of `out`, `mx` values each, times a factor, of their bins `[row][bin in x >= 0]`, of which `left` are not 0.
    pub fn rows_back(
        &self,
        bins: &[Complex<f64>],
        left: usize,
        factor: f64,
        memory: &mut Memory,
        out: &mut [f64],
        mx: usize,
    ) {
        let (px, nb) = (self.rows.length(), self.bins().0);
        let Memory { row, scratch, .. } = memory;
        for (two, out) in bins.chunks(2 * nb).zip(out.chunks_mut(2 * mx)) {
            let (one, other) = two.split_at(nb);
            row[gap(left, px)].fill(Complex::default());
            let second = |bin: usize| other.get(bin).copied().unwrap_or_default();
            for bin in 0..left {
                let (a, b) = (one[bin], second(bin));
                row[bin] = Complex::new(a.re - b.im, a.im + b.re);
                // The bin of the opposite wave has the conjugate of both.
                if bin > 0 && 2 * bin != px {
                    row[px - bin] = Complex::new(a.re + b.im, b.re - a.im);
                }
            }
            self.rows.inverse(row, scratch);
            let (one, other) = out.split_at_mut(mx);
            one.iter_mut().zip(&*row).for_each(|(out, value)| *out = factor * value.re);
            other.iter_mut().zip(&*row).for_each(|(out, value)| *out = factor * value.im);
        }
    }
}

/// Puts a value at an offset and at its mirror image.
fn put(values: &mut [Complex<f64>], k: usize, value: Complex<f64>, odd: bool) {
    values[k] = value;
    if k > 0 {
        let period = values.len();
        values[period - k] = if odd { -1.0 } else { 1.0 } * value;
    }
}

/// The last of so many values: half a period away what is odd is its own opposite.
fn close(values: &mut [Complex<f64>], given: usize, odd: bool) {
    if odd && 2 * (given - 1) == values.len() {
        values[given - 1] = Complex::default();
    }
}

/// The spectra of two rows that were transformed as one: of even rows they are real, of odd ones imaginary.
fn both(value: Complex<f64>, odd: bool) -> (f64, f64) {
    if odd {
        (value.im, -value.re)
    } else {
        (value.re, value.im)
    }
}

/// What is left of a period where the first values and their mirror images stand.
pub fn gap(values: usize, period: usize) -> std::ops::Range<usize> {
    values..values.max(period + 1 - values)
}
