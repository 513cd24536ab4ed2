//! What a scene may name beside its bodies: one file per effect, and the list of them.
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
//! | friction | period, patches; without tangential tables influence, row_tables, coating | yes | another one for each solve |
//! | adhesion | row_tables, patches, pressure_limit, friction | no | another one for each solve |
//!
//! A new effect is a file with an `impl Effect`, a field of [`Scene`](crate::scene::Scene), and a line in the list (`list.rs`).

mod adhesion;
mod coating;
mod effect;
mod friction;
mod friction_checks;
mod layer;
mod list;
mod named;
mod patches;
mod period;
mod pressure_limit;
mod tables;
mod tangential_influence;
mod tangential_rows;

pub use adhesion::{Adhesion, Work};
pub use coating::{Coating, CoatingLayer};
pub use effect::{Effect, Value};
pub use friction::{Coefficient, Friction, Motion, Prescribed, Previous};
pub use layer::Layer;
pub use list::{check_bodies, check_effects, excluded_method, replace_bodies};
pub use named::{Named, SET_THEM};
pub use patches::Patches;
pub use period::Period;
pub use pressure_limit::PressureLimit;
pub use tangential_influence::{KeptInfluence, TangentialInfluence};
