//! The sums over elements at one depth, as products by FFT.
//!
//! The loads are transformed once for all depths. A stress component at one depth is the sum of the products of the loads by the kernels of this
//! component ([`ParityProduct`]).
//!
//! With a period the grid is not padded, and waves that have decayed at a depth are left out. With coupled patches each patch has its own loads
//! and products; all patches have the same kernels.

use toeplitz::fft::{good_length, Complex};
use toeplitz::{ParityMemory, ParityProduct, Term};

use super::body::Body;
use super::kernels::{is_odd, Asked, Kernels};
use super::loads::{Loads, Part};
use super::periodic::Waves;
use crate::effects::Patches;
use crate::error::Result;
use crate::memory::zeros;

/// The name of the memory of stresses in messages.
const STRESS: &str = "the stresses of a depth";

/// The transform of each load, `[bin in x][bin in y]`, divided by the number of elements of the padded grid; `None` if there is no such load.
type Spectra = [Option<Vec<Complex<f64>>>; 3];

/// The products of the loads of one body by the kernels of any depth.
pub struct Product<'a> {
    /// The loaded half-space.
    pub body: Body,
    /// The Fourier transforms on the padded grid.
    transforms: ParityProduct,
    /// The transformed loads of each part of the grid.
    parts: Vec<(Part, Spectra)>,
    /// The contact patches.
    patches: Option<Patches<'a>>,
    /// The number by which the loads are divided.
    scale: f64,
    /// With a period: whether some depth is near the surface.
    near: bool,
}

/// The kernels of one depth.
enum Source {
    /// Tables over offsets, without a period.
    Free(Kernels),
    /// Sums over waves, with a period.
    Periodic(Box<Waves>),
}

/// The memory for the products of one depth.
pub struct Workspace {
    /// The kernels.
    source: Source,
    /// With a period: whether the current depth is near the surface.
    near: bool,
    /// The numbers of bins in x and in y, from 0 on, in which the kernels are not 0 at this depth.
    left: (usize, usize),
    /// The memory of the Fourier transforms.
    memory: ParityMemory,
    /// The symbols of the tabulated kernels of one component: `[load][bin in x][bin in y >= 0]`.
    spectrum: Vec<f64>,
    /// The stresses of one component, transformed in x: `[iy][bin in x]`.
    stress: Vec<Complex<f64>>,
    /// With coupled patches: the stresses by the loads of one patch, on the whole grid.
    field: Vec<f64>,
}

impl<'a> Product<'a> {
    /// Transforms the loads, which have been checked. `near`: with a period, whether some depth is near the surface.
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

    /// The numbers of offsets at which kernels are tabulated: those of the grid, or those up to half a period.
    fn offsets(&self) -> (usize, usize) {
        self.body.grid.offsets((self.body.periodic, self.body.periodic))
    }

    /// Allocates the memory for the products of one depth, for the wanted components.
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

    /// Computes the kernels of the depth z, which becomes the current depth.
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

    /// Whether the grid has parts with different loads.
    fn has_patches(&self) -> bool {
        self.parts.iter().any(|(part, _)| *part != Part::All)
    }

    /// Computes component c of the stresses at the current depth.
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

    /// Computes the symbol of one tabulated kernel.
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

    /// Multiplies all loads by their kernels, and transforms the sum back in y.
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
