//! The results at one depth.

use super::loads::Loads;
use super::product::{Product, Workspace};
use super::tensor::{principal, von_mises, Tensor};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// The results wanted at each depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Components xx, yy, zz, xy, xz, yz.
    pub components: [bool; 6],
    /// The von Mises stress.
    pub von_mises: bool,
    /// The largest shear stress.
    pub maximum_shear: bool,
    /// The principal stresses.
    pub principal: bool,
    /// The directions of the principal stresses.
    pub directions: bool,
}

impl Wanted {
    /// Scalars need all components.
    fn needs(&self) -> [bool; 6] {
        match self.von_mises || self.needs_principal() {
            true => [true; 6],
            false => self.components,
        }
    }

    fn needs_principal(&self) -> bool {
        self.maximum_shear || self.principal || self.directions
    }
}

/// The stresses at one depth, `[my][mx]` each; empty: not wanted.
#[derive(Clone, Debug, Default)]
pub struct Depth {
    /// xx, yy, zz, xy, xz, yz; all of them if any scalar is wanted.
    pub stress: [Vec<f64>; 6],
    /// The von Mises stress.
    pub von_mises: Vec<f64>,
    /// The largest shear stress.
    pub maximum_shear: Vec<f64>,
    /// The principal stresses, the largest first.
    pub principal: [Vec<f64>; 3],
    /// The unit vectors of the principal directions.
    pub directions: [Vec<[f64; 3]>; 3],
}

/// The largest value of a field, and its place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Maximum {
    /// The value.
    pub value: f64,
    /// The index of the depth.
    pub depth: usize,
    /// The index in x of the element above.
    pub ix: usize,
    /// The index in y of the element above.
    pub iy: usize,
}

impl Maximum {
    /// Takes the largest of `values` at a depth, if it is larger than any before. With patches only values below their elements count.
    pub fn join(known: &mut Option<Maximum>, values: &[f64], depth: usize, (grid, loads): (&Grid, &Loads<'_>)) {
        let counts = loads.counted();
        for (i, &value) in values.iter().enumerate().filter(|(i, _)| counts(*i)) {
            if !known.is_some_and(|known| known.value >= value) {
                *known = Some(Maximum { value, depth, ix: i % grid.mx, iy: i / grid.mx });
            }
        }
    }
}

/// The results at one depth, and the workspace of their computation.
pub(super) struct DepthMemory {
    workspace: Workspace,
    pub depth: Depth,
}

impl DepthMemory {
    pub fn new(product: &Product<'_>, wanted: &Wanted) -> Result<DepthMemory> {
        let n = product.body.grid.len();
        let field = |needed: bool| zeros(if needed { n } else { 0 }, "the stresses of a depth");
        let vectors = |needed: bool| zeros(if needed { n } else { 0 }, "the directions of a depth");
        let mut depth = Depth {
            von_mises: field(wanted.von_mises)?,
            maximum_shear: field(wanted.maximum_shear)?,
            ..Depth::default()
        };
        for (component, needed) in depth.stress.iter_mut().zip(wanted.needs()) {
            *component = field(needed)?;
        }
        for k in 0..3 {
            depth.principal[k] = field(wanted.principal)?;
            depth.directions[k] = vectors(wanted.directions)?;
        }
        Ok(DepthMemory { workspace: product.workspace(wanted.needs())?, depth })
    }

    /// Computes all wanted stresses at depth z.
    pub fn compute(&mut self, product: &Product<'_>, wanted: &Wanted, z: f64) {
        product.enter(z, &mut self.workspace);
        for (c, out) in self.depth.stress.iter_mut().enumerate() {
            if !out.is_empty() {
                product.component(c, &mut self.workspace, out);
            }
        }
        let depth = &mut self.depth;
        let tensor = |stress: &[Vec<f64>; 6], i: usize| -> Tensor { std::array::from_fn(|c| stress[c][i]) };
        for (i, value) in depth.von_mises.iter_mut().enumerate() {
            *value = von_mises(tensor(&depth.stress, i));
        }
        if !wanted.needs_principal() {
            return;
        }
        for i in 0..product.body.grid.len() {
            let found = principal(tensor(&depth.stress, i));
            if wanted.maximum_shear {
                depth.maximum_shear[i] = found.maximum_shear();
            }
            for k in 0..3 {
                if wanted.principal {
                    depth.principal[k][i] = found.stresses[k];
                }
                if wanted.directions {
                    depth.directions[k][i] = found.directions[k];
                }
            }
        }
    }
}
