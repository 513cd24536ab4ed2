//! The transforms of tangential coefficients.

use super::coefficients::Entry;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use crate::operator::fft::{ColumnTransform, Complex, Real, RowTransform};
use crate::threads::Threads;

/// What memory is for.
pub const SPECTRUM: &str = "the spectrum of tangential influence";

/// `Sxx, Syy, Sxy` of each wave, the normalisation `1/(px py)` folded in, one column of them per x bin.
pub enum Spectrum<T> {
    /// Real: `py/2 + 1` waves a column.
    Even(Vec<[T; 3]>),
    /// Complex: `py` waves a column.
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
    fill: impl Fn(f64, f64) -> Entry + Sync + Send,
    unit: f64,
    threads: &Threads,
) -> Result<Spectrum<T>> {
    let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
    let (nb, mx, my) = (rows.bins(), grid.mx as i64, grid.my as i64);
    let mut in_x: Vec<[Complex<f64>; 3]> = zeros((2 * grid.my - 1) * nb, SPECTRUM)?;
    let mut scratch = SetUp::for_pieces(threads, &rows, &columns);
    threads.for_each_row(&mut in_x, nb, &mut scratch, |i, out, piece| {
        let ky = (i as i64 - (my - 1)) as f64;
        piece.row.fill([0.0; 3]);
        for kx in 1 - mx..mx {
            piece.row[kx.rem_euclid(px as i64) as usize] = fill(kx as f64, ky);
        }
        piece.transform_row(&rows, |k, component, bin| out[k][component] = bin);
    });
    let mut spectrum: Vec<[Complex<T>; 3]> = zeros(nb * py, SPECTRUM)?;
    let scale = 1.0 / (unit * px as f64 * py as f64);
    threads.for_each_row(&mut spectrum, py, &mut scratch, |kx, out, piece| {
        for component in 0..3 {
            piece.column.fill(Complex::default());
            for i in 0..2 * my - 1 {
                piece.column[(i - (my - 1)).rem_euclid(py as i64) as usize] = in_x[i as usize * nb + kx][component];
            }
            columns.forward(&mut piece.column, &mut piece.scratch);
            for (value, bin) in out.iter_mut().zip(&piece.column) {
                value[component] = Complex::new(T::of(scale * bin.re), T::of(scale * bin.im));
            }
        }
    });
    Ok(Spectrum::General(spectrum))
}

/// Of coefficients that are even or odd: `fill(x, y)` gives those at offsets less than `given`.
pub fn even<T: Real>(
    (px, py): (usize, usize),
    given: (usize, usize),
    fill: impl Fn(usize, usize) -> Entry + Sync + Send,
    kind: Kind,
    unit: f64,
    threads: &Threads,
) -> Result<Option<Spectrum<T>>> {
    let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
    let (nb, half) = (rows.bins(), py / 2 + 1);
    let mut scratch = SetUp::for_pieces(threads, &rows, &columns);
    let mut in_x: Vec<Entry> = zeros(given.1 * nb, SPECTRUM)?;
    threads.for_each_row(&mut in_x, nb, &mut scratch, |ky, out, piece| {
        piece.row.fill([0.0; 3]);
        for kx in 0..given.0 {
            let [xx, yy, xy] = fill(kx, ky);
            // Where there is one offset only half-way around, the even ones stand there, and the odd ones are 0.
            piece.row[kx] = [xx, yy, xy];
            if kx > 0 {
                piece.row[px - kx] = [xx, yy, -xy];
            }
        }
        piece.transform_row(&rows, |k, component, bin| out[k][component] = if component < 2 { bin.re } else { bin.im });
    });
    let mut spectrum: Vec<[T; 3]> = zeros(nb * half, SPECTRUM)?;
    let scale = 1.0 / (px as f64 * py as f64);
    let is_positive = std::sync::atomic::AtomicBool::new(true);
    threads.for_each_row(&mut spectrum, half, &mut scratch, |kx, out, piece| {
        let mut waves = vec![[0.0; 3]; half];
        // xx and yy are the real and the imaginary part of one transform.
        piece.fill_column(py, given.1, 1.0, |ky| Complex::new(in_x[ky * nb + kx][0], in_x[ky * nb + kx][1]));
        columns.forward(&mut piece.column, &mut piece.scratch);
        waves.iter_mut().zip(&piece.column).for_each(|(wave, bin)| (wave[0], wave[1]) = (bin.re, bin.im));
        // i from either direction.
        piece.fill_column(py, given.1, -1.0, |ky| Complex::new(in_x[ky * nb + kx][2], 0.0));
        columns.forward(&mut piece.column, &mut piece.scratch);
        waves.iter_mut().zip(&piece.column).for_each(|(wave, bin)| wave[2] = -bin.im);
        for (value, [xx, yy, xy]) in out.iter_mut().zip(waves) {
            let wave = match kind {
                Kind::Direct => [xx, yy, xy],
                Kind::Inverse => {
                    let determinant = xx * yy - xy * xy;
                    if !(determinant > 0.0 && xx > 0.0) {
                        is_positive.store(false, std::sync::atomic::Ordering::Relaxed);
                    }
                    [yy / determinant, xx / determinant, -xy / determinant]
                }
            };
            *value = wave.map(|value| T::of(scale / unit * value));
        }
    });
    Ok(is_positive.into_inner().then_some(Spectrum::Even(spectrum)))
}

/// Memory of one piece of a set-up.
struct SetUp {
    row: Vec<Entry>,
    values: Vec<f64>,
    bins: Vec<Complex<f64>>,
    column: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl SetUp {
    fn for_pieces(threads: &Threads, rows: &RowTransform<f64>, columns: &ColumnTransform<f64>) -> Vec<SetUp> {
        let mut scratch = rows.scratch();
        columns.fit(&mut scratch);
        let piece = |_| SetUp {
            row: vec![[0.0; 3]; rows.length()],
            values: vec![0.0; rows.length()],
            bins: vec![Complex::default(); rows.bins()],
            column: vec![Complex::default(); columns.length()],
            scratch: scratch.clone(),
        };
        (0..threads.pieces()).map(piece).collect()
    }

    /// Transforms the three components of `row`; `take(bin, component, value)` takes each value.
    fn transform_row(&mut self, rows: &RowTransform<f64>, mut take: impl FnMut(usize, usize, Complex<f64>)) {
        for component in 0..3 {
            self.values.iter_mut().zip(&self.row).for_each(|(value, entry)| *value = entry[component]);
            rows.forward(&mut self.values, &mut self.bins, &mut self.scratch);
            self.bins.iter().enumerate().for_each(|(k, bin)| take(k, component, *bin));
        }
    }

    /// A column of values at offsets less than `given`, and `sign` times them on the other side.
    fn fill_column(&mut self, py: usize, given: usize, sign: f64, value: impl Fn(usize) -> Complex<f64>) {
        self.column.fill(Complex::default());
        for ky in 0..given {
            let value = value(ky);
            self.column[ky] = value;
            if ky > 0 {
                self.column[py - ky] = value * sign;
            }
        }
    }
}
