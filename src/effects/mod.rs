//! The effects that a scene may have beside its bodies: friction, a coating, a period, ...; one file for each effect, and the list of all.
//!
//! The [`Properties`] of an effect state which effects it excludes, which methods and calls solve it, and what it changes. docs/effects.md has tables
//! for users.
//!
//! A new effect needs a file with an `impl Effect`, a line `mod` here, and a line in the list (`list.rs`). The line in the list makes the effect a
//! field of [`Scene`](crate::scene::Scene). Effects act in the order of the list. `together.rs` joins the properties of all effects of a scene.
//!
//! An effect whose equations are solved in turns with the normal problem returns a [`Coupled`] problem; `tests/unit/foundation.rs` is an example. An
//! effect of bodies whose displacements depend on earlier steps returns a [`Memory`].

mod adhesion;
mod coating;
mod coupled;
mod each;
mod effect;
mod friction;
mod friction_bounds;
mod friction_effect;
mod friction_law;
mod layer;
pub(crate) mod list;
mod memory;
mod named;
mod patches;
mod period;
mod pressure_limit;
mod properties;
mod rolled_towards;
mod tables;
mod tangential_influence;
mod tangential_rows;
mod together;
mod visco;
mod visco_step;

pub use adhesion::{Adhesion, Work};
pub use coating::{Coating, CoatingLayer};
pub use coupled::{Coupled, History};
pub use each::Each;
pub use effect::{Effect, Value};
pub use friction::{Coefficient, Friction, Motion, Prescribed, Previous};
pub use friction_law::{Branch, Fall, FrictionLaw, PlasticLayer};
pub use layer::Layer;
pub use memory::Memory;
pub use named::{Named, SET_THEM};
pub use patches::{Patches, MOST_PATCHES, NO_PATCH};
pub use period::Period;
pub use properties::{Continues, Layout, PressureLimit, Properties, Stresses};
pub use tangential_influence::{KeptInfluence, TangentialInfluence, TangentialTables};
pub use together::{
    beside, check_bodies, check_coefficients, check_effects, check_other_grids, continuing, coupled, effects,
    excluded_method, keep, limits, memory, own_coefficients, place, repeats, replace_bodies, surface,
    without_given_area, COUNT,
};
pub use visco::{Branches, Visco};

#[cfg(test)]
#[path = "../../tests/unit/foundation.rs"]
mod foundation;
#[cfg(test)]
pub use foundation::Foundation;
