//! Products with [one table per loaded row](super::row_tables): A is Toeplitz in x only.
//!
//! ```text
//! u^(iy, kx) = sum over jy of S_kx(jy, iy) q^(jy, kx),     ^: the transform in x;  S: a 2 x 2 matrix
//! ```
//!
//! For each of the `px/2 + 1` bins that is a matrix of 2 my by 2 my complex numbers, all of which a product reads.

use std::array::from_fn;

use super::coefficients::Tangential;
use super::plane::Vector;
use super::row_tables::{Full, RowTables};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::memory::{blank, keep, zeros};
use crate::operator::fft::{good_length, Complex, Real};
use crate::operator::row_transform::RowTransform;
use crate::threads::Threads;

/// What memory is for.
const MATRICES: &str = "the transforms of tangential tables per row";

type Wave = Complex<f64>;

/// The operator of one grid, with its workspace.
pub struct RowProduct {
    mx: usize,
    my: usize,
    transform: RowTransform<f64>,
    /// `[bin][iy][jy]`: `xx, yy, xy, yx`, with the normalisation.
    matrices: Vec<[Wave; 4]>,
    /// `[2 my][bins]`, and the other way round.
    rows: Vec<Wave>,
    columns: Vec<Wave>,
    pieces: Vec<Piece>,
    threads: Threads,
}

/// Memory of one piece of the work.
struct Piece {
    entries: Vec<Full>,
    row: Vec<f64>,
    scratch: Vec<Wave>,
    bins: Vec<Wave>,
}

impl Drop for RowProduct {
    fn drop(&mut self) {
        keep([&mut self.rows, &mut self.columns]);
        keep([&mut self.matrices]);
    }
}

impl RowProduct {
    /// Displacements at `by` elements from each centre, along x; A, if that is 0.
    pub fn displaced(
        tangential: &Tangential,
        rows: &RowTables,
        grid: &Grid,
        by: f64,
        threads: &Threads,
    ) -> Result<RowProduct> {
        let (layer, by) = (tangential.layer(), by.round() as i64);
        RowProduct::new(|jy, iy, kx| with_layer(rows, layer, (jy, iy, kx + by)), grid, threads)
    }

    /// Displacements at each centre less those at `by` elements from it, along x: steady rolling.
    pub fn rolling(
        tangential: &Tangential,
        rows: &RowTables,
        grid: &Grid,
        by: f64,
        threads: &Threads,
    ) -> Result<RowProduct> {
        let (layer, by) = (tangential.layer(), by.round() as i64);
        let entry = |jy: usize, iy: usize, kx: i64| {
            let here = with_layer(rows, layer, (jy, iy, kx));
            let there = with_layer(rows, layer, (jy, iy, kx + by));
            [0, 1, 2, 3].map(|k| here[k] - there[k])
        };
        RowProduct::new(entry, grid, threads)
    }

    fn new(
        entry: impl Fn(usize, usize, i64) -> Full + Sync + Send,
        grid: &Grid,
        threads: &Threads,
    ) -> Result<RowProduct> {
        let Grid { mx, my, .. } = *grid;
        let px = good_length(2 * mx - 1);
        let transform = RowTransform::<f64>::new(px)?;
        let nb = transform.bins();
        let size = my.checked_mul(my).and_then(|n| n.checked_mul(nb));
        let size =
            size.ok_or_else(|| Error::OutOfMemory(format!("no memory for {my} * {my} * {nb} values of {MATRICES}")))?;
        let nan = Wave::new(f64::NAN, f64::NAN);
        let piece = |_| {
            let (row, bins) = (zeros(px.max(2 * mx), MATRICES)?, zeros(4 * nb, MATRICES)?);
            Ok(Piece { entries: zeros(2 * mx - 1, MATRICES)?, row, scratch: transform.scratch()?, bins })
        };
        let mut pieces = (0..threads.count()).map(piece).collect::<Result<Vec<_>>>()?;
        let mut matrices = blank(size, [nan; 4], MATRICES)?;
        let mut of_row = blank(my * nb, [nan; 4], MATRICES)?;
        let last = mx as i64 - 1;
        for iy in 0..my {
            threads.for_each_row(&mut of_row, nb, &mut pieces, |jy, out, piece| {
                let Piece { entries, row, scratch, bins } = piece;
                entries.iter_mut().zip(-last..).for_each(|(value, kx)| *value = entry(jy, iy, kx));
                for component in 0..4 {
                    let row = &mut row[..px];
                    row.fill(0.0);
                    for (value, kx) in entries.iter().zip(-last..) {
                        row[kx.rem_euclid(px as i64) as usize] = value[component] / px as f64;
                    }
                    transform.forward(row, &mut bins[component * nb..][..nb], scratch);
                }
                for (bin, out) in out.iter_mut().enumerate() {
                    *out = [0, 1, 2, 3].map(|component| bins[component * nb + bin]);
                }
            });
            let of_row = &of_row[..];
            threads.for_each_plain_row(&mut matrices, my * my, |bin, matrix| {
                let column = of_row[bin..].iter().step_by(nb);
                matrix[iy * my..][..my].iter_mut().zip(column).for_each(|(to, from)| *to = *from);
            });
        }
        keep([&mut of_row]);
        let (rows, columns) = (blank(2 * my * nb, nan, MATRICES)?, blank(2 * my * nb, nan, MATRICES)?);
        Ok(RowProduct { mx, my, transform, matrices, rows, columns, pieces, threads: threads.clone() })
    }

