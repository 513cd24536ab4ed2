//! Sums of convolutions of loads with kernels that are even or odd in either direction. Each load has its own kernel, which may change for each sum.
//!
//! ```text
//! u = F^-1 sum over loads of i^(number of odd directions) S . F load
//! ```
//!
//! A kernel that is even in both directions has a real and even symbol S. For each direction in which a kernel is odd, its symbol is i times a real S
//! that is odd in this direction. Loads are padded with zeros to a period and transformed once. A caller gives one quadrant of the kernel as a table,
//! or S at the bins >= 0. Two real rows a, b make one complex row `a + i b`, which halves the cost of row transforms. Any length is possible.
//! Products use one thread.

use crate::fft::any_length::ColumnTransform;
use crate::real::Complex;
use par::memory::zeros;
use par::Result;

/// The number of columns that are transformed at a time. A row of 8 complex values has two cache lines.
const BLOCK: usize = 8;

/// The name of this memory in messages.
const KERNELS: &str = "the transforms of kernels";

/// The transforms of one period, and the sums of products of this period.
pub struct ParityProduct {
    rows: ColumnTransform<f64>,
    columns: ColumnTransform<f64>,
}

/// The memory of these transforms.
pub struct ParityMemory {
    /// One kernel transformed in x, `[ky][bin in x]`.
    in_x: Vec<f64>,
    /// One complex row, which joins two real ones.
    row: Vec<Complex<f64>>,
    /// A block of columns.
    columns: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// One term of a sum: a load and its kernel, both transformed.
#[derive(Clone, Copy)]
pub struct Term<'a> {
    /// The transform of the load, `[bin in x >= 0][bin in y]`.
    pub load: &'a [Complex<f64>],
    /// The real S of the kernel, `[bin in x >= 0][bin in y >= 0]`. The symbol is S times i for each direction in which the kernel is odd.
    pub symbol: &'a [f64],
    /// Whether the kernel is odd in x, and whether it is odd in y.
    pub is_odd: (bool, bool),
}

impl ParityProduct {
    /// Makes the plans for a period of `px` by `py` values.
    pub fn new(px: usize, py: usize) -> Result<ParityProduct> {
        Ok(ParityProduct { rows: ColumnTransform::new(px)?, columns: ColumnTransform::new(py)? })
    }

    /// The lengths of the period in x and in y.
    pub fn lengths(&self) -> (usize, usize) {
        (self.rows.length(), self.columns.length())
    }

    /// The numbers of bins >= 0 in x and in y.
    pub fn bins(&self) -> (usize, usize) {
        (self.rows.length() / 2 + 1, self.columns.length() / 2 + 1)
    }

    /// Allocates memory for kernels that are tabulated in `rows` rows.
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

    /// Transforms a load `[my][mx]`, padded with zeros, times `factor/scale`. Returns `[bin in x >= 0][bin in y]`.
    pub fn of_load(&self, load: &[f64], mx: usize, scale: f64, factor: f64) -> Result<Vec<Complex<f64>>> {
        let ((px, py), nb) = (self.lengths(), self.bins().0);
        let mut spectrum = zeros(nb * py, "the transform of a load")?;
        let ParityMemory { mut row, mut scratch, .. } = self.memory(0)?;
        for (pair, load) in load.chunks(2 * mx).enumerate() {
            let (first, second) = load.split_at(mx);
            row.fill(Complex::default());
            row.iter_mut().zip(first).for_each(|(value, load)| value.re = load / scale * factor);
            row.iter_mut().zip(second).for_each(|(value, load)| value.im = load / scale * factor);
            self.rows.forward(&mut row, &mut scratch);
            for bin in 0..nb {
                // With Z the transform of a + i b: F_a = (Z_k + Z*_-k)/2 and i F_b = (Z_k - Z*_-k)/2.
                let (value, mirrored) = (row[bin], row[(px - bin) % px].conj());
                let (of_first, i_of_second) = (0.5 * (value + mirrored), 0.5 * (value - mirrored));
                spectrum[bin * py + 2 * pair] = of_first;
                if !second.is_empty() {
                    spectrum[bin * py + 2 * pair + 1] = Complex::new(i_of_second.im, -i_of_second.re);
                }
            }
        }
        self.columns.forward(&mut spectrum, &mut scratch);
        Ok(spectrum)
    }

