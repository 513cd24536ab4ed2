//! The effects that a scene may name beside its bodies: one file per effect, and the list of them.
//!
//! | effect | goes not with | MULTIGRID, FULL_MULTIGRID | on a handle |
//! |---|---|---|---|
//! | influence | period, row_tables | yes | not named: that of the set-up; named: the same |
//! | row_tables | influence, period | no | the same as influence |
//! | coating | influence, row_tables, a period in one direction | yes | that of the set-up |
//! | period | influence, row_tables, patches | no | that of the set-up |
//! | patches | period | no | those of the set-up |
//! | layer | | a uniform one | that of the set-up |
//! | pressure_limit | | yes | another one for each solve |
//! | friction | period, patches; without tangential tables influence, row_tables, coating of bodies that are not the same; with a law or a layer that yields adhesion | yes | another one for each solve |
//! | adhesion | row_tables, pressure_limit; friction of unlike bodies, with a law or with a layer that yields | no | another one for each solve |
//! | visco | layer, friction, adhesion; influence, row_tables, coating of bodies that do not relax alike | yes | its moduli and times are those of the set-up |
//!
//! | effect | on a given contact area | to an accuracy | stresses below the surface | in addition to the normal problem |
//! |---|---|---|---|---|
//! | influence, row_tables | yes | no | no | |
//! | coating | yes | yes | of the other body | |
//! | period | yes | yes | in both directions | |
//! | patches | yes | yes | yes | |
//! | layer | yes | yes | yes | |
//! | pressure_limit | no | yes | yes | |
//! | friction | yes | yes, without tangential tables | yes | the tangential problem, which may continue; of unlike bodies in turns |
//! | adhesion | no | yes, with a range | yes | |
//! | visco | yes | yes, a first step | yes | nothing: its step is a problem of other lengths, with the history of earlier steps |
//!
//! A new effect is a file with an `impl Effect`, its `mod`, and a line in the list (`list.rs`), which makes it a field of
//! [`Scene`](crate::scene::Scene). Effects act in the order of the list; `together.rs` joins the properties of all effects of a scene. A problem
//! solved in turns with the normal one, or with a state from step to step, is [`Coupled`]; `tests/unit/foundation.rs` is an example. The memory of
//! the bodies themselves is [`Memory`].

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
