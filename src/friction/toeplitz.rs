//! Products `u = A q` of two components by FFT.
//!
//! ```text
//! (ux, uy)_I = sum_J [Axx Axy; Axy Ayy](I - J) (qx, qy)_J = [F^-1 (S . F q)]_I
//! ```
//!
//! Axx and Ayy are even in both directions, Axy is odd in both, so that all three transforms are real: a symmetric 2 x 2 matrix S a
//! wave, of which a quarter of the plane is kept (Sxy changes its sign with the wave's y). Coefficients between the centres, of which
//! rolling asks, are neither: their transforms are complex.
//!
//! The two components of a row are transformed one by one and then stand side by side, bin by bin: a block of columns holds all that a
//! wave needs.

use std::ops::Range;

use super::coefficients::{Entry, Tangential};
use super::spectrum::{self, Kind, Spectrum, SPECTRUM};
use super::Vector;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, zeros};
use crate::operator::columns::{for_each_block, BLOCK};
use crate::operator::fft::{good_length, ColumnTransform, Complex, Real, RowTransform};
use crate::threads::Threads;

/// What memory is for.
const WORKSPACE: &str = "the workspace of tangential products";

/// The operator of one grid.
pub struct Toeplitz<T: Real> {
    mx: usize,
    my: usize,
    rows: RowTransform<T>,
    columns: ColumnTransform<T>,
    spectrum: Spectrum<T>,
    threads: Threads,
    /// Coefficients are kept in this unit, a power of two: single precision has a small range.
    unit: f64,
}

/// Memory of products.
#[derive(Default)]
pub struct Workspace<T: Real> {
    /// `[my][px/2 + 1][2]`.
    bins: Vec<Complex<T>>,
    pieces: Vec<Piece<T>>,
}

/// That of one piece of the work.
#[derive(Default)]
struct Piece<T: Real> {
    row: Vec<T>,
    bins: Vec<Complex<T>>,
    columns: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

/// The power of two next to a value.
pub fn unit_of(value: f64) -> f64 {
    if value.is_normal() {
        value.abs().log2().round().exp2()
    } else {
        1.0
    }
}

impl<T: Real> Toeplitz<T> {
    /// Products with the coefficients of `tangential` on `grid`.
    pub fn new(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        let period = (good_length(2 * grid.mx - 1), good_length(2 * grid.my - 1));
        let given = (grid.mx, grid.my);
        let fill = |x: usize, y: usize| tangential.at(x as f64, y as f64);
        let unit = unit_of(tangential.at(0.0, 0.0)[0]);
        let product = spectrum::even(period, given, fill, Kind::Direct, unit, threads)?;
        let spectrum = product.unwrap_or_else(|| unreachable!("only an inverse may not be"));
        Ok(Toeplitz::with(grid, period, spectrum, unit, threads))
    }

