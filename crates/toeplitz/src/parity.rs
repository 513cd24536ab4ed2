//! Products of loads by kernels of any parity: sums over loads, each with its own kernel, which changes often.
//!
//! ```text
//! u = F^-1 sum over loads of i^(number of odd directions) S . F load
//! ```
//!
//! A kernel that is even in both directions has a real, even symbol S. In each direction in which it is odd, the symbol has a factor i and S is odd.
//! Loads are padded with zeros to a period and transformed once. One quadrant of each kernel is tabulated, or half of S is known. Two real rows a, b
//! make one complex row `a + i b`, which halves the cost of row transforms. All lengths are possible; products use one thread.

use crate::fft::any_length::ColumnTransform;
use crate::real::Complex;
use par::memory::zeros;
use par::Result;

/// Columns transformed at a time: values of two cache lines.
const BLOCK: usize = 8;

/// The name of this memory in messages.
const KERNELS: &str = "the transforms of kernels";

/// Products of one period.
pub struct ParityProduct {
    rows: ColumnTransform<f64>,
    columns: ColumnTransform<f64>,
}

/// Memory for these products.
pub struct ParityMemory {
    /// Transforms in x of one kernel, `[ky][bin in x]`.
    in_x: Vec<f64>,
    row: Vec<Complex<f64>>,
    columns: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// A load and its kernel.
#[derive(Clone, Copy)]
pub struct Term<'a> {
    /// The transform of the load, `[bin in x >= 0][bin in y]`.
    pub load: &'a [Complex<f64>],
    /// S, `[bin in x >= 0][bin in y >= 0]`.
    pub symbol: &'a [f64],
    /// Whether the kernel is odd in x, and in y.
    pub is_odd: (bool, bool),
}

impl ParityProduct {
    /// Plans for `px` by `py` values.
    pub fn new(px: usize, py: usize) -> Result<ParityProduct> {
        Ok(ParityProduct { rows: ColumnTransform::new(px)?, columns: ColumnTransform::new(py)? })
    }

    /// Values of a period in x and in y.
    pub fn lengths(&self) -> (usize, usize) {
        (self.rows.length(), self.columns.length())
    }

    /// Numbers of bins >= 0 in x and in y.
    pub fn bins(&self) -> (usize, usize) {
        (self.rows.length() / 2 + 1, self.columns.length() / 2 + 1)
    }

    /// Memory for tables of `rows` rows.
    pub fn memory(&self, rows: usize) -> Result<ParityMemory> {
        let (px, py) = self.lengths();
        let mut scratch = self.rows.scratch()?;
        self.columns.fit(&mut scratch)?;
        Ok(ParityMemory {
            in_x: zeros(rows * self.bins().0.next_multiple_of(2), KERNELS)?,
            row: zeros(px, KERNELS)?,
            columns: zeros(BLOCK * py, KERNELS)?,
            scratch,
        })
    }

