//! `u = A p` by FFT: A is block Toeplitz, so it is a part of a block circulant of period `px * py`.
//!
//! ```text
//! u_I = sum_J c(ix - jx, iy - jy) p_J = [F^-1 (S . F p)]_I,    S = F c,  p padded with zeros to px * py
//! ```
//!
//! The period must keep the offsets `-(m-1)..m-1` apart: `2m - 1`, or `2m - 2` when the coefficients are even
//! (offsets `m-1` and `-(m-1)` are then alike). The product is fused and pruned: real transforms of those rows only that
//! hold pressures; per block of eight columns gather, transform, multiply, transform back, scatter; real transforms of
//! those rows only that are asked for. Even coefficients have a real, even spectrum: a quarter of it is kept. In a direction in which
//! the coefficients repeat themselves after the grid A is circulant: the period is the grid's, and nothing is padded. A diagonal of its
//! own that A may have is added as the rows come back. Where A is Toeplitz in x only, a product by matrices takes the place of the
//! transforms in y ([`PerRow`]).

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use super::columns::{for_each_block, BLOCK};
use super::fft::{good_length, ColumnTransform, Complex, Real, RowTransform};
use super::patches::Mask;
use super::row_tables::PerRow;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{Influence, RowTables};
use crate::memory::zeros;
use crate::threads::Threads;

/// The transform of the coefficients, with the normalisation `1/(px py)` folded in, one column of it per x bin.
enum Spectrum<T> {
    /// Even coefficients: real, `py/2 + 1` values a column.
    Even(Vec<T>),
    /// General coefficients: `py` complex values a column.
    General(Vec<Complex<T>>),
}

/// The operator of one grid.
pub struct Toeplitz<T: Real> {
    mx: usize,
    my: usize,
    rows: RowTransform<T>,
    columns: ColumnTransform<T>,
    spectrum: Spectrum<T>,
    /// What A has on its diagonal beyond the coefficients; empty: nothing.
    diagonal: Vec<T>,
    /// Patches between which A is scaled.
    mask: Option<Mask<T>>,
    /// Tables of loaded rows, instead of the spectrum.
    per_row: Option<PerRow<T>>,
    threads: Threads,
}

/// Memory that a product needs, so that it allocates nothing.
pub struct Workspace<T: Real> {
    /// `[my][px/2 + 1]`: the rows, transformed in x.
    bins: Vec<Complex<T>>,
    pieces: Vec<Piece<T>>,
    /// With patches: p scaled for one of them, and its product.
    masked: [Vec<T>; 2],
    /// And p, where u takes its place.
    given: Vec<T>,
}

impl<T: Real> Workspace<T> {
    /// Makes room for products by another operator too. A smaller grid may need more of something: its transforms may be
    /// of another kind.
    pub fn cover(&mut self, other: Workspace<T>) {
        fn longer<A>(mine: &mut Vec<A>, other: Vec<A>) {
            if other.len() > mine.len() {
                *mine = other;
            }
        }
        longer(&mut self.bins, other.bins);
        for (mine, other) in self.pieces.iter_mut().zip(other.pieces) {
            longer(&mut mine.row, other.row);
            longer(&mut mine.columns, other.columns);
            longer(&mut mine.scratch, other.scratch);
        }
    }
}

/// Scratch of one piece of the work.
struct Piece<T: Real> {
    row: Vec<T>,
    columns: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> Workspace<T> {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        std::mem::size_of_val(&self.bins[..]) + 3 * std::mem::size_of_val(&self.given[..])
    }
}

impl<T: Real> Toeplitz<T> {
    /// Sets up products on `grid`; the spectrum is computed in double precision for either `T`.
    pub fn new(influence: &Influence, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        if let Some((tables, least)) = influence.row_tables() {
            return Toeplitz::of_rows(influence, tables, least, threads);
        }
        let even = influence.is_even(grid);
        let repeats = influence.repeats(grid);
        let period = |m: usize, repeats: bool| match (repeats, even) {
            (true, _) => m,
            (_, true) => good_length(2 * m - 2),
            (_, false) => good_length(2 * m - 1),
        };
        let (px, py) = (period(grid.mx, repeats.0), period(grid.my, repeats.1));
        let spectrum = if even {
            let given = |m: usize, repeats: bool| if repeats { m / 2 + 1 } else { m };
            even_spectrum(
                (px, py),
                (given(grid.mx, repeats.0), given(grid.my, repeats.1)),
                |ky, row| influence.fill_row(0, ky, row),
                |value| value,
                threads,
            )?
        } else {
            general_spectrum(influence, grid, px, py, threads)?
        };
        let diagonal = influence.diagonal().unwrap_or_default().iter().map(|d| T::of(*d)).collect();
        Ok(Toeplitz {
            mx: grid.mx,
            my: grid.my,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(py),
            spectrum,
            diagonal,
            mask: influence.patches().map(Mask::new),
            per_row: None,
            threads: threads.clone(),
        })
    }

