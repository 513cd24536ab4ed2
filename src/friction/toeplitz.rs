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
//! Both components are one complex number, `qx + i qy`: one complex transform has the place of two real ones. A wave k is multiplied
//! together with -k ([`spectrum`](super::spectrum) has the formulas), so a block of columns comes with its mirror image.
//!
//! Without Axy (a Poisson ratio of 0, a single row) a traction in one direction displaces in that direction only: then there is one real
//! transform, half of the work, and the other component is exactly 0.

use std::ops::Range;

use super::coefficients::{Entry, Tangential};
use super::plane::Vector;
use super::quadrant::Quadrant;
use super::spectrum::{self, Kind, Spectrum, SPECTRUM};
use super::unit::unit_of;
use super::workspace::{Piece, Workspace};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{computed, keep};
use crate::operator::columns::for_each_mirrored_block;
use crate::operator::fft::{good_length, ColumnTransform, Complex, Real};
use crate::operator::row_transform::RowTransform;
use crate::threads::Threads;

/// Displacements at the centres.
const HERE: (f64, f64) = (0.0, 0.0);

/// The operator of one grid.
pub struct Toeplitz<T: Real> {
    pub(super) mx: usize,
    pub(super) my: usize,
    pub(super) rows: ColumnTransform<T>,
    /// Of one component alone.
    pub(super) real_rows: RowTransform<T>,
    pub(super) columns: ColumnTransform<T>,
    pub(super) spectrum: Spectrum<T>,
    /// Whether there is no Axy.
    is_uncoupled: bool,
    pub(super) threads: Threads,
    /// Coefficients are kept in this unit, a power of two: single precision has a small range.
    pub(super) unit: f64,
}

impl<T: Real> Drop for Toeplitz<T> {
    fn drop(&mut self) {
        match &mut self.spectrum {
            Spectrum::Even(waves) => keep([waves]),
            Spectrum::General(waves) => keep([waves]),
        }
    }
}

impl<T: Real> Toeplitz<T> {
    /// Products with the coefficients of `tangential` on `grid`.
    pub fn new(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        Toeplitz::direct(&Quadrant::new(tangential, grid, HERE, threads)?, grid, threads)
    }