    /// The transform of a load `[my][mx]` over `scale`, padded with zeros, times a factor: `[bin in x >= 0][bin in y]`.
    pub fn of_load(&self, load: &[f64], mx: usize, scale: f64, factor: f64) -> Result<Vec<Complex<f64>>> {
        let ((px, py), nb) = (self.lengths(), self.bins().0);
        let mut spectrum = zeros(nb * py, "the transform of a load")?;
        let ParityMemory { mut row, mut scratch, .. } = self.memory(0)?;
        for (two, load) in load.chunks(2 * mx).enumerate() {
            let (one, other) = load.split_at(mx);
            row.fill(Complex::default());
            row.iter_mut().zip(one).for_each(|(value, load)| value.re = load / scale * factor);
            row.iter_mut().zip(other).for_each(|(value, load)| value.im = load / scale * factor);
            self.rows.forward(&mut row, &mut scratch);
            for bin in 0..nb {
                // The first row has the even part of the real values and the odd part of the imaginary ones.
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

    /// Computes S, `[bin in x][bin in y]`, both >= 0, from a kernel tabulated at offsets `[ky][kx] >= 0`, `mx` in a row. Offsets beyond the table are
    /// 0.
    pub fn of_kernel(
        &self,
        table: &[f64],
        mx: usize,
        (odd_x, odd_y): (bool, bool),
        memory: &mut ParityMemory,
        spectrum: &mut [f64],
    ) {
        let ((px, py), (nb, half)) = (self.lengths(), self.bins());
        let width = nb.next_multiple_of(2);
        let my = table.len() / mx;
        let ParityMemory { in_x, row, columns, scratch } = memory;
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

    /// The sum over loads, transformed back in y: `[iy][bin in x]`. Only the first `in_x` bins in x and `in_y` bins in y are not 0.
    pub fn in_x<'a>(
        &self,
        terms: impl Iterator<Item = Term<'a>> + Clone,
        (in_x, in_y): (usize, usize),
        memory: &mut ParityMemory,
        out: &mut [Complex<f64>],
    ) {
        let (py, (nb, half)) = (self.columns.length(), self.bins());
        let ParityMemory { columns, scratch, .. } = memory;
        for first in (0..in_x).step_by(BLOCK) {
            let count = BLOCK.min(in_x - first);
            let columns = &mut columns[..count * py];
            columns.chunks_exact_mut(py).for_each(|column| column[gap(in_y, py)].fill(Complex::default()));
            for (k, term) in terms.clone().enumerate() {
                for (bin, column) in (first..).zip(columns.chunks_exact_mut(py)) {
                    let (load, s) = (&term.load[bin * py..][..py], &term.symbol[bin * half..][..in_y]);
                    match k {
                        0 => put_product(column, load, s, term.is_odd, |sum, value| *sum = value),
                        _ => put_product(column, load, s, term.is_odd, |sum, value| *sum += value),
                    }
                }
            }
            self.columns.inverse(columns, scratch);
            for (iy, row) in out.chunks_exact_mut(nb).enumerate() {
                for (value, column) in row[first..first + count].iter_mut().zip(columns.chunks_exact(py)) {
                    *value = column[iy];
                }
            }
        }
    }

    /// Transforms back in x, with a factor: from bins `[row][bin in x >= 0]`, the first `left` of which are not 0, to rows of `out` with `mx` values
    /// each.
    pub fn back(
        &self,
        bins: &[Complex<f64>],
        left: usize,
        factor: f64,
        memory: &mut ParityMemory,
        out: &mut [f64],
        mx: usize,
    ) {
        let (px, nb) = (self.rows.length(), self.bins().0);
        let ParityMemory { row, scratch, .. } = memory;
        for (two, out) in bins.chunks(2 * nb).zip(out.chunks_mut(2 * mx)) {
            let (one, other) = two.split_at(nb);
            row[gap(left, px)].fill(Complex::default());
            let second = |bin: usize| other.get(bin).copied().unwrap_or_default();
            for bin in 0..left {
                let (a, b) = (one[bin], second(bin));
                row[bin] = Complex::new(a.re - b.im, a.im + b.re);
                // The bin of the opposite wave has the conjugates of both.
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

/// Sets the value half a period away to 0 for odd values, which are their own opposite there.
fn close(values: &mut [Complex<f64>], given: usize, odd: bool) {
    if odd && 2 * (given - 1) == values.len() {
        values[given - 1] = Complex::default();
    }
}

/// The transforms of two rows transformed as one: real for even rows, imaginary for odd ones.
fn both(value: Complex<f64>, odd: bool) -> (f64, f64) {
    if odd {
        (value.im, -value.re)
    } else {
        (value.re, value.im)
    }
}

/// Puts `i^(number of odd directions) S . load` of one column, with S given at bins in y >= 0.
fn put_product(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    (odd_x, odd_y): (bool, bool),
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
) {
    let sign = if odd_y { -1.0 } else { 1.0 };
    match (odd_x, odd_y) {
        (false, false) => put_turned(column, load, s, sign, put, |value| value),
        (true, true) => put_turned(column, load, s, sign, put, |value| -value),
        _ => put_turned(column, load, s, sign, put, |value| Complex::new(-value.im, value.re)),
    }
}

#[inline]
fn put_turned(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    sign: f64,
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
    turn: impl Fn(Complex<f64>) -> Complex<f64>,
) {
    let half = column.len() / 2 + 1;
    let ((lower, upper), (load_lower, load_upper)) = (column.split_at_mut(half), load.split_at(half));
    for ((value, load), s) in lower.iter_mut().zip(load_lower).zip(s) {
        put(value, turn(load * s));
    }
    for ((value, load), s) in upper.iter_mut().rev().zip(load_upper.iter().rev()).zip(&s[1..]) {
        put(value, turn(load * (sign * s)));
    }
}

/// The rest of a period beside the first values and their mirror images.
fn gap(values: usize, period: usize) -> std::ops::Range<usize> {
    values..values.max(period + 1 - values)
}