    /// Products by tables of loaded rows. Columns have the length of the grid: they are not transformed.
    fn of_rows(influence: &Influence, tables: &RowTables, least: f64, threads: &Threads) -> Result<Toeplitz<T>> {
        let (mx, my) = (tables.columns(), tables.rows());
        let px = good_length(if tables.is_even_in_x() { 2 * mx - 2 } else { 2 * mx - 1 });
        let diagonal = influence.diagonal().unwrap_or_default().iter().map(|d| T::of(*d)).collect();
        Ok(Toeplitz {
            mx,
            my,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(my),
            spectrum: Spectrum::Even(Vec::new()),
            diagonal,
            mask: influence.patches().map(Mask::new),
            per_row: Some(PerRow::new(tables, least, &RowTransform::new(px), threads)?),
            threads: threads.clone(),
        })
    }

    /// The period of a preconditioner's circulant: that of the grid itself, a quarter of the work of a padded one at the same number
    /// of iterations.
    pub fn circulant_period(influence: &Influence, grid: &Grid) -> (usize, usize) {
        let repeats = influence.repeats(grid);
        let period = |m: usize, repeats: bool| if repeats { m } else { good_length(m + 1) };
        (period(grid.mx, repeats.0), period(grid.my, repeats.1))
    }

    /// The inverse of a circulant near A, as a preconditioner: period `px * py >= mx * my`, coefficients at offsets up to
    /// half of it (at offset -m as well: the true one, not zero), even in both directions. None if it is not positive.
    pub fn inverse_circulant(
        influence: &Influence,
        grid: &Grid,
        (px, py): (usize, usize),
        threads: &Threads,
    ) -> Result<Option<Toeplitz<T>>> {
        let positive = AtomicBool::new(true);
        let finish = |value: f64| {
            if !(value > 0.0) {
                positive.store(false, Ordering::Relaxed);
            }
            1.0 / value
        };
        let fill = |ky: i64, row: &mut [f64]| influence.fill_even_row(ky, row);
        let spectrum = even_spectrum((px, py), (px / 2 + 1, py / 2 + 1), fill, finish, threads)?;
        Ok(positive.into_inner().then(|| Toeplitz {
            mx: grid.mx,
            my: grid.my,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(py),
            spectrum,
            diagonal: Vec::new(),
            mask: None,
            per_row: None,
            threads: threads.clone(),
        }))
    }

