//! The campaign: random scenes through the C ABI of contact-normal, each answer certified by an oracle of the campaign's own.
//!
//! `case` makes a scene from a seed, `call` has the library solve it, `operator` (with `half_space`) sums displacements directly,
//! `rules` has the promises, `bytes` (with `bytes_friction`) turns random bytes into calls, `sequence` what a handle promises beyond them, `account` what was run and
//! what failed. Some seeds are asked more beside their case: `batch`, `set_influence`, `accuracy` (a ball to an accuracy), `stress`,
//! `friction`. Nothing of
//! the library is used but the C ABI's functions: a change of its core does not touch this.

pub mod account;
pub mod accuracy;
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
mod init;
pub mod measured;
mod measures;
pub mod operator;
pub mod random;
pub mod rules;
pub mod run;
pub mod scales;
pub mod sequence;
pub mod set_influence;
pub mod stress;
mod stress_waves;
pub mod surface;
mod tangential;
pub mod verdict;
