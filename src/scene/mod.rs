//! The scene that is simulated: two bodies, the undeformed distance between them, the load, and the effects.

mod bodies;
mod load;
mod plain;
mod refine;
mod regrid;
mod with_effects;

pub use crate::effects::{
    Adhesion, Branch, Branches, Coating, CoatingLayer, Coefficient, Each, Fall, Friction, FrictionLaw, Layer, Motion,
    Patches, Period, PlasticLayer, Prescribed, PressureLimit, Previous, TangentialInfluence, Visco, Work,
};
pub use bodies::Bodies;
pub use load::Load;
pub use plain::Plain;
pub use refine::refine;
pub use regrid::{refines, sample, scaled, Regridded};
pub use with_effects::Scene;