    /// The same operator in another precision.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Toeplitz<S>> {
        let convert = |value: T| S::of(factor * value.to_double());
        let spectrum = match &self.spectrum {
            Spectrum::Even(from) => {
                let mut to = zeros(from.len(), "the operator's spectrum")?;
                to.iter_mut().zip(from).for_each(|(to, from)| *to = convert(*from));
                Spectrum::Even(to)
            }
            Spectrum::General(from) => {
                let mut to = zeros(from.len(), "the operator's spectrum")?;
                to.iter_mut().zip(from).for_each(|(to, from)| *to = Complex::new(convert(from.re), convert(from.im)));
                Spectrum::General(to)
            }
        };
        let (rows, columns) = (RowTransform::new(self.rows.length()), ColumnTransform::new(self.columns.length()));
        let diagonal = self.diagonal.iter().map(|d| convert(*d)).collect();
        let (mask, threads) = (self.mask.as_ref().map(Mask::in_precision), self.threads.clone());
        let per_row = self.per_row.as_ref().map(|per_row| per_row.in_precision(factor)).transpose()?;
        Ok(Toeplitz { mx: self.mx, my: self.my, rows, columns, spectrum, diagonal, mask, per_row, threads })
    }

    /// Memory for products by this operator.
    pub fn workspace(&self) -> Result<Workspace<T>> {
        let mut pieces = Vec::new();
        for _ in 0..self.threads.pieces() {
            let mut scratch = self.rows.scratch();
            scratch.resize(scratch.len().max(self.columns.scratch().len()), Complex::default());
            let columns = vec![Complex::default(); (BLOCK * self.columns.length()).max(self.rows.bins())];
            let row = self.rows.length().max(self.per_row.as_ref().map_or(0, PerRow::scratch));
            pieces.push(Piece { row: vec![T::zero(); row], columns, scratch });
        }
        let masked = self.mask.as_ref().map_or(0, |_| self.mx * self.my);
        let memory = |n| zeros(n, "the product's workspace");
        Ok(Workspace {
            bins: zeros(self.my * self.rows.bins(), "the product's workspace")?,
            pieces,
            masked: [memory(masked)?, memory(masked)?],
            given: memory(masked)?,
        })
    }

    /// Bytes held by the operator.
    pub fn bytes(&self) -> usize {
        let spectrum = match &self.spectrum {
            Spectrum::Even(s) => std::mem::size_of_val(&s[..]),
            Spectrum::General(s) => std::mem::size_of_val(&s[..]),
        };
        spectrum
            + std::mem::size_of_val(&self.diagonal[..])
            + self.mask.as_ref().map_or(0, Mask::bytes)
            + self.per_row.as_ref().map_or(0, PerRow::bytes)
    }

    /// `u = A p`.
    pub fn apply(&self, p: &[T], u: &mut [T], workspace: &mut Workspace<T>) {
        let Some(mask) = &self.mask else { return self.apply_rows(p, u, 0..self.my, workspace) };
        let mut masked = std::mem::take(&mut workspace.masked);
        mask.apply(p, u, &mut masked, |p, u| self.apply_rows(p, u, 0..self.my, workspace));
        workspace.masked = masked;
    }

    /// `u = A p` in the grid's rows `wanted`, as if there were no patches; the other rows of `u` keep what they hold.
    pub fn apply_rows(&self, p: &[T], u: &mut [T], wanted: Range<usize>, workspace: &mut Workspace<T>) {
        assert!(p.len() == self.mx * self.my && u.len() == p.len() && wanted.end <= self.my);
        let loaded = self.transform_rows(p, workspace);
        self.convolve_columns(loaded, wanted.clone(), workspace);
        if self.diagonal.is_empty() {
            return self.transform_rows_back(u, wanted, workspace, |_, u, row| u.copy_from_slice(row));
        }
        self.transform_rows_back(u, wanted, workspace, |iy, u, row| {
            let elements = iy * self.mx..(iy + 1) * self.mx;
            for (((u, value), d), p) in u.iter_mut().zip(row).zip(&self.diagonal[elements.clone()]).zip(&p[elements]) {
                *u = *value + *d * *p;
            }
        });
    }

    /// `p = A p`.
    pub fn apply_in_place(&self, p: &mut [T], workspace: &mut Workspace<T>) {
        assert!(p.len() == self.mx * self.my);
        if self.mask.is_some() {
            let mut given = std::mem::take(&mut workspace.given);
            given.copy_from_slice(p);
            self.apply(&given, p, workspace);
            workspace.given = given;
            return;
        }
        let loaded = self.transform_rows(p, workspace);
        self.convolve_columns(loaded, 0..self.my, workspace);
        if self.diagonal.is_empty() {
            return self.transform_rows_back(p, 0..self.my, workspace, |_, u, row| u.copy_from_slice(row));
        }
        self.transform_rows_back(p, 0..self.my, workspace, |iy, p, row| {
            for ((p, value), d) in p.iter_mut().zip(row).zip(&self.diagonal[iy * self.mx..]) {
                *p = *value + *d * *p;
            }
        });
    }

    /// Transforms in x the rows that hold pressures; returns which.
    fn transform_rows(&self, p: &[T], workspace: &mut Workspace<T>) -> Range<usize> {
        let loaded = rows_with_pressure(p, self.mx);
        let nb = self.rows.bins();
        let bins = &mut workspace.bins[loaded.start * nb..loaded.end * nb];
        let first = loaded.start;
        self.threads.for_each_row(bins, nb, &mut workspace.pieces, |i, row_bins, piece| {
            let row = &mut piece.row[..self.rows.length()];
            row[..self.mx].copy_from_slice(&p[(first + i) * self.mx..(first + i + 1) * self.mx]);
            row[self.mx..].fill(T::zero());
            self.rows.forward(row, row_bins, &mut piece.scratch);
        });
        loaded
    }

    /// Transforms in y, multiplies by the spectrum and transforms back, block by block: from rows `loaded` to rows `wanted`.
    fn convolve_columns(&self, loaded: Range<usize>, wanted: Range<usize>, workspace: &mut Workspace<T>) {
        let Workspace { bins, pieces, .. } = workspace;
        let nb = self.rows.bins();
        let length = self.columns.length();
        if let Some(per_row) = &self.per_row {
            return for_each_block(&mut bins[..self.my * nb], nb, &self.threads, pieces, |block, piece| {
                let columns = &mut piece.columns[..block.columns() * length];
                block.gather(loaded.clone(), length, columns);
                for (c, column) in columns.chunks_exact_mut(length).enumerate() {
                    per_row.multiply(block.first() + c, loaded.clone(), column, &mut piece.row);
                }
                block.scatter(wanted.clone(), length, columns);
            });
        }
        for_each_block(&mut bins[..self.my * nb], nb, &self.threads, pieces, |block, piece| {
            let columns = &mut piece.columns[..block.columns() * length];
            block.gather(loaded.clone(), length, columns);
            self.columns.forward(columns, &mut piece.scratch);
            self.multiply(block.first(), columns);
            self.columns.inverse(columns, &mut piece.scratch);
            block.scatter(wanted.clone(), length, columns);
        });
    }

    /// Transforms the rows `wanted` back; `write(iy, row of u, values)` takes each of them.
    fn transform_rows_back(
        &self,
        u: &mut [T],
        wanted: Range<usize>,
        workspace: &mut Workspace<T>,
        write: impl Fn(usize, &mut [T], &[T]) + Sync + Send,
    ) {
        let Workspace { bins, pieces, .. } = workspace;
        let nb = self.rows.bins();
        let (first, bins) = (wanted.start, &bins[..]);
        let out = &mut u[wanted.start * self.mx..wanted.end * self.mx];
        self.threads.for_each_row(out, self.mx, pieces, |i, u_row, piece| {
            // The inverse overwrites its input: each row goes through the piece's scratch.
            let row_bins = &mut piece.columns[..nb];
            row_bins.copy_from_slice(&bins[(first + i) * nb..(first + i + 1) * nb]);
            self.rows.inverse(row_bins, &mut piece.row[..self.rows.length()], &mut piece.scratch);
            write(first + i, u_row, &piece.row[..self.mx]);
        });
    }

    /// Multiplies the transformed columns of a block, the first of which has x bin `first`, by the spectrum.
    fn multiply(&self, first: usize, block: &mut [Complex<T>]) {
        #[cfg(feature = "test-panics")]
        crate::panics::at_a_block();
        let py = self.columns.length();
        for (c, column) in block.chunks_exact_mut(py).enumerate() {
            match &self.spectrum {
                Spectrum::Even(s) => {
                    let s = &s[(first + c) * (py / 2 + 1)..(first + c + 1) * (py / 2 + 1)];
                    let (lower, upper) = column.split_at_mut(py / 2 + 1);
                    for (value, &factor) in lower.iter_mut().zip(s) {
                        *value = *value * factor;
                    }
                    for (value, &factor) in upper.iter_mut().rev().zip(&s[1..]) {
                        *value = *value * factor;
                    }
                }
                Spectrum::General(s) => {
                    for (value, &factor) in column.iter_mut().zip(&s[(first + c) * py..]) {
                        *value = *value * factor;
                    }
                }
            }
        }
    }
}

