//! The transforms of tangential coefficients.
//!
//! With both components of a traction as one complex number, `q = qx + i qy`, the transform Z of q at a wave k, and W, the conjugate of
//! the one at -k, the displacements `ux + i uy` have the transform
//!
//! ```text
//! U(k) = alpha Z + delta W,    conj U(-k) = alpha W + epsilon Z
//! alpha = (Sxx + Syy)/2,    delta = (Sxx - Syy)/2 + i Sxy,    epsilon = (Sxx - Syy)/2 - i Sxy
//! ```

use super::coefficients::Entry;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{blank, keep, zeros};
use crate::operator::fft::{ColumnTransform, Complex, Real};
use crate::operator::row_transform::RowTransform;
use crate::threads::Threads;

/// What memory is for.
pub const SPECTRUM: &str = "the spectrum of tangential influence";

/// What waves are multiplied by, the normalisation `1/(px py)` folded in, one column of them for each x bin up to px/2.
pub enum Spectrum<T> {
    /// Sxx, Syy and Sxy are real: alpha, and the real and the imaginary part of delta, `py/2 + 1` waves a column. The other ones have
    /// the conjugate of delta; epsilon is the conjugate of delta.
    Even(Vec<[T; 3]>),
    /// alpha, delta, epsilon: `py` waves a column.
    General(Vec<[Complex<T>; 3]>),
}

/// Which coefficients: as they are, or the inverse of what they are on a torus.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Direct,
    Inverse,
}

/// Of coefficients that are neither even nor odd: `fill(x, y)` gives that of an offset.
pub fn general<T: Real>(
    grid: &Grid,
    (px, py): (usize, usize),
    fill: impl Fn(i64, i64) -> Entry + Sync + Send,
    unit: f64,
    threads: &Threads,
) -> Result<Spectrum<T>> {
    let (rows, columns) = (RowTransform::<f64>::new(px)?, ColumnTransform::<f64>::new(py)?);
    let (nb, mx, my) = (rows.bins(), grid.mx as i64, grid.my as i64);
    let nothing = Complex::new(f64::NAN, f64::NAN);
    let mut in_x = blank((2 * grid.my - 1) * nb, [nothing; 3], SPECTRUM)?;
    let mut scratch = SetUp::for_pieces(threads, &rows, &columns)?;
    threads.for_each_row(&mut in_x, nb, &mut scratch, |i, out, piece| {
        let ky = i as i64 - (my - 1);
        piece.row.fill([0.0; 3]);
        for kx in 1 - mx..mx {
            piece.row[kx.rem_euclid(px as i64) as usize] = fill(kx, ky);
        }
        piece.transform_row(&rows, |k, component, bin| out[k][component] = bin);
    });
    let mut spectrum = blank(nb * py, [Complex::new(T::nan(), T::nan()); 3], SPECTRUM)?;
    let scale = 1.0 / (unit * px as f64 * py as f64);
    let rounded = |value: Complex<f64>| Complex::new(T::of(scale * value.re), T::of(scale * value.im));
    threads.for_each_row(&mut spectrum, py, &mut scratch, |kx, out, piece| {
        let SetUp { column, waves, scratch, .. } = piece;
        for component in 0..3 {
            column.fill(Complex::default());
            for i in 0..2 * my - 1 {
                column[(i - (my - 1)).rem_euclid(py as i64) as usize] = in_x[i as usize * nb + kx][component];
            }
            columns.forward(column, scratch);
            waves.iter_mut().zip(&*column).for_each(|(wave, bin)| wave[component] = *bin);
        }
        for (value, &[xx, yy, xy]) in out.iter_mut().zip(&*waves) {
            let (half, turned) = ((xx - yy) * 0.5, Complex::<f64>::i() * xy);
            *value = [(xx + yy) * 0.5, half + turned, half - turned].map(rounded);
        }
    });
    keep([&mut in_x]);
    Ok(Spectrum::General(spectrum))
}

