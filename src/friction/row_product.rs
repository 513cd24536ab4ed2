//! Products with [one table per loaded row](super::row_tables), for which A is Toeplitz in x only.
//!
//! The product is that of a grid with twice as many rows: the first my rows hold the x components of a field, the others the y components.

use toeplitz::fft::{good_length, Real};
use toeplitz::{Memory, OfRows, Product};

use super::coefficients::Tangential;
use super::plane::Vector;
use super::row_tables::{Full, RowTables};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{blank, keep};
use crate::threads::Threads;

/// The operator of one grid, with its memory.
pub struct RowProduct {
    product: Product<f64>,
    memory: Memory<f64>,
    /// Tractions by component, `[2][my][mx]`.
    q: Vec<f64>,
    /// Displacements by component, `[2][my][mx]`.
    u: Vec<f64>,
}

impl Drop for RowProduct {
    fn drop(&mut self) {
        keep([&mut self.q, &mut self.u]);
    }
}

impl RowProduct {
    /// The product for displacements `by` elements from each centre along x. It is that with A if `by` is 0.
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

    /// The product of steady rolling: displacements at each centre less those `by` elements from it along x.
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

    /// Sets up the product with the coefficients `entry(loaded row, row, offset in x)`.
    fn new(
        entry: impl Fn(usize, usize, i64) -> Full + Sync + Send,
        grid: &Grid,
        threads: &Threads,
    ) -> Result<RowProduct> {
        let Grid { mx, my, .. } = *grid;
        let last = mx as i64 - 1;
        let fill = |from: usize, to: usize, period: &mut [f64]| {
            // The index in xx, yy, xy, yx. Rows of this matrix: displacement in x, in y; columns: traction in x, in y.
            let component = [[0, 2], [3, 1]][to / my][from / my];
            let px = period.len() as i64;
            period.fill(0.0);
            (-last..=last).for_each(|kx| period[kx.rem_euclid(px) as usize] = entry(from % my, to % my, kx)[component]);
        };
        let coefficients = OfRows { are_even: false, fill, factor: 1.0 };
        let product = Product::per_row((mx, 2 * my), &coefficients, good_length(2 * mx - 1), threads)?;
        let (memory, what) = (product.memory()?, "the fields of tangential tables per row");
        let field = || blank(2 * mx * my, f64::NAN, what);
        Ok(RowProduct { product, memory, q: field()?, u: field()? })
    }

    /// `u = A q`.
    pub fn apply(&mut self, q: &[Vector], u: &mut [Vector]) {
        for (component, values) in self.q.chunks_exact_mut(q.len()).enumerate() {
            values.iter_mut().zip(q).for_each(|(value, q)| *value = q[component]);
        }
        self.product.apply(&self.q, &mut self.u, &mut self.memory);
        for (component, values) in self.u.chunks_exact(u.len()).enumerate() {
            u.iter_mut().zip(values).for_each(|(u, value)| u[component] = *value);
        }
    }

    /// `u = factor A q` for fields by component, in any precision.
    pub fn apply_by_component<S: Real>(&mut self, q: [&[S]; 2], factor: f64, u: [&mut [S]; 2]) {
        for (values, q) in self.q.chunks_exact_mut(q[0].len()).zip(q) {
            values.iter_mut().zip(q).for_each(|(value, q)| *value = factor * q.to_double());
        }
        self.product.apply(&self.q, &mut self.u, &mut self.memory);
        for (values, u) in self.u.chunks_exact(u[0].len()).zip(u) {
            u.iter_mut().zip(values).for_each(|(u, value)| *u = S::of(*value));
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let fields = size_of_val(&self.q[..]) + size_of_val(&self.u[..]);
        self.product.bytes() + self.memory.bytes() + self.memory.bytes_of_pieces() + fields
    }
}

/// The coefficients of a loaded row, a row and an offset in x, with a layer between the bodies, which adds to the coefficient of an element on
/// itself.
fn with_layer(rows: &RowTables, layer: f64, (jy, iy, kx): (usize, usize, i64)) -> Full {
    let [xx, yy, xy, yx] = rows.at(jy, iy, kx);
    let layer = if jy == iy && kx == 0 { layer } else { 0.0 };
    [xx + layer, yy + layer, xy, yx]
}