/// The run of rows outside of which `p` is zero.
fn rows_with_pressure<T: Real>(p: &[T], mx: usize) -> Range<usize> {
    let loaded = |row: &[T]| row.iter().any(|&value| value != T::zero());
    let Some(first) = p.chunks_exact(mx).position(loaded) else { return 0..0 };
    let last = p.chunks_exact(mx).rposition(loaded).unwrap_or(first);
    first..last + 1
}

/// Spectrum of even coefficients: both transforms are real; two columns share one complex transform, one as its real
/// and one as its imaginary part. `fill(ky, row)` gives the coefficients at offsets `(0.., ky)`, for `ky < rows_given`;
/// the others are zero. `finish` maps each value of the spectrum to what is kept of it (but for the normalisation).
fn even_spectrum<T: Real>(
    (px, py): (usize, usize),
    (row_given, rows_given): (usize, usize),
    fill: impl Fn(i64, &mut [f64]) + Sync + Send,
    finish: impl Fn(f64) -> f64 + Sync + Send,
    threads: &Threads,
) -> Result<Spectrum<T>> {
    let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
    let nb = rows.bins();
    let mut in_x: Vec<f64> = zeros(rows_given * nb, "the influence coefficients")?;
    let mut pieces: Vec<_> = (0..threads.pieces())
        .map(|_| (vec![0.0; px], vec![Complex::default(); nb.max(py)], rows.scratch(), columns.scratch()))
        .collect();
    threads.for_each_row(&mut in_x, nb, &mut pieces, |ky, out, (row, bins, scratch, _)| {
        row.fill(0.0);
        fill(ky as i64, &mut row[..row_given]);
        for kx in 1..row_given {
            row[px - kx] = row[kx];
        }
        rows.forward(row, &mut bins[..nb], scratch);
        out.iter_mut().zip(bins.iter()).for_each(|(value, bin)| *value = bin.re);
    });

    let scale = 1.0 / (px as f64 * py as f64);
    let half = py / 2 + 1;
    let mut spectrum: Vec<T> = zeros((nb + nb % 2) * half, "the operator's spectrum")?;
    threads.for_each_row(&mut spectrum, 2 * half, &mut pieces, |pair, out, (_, column, _, scratch)| {
        let column = &mut column[..py];
        let second = (2 * pair + 1).min(nb - 1);
        column.fill(Complex::default());
        for ky in 0..rows_given {
            let value = Complex::new(in_x[ky * nb + 2 * pair], in_x[ky * nb + second]);
            column[ky] = value;
            if ky > 0 {
                column[py - ky] = value;
            }
        }
        columns.forward(column, scratch);
        for (ky, bin) in column[..half].iter().enumerate() {
            out[ky] = T::of(scale * finish(bin.re));
            out[half + ky] = T::of(scale * finish(bin.im));
        }
    });
    Ok(Spectrum::Even(spectrum))
}