    /// The inverse of a circulant near A, with a period one element longer than the grid: a preconditioner. None where that is not
    /// positive definite.
    pub fn inverse(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Option<Toeplitz<T>>> {
        let length = |m: usize| if m == 1 { 1 } else { good_length(m + 1) };
        let period = (length(grid.mx), length(grid.my));
        let given = (period.0 / 2 + 1, period.1 / 2 + 1);
        // An odd function has no value half-way around.
        let half_way = |k: usize, period: usize| 2 * k == period;
        let fill = |x: usize, y: usize| {
            let [xx, yy, xy] = tangential.at(x as f64, y as f64);
            [xx, yy, if half_way(x, period.0) || half_way(y, period.1) { 0.0 } else { xy }]
        };
        let unit = 1.0 / unit_of(tangential.at(0.0, 0.0)[0]);
        let inverse = spectrum::even(period, given, fill, Kind::Inverse, unit, threads)?;
        Ok(inverse.map(|spectrum| Toeplitz::with(grid, period, spectrum, unit, threads)))
    }

    /// Products whose displacements are taken at `(x, y)` from each centre, in elements.
    pub fn displaced(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        let fill = |x: f64, y: f64| tangential.at(x + by.0, y + by.1);
        Toeplitz::general(tangential, grid, fill, threads)
    }

    /// Products of steady rolling: displacements at each centre less those at `(x, y)` from it, in elements.
    pub fn rolling(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        let fill = |x: f64, y: f64| {
            let (here, there) = (tangential.at(x, y), tangential.at(x + by.0, y + by.1));
            [here[0] - there[0], here[1] - there[1], here[2] - there[2]]
        };
        Toeplitz::general(tangential, grid, fill, threads)
    }

    /// Of coefficients that are neither even nor odd: `fill(x, y)` gives that of an offset.
    fn general(
        tangential: &Tangential,
        grid: &Grid,
        fill: impl Fn(f64, f64) -> Entry + Sync + Send,
        threads: &Threads,
    ) -> Result<Toeplitz<T>> {
        let period = (good_length(2 * grid.mx - 1), good_length(2 * grid.my - 1));
        let unit = unit_of(tangential.at(0.0, 0.0)[0]);
        let spectrum = spectrum::general(grid, period, fill, unit, threads)?;
        Ok(Toeplitz::with(grid, period, spectrum, unit, threads))
    }

    fn with(grid: &Grid, (px, py): (usize, usize), spectrum: Spectrum<T>, unit: f64, threads: &Threads) -> Toeplitz<T> {
        Toeplitz {
            mx: grid.mx,
            my: grid.my,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(py),
            spectrum,
            threads: threads.clone(),
            unit,
        }
    }

    /// The same operator in another precision.
    pub fn in_precision<S: Real>(&self) -> Result<Toeplitz<S>> {
        let real = |value: T| S::of(value.to_double());
        let spectrum = match &self.spectrum {
            Spectrum::Even(from) => Spectrum::Even(collected(from.iter().map(|wave| wave.map(real)), SPECTRUM)?),
            Spectrum::General(from) => {
                let complex = |value: Complex<T>| Complex::new(real(value.re), real(value.im));
                Spectrum::General(collected(from.iter().map(|wave| wave.map(complex)), SPECTRUM)?)
            }
        };
        let grid = Grid { mx: self.mx, my: self.my, dx: 1.0, dy: 1.0 };
        let periods = (self.rows.length(), self.columns.length());
        Ok(Toeplitz::with(&grid, periods, spectrum, self.unit, &self.threads))
    }

    /// Memory for products by this operator.
    pub fn workspace(&self) -> Result<Workspace<T>> {
        let (px, py) = (self.rows.length(), self.columns.length());
        let piece = |_| {
            let mut scratch = self.rows.scratch();
            self.columns.fit(&mut scratch);
            Piece {
                row: vec![T::zero(); px],
                bins: vec![Complex::default(); self.rows.bins()],
                columns: vec![Complex::default(); BLOCK * py],
                scratch,
            }
        };
        Ok(Workspace {
            bins: zeros(self.my * 2 * self.rows.bins(), WORKSPACE)?,
            pieces: (0..self.threads.pieces()).map(piece).collect(),
        })
    }

    /// Bytes of the spectrum.
    pub fn bytes(&self) -> usize {
        match &self.spectrum {
            Spectrum::Even(s) => size_of_val(&s[..]),
            Spectrum::General(s) => size_of_val(&s[..]),
        }
    }

    /// `u = A q`. Values of q are computed with in units of `unit`, a power of two.
    pub fn apply(&self, q: &[Vector], unit: f64, u: &mut [Vector], workspace: &mut Workspace<T>) {
        let n = self.mx * self.my;
        assert!(q.len() == n && u.len() == n);
        let nb = self.rows.bins();
        let Workspace { bins, pieces } = workspace;
        let loaded = rows_with_traction(q, self.mx);
        self.forward(q, 1.0 / unit, &loaded, &mut bins[..self.my * 2 * nb], pieces);
        let length = self.columns.length();
        for_each_block(&mut bins[..self.my * 2 * nb], 2 * nb, &self.threads, pieces, |block, piece| {
            let columns = &mut piece.columns[..block.columns() * length];
            block.gather(loaded.clone(), length, columns);
            self.columns.forward(columns, &mut piece.scratch);
            for (pair, columns) in columns.chunks_exact_mut(2 * length).enumerate() {
                self.multiply(block.first() / 2 + pair, columns);
            }
            self.columns.inverse(columns, &mut piece.scratch);
            block.scatter(0..self.my, length, columns);
        });
        self.back(unit * self.unit, u, &bins[..self.my * 2 * nb], pieces);
    }

    fn forward(
        &self,
        q: &[Vector],
        scale: f64,
        loaded: &Range<usize>,
        bins: &mut [Complex<T>],
        pieces: &mut [Piece<T>],
    ) {
        let (mx, nb, first) = (self.mx, self.rows.bins(), loaded.start);
        let rows = &mut bins[first * 2 * nb..loaded.end * 2 * nb];
        self.threads.for_each_row(rows, 2 * nb, pieces, |i, out, piece| {
            let q = &q[(first + i) * mx..(first + i + 1) * mx];
            for component in 0..2 {
                let row = &mut piece.row[..];
                row.iter_mut().zip(q).for_each(|(to, q)| *to = T::of(scale * q[component]));
                row[mx..].fill(T::zero());
                self.rows.forward(row, &mut piece.bins, &mut piece.scratch);
                out.iter_mut().skip(component).step_by(2).zip(&piece.bins).for_each(|(to, bin)| *to = *bin);
            }
        });
    }

    fn back(&self, scale: f64, u: &mut [Vector], bins: &[Complex<T>], pieces: &mut [Piece<T>]) {
        let nb = self.rows.bins();
        self.threads.for_each_row(u, self.mx, pieces, |iy, u, piece| {
            let from = &bins[iy * 2 * nb..(iy + 1) * 2 * nb];
            for component in 0..2 {
                piece.bins.iter_mut().zip(from.iter().skip(component).step_by(2)).for_each(|(to, bin)| *to = *bin);
                self.rows.inverse(&mut piece.bins, &mut piece.row, &mut piece.scratch);
                u.iter_mut().zip(&piece.row).for_each(|(u, value)| u[component] = scale * value.to_double());
            }
        });
    }

    /// Multiplies the transformed columns of both components of x bin `kx`.
    fn multiply(&self, kx: usize, columns: &mut [Complex<T>]) {
        let py = self.columns.length();
        let (x, y) = columns.split_at_mut(py);
        match &self.spectrum {
            Spectrum::Even(spectrum) => {
                let waves = &spectrum[kx * (py / 2 + 1)..(kx + 1) * (py / 2 + 1)];
                let (low_x, high_x) = x.split_at_mut(py / 2 + 1);
                let (low_y, high_y) = y.split_at_mut(py / 2 + 1);
                let turn = |x: &mut Complex<T>, y: &mut Complex<T>, [xx, yy, xy]: [T; 3]| {
                    (*x, *y) = (*x * xx + *y * xy, *x * xy + *y * yy);
                };
                for ((x, y), &wave) in low_x.iter_mut().zip(low_y).zip(waves) {
                    turn(x, y, wave);
                }
                for ((x, y), &[xx, yy, xy]) in high_x.iter_mut().rev().zip(high_y.iter_mut().rev()).zip(&waves[1..]) {
                    turn(x, y, [xx, yy, -xy]);
                }
            }
            Spectrum::General(spectrum) => {
                for ((x, y), &[xx, yy, xy]) in x.iter_mut().zip(y).zip(&spectrum[kx * py..(kx + 1) * py]) {
                    (*x, *y) = (*x * xx + *y * xy, *x * xy + *y * yy);
                }
            }
        }
    }
}

/// The run of rows outside of which q is zero.
fn rows_with_traction(q: &[Vector], mx: usize) -> Range<usize> {
    let loaded = |row: &[Vector]| row.iter().any(|q| *q != [0.0; 2]);
    let Some(first) = q.chunks_exact(mx).position(loaded) else { return 0..0 };
    let last = q.chunks_exact(mx).rposition(loaded).unwrap_or(first);
    first..last + 1
}