    /// The inverse of a circulant near A, with a period one element longer than the grid: a preconditioner. None where that is not
    /// positive definite.
    pub fn inverse(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Option<Toeplitz<T>>> {
        Toeplitz::nearly_inverse(&Quadrant::new(tangential, grid, HERE, threads)?, grid, threads)
    }

    /// Products whose displacements are taken at `(x, y)` from each centre, in elements.
    pub fn displaced(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        let quadrant = Quadrant::new(tangential, grid, by, threads)?;
        Toeplitz::general((&quadrant, by), grid, |x, y| quadrant.displaced(x, y, by), threads)
    }

    /// Products with coefficients that were computed.
    pub fn direct(quadrant: &Quadrant, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        let period = (good_length(2 * grid.mx - 1), good_length(2 * grid.my - 1));
        let fill = |x: usize, y: usize| quadrant.at(x as i64, y as i64);
        let unit = unit_of(quadrant.at(0, 0)[0]);
        let product = spectrum::even(period, (grid.mx, grid.my), fill, Kind::Direct, unit, threads)?;
        let spectrum = product.unwrap_or_else(|| unreachable!("only an inverse may not be"));
        Toeplitz::with(grid, period, (spectrum, quadrant.is_uncoupled(grid, HERE)), unit, threads)
    }

    /// See [`inverse`](Self::inverse).
    pub fn nearly_inverse(quadrant: &Quadrant, grid: &Grid, threads: &Threads) -> Result<Option<Toeplitz<T>>> {
        let length = |m: usize| if m == 1 { 1 } else { good_length(m + 1) };
        let period = (length(grid.mx), length(grid.my));
        let given = (period.0 / 2 + 1, period.1 / 2 + 1);
        // An odd function has no value half-way around.
        let half_way = |k: usize, period: usize| 2 * k == period;
        let fill = |x: usize, y: usize| {
            let [xx, yy, xy] = quadrant.at(x as i64, y as i64);
            [xx, yy, if half_way(x, period.0) || half_way(y, period.1) { 0.0 } else { xy }]
        };
        let unit = 1.0 / unit_of(quadrant.at(0, 0)[0]);
        let inverse = spectrum::even(period, given, fill, Kind::Inverse, unit, threads)?;
        let uncoupled = quadrant.is_uncoupled(grid, HERE);
        inverse.map(|spectrum| Toeplitz::with(grid, period, (spectrum, uncoupled), unit, threads)).transpose()
    }

    /// Products of steady rolling: displacements at each centre less those at `(x, y)` from it, in elements.
    pub fn rolling(quadrant: &Quadrant, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        let fill = |x: i64, y: i64| {
            let (here, there) = (quadrant.at(x, y), quadrant.displaced(x, y, by));
            [here[0] - there[0], here[1] - there[1], here[2] - there[2]]
        };
        Toeplitz::general((quadrant, by), grid, fill, threads)
    }

    /// Of coefficients that are neither even nor odd: `fill(x, y)` gives that of an offset.
    fn general(
        (quadrant, by): (&Quadrant, (f64, f64)),
        grid: &Grid,
        fill: impl Fn(i64, i64) -> Entry + Sync + Send,
        threads: &Threads,
    ) -> Result<Toeplitz<T>> {
        let period = (good_length(2 * grid.mx - 1), good_length(2 * grid.my - 1));
        let unit = unit_of(quadrant.at(0, 0)[0]);
        let spectrum = spectrum::general(grid, period, fill, unit, threads)?;
        Toeplitz::with(grid, period, (spectrum, quadrant.is_uncoupled(grid, by)), unit, threads)
    }

    fn with(
        grid: &Grid,
        (px, py): (usize, usize),
        (spectrum, is_uncoupled): (Spectrum<T>, bool),
        unit: f64,
        threads: &Threads,
    ) -> Result<Toeplitz<T>> {
        Ok(Toeplitz {
            mx: grid.mx,
            my: grid.my,
            rows: ColumnTransform::new(px)?,
            real_rows: RowTransform::new(px)?,
            columns: ColumnTransform::new(py)?,
            spectrum,
            is_uncoupled,
            threads: threads.clone(),
            unit,
        })
    }

    /// Memory for products by this operator.
    pub fn workspace(&self) -> Result<Workspace<T>> {
        let of_rows = self.rows.scratch_length().max(self.real_rows.scratch_length());
        let scratch = of_rows.max(self.columns.scratch_length());
        Workspace::new((self.rows.length(), self.columns.length()), self.my, scratch, &self.threads)
    }

    /// The same operator in another precision.
    pub fn in_precision<S: Real>(&self) -> Result<Toeplitz<S>> {
        let real = |value: T| S::of(value.to_double());
        let spectrum = match &self.spectrum {
            Spectrum::Even(from) => Spectrum::Even(computed(from.iter().map(|wave| wave.map(real)), SPECTRUM)?),
            Spectrum::General(from) => {
                let complex = |value: Complex<T>| Complex::new(real(value.re), real(value.im));
                Spectrum::General(computed(from.iter().map(|wave| wave.map(complex)), SPECTRUM)?)
            }
        };
        let grid = Grid { mx: self.mx, my: self.my, dx: 1.0, dy: 1.0 };
        let periods = (self.rows.length(), self.columns.length());
        Toeplitz::with(&grid, periods, (spectrum, self.is_uncoupled), self.unit, &self.threads)
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
        self.apply_scaled(q, (1.0 / unit, unit * self.unit), u, workspace);
    }

    /// `u = A q` of fields in any precision, q times the first of the scales, and u times the second and in the unit of the coefficients.
    pub fn apply_scaled<S: Real>(
        &self,
        q: &[[S; 2]],
        scales: (f64, f64),
        u: &mut [[S; 2]],
        workspace: &mut Workspace<T>,
    ) {
        let n = self.mx * self.my;
        assert!(q.len() == n && u.len() == n);
        if self.is_uncoupled {
            let is_zero = |component: usize| q.iter().all(|q| q[component].is_zero());
            if let Some(other) = [1, 0].into_iter().find(|&component| is_zero(component)) {
                return self.apply_one(1 - other, q, scales, u, workspace);
            }
        }
        let (px, length) = (self.rows.length(), self.columns.length());
        let Workspace { bins, pieces } = workspace;
        let loaded = rows_with_traction(q, self.mx);
        self.forward(q, scales.0, &loaded, bins, pieces);
        for_each_mirrored_block(bins, px, &self.threads, pieces, |block, piece| {
            let count = block.columns() * length;
            let (columns, mirrored) = (&mut piece.columns[..count], &mut piece.mirrored[..count]);
            block.gather(loaded.clone(), length, columns, mirrored);
            self.columns.forward(columns, &mut piece.scratch);
            self.columns.forward(mirrored, &mut piece.scratch);
            let pairs = columns.chunks_exact_mut(length).zip(mirrored.chunks_exact_mut(length));
            pairs.enumerate().for_each(|(c, (z, w))| self.multiply(block.first() + c, z, w));
            self.columns.inverse(columns, &mut piece.scratch);
            self.columns.inverse(mirrored, &mut piece.scratch);
            block.scatter(0..self.my, length, columns, mirrored);
        });
        self.back(scales.1, u, bins, pieces);
    }

    fn forward<S: Real>(
        &self,
        q: &[[S; 2]],
        scale: f64,
        loaded: &Range<usize>,
        bins: &mut [Complex<T>],
        pieces: &mut [Piece<T>],
    ) {
        let (mx, px, first) = (self.mx, self.rows.length(), loaded.start);
        let rows = &mut bins[first * px..loaded.end * px];
        self.threads.for_each_row(rows, px, pieces, |i, row, piece| {
            let q = &q[(first + i) * mx..(first + i + 1) * mx];
            for (to, q) in row.iter_mut().zip(q) {
                *to = Complex::new(T::of(scale * q[0].to_double()), T::of(scale * q[1].to_double()));
            }
            row[mx..].fill(Complex::default());
            self.rows.forward(row, &mut piece.scratch);
        });
    }

    fn back<S: Real>(&self, scale: f64, u: &mut [[S; 2]], bins: &mut [Complex<T>], pieces: &mut [Piece<T>]) {
        let px = self.rows.length();
        self.threads.for_each_row_pair_with((u, self.mx), (bins, px), pieces, |_, u, row, piece| {
            self.rows.inverse(row, &mut piece.scratch);
            for (u, value) in u.iter_mut().zip(row) {
                *u = [S::of(scale * value.re.to_double()), S::of(scale * value.im.to_double())];
            }
        });
    }

    /// Multiplies the waves of x bin `kx`, z, and the conjugates of their opposites, w.
    fn multiply(&self, kx: usize, z: &mut [Complex<T>], w: &mut [Complex<T>]) {
        let py = self.columns.length();
        match &self.spectrum {
            Spectrum::Even(spectrum) => {
                let half = py / 2 + 1;
                let waves = &spectrum[kx * half..(kx + 1) * half];
                let (low_z, high_z) = z.split_at_mut(half);
                let (low_w, high_w) = w.split_at_mut(half);
                let turn = |z: &mut Complex<T>, w: &mut Complex<T>, [alpha, beta, gamma]: [T; 3]| {
                    let of_w = Complex::new(beta * w.re - gamma * w.im, beta * w.im + gamma * w.re);
                    let of_z = Complex::new(beta * z.re + gamma * z.im, beta * z.im - gamma * z.re);
                    (*z, *w) = (*z * alpha + of_w, *w * alpha + of_z);
                };
                for ((z, w), &wave) in low_z.iter_mut().zip(low_w).zip(waves) {
                    turn(z, w, wave);
                }
                for ((z, w), &[alpha, beta, gamma]) in
                    high_z.iter_mut().rev().zip(high_w.iter_mut().rev()).zip(&waves[1..])
                {
                    turn(z, w, [alpha, beta, -gamma]);
                }
            }
            Spectrum::General(spectrum) => {
                for ((z, w), &[alpha, delta, epsilon]) in z.iter_mut().zip(w).zip(&spectrum[kx * py..(kx + 1) * py]) {
                    (*z, *w) = (*z * alpha + *w * delta, *w * alpha + *z * epsilon);
                }
            }
        }
    }
}

/// The run of rows outside of which q is zero.
pub(super) fn rows_with_traction<S: Real>(q: &[[S; 2]], mx: usize) -> Range<usize> {
    let loaded = |row: &[[S; 2]]| row.iter().any(|q| *q != [S::zero(); 2]);
    let Some(first) = q.chunks_exact(mx).position(loaded) else { return 0..0 };
    let last = q.chunks_exact(mx).rposition(loaded).unwrap_or(first);
    first..last + 1
}