fn general_spectrum<T: Real>(
    influence: &Influence,
    grid: &Grid,
    px: usize,
    py: usize,
    threads: &Threads,
) -> Result<Spectrum<T>> {
    let (rows, columns) = (RowTransform::<f64>::new(px), ColumnTransform::<f64>::new(py));
    let nb = rows.bins();
    let (mx, my) = (grid.mx, grid.my);
    let mut in_x: Vec<Complex<f64>> = zeros((2 * my - 1) * nb, "the influence coefficients")?;
    let mut pieces: Vec<_> = (0..threads.pieces())
        .map(|_| (vec![0.0; px], vec![Complex::default(); py], rows.scratch(), columns.scratch()))
        .collect();
    threads.for_each_row(&mut in_x, nb, &mut pieces, |i, out, (row, _, scratch, _)| {
        row.fill(0.0);
        let ky = i as i64 - (my as i64 - 1);
        influence.fill_row(0, ky, &mut row[..mx]);
        influence.fill_row(1 - mx as i64, ky, &mut row[px - (mx - 1)..]);
        rows.forward(row, out, scratch);
    });

    let scale = 1.0 / (px as f64 * py as f64);
    let mut spectrum: Vec<Complex<T>> = zeros(nb * py, "the operator's spectrum")?;
    threads.for_each_row(&mut spectrum, py, &mut pieces, |kx, out, (_, column, _, scratch)| {
        column.fill(Complex::default());
        for i in 0..2 * my - 1 {
            column[(i + py - (my - 1)) % py] = in_x[i * nb + kx];
        }
        columns.forward(column, scratch);
        for (value, bin) in out.iter_mut().zip(column.iter()) {
            *value = Complex::new(T::of(scale * bin.re), T::of(scale * bin.im));
        }
    });
    Ok(Spectrum::General(spectrum))
}