    /// Computes S, `[bin in x >= 0][bin in y >= 0]`, of a kernel that is tabulated at offsets `[ky][kx] >= 0`, `mx` in a row. Beyond the table the
    /// kernel is 0.
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
        for (pair, in_x) in table.chunks(2 * mx).zip(in_x.chunks_mut(2 * width)) {
            let (first, second) = pair.split_at(mx);
            row[gap(mx, px)].fill(Complex::default());
            for (kx, re) in first.iter().enumerate() {
                let value = Complex::new(*re, second.get(kx).copied().unwrap_or(0.0));
                put(row, kx, value, odd_x);
            }
            clear_half_period(row, mx, odd_x);
            self.rows.forward(row, scratch);
            let (first, second) = in_x.split_at_mut(width);
            for (bin, value) in row[..nb].iter().enumerate() {
                let (of_first, of_second) = of_pair(*value, odd_x);
                first[bin] = of_first;
                if let Some(second) = second.get_mut(bin) {
                    *second = of_second;
                }
            }
        }
        for first in (0..nb).step_by(2 * BLOCK) {
            let pairs = BLOCK.min((width - first) / 2);
            let columns = &mut columns[..pairs * py];
            columns.chunks_exact_mut(py).for_each(|column| column[gap(my, py)].fill(Complex::default()));
            for (ky, in_x) in in_x.chunks_exact(width).take(my).enumerate() {
                for (column, pair) in columns.chunks_exact_mut(py).zip(in_x[first..].chunks_exact(2)) {
                    let value = Complex::new(pair[0], pair[1]);
                    put(column, ky, value, odd_y);
                }
            }
            columns.chunks_exact_mut(py).for_each(|column| clear_half_period(column, my, odd_y));
            self.columns.forward(columns, scratch);
            let spectra = spectrum[first * half..].chunks_mut(2 * half);
            for (column, pair) in columns.chunks_exact(py).zip(spectra) {
                let (first, second) = pair.split_at_mut(half);
                for (k, value) in column[..half].iter().enumerate() {
                    let (of_first, of_second) = of_pair(*value, odd_y);
                    first[k] = of_first;
                    if let Some(second) = second.get_mut(k) {
                        *second = of_second;
                    }
                }
            }
        }
    }

    /// Multiplies each load by its symbol, adds the products and transforms the sum back in y, to `out`: `[iy][bin in x]`. The caller knows that the
    /// symbols are 0 except in the first `bins_x` bins in x and the first `bins_y` bins in y. Only the first `bins_x` bins of each row of `out` are
    /// written.
    pub fn in_x<'a>(
        &self,
        terms: impl Iterator<Item = Term<'a>> + Clone,
        (bins_x, bins_y): (usize, usize),
        memory: &mut ParityMemory,
        out: &mut [Complex<f64>],
    ) {
        let (py, (nb, half)) = (self.columns.length(), self.bins());
        let ParityMemory { columns, scratch, .. } = memory;
        for first in (0..bins_x).step_by(BLOCK) {
            let count = BLOCK.min(bins_x - first);
            let columns = &mut columns[..count * py];
            columns.chunks_exact_mut(py).for_each(|column| column[gap(bins_y, py)].fill(Complex::default()));
            for (i, term) in terms.clone().enumerate() {
                for (bin, column) in (first..).zip(columns.chunks_exact_mut(py)) {
                    let (load, s) = (&term.load[bin * py..][..py], &term.symbol[bin * half..][..bins_y]);
                    // The first term overwrites the columns of the previous block.
                    match i {
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

    /// Transforms bins `[row][bin in x >= 0]` back in x, times a factor, to the rows of `out`, which have `mx` values each. In each row only the
    /// first `bins_x` bins are not 0.
    pub fn back(
        &self,
        bins: &[Complex<f64>],
        bins_x: usize,
        factor: f64,
        memory: &mut ParityMemory,
        out: &mut [f64],
        mx: usize,
    ) {
        let (px, nb) = (self.rows.length(), self.bins().0);
        let ParityMemory { row, scratch, .. } = memory;
        for (pair, out) in bins.chunks(2 * nb).zip(out.chunks_mut(2 * mx)) {
            let (first, second) = pair.split_at(nb);
            row[gap(bins_x, px)].fill(Complex::default());
            let second = |bin: usize| second.get(bin).copied().unwrap_or_default();
            for bin in 0..bins_x {
                let (a, b) = (first[bin], second(bin));
                row[bin] = Complex::new(a.re - b.im, a.im + b.re);
                // Bin px - k of a real row is the conjugate of bin k.
                if bin > 0 && 2 * bin != px {
                    row[px - bin] = Complex::new(a.re + b.im, b.re - a.im);
                }
            }
            self.rows.inverse(row, scratch);
            let (first, second) = out.split_at_mut(mx);
            first.iter_mut().zip(&*row).for_each(|(out, value)| *out = factor * value.re);
            second.iter_mut().zip(&*row).for_each(|(out, value)| *out = factor * value.im);
        }
    }
}

/// Writes a value at offset k of a period, and the same value or, if odd, its negative at offset -k.
fn put(values: &mut [Complex<f64>], k: usize, value: Complex<f64>, odd: bool) {
    values[k] = value;
    if k > 0 {
        let period = values.len();
        values[period - k] = if odd { -1.0 } else { 1.0 } * value;
    }
}

/// Sets the value at half a period to 0 if the values are odd: there k and -k coincide. `given` is the number of given offsets >= 0.
fn clear_half_period(values: &mut [Complex<f64>], given: usize, odd: bool) {
    if odd && 2 * (given - 1) == values.len() {
        values[given - 1] = Complex::default();
    }
}

/// The values of S of two real rows or columns a, b that were transformed as a + i b, from one bin. Even ones have the real transforms F_a and F_b,
/// and the bin is `F_a + i F_b`. Odd ones have the imaginary transforms `i F_a` and `i F_b`, and the bin is `i F_a - F_b`.
fn of_pair(value: Complex<f64>, odd: bool) -> (f64, f64) {
    if odd {
        (value.im, -value.re)
    } else {
        (value.re, value.im)
    }
}

/// Multiplies the load of one column by its symbol, `i^(number of odd directions) S`. `s` has S at bins in y >= 0. `put(value, product)` stores or
/// adds a product.
fn put_product(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    (odd_x, odd_y): (bool, bool),
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
) {
    let sign = if odd_y { -1.0 } else { 1.0 };
    match (odd_x, odd_y) {
        (false, false) => put_with_phase(column, load, s, sign, put, |value| value),
        (true, true) => put_with_phase(column, load, s, sign, put, |value| -value),
        _ => put_with_phase(column, load, s, sign, put, |value| Complex::new(-value.im, value.re)),
    }
}

/// [`put_product`] with the factor `i^(number of odd directions)` as a function `phase`. `sign` is -1 if S is odd in y, otherwise 1.
#[inline]
fn put_with_phase(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    sign: f64,
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
    phase: impl Fn(Complex<f64>) -> Complex<f64>,
) {
    let half = column.len() / 2 + 1;
    let ((lower, upper), (load_lower, load_upper)) = (column.split_at_mut(half), load.split_at(half));
    for ((value, load), s) in lower.iter_mut().zip(load_lower).zip(s) {
        put(value, phase(load * s));
    }
    for ((value, load), s) in upper.iter_mut().rev().zip(load_upper.iter().rev()).zip(&s[1..]) {
        put(value, phase(load * (sign * s)));
    }
}

/// The indices of a period that are neither among the first `values` offsets 0, 1, ... nor among their opposites -1, -2, ...
fn gap(values: usize, period: usize) -> std::ops::Range<usize> {
    values..values.max(period + 1 - values)
}