    /// `u = A q`.
    pub fn apply(&mut self, q: &[Vector], u: &mut [Vector]) {
        let mx = self.mx;
        let load = |component: usize, first: usize, row: &mut [f64]| {
            row.iter_mut().zip(&q[first..]).for_each(|(value, q)| *value = q[component]);
        };
        let write = |u: &mut [Vector], [x, y]: [&[f64]; 2]| {
            u.iter_mut().zip(x).zip(y).for_each(|((u, x), y)| *u = [*x, *y]);
        };
        self.multiply(load, (u.chunks_mut(mx), write));
    }

    /// `u = by A q` of fields by component, in any precision.
    pub fn apply_by_component<S: Real>(&mut self, q: [&[S]; 2], by: f64, [ux, uy]: [&mut [S]; 2]) {
        let mx = self.mx;
        let load = |component: usize, first: usize, row: &mut [f64]| {
            row.iter_mut().zip(&q[component][first..]).for_each(|(value, q)| *value = by * q.to_double());
        };
        let write = |(ux, uy): (&mut [S], &mut [S]), values: [&[f64]; 2]| {
            for (u, values) in [ux, uy].into_iter().zip(values) {
                u.iter_mut().zip(values).for_each(|(u, value)| *u = S::of(*value));
            }
        };
        self.multiply(load, (ux.chunks_mut(mx).zip(uy.chunks_mut(mx)), write));
    }

    /// `load(component, first element, row)` gives a row of q; `write(piece, [x, y])` takes one of u, of which `pieces` are.
    fn multiply<P: Send>(
        &mut self,
        load: impl Fn(usize, usize, &mut [f64]) + Sync + Send,
        (pieces_of_u, write): (
            impl DoubleEndedIterator<Item = P> + ExactSizeIterator + Send,
            impl Fn(P, [&[f64]; 2]) + Sync + Send,
        ),
    ) {
        let RowProduct { mx, my, transform, matrices, rows, columns, pieces, threads } = self;
        let (mx, my, nb) = (*mx, *my, transform.bins());
        // Rows of x components, then those of y.
        threads.for_each_row(rows, nb, pieces, |k, bins, Piece { row, scratch, .. }| {
            load(k / my, k % my * mx, &mut row[..mx]);
            transform.forward(&row[..mx], bins, scratch);
        });
        let (rows, matrices) = (&rows[..], &matrices[..]);
        threads.for_each_plain_row(columns, 2 * my, |bin, column| {
            let (x, y) = column.split_at_mut(my);
            let matrix = &matrices[bin * my * my..][..my * my];
            for ((x, y), row) in x.iter_mut().zip(y).zip(matrix.chunks_exact(my)) {
                let mut sum = [Wave::default(); 2];
                for (jy, [xx, yy, xy, yx]) in row.iter().enumerate() {
                    let (qx, qy) = (rows[jy * nb + bin], rows[(my + jy) * nb + bin]);
                    sum = [sum[0] + xx * qx + xy * qy, sum[1] + yx * qx + yy * qy];
                }
                (*x, *y) = (sum[0], sum[1]);
            }
        });
        let columns = &columns[..];
        threads.share(pieces_of_u.enumerate(), pieces, |(iy, u), Piece { row, scratch, bins, .. }| {
            let mut values = row[..2 * mx].chunks_exact_mut(mx);
            let mut values: [&mut [f64]; 2] = from_fn(|_| values.next().unwrap_or_default());
            for (component, values) in values.iter_mut().enumerate() {
                let bins = &mut bins[..nb];
                bins.iter_mut()
                    .enumerate()
                    .for_each(|(bin, value)| *value = columns[bin * 2 * my + component * my + iy]);
                transform.inverse(bins, values, scratch);
            }
            write(u, values.map(|values| &*values));
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let piece = |piece: &Piece| {
            let Piece { entries, row, scratch, bins } = piece;
            size_of_val(&entries[..]) + size_of_val(&row[..]) + size_of_val(&scratch[..]) + size_of_val(&bins[..])
        };
        let fields = size_of_val(&self.rows[..]) + size_of_val(&self.columns[..]);
        size_of_val(&self.matrices[..]) + fields + self.pieces.iter().map(piece).sum::<usize>()
    }
}

/// The coefficients with a layer between the bodies, which displaces an element by its own traction alone.
fn with_layer(rows: &RowTables, layer: f64, (jy, iy, kx): (usize, usize, i64)) -> Full {
    let [xx, yy, xy, yx] = rows.at(jy, iy, kx);
    let layer = if jy == iy && kx == 0 { layer } else { 0.0 };
    [xx + layer, yy + layer, xy, yx]
}
