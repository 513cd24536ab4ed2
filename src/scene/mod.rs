//! What is simulated: two bodies, the undeformed distance between them, the load, and the effects a scene names.

mod bodies;
mod load;
mod refine;

pub use crate::effects::{Layer, Patches, Period, PressureLimit};
pub use bodies::Bodies;
pub use load::Load;
pub use refine::refine;

use crate::effects;
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::{Coefficients, RowTables, Table};

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
    /// Effect: the scene repeats itself.
    pub period: Option<Period>,
    /// Effect: a thin compliant layer.
    pub layer: Option<Layer<'a>>,
    /// Effect: pressures do not exceed a limit.
    pub pressure_limit: Option<PressureLimit<'a>>,
    /// Effect: several contact patches, whose interaction is scaled.
    pub patches: Option<Patches<'a>>,
    /// Effect: own coefficients, one table per loaded row.
    pub row_tables: Option<RowTables>,
}

impl<'a> Scene<'a> {
    /// A scene without further effects.
    pub fn new(grid: Grid, undeformed_distance: &'a [f64], bodies: Bodies, load: Load) -> Scene<'a> {
        Scene {
            grid,
            undeformed_distance,
            bodies,
            load,
            influence: None,
            period: None,
            layer: None,
            pressure_limit: None,
            patches: None,
            row_tables: None,
        }
    }

    /// The coefficients that this scene asks for.
    pub fn coefficients(&self) -> Result<Coefficients> {
        effects::coefficients(self)
    }

    /// Checks everything the solver relies on.
    pub fn check(&self) -> Result<()> {
        self.check_distance_and_load()?;
        effects::check(self)
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
                "undeformed_distance of {} is {}; it must be a number, or +infinity where there is no surface",
                self.grid.element(i),
                h[i]
            )));
        }
        self.load.check()?;
        effects::check_load(self)?;
        match self.load {
            Load::Force(force) if force > 0.0 && h.iter().all(|v| v.is_infinite()) => Err(Error::Infeasible(format!(
                "force is {force}, but undeformed_distance is infinite on every element: nothing can carry it"
            ))),
            _ => Ok(()),
        }
    }
}
