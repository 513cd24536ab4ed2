//! Sums over elements at one depth, by FFT.
//!
//! The loads are padded with zeros to `px * py >= (2 mx - 1) (2 my - 1)` and transformed once. With S of each kernel (see
//! [`transform`](super::transform))
//!
//! ```text
//! stress = F^-1 sum over loads of i^(number of odd directions) S . F load
//! ```
//!
//! With a period nothing is padded, and the waves that have faded at a depth are left out. Where patches scale what elements feel, each has
//! loads and products of its own; kernels are those of all.

use super::body::Body;
use super::kernels::{is_odd, Asked, Kernels};
use super::loads::Loads;
use super::loads::Part;
use super::periodic::Waves;
use super::transform::{gap, Memory, Transforms, BLOCK};
use crate::error::Result;
use crate::memory::zeros;
use crate::operator::fft::{good_length, Complex};
use crate::scene::Patches;

/// What memory is for.
const STRESS: &str = "the stresses of a depth";

/// The transform of each load, `[bin in x][bin in y]`, over its number of values; none: no such load.
type Spectra = [Option<Vec<Complex<f64>>>; 3];

/// Products with the loads of one body, of all depths.
pub struct Product<'a> {
    pub body: Body,
    transforms: Transforms,
    /// What stresses each part.
    parts: Vec<(Part, Spectra)>,
    patches: Option<Patches<'a>>,
    /// What the loads were divided by.
    scale: f64,
    /// With a period: whether some depth is near the surface.
    near: bool,
}

/// Kernels of one depth.
enum Source {
    Free(Kernels),
    Periodic(Box<Waves>),
}

/// Memory for the products of one depth.
pub struct Workspace {
    source: Source,
    /// Whether the depth that was entered is near the surface.
    near: bool,
    /// Bins in x and in y, from 0 on, that are not 0 at this depth.
    left: (usize, usize),
    memory: Memory,
    /// Of the kernels of one component, where tables were transformed: `[load][bin in x][bin in y >= 0]`.
    spectrum: Vec<f64>,
    /// Of the stresses: `[iy][bin in x]`.
    stress: Vec<Complex<f64>>,
    /// Of patches: the stresses that one patch would have everywhere.
    field: Vec<f64>,
}

