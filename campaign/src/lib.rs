//! The campaign: random scenes are solved through the C ABI of contact-normal, and each result is checked.
//!
//! The checks use influence coefficients and products of the campaign, not of the library. Together they are called the oracle. The campaign uses
//! only the functions of the C ABI and its reader of dumps, so it does not depend on the core of the library.
//!
//! | modules | what they do |
//! |---|---|
//! | `case`, `effects`, `surface`, `scales`, `random` | make a scene from a seed |
//! | `measured` | makes a scene with a surface like measured ones |
//! | `call` | solves a scene with the library |
//! | `operator`, `half_space`, `coating`, `hankel`, `fft` | compute products A p |
//! | `rules`, `measures` | check the promises of the library for a result |
//! | `verdict` | broken promises, and excuses of results that are no solution |
//! | `sequence`, `batch`, `set_influence` | check the further promises of a handle |
//! | `run`, `account` | run the case of a seed, and count the results |
//! | `accuracy` | solves to an accuracy |
//! | `stress`, `stress_waves` | stresses below the surface |
//! | `adhesion`, `adhesion_case`, `adhesion_call` | scenes with adhesion |
//! | `friction`, `friction_...`, `slide`, `refused_force`, `tangential`, `tangential_...`, `own_tractions` | scenes with friction |
//! | `laws`, `law_case`, `flash` | laws of friction, layers that yield, wear, and flash temperatures |
//! | `relaxing` | viscoelastic bodies |
//! | `bytes`, `bytes_...` | turn random bytes into calls |
//! | `replay` | checks the scene of a dump |

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
