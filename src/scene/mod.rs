//! What is simulated: two bodies, the undeformed distance between them, the load, and the effects a scene names.

mod bodies;
mod load;
mod plain;
mod refine;

pub use crate::effects::{
    Adhesion, Coating, CoatingLayer, Coefficient, Friction, Layer, Motion, Patches, Period, Prescribed, PressureLimit,
    Previous, TangentialInfluence, Work,
};
pub use bodies::Bodies;
pub use load::Load;
pub use plain::Plain;
pub use refine::{refine, sample};

use crate::grid::Grid;
use crate::influence::{RowTables, Table};

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
    /// Effect: bonded elastic layers on the bodies.
    pub coating: Option<Coating>,
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
    /// Effect: friction between the bodies.
    pub friction: Option<Friction<'a>>,
    /// Effect: attraction between the bodies.
    pub adhesion: Option<Adhesion<'a>>,
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
            coating: None,
            period: None,
            layer: None,
            pressure_limit: None,
            patches: None,
            row_tables: None,
            friction: None,
            adhesion: None,
        }
    }

    /// The adhesion, if anything attracts.
    pub fn attraction(&self) -> Option<&Adhesion<'a>> {
        self.adhesion.as_ref().filter(|adhesion| adhesion.is_one())
    }

    /// The same without its effects.
    pub fn plain(&self) -> Plain<'a> {
        let Scene { grid, undeformed_distance, bodies, load, .. } = *self;
        Plain { grid, undeformed_distance, bodies, load }
    }
}
