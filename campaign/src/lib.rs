//! The campaign: random scenes through the C ABI of contact-normal, each answer certified by an oracle of the campaign's own.
//!
//! `case` makes a scene from a seed, `measured` one of what people bring, `call` has the library solve it, `operator` (with `half_space`,
//! `coating` and `fft`) multiplies displacements, `rules` has the promises, `verdict` what was broken and what is excused, `sequence` what a
//! handle promises beyond them, `run` puts this together, and `account` tells what was run. `bytes` (with `bytes_friction`) turns random
//! bytes into calls. Some seeds are asked more beside their case: `batch`, `set_influence`, `accuracy` (a ball to an accuracy), `stress`
//! (with `stress_waves`), `adhesion`, and `friction` with its rules, its coefficients (`tangential`) and its handles
//! (`friction_sequence`); `laws` asks for laws of friction (`law_case`), layers that yield, wear, and `flash` temperatures. `replay` has the scene of
//! a dump judged. Nothing of the library is used but the C ABI's functions and its reader of dumps: a change of its core does not touch this.

pub mod account;
pub mod accuracy;
pub mod adhesion;
pub mod adhesion_call;
pub mod adhesion_case;
pub mod batch;
pub mod bytes;
mod bytes_call;
pub mod bytes_friction;
mod bytes_reader;
pub mod call;
pub mod case;
pub mod coating;
mod effect_structs;
pub mod effects;
mod fft;
pub mod flash;
pub mod friction;
pub mod friction_call;
pub mod friction_case;
mod friction_conditions;
pub mod friction_found;
pub mod friction_place;
pub mod friction_rules;
pub mod friction_sequence;
pub mod grid;
pub mod half_space;
mod hankel;
mod init;
pub mod law_case;
pub mod laws;
pub mod measured;
mod measures;
pub mod operator;
pub mod own_tractions;
pub mod random;
pub mod refused_force;
pub mod relaxing;
pub mod replay;
pub mod rules;
pub mod run;
pub mod scales;
pub mod sequence;
pub mod set_influence;
pub mod slide;
pub mod stress;
mod stress_waves;
pub mod surface;
mod tangential;
mod tangential_coating;
mod tangential_coefficients;
pub mod verdict;
