//! Sums over elements at one depth, by FFT.
//!
//! The loads are padded with zeros to `px * py >= (2 mx - 1) (2 my - 1)` and transformed once. A kernel that is even in both directions
//! has a real, even spectrum S; each direction in which it is odd makes that a factor i, and S odd in this direction. So
//!
//! ```text
//! stress = F^-1 sum over loads of i^(number of odd directions) S . F load
//! ```
//!
//! With a period nothing is padded.

use super::kernels::{is_odd, Asked, Kernels};
use super::periodic::Waves;
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
    /// With a period: whether some depth is near the surface.
    near: bool,
}

/// Kernels of one depth.
enum Source {
    Free(Kernels),
    Periodic(Waves),
}

/// Memory for the products of one depth.
pub struct Workspace {
    source: Source,
    /// Whether the depth that was entered is near the surface.
    near: bool,
    transform: Transform,
    /// Of the kernels of one component: `[load][bin in x][bin in y >= 0]`.
    spectrum: Vec<f64>,
    /// Of the stresses: `[iy][bin in x]`.
    stress: Vec<Complex<f64>>,
}

/// Memory for transforms.
struct Transform {
    /// Of one kernel: transforms in x, `[bin in x][ky]`.
    in_x: Vec<f64>,
    row: Vec<f64>,
    bins: Vec<Complex<f64>>,
    column: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Product {
    /// Transforms the loads, which were checked.
    pub fn new(body: &Body, loads: &Loads<'_>, near: bool) -> Result<Product> {
        let period = |m: usize| if body.periodic { m } else { good_length(2 * m - 1) };
        let (px, py) = (period(body.grid.mx), period(body.grid.my));
        let mut product = Product {
            body: *body,
            rows: RowTransform::new(px),
            columns: ColumnTransform::new(py),
            loads: [const { None }; 3],
            scale: loads.scale(),
            near,
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
        let offsets = if self.body.periodic { (grid.mx / 2 + 1, grid.my / 2 + 1) } else { (grid.mx, grid.my) };
        let asked = Asked { loaded, components, offsets };
        Ok(Workspace {
            source: match self.body.periodic {
                true => Source::Periodic(Waves::new(&self.body, asked, self.near)?),
                false => Source::Free(Kernels::new(asked)?),
            },
            near: false,
            transform: Transform {
                in_x: zeros((nb + nb % 2) * offsets.1, STRESS)?,
                row: zeros(self.rows.length(), STRESS)?,
                bins: zeros(nb, STRESS)?,
                column: zeros(py, STRESS)?,
                scratch,
            },
            spectrum: zeros(3 * (nb + nb % 2) * (py / 2 + 1), STRESS)?,
            stress: zeros(grid.my * nb, STRESS)?,
        })
    }

    /// Computes the kernels of depth z.
    pub fn enter(&self, z: f64, workspace: &mut Workspace) {
        let z = self.body.in_units(z);
        match &mut workspace.source {
            Source::Free(kernels) => kernels.compute(&self.body, z),
            Source::Periodic(waves) => waves.compute(&self.body, z),
        }
        workspace.near = Waves::is_near(z);
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
        let Workspace { transform: Transform { row, scratch, .. }, stress, .. } = workspace;
        for (bins, out) in stress.chunks_exact_mut(nb).zip(out.chunks_exact_mut(mx)) {
            self.rows.inverse(bins, row, scratch);
            out.iter_mut().zip(&*row).for_each(|(out, value)| *out = self.scale * value);
        }
    }

    /// S of one kernel.
    fn transform_kernel(&self, load: usize, c: usize, workspace: &mut Workspace) {
        let (py, nb) = (self.columns.length(), self.rows.bins());
        let of_load = (nb + nb % 2) * (py / 2 + 1);
        let Workspace { source, transform, spectrum, near, .. } = workspace;
        let spectrum = &mut spectrum[load * of_load..(load + 1) * of_load];
        let (table, waves) = match source {
            Source::Free(kernels) => (kernels.table(load, c), None),
            Source::Periodic(waves) => match waves.kernel(load, c) {
                Some((waves, images)) => (images.filter(|_| *near), Some(waves)),
                None => (None, None),
            },
        };
        match table {
            Some(table) => self.transform_table(table, is_odd(load, c), transform, spectrum),
            None => spectrum.fill(0.0),
        }
        for (sum, wave) in spectrum.iter_mut().zip(waves.unwrap_or_default()) {
            *sum += wave;
        }
    }

    /// The spectrum of the table of a kernel, without its factors i.
    fn transform_table(
        &self,
        table: &[f64],
        (odd_x, odd_y): (bool, bool),
        memory: &mut Transform,
        spectrum: &mut [f64],
    ) {
        let (px, py) = (self.rows.length(), self.columns.length());
        let grid = &self.body.grid;
        let given = |m: usize| if self.body.periodic { m / 2 + 1 } else { m };
        let (mx, my) = (given(grid.mx), given(grid.my));
        let sign = |odd: bool| if odd { -1.0 } else { 1.0 };
        let Transform { in_x, row, bins, column, scratch } = memory;
        for (ky, table) in table.chunks_exact(mx).enumerate() {
            row.fill(0.0);
            row[..mx].copy_from_slice(table);
            for kx in 1..mx {
                row[px - kx] = sign(odd_x) * table[kx];
            }
            // Half a period away an odd kernel is its own opposite.
            if odd_x && 2 * (mx - 1) == px {
                row[mx - 1] = 0.0;
            }
            self.rows.forward(row, bins, scratch);
            for (bin, value) in bins.iter().enumerate() {
                in_x[bin * my + ky] = if odd_x { value.im } else { value.re };
            }
        }
        let half = py / 2 + 1;
        for (two, out) in in_x.chunks_exact(2 * my).zip(spectrum.chunks_exact_mut(2 * half)) {
            column.fill(Complex::default());
            for ky in 0..my {
                let value = Complex::new(two[ky], two[my + ky]);
                column[ky] = value;
                if ky > 0 {
                    column[py - ky] = value * sign(odd_y);
                }
            }
            if odd_y && 2 * (my - 1) == py {
                column[my - 1] = Complex::default();
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
        let Workspace { spectrum, transform: Transform { column, scratch, .. }, stress, .. } = workspace;
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
