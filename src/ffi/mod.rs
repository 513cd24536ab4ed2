//! The C ABI: translation only, no numerics. Each export goes through `guard.rs`.

#![allow(non_camel_case_types)]
#![allow(clippy::doc_lazy_continuation)] // comments of members are those of the header
#![allow(clippy::missing_safety_doc)] // the rules for all exports stand in docs/conventions.md

mod accuracy;
mod arguments;
mod batch;
mod by_name;
mod coating;
mod conclusion;
pub mod dump;
mod effects;
mod fields;
mod floating_point;
mod friction;
mod friction_results;
mod friction_tables;
mod guard;
mod has;
mod influence;
mod init;
mod kept;
mod ledger;
mod linear;
mod log;
mod marks;
mod member;
mod members;
mod options;
mod outputs;
mod price_list;
mod progress;
mod report;
mod scene;
mod set_by_name;
mod solve;
mod solver;
mod special;
mod status;
mod stress;
mod stress_outputs;
mod structs;
mod tangential;
mod warnings;
mod watcher;

pub use self::log::*;
pub use accuracy::*;
pub use batch::*;
pub use coating::*;
pub use effects::*;
pub use fields::*;
pub use friction::*;
pub use friction_results::*;
pub use has::*;
pub use influence::*;
pub use init::*;
pub use kept::*;
pub use ledger::*;
pub use linear::*;
pub use options::*;
pub use price_list::*;
pub use progress::*;
pub use report::*;
pub use scene::*;
pub use set_by_name::*;
pub use solve::*;
pub use solver::*;
pub use special::*;
pub use status::*;
pub use stress::*;
pub use stress_outputs::*;
pub use tangential::*;
pub use warnings::*;