impl<'a> Product<'a> {
    /// Transforms the loads, which were checked.
    pub fn new(body: &Body, loads: &Loads<'a>, near: bool) -> Result<Product<'a>> {
        let period = |m: usize| if body.periodic { m } else { good_length(2 * m - 1) };
        let (px, py) = (period(body.grid.mx), period(body.grid.my));
        let (transforms, scale) = (Transforms::new(px, py)?, loads.scale());
        let factor = 1.0 / (px as f64 * py as f64);
        let mut parts = Vec::new();
        for part in loads.parts() {
            let mut spectra = [const { None }; 3];
            for (spectrum, load) in spectra.iter_mut().zip(loads.list()) {
                let Some(load) = load else { continue };
                let on_part = if part == Part::All { Vec::new() } else { loads.on(part, load)? };
                let load = if part == Part::All { load } else { &on_part };
                *spectrum = Some(transforms.of_load(load, body.grid.mx, scale, factor)?);
            }
            parts.push((part, spectra));
        }
        Ok(Product { body: *body, transforms, parts, patches: loads.patches, scale, near })
    }

    /// Which loads there are.
    fn loaded(&self) -> [bool; 3] {
        self.parts[0].1.each_ref().map(Option::is_some)
    }

    /// Offsets at which kernels are tabulated: those of the grid, or up to half a period.
    fn offsets(&self) -> (usize, usize) {
        let given = |m: usize| if self.body.periodic { m / 2 + 1 } else { m };
        (given(self.body.grid.mx), given(self.body.grid.my))
    }

    /// Memory for the products of one depth, with these components.
    pub fn workspace(&self, components: [bool; 6]) -> Result<Workspace> {
        let (nb, half) = self.transforms.bins();
        let loaded = self.loaded();
        let offsets = self.offsets();
        let asked = Asked { loaded, components, offsets };
        let tables = if self.body.periodic && !self.near { 0 } else { 3 };
        Ok(Workspace {
            source: match self.body.periodic {
                true => Source::Periodic(Box::new(Waves::new(&self.body, asked, self.near)?)),
                false => Source::Free(Kernels::new(asked)?),
            },
            near: false,
            left: (nb, half),
            memory: self.transforms.memory(offsets.1)?,
            spectrum: zeros(tables * nb * half, STRESS)?,
            stress: zeros(self.body.grid.my * nb, STRESS)?,
            field: zeros(if self.parts[0].0 == Part::All { 0 } else { self.body.grid.len() }, STRESS)?,
        })
    }

    /// Computes the kernels of depth z.
    pub fn enter(&self, z: f64, workspace: &mut Workspace) {
        let z = self.body.in_units(z);
        workspace.near = Waves::is_near(z);
        workspace.left = self.transforms.bins();
        match &mut workspace.source {
            Source::Free(kernels) => kernels.compute(&self.body, z),
            Source::Periodic(waves) => {
                waves.compute(&self.body, z);
                if !workspace.near {
                    workspace.left = waves.left();
                }
            }
        }
    }

    /// Component c at the depth that was entered.
    pub fn component(&self, c: usize, workspace: &mut Workspace, out: &mut [f64]) {
        for load in (0..3).filter(|&load| self.loaded()[load]) {
            self.transform_table(load, c, workspace);
        }
        for (part, loads) in &self.parts {
            self.multiply(loads, c, workspace);
            let Workspace { stress, memory, left, field, .. } = workspace;
            let to = if *part == Part::All { &mut *out } else { &mut field[..] };
            self.transforms.rows_back(stress, left.0, self.scale, memory, to, self.body.grid.mx);
            if let (Part::Patch(patch), Some(patches)) = (part, &self.patches) {
                for (i, (out, value)) in out.iter_mut().zip(&*field).enumerate() {
                    *out = if patches.of(i) == *patch { *value } else { *out };
                }
            }
        }
    }

    /// S of one kernel, where it is tabulated.
    fn transform_table(&self, load: usize, c: usize, workspace: &mut Workspace) {
        let (nb, half) = self.transforms.bins();
        let Workspace { source, memory, spectrum, near, .. } = workspace;
        let (table, waves) = match source {
            Source::Free(kernels) => (kernels.table(load, c), None),
            Source::Periodic(waves) if *near => (waves.images(load, c), waves.spectrum(load, c)),
            Source::Periodic(_) => return,
        };
        let Some(table) = table else { return };
        let spectrum = &mut spectrum[load * nb * half..(load + 1) * nb * half];
        self.transforms.of_kernel(table, self.offsets().0, is_odd(load, c), memory, spectrum);
        for (sum, wave) in spectrum.iter_mut().zip(waves.unwrap_or_default()) {
            *sum += wave;
        }
    }

    /// Products with all loads, and back in y.
    fn multiply(&self, loads: &Spectra, c: usize, workspace: &mut Workspace) {
        let ((_, py), (nb, half)) = (self.transforms.lengths(), self.transforms.bins());
        let Workspace { source, spectrum, memory, stress, left, near, .. } = workspace;
        let (source, tables, near) = (&*source, &*spectrum, *near);
        let spectrum = |load: usize| match source {
            Source::Periodic(waves) if !near => waves.spectrum(load, c),
            _ => Some(&tables[load * nb * half..(load + 1) * nb * half]),
        };
        for first in (0..left.0).step_by(BLOCK) {
            let count = BLOCK.min(left.0 - first);
            let columns = memory.columns.chunks_exact_mut(py).take(count);
            columns.for_each(|column| column[gap(left.1, py)].fill(Complex::default()));
            let mut first_load = true;
            for (load, transform) in loads.iter().enumerate() {
                let (Some(transform), Some(spectrum)) = (transform, spectrum(load)) else { continue };
                for (k, column) in memory.columns.chunks_exact_mut(py).take(count).enumerate() {
                    let bin = first + k;
                    let (load_bins, s) = (&transform[bin * py..][..py], &spectrum[bin * half..][..left.1]);
                    match first_load {
                        true => put_product(column, load_bins, s, is_odd(load, c), |sum, value| *sum = value),
                        false => put_product(column, load_bins, s, is_odd(load, c), |sum, value| *sum += value),
                    }
                }
                first_load = false;
            }
            self.transforms.columns_back(count, memory);
            for (iy, row) in stress.chunks_exact_mut(nb).enumerate() {
                for (value, column) in row[first..first + count].iter_mut().zip(memory.columns.chunks_exact(py)) {
                    *value = column[iy];
                }
            }
        }
    }
}

/// Puts `i^(number of odd directions) S . load` of one column, where S is given at bins in y >= 0.
fn put_product(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    (odd_x, odd_y): (bool, bool),
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
) {
    let sign = if odd_y { -1.0 } else { 1.0 };
    match (odd_x, odd_y) {
        (false, false) => put_turned(column, load, s, sign, put, |value| value),
        (true, true) => put_turned(column, load, s, sign, put, |value| -value),
        _ => put_turned(column, load, s, sign, put, |value| Complex::new(-value.im, value.re)),
    }
}

#[inline]
fn put_turned(
    column: &mut [Complex<f64>],
    load: &[Complex<f64>],
    s: &[f64],
    sign: f64,
    put: impl Fn(&mut Complex<f64>, Complex<f64>),
    turn: impl Fn(Complex<f64>) -> Complex<f64>,
) {
    let half = column.len() / 2 + 1;
    let ((lower, upper), (load_lower, load_upper)) = (column.split_at_mut(half), load.split_at(half));
    for ((value, load), s) in lower.iter_mut().zip(load_lower).zip(s) {
        put(value, turn(load * s));
    }
    for ((value, load), s) in upper.iter_mut().rev().zip(load_upper.iter().rev()).zip(&s[1..]) {
        put(value, turn(load * (sign * s)));
    }
}
