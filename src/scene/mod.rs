//! What is simulated: two bodies, the undeformed distance between them, the load, and the effects a scene names.

mod bodies;
mod load;
mod refine;

pub use bodies::Bodies;
pub use load::Load;
pub use refine::refine;

use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::{HalfSpace, Influence, Table};

/// One contact problem: `e = h - approach + A p`.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// The potential contact area.
    pub grid: Grid,
    /// h, `[my][mx]`; `+infinity`: no surface there, the element stays exterior.
    pub undeformed_distance: &'a [f64],
    /// Elasticity of the two bodies.
    pub bodies: Bodies,
    /// Prescribed approach or prescribed force.
    pub load: Load,
    /// Effect: own coefficients instead of the half-space.
    pub influence: Option<Table>,
}

impl<'a> Scene<'a> {
    /// A scene without further effects.
    pub fn new(grid: Grid, undeformed_distance: &'a [f64], bodies: Bodies, load: Load) -> Scene<'a> {
        Scene { grid, undeformed_distance, bodies, load, influence: None }
    }

    /// The coefficients that this scene asks for.
    pub fn influence(&self) -> Influence {
        match &self.influence {
            Some(table) => Influence::Table(table.clone()),
            None => Influence::HalfSpace(HalfSpace::new(self.grid.dx, self.grid.dy, self.bodies.compliance())),
        }
    }

    /// Checks everything the solver relies on.
    pub fn check(&self) -> Result<()> {
        self.check_distance_and_load()?;
        match self.influence {
            Some(_) => Ok(()),
            None => self.bodies.check(),
        }
    }

    /// Checks what changes from solve to solve.
    pub fn check_distance_and_load(&self) -> Result<()> {
        let h = self.undeformed_distance;
        if h.len() != self.grid.len() {
            return invalid(format!(
                "undeformed_distance has {} values; the grid has {} elements",
                h.len(),
                self.grid.len()
            ));
        }
        if let Some(i) = h.iter().position(|v| v.is_nan() || *v == f64::NEG_INFINITY) {
            return Err(Error::NotFinite(format!(
                "undeformed_distance of element ({}, {}) is {}; it must be a number, or +infinity where there is no surface",
                i % self.grid.mx,
                i / self.grid.mx,
                h[i]
            )));
        }
        self.load.check()?;
        if let Load::Force(force) = self.load {
            if force > 0.0 && h.iter().all(|v| v.is_infinite()) {
                return Err(Error::Infeasible(format!(
                    "force is {force}, but undeformed_distance is infinite on every element: nothing can carry it"
                )));
            }
        }
        Ok(())
    }
}
