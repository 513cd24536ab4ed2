//! The campaign: random scenes through the C ABI of contact-normal. An oracle of the campaign's own certifies each result.
//!
//! `case` makes a scene from a seed, `measured` one with a measured surface. `call` solves it with the library, and `operator` (with `half_space`,
//! `coating` and `fft`) computes products. `rules` has the promises, `verdict` the broken ones and the excuses, and `sequence` the further promises of a
//! handle. `run` runs a case, and `account` counts the results. `bytes` (with `bytes_friction`) turns random bytes into calls. Some seeds also run
//! `batch`, `set_influence`, `accuracy` (a ball to an accuracy), `stress` (with `stress_waves`), `adhesion`, and `friction` with its rules, its
//! coefficients (`tangential`) and its handles (`friction_sequence`). `laws` runs laws of friction (`law_case`), layers that yield, wear, and `flash`
//! temperatures. `replay` judges the scene of a dump. The campaign uses only the functions of the C ABI and its reader of dumps, so it does not depend on the
//! core of the library.

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