/// Of coefficients that are even or odd: `fill(x, y)` gives those at offsets less than `given`. None if an inverse is not positive definite.
///
/// One complex transform a row, and a column, has all three: those of xx and of yy are real and even, that of xy is imaginary and odd,
/// so that `xx + xy + i yy` keeps them apart.
pub fn even<T: Real>(
    (px, py): (usize, usize),
    given: (usize, usize),
    fill: impl Fn(usize, usize) -> Entry + Sync + Send,
    kind: Kind,
    unit: f64,
    threads: &Threads,
) -> Result<Option<Spectrum<T>>> {
    let (rows, columns) = (ColumnTransform::<f64>::new(px)?, ColumnTransform::<f64>::new(py)?);
    let (nb, half) = (px / 2 + 1, py / 2 + 1);
    let of_transforms = rows.scratch_length().max(columns.scratch_length());
    let piece = |_| -> Result<(Vec<_>, Vec<_>)> { Ok((zeros(px.max(py), SPECTRUM)?, zeros(of_transforms, SPECTRUM)?)) };
    let mut scratch = (0..threads.count()).map(piece).collect::<Result<Vec<_>>>()?;
    let mut in_x: Vec<Entry> = blank(given.1 * nb, [f64::NAN; 3], SPECTRUM)?;
    threads.for_each_row(&mut in_x, nb, &mut scratch, |ky, out, (row, scratch)| {
        let row = &mut row[..px];
        transform_even(&rows, row, given.0, |kx| fill(kx, ky), scratch);
        out.iter_mut().enumerate().for_each(|(k, out)| *out = apart(row, k));
    });
    let mut spectrum: Vec<[T; 3]> = blank(nb * half, [T::nan(); 3], SPECTRUM)?;
    let scale = 1.0 / (unit * px as f64 * py as f64);
    let is_positive = std::sync::atomic::AtomicBool::new(true);
    threads.for_each_row(&mut spectrum, half, &mut scratch, |kx, out, (column, scratch)| {
        let column = &mut column[..py];
        transform_even(&columns, column, given.1, |ky| in_x[ky * nb + kx], scratch);
        for (k, value) in out.iter_mut().enumerate() {
            let [xx, yy, odd] = apart(column, k);
            // i from either direction.
            let [xx, yy, xy] = match kind {
                Kind::Direct => [xx, yy, -odd],
                Kind::Inverse => {
                    let determinant = xx * yy - odd * odd;
                    if !(determinant > 0.0 && xx > 0.0) {
                        is_positive.store(false, std::sync::atomic::Ordering::Relaxed);
                    }
                    [yy / determinant, xx / determinant, odd / determinant]
                }
            };
            *value = [0.5 * (xx + yy), 0.5 * (xx - yy), xy].map(|value| T::of(scale * value));
        }
    });
    keep([&mut in_x]);
    Ok(is_positive.into_inner().then_some(Spectrum::Even(spectrum)))
}

/// The transform of `xx + xy + i yy`, whose values at offsets less than `given` are those of `at`; on the other side xy has the other sign.
/// Where there is one offset only half-way around, xy is 0.
fn transform_even(
    transform: &ColumnTransform<f64>,
    values: &mut [Complex<f64>],
    given: usize,
    at: impl Fn(usize) -> Entry,
    scratch: &mut [Complex<f64>],
) {
    let period = values.len();
    values[given..(period + 1 - given).max(given)].fill(Complex::default());
    for k in 0..given {
        let [xx, yy, xy] = at(k);
        if k > 0 {
            values[period - k] = Complex::new(xx - xy, yy);
        }
        values[k] = Complex::new(xx + xy, yy);
    }
    transform.forward(values, scratch);
}

/// Of a transform of `xx + xy + i yy` those of xx and yy at a wave, and the imaginary part of that of xy.
fn apart(transformed: &[Complex<f64>], k: usize) -> Entry {
    let (value, mirrored) = (transformed[k], transformed[(transformed.len() - k) % transformed.len()]);
    [0.5 * (value.re + mirrored.re), 0.5 * (value.im + mirrored.im), 0.5 * (value.im - mirrored.im)]
}

/// Memory of one piece of a set-up.
struct SetUp {
    row: Vec<Entry>,
    values: Vec<f64>,
    bins: Vec<Complex<f64>>,
    column: Vec<Complex<f64>>,
    waves: Vec<[Complex<f64>; 3]>,
    scratch: Vec<Complex<f64>>,
}

impl SetUp {
    fn for_pieces(threads: &Threads, rows: &RowTransform<f64>, columns: &ColumnTransform<f64>) -> Result<Vec<SetUp>> {
        let of_transforms = rows.scratch_length().max(columns.scratch_length());
        let piece = |_| {
            Ok(SetUp {
                row: zeros(rows.length(), SPECTRUM)?,
                values: zeros(rows.length(), SPECTRUM)?,
                bins: zeros(rows.bins(), SPECTRUM)?,
                column: zeros(columns.length(), SPECTRUM)?,
                waves: zeros(columns.length(), SPECTRUM)?,
                scratch: zeros(of_transforms, SPECTRUM)?,
            })
        };
        (0..threads.count()).map(piece).collect()
    }

    /// Transforms the three components of `row`; `take(bin, component, value)` takes each value.
    fn transform_row(&mut self, rows: &RowTransform<f64>, mut take: impl FnMut(usize, usize, Complex<f64>)) {
        for component in 0..3 {
            self.values.iter_mut().zip(&self.row).for_each(|(value, entry)| *value = entry[component]);
            rows.forward(&self.values, &mut self.bins, &mut self.scratch);
            self.bins.iter().enumerate().for_each(|(k, bin)| take(k, component, *bin));
        }
    }
}
