//! Sums over elements at one depth, by FFT.
//!
//! The loads are padded with zeros to `px * py >= (2 mx - 1) (2 my - 1)` and transformed once. A kernel that is even in both directions
//! has a real, even spectrum S; each direction in which it is odd makes that a factor i, and S odd in this direction. So
//!
//! ```text
//! stress = F^-1 sum over loads of i^(number of odd directions) S . F load
//! ```

use super::kernels::{is_odd, Asked, Kernels};
use super::{Body, Loads};
use crate::error::Result;
use crate::memory::zeros;
use crate::operator::fft::{good_length, ColumnTransform, Complex, RowTransform};

/// What memory is for.
const STRESS: &str = "the stresses of a depth";

/// Products with the loads of one body, of all depths.
pub struct Product {
    pub body: Body,
    rows: RowTransform<f64>,
    columns: ColumnTransform<f64>,
    /// The transform of each load, `[bin in x][bin in y]`, over its number of values; none: no such load.
    loads: [Option<Vec<Complex<f64>>>; 3],
    /// What the loads were divided by.
    scale: f64,
}

/// Memory for the products of one depth.
pub struct Workspace {
    kernels: Kernels,
    /// Of one kernel: transforms in x, `[bin in x][ky]`, and its spectrum, `[load][bin in x][bin in y >= 0]`.
    in_x: Vec<f64>,
    spectrum: Vec<f64>,
    row: Vec<f64>,
    bins: Vec<Complex<f64>>,
    column: Vec<Complex<f64>>,
    /// Of the stresses: `[iy][bin in x]`.
    stress: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Product {
    /// Transforms the loads, which were checked.
    pub fn new(body: &Body, loads: &Loads<'_>) -> Result<Product> {
        let (px, py) = (good_length(2 * body.grid.mx - 1), good_length(2 * body.grid.my - 1));
        let mut product = Product {
            body: *body,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(py),
            loads: [const { None }; 3],
            scale: loads.scale(),
        };
        for (k, load) in loads.list().into_iter().enumerate() {
            product.loads[k] = load.map(|load| product.transform(load)).transpose()?;
        }
        Ok(product)
    }

    fn transform(&self, load: &[f64]) -> Result<Vec<Complex<f64>>> {
        let (px, py, nb, mx) = (self.rows.length(), self.columns.length(), self.rows.bins(), self.body.grid.mx);
        let mut spectrum = zeros(nb * py, "the transform of a load")?;
        let (mut row, mut bins, mut scratch) = (zeros(px, STRESS)?, zeros(nb, STRESS)?, self.rows.scratch());
        self.columns.fit(&mut scratch);
        let factor = 1.0 / (px as f64 * py as f64);
        for (iy, load) in load.chunks_exact(mx).enumerate() {
            row.fill(0.0);
            row.iter_mut().zip(load).for_each(|(value, load)| *value = load / self.scale);
            self.rows.forward(&mut row, &mut bins, &mut scratch);
            bins.iter().enumerate().for_each(|(bin, value)| spectrum[bin * py + iy] = value * factor);
        }
        spectrum.chunks_exact_mut(py).for_each(|column| self.columns.forward(column, &mut scratch));
        Ok(spectrum)
    }

    /// Memory for the products of one depth, with these components.
    pub fn workspace(&self, components: [bool; 6]) -> Result<Workspace> {
        let grid = &self.body.grid;
        let (nb, py) = (self.rows.bins(), self.columns.length());
        let loaded = self.loads.each_ref().map(Option::is_some);
        let mut scratch = self.rows.scratch();
        self.columns.fit(&mut scratch);
        Ok(Workspace {
            kernels: Kernels::new(Asked { loaded, components, offsets: (grid.mx, grid.my) })?,
            in_x: zeros((nb + nb % 2) * grid.my, STRESS)?,
            spectrum: zeros(3 * (nb + nb % 2) * (py / 2 + 1), STRESS)?,
            row: zeros(self.rows.length(), STRESS)?,
            bins: zeros(nb, STRESS)?,
            column: zeros(py, STRESS)?,
            stress: zeros(grid.my * nb, STRESS)?,
            scratch,
        })
    }

    /// Computes the kernels of depth z.
    pub fn enter(&self, z: f64, workspace: &mut Workspace) {
        workspace.kernels.compute(&self.body, self.body.in_units(z));
    }

    /// Component c at the depth that was entered.
    pub fn component(&self, c: usize, workspace: &mut Workspace, out: &mut [f64]) {
        for load in 0..3 {
            if self.loads[load].is_some() {
                self.transform_kernel(load, c, workspace);
            }
        }
        self.multiply(c, workspace);
        let (nb, mx) = (self.rows.bins(), self.body.grid.mx);
        let Workspace { row, stress, scratch, .. } = workspace;
        for (bins, out) in stress.chunks_exact_mut(nb).zip(out.chunks_exact_mut(mx)) {
            self.rows.inverse(bins, row, scratch);
            out.iter_mut().zip(&*row).for_each(|(out, value)| *out = self.scale * value);
        }
    }

    /// S of one kernel.
    fn transform_kernel(&self, load: usize, c: usize, workspace: &mut Workspace) {
        let (mx, my) = (self.body.grid.mx, self.body.grid.my);
        let (px, py, nb) = (self.rows.length(), self.columns.length(), self.rows.bins());
        let (odd_x, odd_y) = is_odd(load, c);
        let Workspace { kernels, in_x, spectrum, row, bins, column, scratch, .. } = workspace;
        let Some(table) = kernels.table(load, c) else { return };
        for (ky, table) in table.chunks_exact(mx).enumerate() {
            row[..mx].copy_from_slice(table);
            row[mx..px - mx + 1].fill(0.0);
            let sign = if odd_x { -1.0 } else { 1.0 };
            for kx in 1..mx {
                row[px - kx] = sign * table[kx];
            }
            self.rows.forward(row, bins, scratch);
            for (bin, value) in bins.iter().enumerate() {
                in_x[bin * my + ky] = if odd_x { value.im } else { value.re };
            }
        }
        let half = py / 2 + 1;
        let of_load = (nb + nb % 2) * half;
        let spectrum = &mut spectrum[load * of_load..(load + 1) * of_load];
        for (two, out) in in_x.chunks_exact(2 * my).zip(spectrum.chunks_exact_mut(2 * half)) {
            let sign = if odd_y { -1.0 } else { 1.0 };
            column[my..py - my + 1].fill(Complex::default());
            for ky in 0..my {
                let value = Complex::new(two[ky], two[my + ky]);
                column[ky] = value;
                if ky > 0 {
                    column[py - ky] = value * sign;
                }
            }
            self.columns.forward(column, scratch);
            for (k, value) in column[..half].iter().enumerate() {
                (out[k], out[half + k]) = if odd_y { (value.im, -value.re) } else { (value.re, value.im) };
            }
        }
    }

    /// Products with all loads, and back in y.
    fn multiply(&self, c: usize, workspace: &mut Workspace) {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        let half = py / 2 + 1;
        let of_load = (nb + nb % 2) * half;
        let Workspace { spectrum, column, stress, scratch, .. } = workspace;
        for bin in 0..nb {
            column.fill(Complex::default());
            for (load, transform) in self.loads.iter().enumerate() {
                let Some(transform) = transform else { continue };
                let s = &spectrum[load * of_load + bin * half..][..half];
                let (odd_x, odd_y) = is_odd(load, c);
                let factor = match (odd_x, odd_y) {
                    (false, false) => Complex::new(1.0, 0.0),
                    (true, true) => Complex::new(-1.0, 0.0),
                    _ => Complex::new(0.0, 1.0),
                };
                let sign = if odd_y { -1.0 } else { 1.0 };
                let (transform_lower, transform_upper) = transform[bin * py..(bin + 1) * py].split_at(half);
                let (lower, upper) = column.split_at_mut(half);
                for ((sum, load), s) in lower.iter_mut().zip(transform_lower).zip(s) {
                    *sum += factor * load * s;
                }
                for ((sum, load), s) in upper.iter_mut().rev().zip(transform_upper.iter().rev()).zip(&s[1..]) {
                    *sum += factor * load * (sign * s);
                }
            }
            self.columns.inverse(column, scratch);
            for (iy, value) in column[..self.body.grid.my].iter().enumerate() {
                stress[iy * nb + bin] = *value;
            }
        }
    }
}
