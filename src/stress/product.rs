//! Sums over elements at one depth, by FFT.
//!
//! Loads are transformed once. A stress component at one depth is the sum of the loads' products by its kernels ([`ParityProduct`]).
//!
//! With a period there is no padding, and waves that have decayed at a depth are left out. With patches each patch has loads and products of its
//! own, with common kernels.

use toeplitz::fft::{good_length, Complex};
use toeplitz::{ParityMemory, ParityProduct, Term};

use super::body::Body;
use super::kernels::{is_odd, Asked, Kernels};
use super::loads::{Loads, Part};
use super::periodic::Waves;
use crate::effects::Patches;
use crate::error::Result;
use crate::memory::zeros;

/// The name of this memory in messages.
const STRESS: &str = "the stresses of a depth";

/// The transform of each load, `[bin in x][bin in y]`, divided by the number of elements of a period; none if there is no such load.
type Spectra = [Option<Vec<Complex<f64>>>; 3];

/// The products of the loads of one body by the kernels of any depth.
pub struct Product<'a> {
    pub body: Body,
    transforms: ParityProduct,
    /// The loads of each part.
    parts: Vec<(Part, Spectra)>,
    patches: Option<Patches<'a>>,
    /// The divisor of the loads.
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
    /// Whether the entered depth is near the surface.
    near: bool,
    /// Bins in x and in y, from 0 on, that are not 0 at this depth.
    left: (usize, usize),
    memory: ParityMemory,
    /// The symbols of one component's tabulated kernels: `[load][bin in x][bin in y >= 0]`.
    spectrum: Vec<f64>,
    /// The transform of the stresses: `[iy][bin in x]`.
    stress: Vec<Complex<f64>>,
    /// With patches: the stresses of one patch's loads on the whole grid.
    field: Vec<f64>,
}

impl<'a> Product<'a> {
    /// Transforms the checked loads.
    pub fn new(body: &Body, loads: &Loads<'a>, near: bool) -> Result<Product<'a>> {
        let period = |m: usize| if body.periodic { m } else { good_length(2 * m - 1) };
        let (px, py) = (period(body.grid.mx), period(body.grid.my));
        let (transforms, scale) = (ParityProduct::new(px, py)?, loads.scale());
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

    /// Whether each load is given.
    fn loaded(&self) -> [bool; 3] {
        self.parts[0].1.each_ref().map(Option::is_some)
    }

    /// Offsets at which kernels are tabulated: those of the grid, or up to half a period.
    fn offsets(&self) -> (usize, usize) {
        self.body.grid.offsets((self.body.periodic, self.body.periodic))
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
            field: zeros(if self.has_patches() { self.body.grid.len() } else { 0 }, STRESS)?,
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

    fn has_patches(&self) -> bool {
        self.parts.iter().any(|(part, _)| *part != Part::All)
    }

    /// Component c at the entered depth.
    pub fn component(&self, c: usize, workspace: &mut Workspace, out: &mut [f64]) {
        for load in (0..3).filter(|&load| self.loaded()[load]) {
            self.transform_table(load, c, workspace);
        }
        for (part, loads) in &self.parts {
            self.multiply(loads, c, workspace);
            let Workspace { stress, memory, left, field, .. } = workspace;
            let to = if *part == Part::All { &mut *out } else { &mut field[..] };
            self.transforms.back(stress, left.0, self.scale, memory, to, self.body.grid.mx);
            if let (Part::Patch(patch), Some(patches)) = (part, &self.patches) {
                for ((out, value), of) in out.iter_mut().zip(&*field).zip(patches.patch) {
                    *out = if *of == *patch as i32 { *value } else { *out };
                }
            }
        }
    }

    /// The symbol of one tabulated kernel.
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

    /// Multiplies all loads and transforms back in y.
    fn multiply(&self, loads: &Spectra, c: usize, workspace: &mut Workspace) {
        let (nb, half) = self.transforms.bins();
        let Workspace { source, spectrum, memory, stress, left, near, .. } = workspace;
        let (source, tables, near) = (&*source, &*spectrum, *near);
        let symbol = |load: usize| match source {
            Source::Periodic(waves) if !near => waves.spectrum(load, c),
            _ => Some(&tables[load * nb * half..(load + 1) * nb * half]),
        };
        let terms = loads.iter().enumerate().filter_map(|(load, transform)| {
            Some(Term { load: transform.as_ref()?, symbol: symbol(load)?, is_odd: is_odd(load, c) })
        });
        self.transforms.in_x(terms, *left, memory, stress);
    }
}
