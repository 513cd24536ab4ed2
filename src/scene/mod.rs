//! What is simulated: two bodies, the undeformed distance between them, the load, and the effects a scene names.

mod bodies;
mod layer;
mod load;
mod patches;
mod period;
mod pressure_limit;
mod refine;

pub use bodies::Bodies;
pub use layer::Layer;
pub use load::Load;
pub use patches::Patches;
pub use period::Period;
pub use pressure_limit::PressureLimit;
pub use refine::refine;

use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::{HalfSpace, Influence, Periodic, RowTables, Table};

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
    pub fn influence(&self) -> Influence {
        let half_space = || HalfSpace::new(self.grid.dx, self.grid.dy, self.bodies.compliance());
        let bodies = match (&self.influence, &self.row_tables, self.period) {
            (Some(table), ..) => Influence::Table(table.clone()),
            (_, Some(tables), _) => Influence::RowTables(tables.clone()),
            (.., Some(Period { x, y })) => Influence::Periodic(Periodic::new(half_space(), (x, y), &self.grid)),
            _ => Influence::HalfSpace(half_space()),
        };
        let scaled = match &self.patches {
            Some(patches) => patches.on(bodies),
            None => bodies,
        };
        match &self.layer {
            Some(layer) => layer.on(scaled),
            None => scaled,
        }
    }

    /// Checks everything the solver relies on.
    pub fn check(&self) -> Result<()> {
        self.check_distance_and_load()?;
        self.check_effects()?;
        // Own coefficients know no bodies.
        if self.influence.is_some() || self.row_tables.is_some() {
            return Ok(());
        }
        self.bodies.check()
    }

    /// Checks each effect, and refuses pairs that are not solved.
    pub(crate) fn check_effects(&self) -> Result<()> {
        if let Some(period) = &self.period {
            period.check()?;
            if self.influence.is_some() {
                return not_together("influence", "period");
            }
        }
        if let Some(tables) = &self.row_tables {
            tables.check(&self.grid)?;
            if self.influence.is_some() {
                return not_together("influence", "row_tables");
            }
            if self.period.is_some() {
                return not_together("row_tables", "period");
            }
        }
        if let Some(patches) = &self.patches {
            patches.check(&self.grid)?;
            if self.period.is_some() {
                return not_together("patches", "period");
            }
        }
        if let Some(layer) = &self.layer {
            layer.check(&self.grid)?;
        }
        if let Some(limit) = &self.pressure_limit {
            limit.check(&self.grid)?;
        }
        Ok(())
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
        if let Some(period) = &self.period {
            period.check_load(self)?;
        }
        if let Load::Force(force) = self.load {
            if force > 0.0 && h.iter().all(|v| v.is_infinite()) {
                return Err(Error::Infeasible(format!(
                    "force is {force}, but undeformed_distance is infinite on every element: nothing can carry it"
                )));
            }
            if let Some(limit) = &self.pressure_limit {
                limit.check(&self.grid)?;
                limit.check_force(force, h, &self.grid)?;
            }
        }
        Ok(())
    }
}

fn not_together(one: &str, other: &str) -> Result<()> {
    Err(Error::Unsupported(format!("{one} and {other} are both given; this version does not solve them together")))
}
