//! The results at one depth, and their computation.

use super::loads::Loads;
use super::product::{Product, Workspace};
use super::tensor::{principal, von_mises, Tensor};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// The results wanted at each depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Which of the components xx, yy, zz, xy, xz, yz are wanted.
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
    /// The components that have to be computed. Any result except single components needs all of them.
    fn needs(&self) -> [bool; 6] {
        match self.von_mises || self.needs_principal() {
            true => [true; 6],
            false => self.components,
        }
    }

    /// Whether principal stresses have to be computed.
    fn needs_principal(&self) -> bool {
        self.maximum_shear || self.principal || self.directions
    }
}

/// The results at one depth. Each array is `[my][mx]`, or empty if it is not needed.
#[derive(Clone, Debug, Default)]
pub struct Depth {
    /// The components xx, yy, zz, xy, xz, yz. All are present if any other result is wanted.
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

/// The largest value of a result over all depths, and its position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Maximum {
    /// The value.
    pub value: f64,
    /// The index of the depth.
    pub depth: usize,
    /// The index in x of the element above the position.
    pub ix: usize,
    /// The index in y of the element above the position.
    pub iy: usize,
}

impl Maximum {
    /// Updates the `known` maximum by the `values` at one depth. With patches, only values below elements of patches count.
    pub fn join(known: &mut Option<Maximum>, values: &[f64], depth: usize, (grid, loads): (&Grid, &Loads<'_>)) {
        let counts = loads.counted();
        for (i, &value) in values.iter().enumerate().filter(|(i, _)| counts(*i)) {
            if !known.is_some_and(|known| known.value >= value) {
                *known = Some(Maximum { value, depth, ix: i % grid.mx, iy: i / grid.mx });
            }
        }
    }
}

/// The results at one depth, and the memory for their computation.
pub(super) struct DepthMemory {
    /// The memory of the products.
    workspace: Workspace,
    /// The results.
    pub depth: Depth,
}

impl DepthMemory {
    /// Allocates the memory for the wanted results.
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

    /// Computes all wanted results at the depth z.
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
